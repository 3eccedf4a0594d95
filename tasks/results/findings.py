"""Findings of a check as a table."""

from __future__ import annotations

from pathlib import Path

from ...core.display import counted
from ...core.lint.finding import Finding, Severity
from ..files.source_places import short_place

COLUMNS = (
    ("line", "right"),
    ("", "left"),
    ("rule", "left"),
    ("finding", "left"),
    ("what to do", "left"),
)


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
        """A row for each finding; places in the program's own file are lines alone."""
        return [
            (short_place(program, f.span), str(f.severity), f.rule, f.message, f.fix) for f in self
        ]

    def __repr__(self) -> str:
        return f"<Findings: {self.said}>"

    def _repr_html_(self) -> str:
        from ...core.notebook import page, table

        return page(self.said, table(COLUMNS, self.rows()) if self else "")
