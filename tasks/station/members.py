"""The robots of a station: their programs read, and driven in their cells."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core.errors import FlybyError, InputError, Note
from ..read import SourceOptions, read_with
from ..results.cell_course import CellCourse
from ..setup import Setup, setup_of_program, start_of

if TYPE_CHECKING:
    from ...core.dialect import SignalWords
    from ...core.program.program import Program
    from ...core.spatial.pose import Pose
    from ...core.station.actions import MeetingPoint
    from ...core.station.carried import Carrier
    from ...core.station.station import CarriedMoves, StationRobot
    from ...core.station.station_file import MemberFile, StationFile
    from ...core.station.synchronised import IdOf, Together

Driven = tuple["StationRobot", list[Note]]
"""A robot, and what there is to say of the parts of its cell."""


@dataclass(frozen=True)
class ReadMember:
    """A robot whose program has been read.

    Args:
        stated: what the station file says of it.
        program: that stops for all waits.
        setup: its robot and cell.
        words: how its language says what it does with signals; None if nobody knows.
        passed: moves whose zones it may pass through though a wait stands behind.
        meetings: where it waits for others.
        carried: moves on what other robots turn.
    """

    stated: MemberFile
    program: Program
    setup: Setup
    words: SignalWords | None
    passed: tuple[int, ...]
    meetings: tuple[MeetingPoint, ...]
    carried: tuple[CarriedMoves, ...] = ()

    @property
    def not_followed(self) -> tuple[str, ...]:
        """Units that move work objects of its targets, and are none of its robot's."""
        units = [move.work_object.not_followed for move in self.program.moves]
        return tuple(dict.fromkeys(unit for unit in units if unit is not None))

    def ids(self) -> IdOf | None:
        """The ids by which its moves are made together with others'."""
        from ...core.source.reading import Reading

        together = None if self.words is None else self.words.together
        if together is None:
            return None
        program = self.program

        def found(index: int) -> str | None:
            span, reading = program.moves[index].statement, program.reading
            if span is None or not isinstance(reading, Reading) or span.file not in reading.files:
                return None
            return together(reading.files[span.file].text[span.start : span.end])

        return found


def read_member(stated: MemberFile, file: StationFile) -> ReadMember:
    """Read the program of a robot.

    Raises:
        InputError: it cannot be read; the message names file and robot.
    """
    from ...core.spatial.pose import IDENTITY
    from ...core.station.actions import meetings_of
    from ...core.station.passing import stopping, waits_behind_zones

    try:
        source = SourceOptions(
            cell=stated.cell,
            entry=stated.entry,
            task=stated.task,
            answers=stated.answers,
            start=stated.start,
            configuration=stated.configuration,
        )
        program: Program = read_with(stated.program, source)
        setup = setup_of_program(program)
        if stated.world != IDENTITY:
            program, setup = _moved(program, setup, stated.world)
        words = None if setup.vendor.speaks is None else setup.vendor.speaks.signals
        passed = waits_behind_zones(program, words)
        program = stopping(program, words)
        meetings = meetings_of(program, words)
    except FlybyError as error:
        raise InputError(f"{file.file}: robot.{stated.name}: {error}") from error
    return ReadMember(stated, program, setup, words, passed, meetings)


def _moved(program: Program, setup: Setup, world: Pose) -> tuple[Program, Setup]:
    """A program with its robot and cell where its controller's world is in the station's."""
    from ...core.cell.placing import moved_cell, moved_program, moved_robot

    robot = moved_robot(setup.robot, world)
    cell = None if setup.cell is None else moved_cell(setup.cell, robot, world)
    setup = replace(setup, robot=robot, cell=cell)
    return replace(moved_program(program, world), setup=setup), setup


