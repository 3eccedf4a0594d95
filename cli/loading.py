"""Programs, robots and answers as the options name them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from . import values
from .installed import check_language, registry, vendor_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..core.cell.cell import Cell
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.program.tool import Tool
    from ..core.robot.model import Robot
    from ..core.source.execution.answers import Answers
    from ..core.vendor import Vendor


@dataclass(frozen=True)
class Source:
    """A program and what is needed to read it.

    Args:
        file: the program.
        entry: the routine to run; None for the vendor's own.
        answers: file of answers; None for none.
        others: further files of the program.
        start: where the robot stands before the first move, as ``--start`` says it.
    """

    file: Path
    entry: str | None = None
    answers: Path | None = None
    others: tuple[Path, ...] = ()
    start: str | None = None

    @classmethod
    def of(
        cls,
        file: Path,
        entry: str | None,
        answers: Path | None,
        others: list[Path] | None,
        start: str | None = None,
    ) -> Source:
        """From the options as they were given."""
        return cls(file, entry, answers, tuple(others or ()), start)

    def inputs(self, *more: Path | None) -> list[Path]:
        """All files that are read: none of them is ever written to."""
        given = (self.file, self.answers, *self.others, *more)
        return [path for path in given if path is not None]

    def read(self, vendor: Vendor, robot: Robot) -> Program:
        """The program.

        Raises:
            FlybyError: it is another vendor's, or cannot be read.
        """
        check_language(vendor, self.file)
        stand = start_of(self.start, robot)
        return vendor.read_file(self.file, self.entry, robot, self._answers(), self.others, stand)

    def _answers(self) -> Answers | None:
        if self.answers is None:
            return None
        from ..core.source.execution.answers import load_answers

        return load_answers(self.answers)


def robot_of(
    name: str | None, cell: Path | None, motion: Path | None = None
) -> tuple[Vendor, Robot]:
    """The robot that ``--robot`` or ``--cell`` names, with its vendor.

    Args:
        name, cell: as the options give them.
        motion: file of how the robot is driven; None for what cell and vendor state.

    Raises:
        InputError: no robot is given, name and cell contradict each other, or the motion file is
            unusable.
    """
    vendor, robot = _stated(name, cell)
    return (vendor if motion is None else vendor.driven_by(motion, robot)), robot


def cell_of(
    robot: tuple[Vendor, Robot],
    file: Path | None,
    tools: Iterable[Tool] = (),
    *,
    no_floor: bool,
) -> Cell:
    """What stands around a robot: what the cell file says, or nothing but a floor.

    Args:
        robot: as `robot_of` gives it.
        file: the cell; None where there is none.
        tools: that are mounted, where no file says so.
        no_floor: whether ``--no-floor`` was given.

    Raises:
        InputError: the file is unusable, or ``--no-floor`` is given with one.
    """
    vendor, arm = robot
    if file is None:
        from ..core.cell.floor import bare_cell

        return bare_cell(arm, vendor.name, tools, floor=not no_floor)
    if no_floor:
        raise InputError(f"--no-floor: what stands around is what the cell {file} says; change it")
    from ..core.cell.file import load_cell

    return load_cell(file, registry())


def _stated(name: str | None, cell: Path | None) -> tuple[Vendor, Robot]:
    if cell is None:
        if name is None:
            raise InputError("which robot? Give --robot ('flyby robots' lists them) or --cell")
        return vendor_of(name), registry().find_robot(name)
    from ..core.cell.file import load_cell

    loaded = load_cell(cell, registry())
    if name is not None and name != loaded.robot.name:
        raise InputError(f"--robot {name}: the cell {cell} has a {loaded.robot.name}")
    return loaded.find_vendor(registry()), loaded.robot


def start_of(text: str | None, robot: Robot) -> JointTarget | None:
    """Where ``--start`` has the robot stand; None if it was not given."""
    from ..core.program.target import JointTarget

    if text is None:
        return None
    q = values.configuration(text, "--start", robot)
    return JointTarget(q[: robot.arm_size], q[robot.arm_size :])
