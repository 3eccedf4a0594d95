"""Station files with their programs as driven, and what joins these checked."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import said_in_file
from ...core.errors import InputError, MotionError, Note
from ..setup import start_of
from .members import ReadMember, drive_members, read_member
from .names import check_names
from .own_parts import check_own_parts
from .taken import taken_notes

if TYPE_CHECKING:
    from ...core.dialect import SignalWords
    from ...core.program.program import Program
    from ...core.robot.model import Robot
    from ...core.source.reading import Reading
    from ...core.source.text.files import SourceFile
    from ...core.station.actions import Action
    from ...core.station.station import Driven, Passing, RobotStation, StationRobot
    from ...core.station.station_file import StationFile

Sources = str | Path | Sequence[str | Path]
"""A station file, or backups."""


@dataclass(frozen=True)
class OpenedStation:
    """A station with its programs as driven.

    Args:
        station: the robots.
        actions: what their programs do with signals.
        unknown: what is said of statements that set signals in ways that nobody knows.
        notes: what else a user should know.
    """

    station: RobotStation
    actions: dict[str, tuple[Action, ...]]
    unknown: tuple[Note, ...]
    notes: tuple[Note, ...]


def open_station(
    source: Sources, say: Callable[[str], None], *, proven: bool = True
) -> OpenedStation:
    """A station with its programs as driven, and what these do with signals.

    Args:
        proven: whether something is proven of it, as nothing can be where nobody knows a tool or
            work object.

    Raises:
        InputError, MotionError: as `station_with`.
    """
    from ...core.station.actions import actions_of, unknown_of
    from ...core.station.hand_over import check_hand_overs
    from ...core.station.held_together import check_held_together
    from ...core.station.station import RobotStation
    from ...core.station.station_file import read_station_file
    from ...core.station.synchronised import moves_together, synchronised
    from ...core.station.world_zones import on_at_start, with_zones

    sources = _listed(source)
    stated = len(sources) == 1 and is_station_file(sources[0])
    file = read_station_file(sources[0]) if stated else _of_backups(sources)
    with said_in_file(_keys(stated)):
        read = _read(file, say, proven)
    try:
        together = moves_together(
            {name: one.program for name, one in read.items()},
            {name: one.meetings for name, one in read.items()},
            {name: one.ids() for name, one in read.items()},
        )
    except InputError as error:
        raise InputError(f"{file.file}: {error}") from None
    with said_in_file(_keys(stated)):
        driven = drive_members(read, file, together, say)
    members, actions = {}, {}
    unknown: list[Note] = []
    notes: list[Note] = []
    for name, (made, of_parts) in driven.items():
        words, passed = read[name].words, read[name].passed
        notes += of_parts
        file, said = _with_own_zones(file, made, words)
        _check_axes(file, made)
        actions[name] = with_zones(actions_of(made.run, words), file.zones, name, made.run)
        members[name] = replace(made, passing=_passing(file, made, words, passed))
        looked_at = _looked_at(file, name) - _zoned(file, name)
        for note in said:
            asked = any(one.casefold() in note.message.casefold() for one in looked_at)
            (unknown if asked else notes).append(note)
        for text, span in unknown_of(made.run, words, looked_at):
            where = "" if span is None else f"{span}: "
            unknown.append(
                Note(
                    f"{name}: {where}{text}: what this does to its signal is not known, and "
                    "times are as if it did nothing; what the interlocks allow is not looked at"
                )
            )
    try:
        check_names(file, members, actions)
    except InputError as error:
        why = "; ".join(note.message for note in unknown if "not followed" in note.message)
        raise InputError(f"{error}; {why}" if why else str(error)) from None
    _check_starts(file, members)
    carried = {name for name, member in members.items() if member.carried}
    carried |= {name for each in file.held_together for name in (each.holder, each.other)}
    shared = synchronised({n: m.run for n, m in members.items()}, actions, together, carried)
    try:
        for each in file.held_together:
            check_held_together(each, members, shared.paces, together)
    except InputError as error:
        raise InputError(f"{file.file}: {error}") from None
    actions = shared.actions
    members = {n: replace(m, pace=shared.paces.get(n, m.pace)) for n, m in members.items()}
    station = RobotStation(
        members,
        file.wires,
        file.gates,
        file.initial
        | {
            f"{zone.robot}.{zone.signal}"
            for zone in file.zones
            if on_at_start(zone, members[zone.robot].run)
        },
        file.given,
        file.clearance,
        file.allowed,
        file.file,
        file.zones,
        file.hand_overs,
    )
    check_hand_overs(station)
    check_own_parts(file, members.values())
    if not stated:
        notes.append(
            Note(
                f"{file.file}: of backups nobody says what joins outputs and inputs of robots, and "
                "what stands around; a station file does, and may name a backup as the program of "
                "each robot, with its task"
            )
        )
    taken = [note for name, one in members.items() for note in taken_notes(one, actions[name])]
    unknown += [note for note in taken if note.damage]
    notes += [note for note in taken if not note.damage]
    notes += [*shared.notes, *_alone(actions), *_passed(actions, members)]
    return OpenedStation(station, actions, tuple(unknown), tuple(notes))


def _keys(stated: bool) -> dict[str, str]:
    """How options of a robot's program are said of a station, by their names."""
    keys = ("cell", "entry", "task", "answers", "start", "configuration")
    found = {**{key: key for key in keys}, "robot": "robot in its cell file"}
    return found if stated else {name: f"{key} in a station file" for name, key in found.items()}


