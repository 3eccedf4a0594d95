"""Loops and routines of URScript: ``while``, functions without parameters."""

from __future__ import annotations

from ....core.program.move import Move
from ....core.source.text.names import Names
from ....core.source.write import structure
from .declarations import Line
from .instructions import Phrases, WrittenSettings


class Structure(structure.Structure[Line]):
    """Writes them.

    Args:
        names: gives functions theirs.
        phrases: know where the robot stands.
    """

    held: WrittenSettings
    fallback = "routine"

    def __init__(self, names: Names, phrases: Phrases) -> None:
        super().__init__(names, WrittenSettings())
        self._phrases = phrases

    def nothing_known(self) -> WrittenSettings:
        """See `core.source.write.structure.Structure`."""
        return WrittenSettings(known=False)

    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """``i = 0``, ``while i < 3: … i = i + 1 end``"""
        step: Line = (f"{counter} = {counter} + 1",)
        head = [(f"{counter} = 0",), (f"while {counter} < {count}:",)]
        return [*head, *_indented([*body, step]), ("end",)]

    def endless(self, body: list[Line]) -> list[Line]:
        """``while True: … end``"""
        return [("while True:",), *_indented(body), ("end",)]

    def call(self, name: str) -> Line:
        """``pick()``"""
        return (f"{name}()",)

    def passed(self, move: Move, index: int) -> None:
        """See `core.source.write.structure.Structure`."""
        self._phrases.passed(move)


def _indented(lines: list[Line]) -> list[Line]:
    return [("  ", *line) for line in lines]
