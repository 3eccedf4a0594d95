"""Findings of a check as a table."""

from __future__ import annotations

from pathlib import Path

from ...core.display import alike, counted
from ...core.lint.finding import Finding, Severity
from ..files.source_places import short_place

COLUMNS = (
    ("line", "right"),
    ("", "left"),
    ("rule", "left"),
    ("finding", "left"),
    ("what to do", "left"),
)

MOST_ALIKE = 5
"""Findings that differ in numbers alone that a table lists one by one; JSON has all of them."""


class Findings(tuple[Finding, ...]):
    """What was found, in the order of the source."""

    __slots__ = ()

    @property
    def errors(self) -> tuple[Finding, ...]:
        """Those without which the program does not run as it should."""
        return tuple(found for found in self if found.severity is Severity.ERROR)

    @property
    def said(self) -> str:
        """How many there are of each severity."""
        counts = {kind: sum(f.severity is kind for f in self) for kind in Severity}
        told = [counted(n, str(kind)) for kind, n in counts.items() if n]
        return ", ".join(told) or "nothing found"

    def rows(self, program: Path | None = None) -> list[tuple[str, ...]]:
        """A row a finding, of more than `MOST_ALIKE` the first, with how many are like it.

        Args:
            program: places in whose own file are lines alone.
        """
        kinds = alike(self, lambda one: f"{one.rule} {one.message}")
        many = {id(same[0]): len(same) - 1 for same in kinds if len(same) > MOST_ALIKE}
        left = {id(one) for same in kinds if len(same) > MOST_ALIKE for one in same[1:]}
        rows: list[tuple[str, ...]] = []
        for one in self:
            if id(one) not in left:
                more = f" (and {many[id(one)]} like it)" if id(one) in many else ""
                place = short_place(program, one.span)
                rows.append((place, str(one.severity), one.rule, one.message + more, one.fix))
        return rows

    def __repr__(self) -> str:
        return f"<Findings: {self.said}>"

    def _repr_html_(self) -> str:
        from ...core.notebook import page, table

        return page(self.said, table(COLUMNS, self.rows()) if self else "")
