"""The data that a script declares, each value once and under one name."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.source.text.names import Names


@dataclass(frozen=True, slots=True)
class Datum:
    """A value with a name.

    Args:
        text: the value's literal.
        wanted: the name it had in its source.
    """

    text: str
    wanted: str


Operand = str | Datum
Line = tuple[Operand, ...]
"""Text, and data whose names are not given yet."""


class Declarations:
    """Data in the order of their first use; names are given once all are known."""

    def __init__(self) -> None:
        self._data: dict[Datum, None] = {}

    def add(self, text: str, wanted: str | None) -> Operand:
        """The datum of a value with a name; a value without one stands where it is used."""
        if not wanted:
            return text
        datum = Datum(text, wanted)
        self._data.setdefault(datum)
        return datum

    def names(self, names: Names) -> dict[Datum, str]:
        """A name for every datum: its own where it is legal and free."""
        return {datum: names.claim(datum.wanted, "target") for datum in self._data}

    def lines(self, names: dict[Datum, str]) -> list[str]:
        """The declarations: global, so that threads see them too."""
        return [f"global {names[datum]} = {datum.text}" for datum in self._data]
