"""What `flyby.emulate` returns."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from ...core.display import counted
from ...core.driving.driven_program import DrivenProgram
from ...core.errors import InputError, MotionError
from ...core.motion.emulator import run as core_run
from ...core.motion.path.path import Path
from ...core.motion.timing.timing import Timing
from ...core.notebook import PictureCurve, page, picture
from ...core.robot.model import Robot
from .causes import PASSED, PlaceOf, TimeCause, causes_of, first_to_change
from .lines import LineReport, lines_of
from .report import MoveTable, Report, make_report

if TYPE_CHECKING:
    from ...core.collision.clearance import MoveClearance


@dataclass(frozen=True, repr=False)
class Run(DrivenProgram):
    """A driven program with its robot: moves as a table, pictures, how it shows itself in
    notebooks.

    Args:
        robot: that was driven.
        clearances: how near its moves come, as far as they come nearer than those before or than
            the cell allows; empty without a cell.
        time_range: s, least and greatest time if the robot's assumed speeds and accelerations are
            off by their spread; None where none has one.
    """

    robot: Robot = field(kw_only=True)
    clearances: tuple[MoveClearance, ...] = field(default=(), kw_only=True)
    time_range: tuple[float, float] | None = field(default=None, kw_only=True)

    @classmethod
    def of(
        cls,
        driven: DrivenProgram,
        robot: Robot,
        clearances: tuple[MoveClearance, ...] = (),
        time_range: tuple[float, float] | None = None,
    ) -> Run:
        """A driven program with its robot."""
        return cls(
            driven.program,
            driven.parts,
            driven.faults,
            robot=robot,
            clearances=clearances,
            time_range=time_range,
        )

    def __repr__(self) -> str:
        return f"{super().__repr__()[:-1]} on {self.robot.name}>"

    @property
    def whole(self) -> core_run.Run:
        """The one run of all moves.

        Raises:
            MotionError: a move cannot be driven, so that there are several, in `parts`; or the
                program moves nothing.
        """
        self.refuse_standing()
        if self.faults:
            raise MotionError(
                f"{counted(self.faults, 'move')} cannot be driven, the first is: "
                f"{self.faults[0]}; what can be driven is in parts"
            )
        return self.parts[0].run

    @property
    def path(self) -> Path:
        """The geometry; see `whole` for what is raised."""
        return self.whole.path

    @property
    def timing(self) -> Timing:
        """The stamp, before any smoothing in time; see `whole` for what is raised."""
        return self.whole.timing

    def exported(self, file: str | FilePath) -> bytes:
        """The motion for other software, by the plugin whose files end as this one.

        Raises:
            InputError: there is none, or it makes no bytes.
            MotionError: a move cannot be driven.
        """
        from ..catalogue import registry

        exporter = registry().exporter_of(file)
        made = exporter.export(self.whole)
        if not isinstance(made, bytes):
            raise InputError(
                f"the plugin that exports {exporter.name} is at fault: it gives no bytes, but "
                f"{type(made).__name__}"
            )
        return made

    @cached_property
    def report(self) -> Report:
        """All figures of the run, move by move."""
        return make_report(self, self.robot, self.clearances, self.time_range)

    @property
    def moves(self) -> MoveTable:
        """One entry for each move of the program: time, length, speed, what limits it."""
        return self.report.moves

    @property
    def lines(self) -> tuple[LineReport, ...]:
        """What each line of the source drives and waits, however often it runs."""
        return lines_of(self.program, self.report)

    @cached_property
    def causes(self) -> tuple[TimeCause, ...]:
        """What the time is lost to, and what each cause would give back if it fell away."""
        if not self.parts:
            return ()
        from ...core.motion.emulator.controller import Controller
        from ...problems.improve.zones.sizes import pattern_for
        from ..setup import setup_of_program

        setup = setup_of_program(self.program)
        zone = pattern_for(setup.vendor.speaks).resized(PASSED)
        return causes_of(Controller(setup.vendor, self.robot), self, self.report, zone)

    def first_to_change(self, place: PlaceOf = lambda span: str(span.line)) -> str:
        """What to change first if the cycle is to be shorter, in a sentence or two.

        Args:
            place: a line of the source, short.

        Raises:
            FlybyError: nobody knows who drives the program.
        """
        often = {line.span: line.times for line in self.lines if line.span is not None}
        return first_to_change(self.causes, often, self.report.driven_time, place)

    def picture(self, kind: str = "svg") -> bytes:
        """Path and motion drawn, as a file.

        Args:
            kind: ``png``, ``pdf`` or ``svg``.

        Raises:
            MotionError: the program moves nothing.
        """
        self.refuse_standing()
        from ...drawing.run import draw

        return draw(self, self.robot, kind)

    def show(self) -> None:
        """Show the run in a browser, or in a notebook's frame; see `flyby.show`."""
        from ..pages.show import show

        show(self)

    def _repr_html_(self) -> str:
        """The page of the run in a frame; below it, folded, what shows where no script runs."""
        if not self.parts:
            return self._table()
        from ...drawing.page.html import page_frame
        from ..pages.of_results import page_bytes

        told = (
            f"<details><summary>{html.escape(repr(self)[1:-1])}</summary>{self._table()}</details>"
        )
        return page_frame(page_bytes(self)) + told

    def _table(self) -> str:
        curves = [
            PictureCurve("path of the TCP", part.run.trajectory.position) for part in self.parts
        ]
        told = [*(f"fault: {fault}" for fault in self.faults), *map(str, self.notes)]
        return page(repr(self)[1:-1], self.moves._repr_html_(), picture(curves), notes=told)
