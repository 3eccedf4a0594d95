"""Which robot a program is for, who drives it and what stands around it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.display import in_line
from ..core.door import called, given, spelt, switched
from ..core.errors import InputError, OptionError
from ..core.robot_files import names_file
from .catalogue import cell_around, driver_of, registry, robots
from .catalogue import robot as robot_called
from .options.entries import TaskOptions, choice, switch, value

if TYPE_CHECKING:
    from ..core.backup.backup import Backup
    from ..core.cell.cell import Cell
    from ..core.errors import Note
    from ..core.motion.emulator.controller import Controller
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.program.tool import Tool
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

NO_FLOOR = "Without a cell the plane under the robot's base is an obstacle; this lifts it."


def configurations() -> Any:
    """The option that says what becomes of configuration data that contradict their target."""
    return choice(
        None,
        "Configuration data that contradict their target: a fault (exact, the default), or given "
        "up for the solution nearest to where the robot comes from.",
        ("exact", "nearest"),
    )


@dataclass(frozen=True, kw_only=True)
class RobotOptions(TaskOptions):
    """The robot, its cell, how it is driven; of a program that was read, its own if unset."""

    robot: str | Robot | None = value(
        None,
        "Robot, such as abb/irb6640-180-255 (`robots`), or its file: a catalogue file (.toml), a "
        "URDF, a KUKA's $machine.dat.",
    )
    vendor: str | None = value(
        None, "Whose controller drives the robot, where its file does not say."
    )
    cell: str | Path | Cell | None = value(
        None,
        "Cell file: robot, base, external axes, tools, obstacles, parts, clearance.",
        kind=Path,
    )
    motion: str | Path | None = value(
        None, "How the robot is driven, as `identify` writes it (TOML).", kind=Path
    )
    machine_data: str | Path | None = value(
        None,
        "What the robot's own controller says of this arm: calibration.conf (UR), $machine.dat "
        "(KUKA).",
        kind=Path,
    )
    configuration: str | None = configurations()


@dataclass(frozen=True, kw_only=True)
class CellOptions(RobotOptions):
    """The same where it counts what stands around."""

    no_floor: bool = switch(NO_FLOOR)


@dataclass(frozen=True, repr=False)
class Setup:
    """A robot with who drives it and what stands around it.

    Args:
        vendor: as it drives the robot, by the user's motion file where there is one.
        robot: where it stands, with its external axes.
        cell: None where no cell file says what stands around.
        backup: that the program was read of; None if it was read of files.
    """

    vendor: Vendor
    robot: Robot
    cell: Cell | None = None
    backup: Backup | None = None

    def __repr__(self) -> str:
        file = None if self.cell is None else self.cell.file
        around = ("no cell" if self.cell is None else "cell") + (f" {file.name}" if file else "")
        return in_line(f"Setup: {self.robot.name}, driven by {self.vendor.name}, {around}")

    def surroundings(self, program: Program | None = None, *, no_floor: bool = False) -> Cell:
        """What stands around: what the cell file says, or nothing but a floor.

        Args:
            program: whose tools are mounted where no file says so.
            no_floor: whether not even a floor is there.

        Raises:
            InputError: the floor is lifted of a cell.
        """
        if self.cell is None:
            from ..core.cell.floor import bare_cell

            moves = () if program is None else program.moves
            tools: Iterable[Tool] = dict.fromkeys(move.tool for move in moves)
            return bare_cell(self.robot, self.vendor.name, tools, floor=not no_floor)
        if no_floor:
            where = "" if self.cell.file is None else f" {self.cell.file}"
            raise OptionError(
                f"{switched('no_floor')}: what stands around is what the cell{where} says; "
                "change it"
            )
        return self.cell

    def before_programs(self, *, no_floor: bool = False) -> tuple[Cell, tuple[Note, ...]]:
        """What stands around where no program tells which parts are taken: all lie where they are
        at first. And what there is to say of that.

        Raises:
            InputError: the floor is lifted of a cell.
        """
        from ..core.cell.lying_parts import with_parts_lying

        return with_parts_lying(self.surroundings(no_floor=no_floor))


def setup_of(options: RobotOptions, known: Robot | None = None) -> Setup:
    """The robot that options name.

    Args:
        known: the arm as a backup has it, with its own ranges, base and external axes. Options that
            name the same arm mean this one; what a cell file says of it goes first.

    Raises:
        InputError: none is named, robot and cell contradict each other, or a file is unusable.
    """
    made = _stated(options, known)
    if options.vendor not in (None, made.vendor.name):
        raise InputError(
            f"{given('vendor', str(options.vendor))}: {made.robot.name} is driven by "
            f"{made.vendor.name}"
        )
    return laid_on(made, options)


def laid_on(made: Setup, options: RobotOptions) -> Setup:
    """A setup with the user's files of this one robot on top.

    Raises:
        InputError: a file cannot be read, or is another robot's.
    """
    if options.machine_data is not None:
        robot = made.vendor.as_described(made.robot, Path(options.machine_data))
        cell = None if made.cell is None else replace(made.cell, robot=robot)
        vendor = made.vendor.as_stated(robot, Path(options.machine_data))
        made = replace(made, vendor=vendor, robot=robot, cell=cell)
    if options.motion is not None:
        made = replace(made, vendor=made.vendor.driven_by(Path(options.motion), made.robot))
    if options.configuration is not None:
        nearest = options.configuration == "nearest"
        made = replace(made, vendor=replace(made.vendor, nearest=nearest))
    return made


def _stated(options: RobotOptions, known: Robot | None) -> Setup:
    robot, cell = options.robot, options.cell
    if cell is None:
        if robot is None:
            raise OptionError(
                f"which robot? Give {spelt('robot')} ({called('robots')} lists them) or "
                f"{spelt('cell')}"
            )
        arm = robot_called(robot, options.vendor) if isinstance(robot, str) else robot
        same = isinstance(robot, str) and not names_file(robot) and known is not None
        return _driven(known if same and known is not None and known.name == arm.name else arm)
    loaded = cell_around(cell, known) if isinstance(cell, str | Path) else cell
    if isinstance(robot, str):
        robot = robot if robot == loaded.robot.name else robot_called(robot, options.vendor)
    name = robot if robot is None or isinstance(robot, str) else robot.name
    if name is not None and name != loaded.robot.name:
        where = "" if loaded.file is None else f" {loaded.file}"
        raise InputError(
            f"{given('robot', name)}: the cell{where} is one of {loaded.robot.name}; leave the "
            "robot out, or give a cell of this robot"
        )
    return Setup(loaded.find_vendor(registry()), loaded.robot, loaded)


def _driven(robot: Robot) -> Setup:
    """A robot with the vendor who drives it, and knows it though it comes of a file."""
    return Setup(driver_of(robot), robot)


def named_robot(name: str) -> Setup:
    """The robot called ``vendor/robot``, or of a file, as its vendor drives it.

    Raises:
        UnknownNameError: there is none.
    """
    return _driven(robot_called(name))


def writable_robot(name: str, option: str | None = None) -> Setup:
    """A robot for which programs can be written; of a vendor with one robot its own name will do.

    Args:
        name: ``vendor/robot``.
        option: that may name the vendor alone; None where the robot must be named.

    Raises:
        InputError: there is none, or it can be emulated only.
    """
    if option is not None and "/" not in name and name in registry().vendors:
        own = robots(name)
        if len(own) != 1:
            raise InputError(
                f"{option} {name}: which of its {len(own)} robots? {called('robots', name)} lists "
                "them"
                if own
                else f"{option} {name}: it has no robot"
            )
        (name,) = own
    made = named_robot(name)
    made.vendor.check_written(made.robot)
    return made


def check_language(vendor: Vendor, program: Path) -> None:
    """Refuse a program that another vendor's controller runs.

    Raises:
        InputError: the file is no program of the vendor, judged by its suffix, and of plain text by
            what stands in it.
    """
    if program.suffix.lower() in vendor.suffixes:
        return
    other = registry().reader_of(program)
    if other is vendor or other.name == vendor.name:  # it may have got what a backup says of it
        return
    raise InputError(
        f"{program} is a program for {other.name}, the robot is driven by {vendor.name}; "
        f"choose a robot of {other.name} ({called('robots', other.name)} lists them)"
    )


def in_setup(program: Program, setup: Setup) -> Program:
    """A program that knows its setup, read again where it was read for a robot elsewhere.

    Raises:
        InputError: another vendor's controller runs it, or it says something else there: it has to
            be read for that robot.
    """
    from ..core.source.reading import Reading

    reading = program.reading
    if isinstance(reading, Reading) and (main := Path(reading.main)).suffix:
        check_language(setup.vendor, main)
    if isinstance(reading, Reading) and reading.options.robot != setup.robot:
        placed = replace(reading, options=replace(reading.options, robot=setup.robot))
        if placed.again({}) != reading.again({}):
            raise InputError(
                f"program {program.name!r} says something else for {setup.robot.name} where it "
                "stands now than where it was read for: read it with the same robot and cell"
            )
        program = replace(program, reading=placed)
    return replace(program, setup=setup)


def with_setup(program: Program, options: RobotOptions) -> tuple[Program, Setup]:
    """A program with its setup: what options name, else what it was read for.

    Raises:
        InputError: it is no program, nobody says which robot, or the program is for another one.
    """
    from ..core.program.program import Program

    if not isinstance(program, Program):
        raise InputError(
            f"expected a program, not {type(program).__name__}: flyby.read(path, robot=…) gives one"
        )
    own = program.setup if isinstance(program.setup, Setup) else None
    if options.robot is None and options.cell is None:
        if own is None:
            setup_of(options)  # asks for the robot
        assert own is not None
        made = laid_on(own, options)
        if made is own:
            return program, own
        if made.robot is not own.robot:
            return in_setup(program, made), made
        return replace(program, setup=made), made
    made = setup_of(options, own.robot if own is not None and own.backup is not None else None)
    said = options.motion is not None or (made.cell is not None and made.cell.motion is not None)
    if not said and own is not None and own.robot == made.robot:
        # A motion file that the program was read with stays, unless another is named.
        nearest = own.vendor.nearest if options.configuration is None else made.vendor.nearest
        made = replace(made, vendor=replace(own.vendor, nearest=nearest))
    return in_setup(program, made), made


def setup_of_program(program: Program) -> Setup:
    """The robot that a program was read for.

    Raises:
        InputError: it was read for none.
    """
    return with_setup(program, RobotOptions())[1]


def start_of(program: Program) -> JointTarget | None:
    """Where a program was read to begin; None where nothing was said of it."""
    from ..core.source.reading import Reading

    reading = program.reading
    return reading.options.start if isinstance(reading, Reading) else None


def controller_of(program: Program, setup: Setup) -> Controller:
    """The controller for a program that is used as a whole.

    Raises:
        InputError: a tool or work object of it is not known.
        MotionError: moves cannot be driven; it names all of them.
    """
    from ..core.driving.past_faults import refuse_faults
    from ..core.motion.emulator.controller import Controller
    from ..core.program.assumed_places import refuse_assumed

    refuse_assumed(program)
    controller = Controller(setup.vendor, setup.robot)
    refuse_faults(controller, program, start_of(program))
    return controller


def like(program: Program, original: Program, setup: Setup) -> Program:
    """A program that was read back, for the robot and from the start of the one it was made of."""
    from ..core.source.reading import Reading

    reading, start = program.reading, start_of(original)
    if isinstance(reading, Reading) and reading.options.start != start:
        reading = replace(reading, options=replace(reading.options, start=start))
    return replace(program, setup=setup, reading=reading)