def drive_members(
    read: Mapping[str, ReadMember],
    file: StationFile,
    together: Sequence[Together],
    say: Callable[[str], None],
) -> dict[str, Driven]:
    """Drive the programs of all robots, those first that turn what others work on.

    Raises:
        InputError: one cannot be driven; the message names file and robot.
    """
    driven: dict[str, Driven] = {}
    under_way: list[str] = []

    def drive(name: str) -> None:
        if name in driven:
            return
        member = read[name]
        under_way.append(name)
        try:
            carriers = {unit: _owner(read, member, unit) for unit in member.not_followed}
            if ring := set(carriers.values()) & set(under_way):
                raise InputError(
                    f"it works on what {' and '.join(ring)} turns, which waits for it in turn: "
                    "that is not followed"
                )
        except InputError as error:
            raise InputError(f"{file.file}: robot.{name}: {error}") from None
        for carrier in carriers.values():
            drive(carrier)
        say(f"driving {name}")
        try:
            for unit, carrier in carriers.items():
                member = _following(member, unit, _carrier(read, driven, carrier), together)
            driven[name] = _driven(member)
        except FlybyError as error:
            raise InputError(f"{file.file}: robot.{name}: {error}") from error
        under_way.pop()

    for name in read:
        drive(name)
    return {name: driven[name] for name in read}


def _owner(read: Mapping[str, ReadMember], member: ReadMember, unit: str) -> str:
    """The robot of which a unit is an axis.

    Raises:
        InputError: there is none, or several.
    """
    found = [
        name
        for name, other in read.items()
        if other is not member
        and unit.casefold() in {axis.name.casefold() for axis in other.setup.robot.external_axes}
    ]
    if len(found) == 1:
        return found[0]
    index, move = next(
        (i, move)
        for i, move in enumerate(member.program.moves)
        if move.work_object.not_followed == unit
    )
    where = "" if move.statement is None else f"{move.statement}: "
    told = (
        f"{where}move {index + 1}: its target is in work object {move.work_object.name}, which "
        f"{unit} moves, and "
    )
    if found:
        raise InputError(
            f"{told}{' and '.join(found)} have an axis of that name: leave it in the cell of the "
            "one whose program turns it"
        )
    raise InputError(
        f"{told}{unit} is no axis of this robot, nor of another one of the station: if {unit} is a "
        f"table, give it to the robot whose program turns it, as [external_axis.{unit}] of its "
        "cell (a cell without robot, with vendor, has tables alone); work objects that arms hold "
        "for others are not followed: leave these moves out of the programs of the station"
    )


def _carrier(read: Mapping[str, ReadMember], driven: Mapping[str, Driven], name: str) -> Carrier:
    from ...core.station.carried import Carrier

    member = driven[name][0]
    return Carrier(name, member.cell.robot, member.run, read[name].meetings)


def _following(
    member: ReadMember, unit: str, carrier: Carrier, together: Sequence[Together]
) -> ReadMember:
    """A robot with what another one turns under the targets that lie on it."""
    from ...core.source.reading import Reading
    from ...core.station.carried import CarriedProgram, carried_by

    program = member.program
    given = CarriedProgram(program, member.setup.robot, start_of(program), member.carried)
    made = carried_by(member.stated.name, given, unit, carrier, member.meetings, together)
    setup = member.setup
    cell = None if setup.cell is None else replace(setup.cell, robot=made.robot)
    setup = replace(setup, robot=made.robot, cell=cell)
    program, reading = replace(made.program, setup=setup), made.program.reading
    if isinstance(reading, Reading) and reading.options.start is not None:
        options = replace(reading.options, start=made.start)
        program = replace(program, reading=replace(reading, options=options))
    return replace(member, program=program, setup=setup, carried=made.moves)


def _driven(member: ReadMember) -> Driven:
    from ...core.driving.past_faults import refuse_faults
    from ...core.motion.emulator.controller import Controller
    from ...core.station.station import StationRobot

    program, setup, name = member.program, member.setup, member.stated.name
    controller = Controller(setup.vendor, setup.robot)
    refuse_faults(controller, program, start_of(program))
    course = CellCourse.of(program, setup)
    run = controller.run(course.program, start_of(program))
    made = StationRobot(
        name,
        program,
        controller,
        setup.surroundings(program),
        run,
        member.stated.begins,
        handling=course.handling,
        carried=member.carried,
        world=member.stated.world,
    )
    return made, [replace(note, message=f"{name}: {note.message}") for note in course.notes]
