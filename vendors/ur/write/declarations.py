"""The data that a script declares, each value once and under one name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ....core.source.write import declarations
from ....core.source.write.declarations import NewDatum

Operand = str | NewDatum
Line = tuple[Operand, ...]
"""Text, and data whose names are not given yet."""


class Declarations(declarations.Declarations):
    """Data in the order of their first use, global, so that threads see them too."""

    types = ("",)

    def add(self, text: str, wanted: str | None) -> Operand:
        """The datum of a value with a name; a value without one stands where it is used."""
        if not wanted:
            return text
        return self.declare(NewDatum("", text, wanted, wanted, "target"), wanted)

    def numbered(self) -> Mapping[str, Iterator[str]]:
        """None: all have names."""
        return {}

    def line(self, datum: NewDatum, name: str) -> str:
        """``global p1 = p[…]``"""
        return f"global {name} = {datum.text}"