def _read(file: StationFile, say: Callable[[str], None], proven: bool) -> dict[str, ReadMember]:
    """The programs of all robots; what nothing can be proven of is refused, if that is asked."""
    read = {}
    for member in file.members:
        say(f"reading {member.name}")
        read[member.name] = read_member(member, file)
        if proven:
            _refuse_assumed(file, member.name, read[member.name].program)
    return read


def _refuse_assumed(file: StationFile, name: str, program: Program) -> None:
    from ...core.program.assumed_places import refuse_assumed

    try:
        refuse_assumed(program)
    except InputError as error:
        raise InputError(f"{file.file}: robot.{name}: {error}") from None


def is_station_file(source: Path) -> bool:
    """Whether a source is a station file, and not a backup."""
    return source.suffix.casefold() == ".toml"


def _listed(source: Sources) -> list[Path]:
    return [Path(source)] if isinstance(source, str | Path) else list(map(Path, source))


def _of_backups(sources: Sequence[Path]) -> StationFile:
    """A station of the tasks of backups that move robots; nothing joins their signals.

    A robot is called as its task; as its file, where that has one.

    Raises:
        InputError: one is no backup, or fewer than two of their tasks move robots.
    """
    from ...core.station.station_file import MemberFile, StationFile
    from ..backup.finding import find_backup
    from ..catalogue import registry

    members: list[MemberFile] = []
    file = Path(", ".join(map(str, sources)))
    for source in sources:
        if is_station_file(source):
            raise InputError(f"{source}: a station file stands for itself: give no other beside it")
        backup = find_backup(source, registry())
        if backup is None:
            raise InputError(
                f"{source}: is neither a station file (.toml) nor a backup: of programs alone "
                "nobody says which robots drive them, and where these stand; write a station file"
            )
        moving = [task.name for task in backup.tasks if task.robot is not None]
        single = len(sources) > 1 and len(moving) == 1
        for task in moving:
            name = source.stem if single else task
            if name in {member.name for member in members}:
                name = f"{source.stem} {task}"
            members.append(MemberFile(name, None, source, None, task, None, None, None, 0.0))
    if len(members) < 2:
        counted = f"{len(members)} of its tasks moves a robot"
        raise InputError(f"{file}: {counted}; a station has two robots or more")
    return StationFile(tuple(members), (), {}, frozenset(), {}, 0.0, (), file)


def _with_own_zones(
    file: StationFile, member: StationRobot, words: SignalWords | None
) -> tuple[StationFile, list[Note]]:
    """The station file with the world zones that a robot's program sets up itself, and what is said
    of them. For outputs for which the file has a zone that one counts."""
    from ...core.source.reading import Reading
    from ...core.spatial.pose import IDENTITY

    reading = member.program.reading
    if words is None or words.zones is None or not isinstance(reading, Reading):
        return file, []
    found, notes = words.zones(_loaded(reading, member.program), member.cell.robot)
    if found and member.world != IDENTITY:
        why = "its world zones are in its controller's world: give them in the station file"
        return file, [Note(f"{member.name}: {zone.signal}: {why}") for zone in found]
    stated = {name.casefold() for name in _zoned(file, member.name)}
    own = [
        replace(zone, robot=member.name) for zone in found if zone.signal.casefold() not in stated
    ]
    said = [
        replace(note, message=f"{member.name}: {note.message}")
        for note in notes
        if not any(note.message.casefold().startswith(f"{name}:") for name in stated)
    ]
    said += [
        Note(
            f"{member.name}: the controller sets {zone.signal} by the world zone {zone.name}, from "
            "the start on"
        )
        for zone in own
    ]
    return replace(file, zones=(*file.zones, *own)), said


def _loaded(reading: Reading, program: Program) -> dict[str, SourceFile]:
    """The files that a controller has loaded: those of its backup; else those that are driven or
    were named, as others may only lie beside them."""
    if reading.options.beside is not None:
        return dict(reading.files)
    named = {reading.main, *map(str, reading.options.others)}
    named |= {move.statement.file for move in program.moves if move.statement is not None}
    return {name: file for name, file in reading.files.items() if name in named}


def _looked_at(file: StationFile, robot: str) -> set[str]:
    """Outputs of a robot that wires and gates look at."""
    named = [wire.source for wire in file.wires]
    named += [one.name for gate in file.gates.values() for one in (*gate.inputs, *gate.resets)]
    parted = [name.partition(".") for name in named]
    return {rest.strip() for own, _, rest in parted if own.strip().casefold() == robot.casefold()}


