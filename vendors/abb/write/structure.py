"""Loops and routines of RAPID: ``FOR``, ``WHILE TRUE``, procedures without parameters."""

from __future__ import annotations

from ....core.source.text.names import Names
from ....core.source.write import structure
from .formatting import NAME_RULES
from .instructions import Line, WrittenSettings


class Structure(structure.Structure[Line]):
    """Writes them.

    Args:
        taken: names that routines and counters may not have.
    """

    held: WrittenSettings

    def __init__(self, *taken: str) -> None:
        super().__init__(Names(NAME_RULES, taken), WrittenSettings())

    def nothing_known(self) -> WrittenSettings:
        """See `core.source.write.structure.Structure`."""
        return WrittenSettings(known=False)

    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """``FOR i FROM 1 TO 3 DO … ENDFOR``; the counter is the loop's own."""
        return [(f"FOR {counter} FROM 1 TO {count} DO",), *indented(body), ("ENDFOR",)]

    def endless(self, body: list[Line]) -> list[Line]:
        """``WHILE TRUE DO … ENDWHILE``"""
        return [("WHILE TRUE DO",), *indented(body), ("ENDWHILE",)]

    def call(self, name: str) -> Line:
        """``rPick;``"""
        return (f"{name};",)


def indented(lines: list[Line]) -> list[Line]:
    """Lines inside a block."""
    return [("  ", *line) for line in lines]
