"""Programs that drive the same moves and log themselves on the controller."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .options.entries import TIME, Extent, number
from .options.keywords import by_keywords
from .setup import RobotOptions, with_setup
from .write import texts_as_files

if TYPE_CHECKING:
    from ..core.program.program import Program

PERIODS = Extent(1e-3, 1.0)
"""s. No controller logs its own joints faster; beyond 1 it was meant in ms."""


@dataclass(frozen=True, kw_only=True)
class RecordOptions(RobotOptions):
    """How a program logs itself."""

    period: float = number(0.012, "Seconds between logged samples.", TIME, PERIODS)


@dataclass(frozen=True)
class RecordedProgram:
    """A program that logs itself.

    Args:
        program: that it drives.
        period: s between samples.
        files: its texts by file name; `flyby.write` puts them into a folder.
    """

    program: Program
    period: float
    files: Mapping[str, bytes]

    def __repr__(self) -> str:
        return (
            f"<Program {self.program.name} that logs itself every {1e3 * self.period:g} ms: "
            f"{', '.join(self.files)}>"
        )


def record_with(program: Program, options: RecordOptions) -> RecordedProgram:
    """A program that drives the same moves and logs joints with time on the controller.

    Args:
        program: as `flyby.read` gives it.

    Raises:
        FlybyError: the robot's language cannot log, or cannot say what the program holds.
    """
    program, setup = with_setup(program, options)
    sources = setup.vendor.record(program, setup.robot, options.period)
    return RecordedProgram(program, options.period, texts_as_files(sources))


record = by_keywords(record_with, RecordOptions)
