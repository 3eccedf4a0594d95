"""Loops and routines of URScript: ``while``, functions whose parameters are targets."""

from __future__ import annotations

from collections.abc import Sequence

from ....core.program.move import Move
from ....core.program.places import Argument, Destination
from ....core.program.target import JointTarget
from ....core.program.tool import WorkObject
from ....core.source.text.names import Names
from ....core.source.write import structure
from ....core.source.write.structure import argument, summed
from .declarations import Line, Operand
from .formatting import number
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

    def call(
        self, name: str, arguments: Sequence[Destination], frames: Sequence[WorkObject]
    ) -> list[Line]:
        """``pick()``, ``pick(pose_add(p10, p[0, 0.05*flyby_1, 0, 0, 0, 0]))``"""
        given = [
            part
            for place, frame in zip(arguments, frames, strict=True)
            for part in (", ", *self.placed(place, frame))
        ]
        return [(f"{name}(", *given[1:], ")")]

    def placed(self, place: Destination, frame: WorkObject) -> Line:
        """Joint values or a pose, or ``pose_add(p_1, p_2)``, which adds positions.

        Args:
            frame: the work object that it is seen in.
        """
        base = self._base(place, frame)
        if place.plain:
            return (base,)
        seen = self._phrases.in_base(place, frame)
        along = [summed(terms, number) for terms in self.stretches(seen, 0)]
        return ("pose_add(", base, f", p[{', '.join(along)}, 0, 0, 0])")

    def _base(self, place: Destination, frame: WorkObject) -> Operand:
        if isinstance(place.base, Argument):
            return argument(place.base.number)
        if isinstance(place.base, JointTarget):
            return self._phrases.operands.joints(place.base)
        return self._phrases.operands.pose(place.base, frame)

    def head(self, name: str) -> str:
        """``def pick(flyby_p1):``"""
        return f"def {name}({', '.join(map(argument, range(len(self.arguments[name]))))}):"

    def passed(self, move: Move, index: int) -> None:
        """See `core.source.write.structure.Structure`."""
        self._phrases.passed(move)


def _indented(lines: list[Line]) -> list[Line]:
    return [("  ", *line) for line in lines]