def _zoned(file: StationFile, robot: str) -> set[str]:
    """Outputs of a robot that the file's zones set."""
    return {zone.signal for zone in file.zones if zone.robot == robot}


def _check_axes(file: StationFile, member: StationRobot) -> None:
    """Zones watch axes that there are, in the units of these."""
    from ...core.robot.joint import JointKind

    robot = member.cell.robot
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    for zone in file.zones:
        if zone.robot != member.name:
            continue
        given = (("axes_deg", zone.axes), ("axes_mm", zone.linear_axes))
        for key, index in ((key, index) for key, ranges in given for index, _, _ in ranges):
            where = f"{file.file}: zone.{zone.name}: {key}"
            if index >= len(joints):
                raise InputError(
                    f"{where}: {member.name} has axes 1 to {len(joints)}, no axis {index + 1}"
                )
            own = "axes_mm" if joints[index].kind is JointKind.PRISMATIC else "axes_deg"
            if key != own:
                raise InputError(
                    f"{where}: the range of {member.name}'s axis {index + 1}, "
                    f"{joints[index].name}, is given as {own}"
                )


def _alone(actions: dict[str, tuple[Action, ...]]) -> Iterator[Note]:
    """Meetings to which no other robot of the station comes."""
    from ...core.program.signal import Meet

    who: dict[str, set[str]] = {}
    first: dict[str, Action] = {}
    for name, doings in actions.items():
        for action in doings:
            if isinstance(action.does, Meet):
                who.setdefault(action.does.label, set()).add(name)
                first.setdefault(action.does.label, action)
    for label, names in who.items():
        if len(names) == 1:
            action, (name,) = first[label], names
            where = "" if action.span is None else f"{action.span}: "
            yield Note(
                f"{name}: {where}{action.text}: no other robot of the station comes to this "
                "meeting: it is taken to wait for nobody"
            )


def _passed(
    actions: dict[str, tuple[Action, ...]], members: dict[str, StationRobot]
) -> Iterator[Note]:
    """Waits behind a zone: the robot is taken to stop there, which controllers may not."""
    from ...core.program.signal import WaitSignal

    for name, doings in actions.items():
        known = members[name].passing
        for action in doings:
            if not isinstance(action.does, WaitSignal) or known is None:
                continue
            if action.move in known.moves:
                where = "" if action.span is None else f"{action.span}: "
                yield Note(
                    f"{name}: {where}{action.text}: the move before it has a zone: the robot is "
                    "driven with a stop there, and a controller that finds the condition "
                    "fulfilled in time passes through the zone; clearances are proven of both, "
                    "times are those with the stop"
                )


def _passing(
    file: StationFile,
    member: StationRobot,
    words: SignalWords | None,
    moves: tuple[int, ...],
) -> Passing | None:
    """What a robot drives that passes through the zones of moves, which waits stand behind."""
    from ...core.station.actions import actions_of
    from ...core.station.passing import passing, zones_overlap
    from ...core.station.station import Passing
    from ...core.station.world_zones import with_zones

    def drive(which: Collection[int]) -> Driven:
        program = member.carrying(passing(member.program, words, which))
        run = member.controller.run(program, start_of(member.program))
        return run, with_zones(actions_of(run, words), file.zones, member.name, run)

    if not moves:
        return None
    where = f"{file.file}: robot.{member.name}: where it need not stop for a wait behind a zone"
    try:
        made = Passing(moves, drive, *drive(moves))
    except MotionError as error:
        raise InputError(f"{where}: {error}") from error
    if len(moves) > 1 and zones_overlap(member.run, made.run):
        names = ", ".join(str(move + 1) for move in moves)
        raise InputError(
            f"{where}: behind moves {names} it waits, zones there overlap, and its path depends on "
            "which of them it passes: no clearance would be proven of all these paths: make the "
            "zones smaller, or end the moves at a stop"
        )
    return made


def _foot(robot: Robot) -> tuple[float, float, float]:
    """Where a robot's first axis stands on the level of its base, m in the world: two arms on one
    body share a base."""
    from ...core.spatial.pose import Pose

    x, y, _ = robot.joints[robot.along[0]].placement.position
    return (robot.base @ Pose((x, y, 0.0))).position


def _check_starts(file: StationFile, members: dict[str, StationRobot]) -> None:
    """No two robots stand in one place."""
    import numpy as np

    arms = {n: m.cell.robot for n, m in members.items() if m.cell.robot.has_arm}
    places = {name: np.array(_foot(robot)) for name, robot in arms.items()}
    names = list(places)
    for k, one in enumerate(names):
        for other in names[k + 1 :]:
            if np.linalg.norm(places[one] - places[other]) < 1e-3:
                raise InputError(
                    f"{file.file}: {one} and {other} stand at one place: their cells put both "
                    f"bases at {1e3 * places[one].round(4)} mm in the world; say in each cell "
                    "where its robot stands (base), or in the station file where its controller's "
                    "world is (world = { xyz_mm = [3000, 0, 0] })"
                )
