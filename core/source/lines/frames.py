"""Tools and frames that have numbers, and whose poses stand in registers."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError, SourceError
from ...program.tool import FLANGE, WORLD, Tool, WorkObject
from ...spatial.pose import Pose
from .positions import PositionForm
from .statements import Situation


@dataclass(frozen=True)
class FrameRegisters:
    """The registers of a language; number 0 is the flange, and the robot's base.

    Args:
        form: of their numbers.
        tool, frame: their words; ``""`` for none.
        beside: the file that states them, to be put beside programs; ``""`` where there is none.
    """

    form: PositionForm
    tool: str
    frame: str = ""
    beside: str = ""

    def tool_of(self, number: int, now: Situation) -> Tool:
        """The tool of a number."""
        if not number:
            return FLANGE
        return Tool(f"{self.tool}[{number}]", self.pose(self.tool, number, now))

    def work_object_of(self, number: int, now: Situation) -> WorkObject:
        """The work object of a frame's number."""
        if not number:
            return WORLD
        return WorkObject(f"{self.frame}[{number}]", user=self.pose(self.frame, number, now))

    def pose(self, word: str, number: int, now: Situation) -> Pose:
        """The pose that a register holds.

        Raises:
            InputError: nobody knows it.
        """
        try:
            return self.form.pose(now.vector(word, number))
        except SourceError:
            offer = f"put {self.beside} beside the program, or " if self.beside else ""
            raise InputError(
                f"{word}[{number}] is not known: {offer}answer {word}[{number},1] to "
                f"{word}[{number},6] in the table [values]"
            ) from None
