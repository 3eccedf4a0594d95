"""Loops and routines of RAPID: ``FOR``, ``WHILE TRUE``, procedures whose parameters are targets."""

from __future__ import annotations

from collections.abc import Sequence

from ....core.program.places import Argument, Destination
from ....core.program.target import JointTarget
from ....core.program.tool import WorkObject
from ....core.source.text.names import Names
from ....core.source.write import structure
from ....core.source.write.structure import argument, summed
from ..values.records import MM
from .formatting import NAME_RULES
from .instructions import Line, WrittenSettings
from .numbers import number
from .operands import Operand, Operands


class Structure(structure.Structure[Line]):
    """Writes them.

    Args:
        operands: of its instructions.
        taken: names that routines and counters may not have.
    """

    held: WrittenSettings

    def __init__(self, operands: Operands, *taken: str) -> None:
        super().__init__(Names(NAME_RULES, taken), WrittenSettings())
        self._operands = operands

    def nothing_known(self) -> WrittenSettings:
        """See `core.source.write.structure.Structure`."""
        return WrittenSettings(known=False)

    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """``FOR i FROM 1 TO 3 DO … ENDFOR``; the counter is the loop's own."""
        return [(f"FOR {counter} FROM 1 TO {count} DO",), *indented(body), ("ENDFOR",)]

    def endless(self, body: list[Line]) -> list[Line]:
        """``WHILE TRUE DO … ENDWHILE``"""
        return [("WHILE TRUE DO",), *indented(body), ("ENDWHILE",)]

    def call(
        self, name: str, arguments: Sequence[Destination], frames: Sequence[WorkObject]
    ) -> list[Line]:
        """``rPick;``, ``rPick Offs(p10,0,50*(flyby_1-1),0);``"""
        given = [part for place in arguments for part in (",", *self.placed(place))][1:]
        return [(name, *([" "] if given else []), *given, ";")]

    def placed(self, place: Destination) -> Line:
        """A robtarget or jointtarget, or ``Offs(Point,XOffset,YOffset,ZOffset)``."""
        base = self._base(place)
        if place.plain:
            return (base,)
        along = [summed(terms, _millimetres) for terms in self.stretches(place, 1)]
        return ("Offs(", base, f",{','.join(along)})")

    def _base(self, place: Destination) -> Operand:
        if isinstance(place.base, Argument):
            return argument(place.base.number)
        if isinstance(place.base, JointTarget):
            return self._operands.jointtarget(place.base)
        return self._operands.robtarget(place.base)

    def head(self, name: str) -> str:
        """``PROC rPick(robtarget flyby_p1)``"""
        given = (
            f"{'jointtarget' if joints else 'robtarget'} {argument(number)}"
            for number, joints in enumerate(self.arguments[name])
        )
        return f"PROC {name}({','.join(given)})"


def _millimetres(metres: float) -> str:
    return number(metres / MM)


def indented(lines: list[Line]) -> list[Line]:
    """Lines inside a block."""
    return [("  ", *line) for line in lines]
