"""What `flyby.emulate` returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from ...core.motion.emulator import run as core_run
from ...core.notebook import PictureCurve, page, picture
from ...core.robot.model import Robot
from .report import MoveTable, Report, located, make_report


@dataclass(frozen=True, repr=False)
class Run(core_run.Run):
    """The core's run with its robot: moves as a table, pictures, how it shows itself in notebooks.

    Args:
        robot: that was driven.
    """

    robot: Robot = field(kw_only=True)

    @classmethod
    def of(cls, run: core_run.Run, robot: Robot) -> Run:
        """A run with its robot, its notes with their places in the source."""
        return cls(run.program, run.path, run.timing, run.trajectory, located(run), robot=robot)

    @cached_property
    def report(self) -> Report:
        """All figures of the run, move by move."""
        return make_report(self, self.robot)

    @property
    def moves(self) -> MoveTable:
        """One entry for each move of the program: time, length, speed, what limits it."""
        return self.report.moves

    def picture(self, kind: str = "svg") -> bytes:
        """Path and motion drawn, as a file.

        Args:
            kind: ``png``, ``pdf`` or ``svg``.
        """
        from ...drawing.run import draw

        return draw(self, self.robot, kind)

    def _repr_html_(self) -> str:
        curve = PictureCurve("path of the TCP", self.trajectory.position)
        return page(repr(self)[1:-1], self.moves._repr_html_(), picture([curve]), notes=self.notes)
