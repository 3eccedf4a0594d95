"""Two states of a program or a station: data, moves, texts, and how they are driven."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ...core.difference.data import (
    frame_differences,
    frames_of,
    load_differences,
    loads_of,
    paired,
    point_differences,
    points_of,
    pose_text,
    tool_differences,
    tools_of,
    value_differences,
)
from ...core.difference.differences import Difference, Differing
from ...core.difference.moves import move_differences
from ...core.difference.texts import FileDifference, file_differences
from ...core.difference.waits import wait_differences
from ...core.errors import InputError
from .state import MAIN, Routine, StationState, state_of

if TYPE_CHECKING:
    from ...core.backup.backup import Backup
    from ...core.program.program import Program
    from ...core.program.tool import Tool, WorkObject
    from ...core.robot.joint import Joint
    from ...core.spatial.pose import Pose
    from ..read import SourceOptions
    from ..results.runs import Run

SAME_TIME = 5e-4
"""s, and m of distance between paths: what no user would call a difference."""
_PLACE = re.compile(r"^.*?:\d+:\d+: |\S+:\d+:\d+: |, line \d+")
"""The place that a message begins with, in folders of any name, and those within."""
Kind = TypeVar("Kind")


@dataclass(frozen=True, slots=True)
class RoutineDifference:
    """How a routine is driven on both sides.

    Args:
        name: of the routine.
        times: s that it takes before and after; None where it cannot be driven, is not there, or
            no robot is known.
        distance: m, the greatest distance of either path of the TCP from the other one; None where
            one of them is not known, or not driven to its end and the same as far as it is.
        clearances: m to the cell before and after; None without a cell.
        faults: what cannot be driven after, and could before, or is otherwise.
        mended: what could not be driven before, and can now.
        lasting: what cannot be driven on either side.
    """

    name: str
    times: tuple[float | None, float | None]
    distance: float | None
    clearances: tuple[float | None, float | None]
    faults: tuple[str, ...]
    mended: tuple[str, ...]
    lasting: tuple[str, ...] = ()

    @property
    def differs(self) -> bool:
        """Whether anything does."""
        one, other = self.times
        times = one != other if None in self.times else not _near(one, other)
        return bool(times or (self.distance or 0.0) > SAME_TIME or self.faults or self.mended)


@dataclass(frozen=True)
class StateDifference:
    """What differs between two states.

    Args:
        before, after: the paths.
        differences: of data and moves.
        files: of source texts.
        routines: how each is driven, whether it differs or not.
        runs: of each routine before and after; None where it cannot be driven, or is not there.
        undriven: why times, paths, clearances and what cannot be driven are not compared: one of
            the states names no robot; empty if they are.
    """

    before: Path
    after: Path
    differences: tuple[Difference, ...]
    files: tuple[FileDifference, ...]
    routines: tuple[RoutineDifference, ...]
    runs: Mapping[str, tuple[Run | None, Run | None]] = field(
        default_factory=dict, repr=False, compare=False
    )
    undriven: str = ""

    @property
    def differs(self) -> bool:
        """Whether the states are not the same to the robot or in their texts."""
        return bool(self.differences or self.files or any(r.differs for r in self.routines))


def compared(old: Path, new: Path, options: SourceOptions) -> StateDifference:
    """What differs between two states; see `diff.diff_with`."""
    for path in (old, new):
        if not path.exists():
            raise InputError(f"{path}: there is no such file or folder")
    options.say(f"reading {old}")
    one = state_of(old, options)
    options.say(f"reading {new}")
    other = state_of(new, options)
    _check_read(one, other)
    one, other = _read_as(one, other), _read_as(other, one)
    undriven = one.undriven or other.undriven
    if undriven:
        one, other = one.read_alone(), other.read_alone()
    options.say("comparing")
    found = _once([*_of_stations(one, other), *_of_programs(one, other)])
    order = list(Differing)
    found.sort(key=lambda difference: order.index(difference.subject))
    pairs = list(paired(*_called_alike(one.routines, other.routines)))
    return StateDifference(
        old,
        new,
        tuple(found),
        file_differences(_called_as(other, one), other.texts),
        tuple(_driven(name, a, b) for name, a, b in pairs),
        {name: (_run(a), _run(b)) for name, a, b in pairs},
        undriven,
    )


def _check_read(one: StationState, other: StationState) -> None:
    """Refuse programs of which nothing can be read on either side: nobody knows what differs."""
    if one.backup is None and other.backup is None and not (one.programs or other.programs):
        errors = [side.error for state in (one, other) for side in state.routines.values()]
        raise InputError("; ".join(dict.fromkeys(errors)) or f"{one.path}: nothing drives a robot")


def _read_as(state: StationState, other: StationState) -> StationState:
    """A state that cannot be read, with its fault in each of the routines of the other one."""
    alone = state.routines.get(MAIN)
    if alone is None or alone.program is not None or not other.programs:
        return state
    return replace(state, routines=dict.fromkeys(other.routines, alone))


def _run(side: Routine | None) -> Run | None:
    return None if side is None else side.run


def _called_as(other: StationState, one: StationState) -> Mapping[str, str]:
    """The texts of one side; a program's own file is called as that of the other side."""
    names = {one.path.name: other.path.name} if one.backup is None and one.path.is_file() else {}
    return {names.get(name, name): text for name, text in one.texts.items()}


def _once(found: list[Difference]) -> list[Difference]:
    """Differences, those of one line in several routines once; a tool that programs and their
    station call otherwise, by both names."""
    seen: dict[object, Difference] = {}
    for k, one in enumerate(found):
        place = one.span or (None if one.subject is Differing.TOOL else k)
        key = (one.subject, place, one.before, one.after)
        known = seen.setdefault(key, one)
        if one.name not in known.name.split(", ") and place is None:
            seen[key] = replace(known, name=f"{known.name}, {one.name}")
    return list(seen.values())


def _of_programs(one: StationState, other: StationState) -> Iterator[Difference]:
    """Data that moves use, and the moves of the routines that both have."""
    old, new = _told(one, other), _told(other, one)
    yield from tool_differences(_tools(one, old), _tools(other, new))
    yield from frame_differences(_frames(one, old), _frames(other, new))
    yield from load_differences(loads_of(old), loads_of(new))
    yield from point_differences(points_of(old), points_of(new))
    for name, a, b in paired(*_called_alike(old, new)):
        if a is not None and b is not None:
            yield from move_differences(name, a.moves, b.moves)
            yield from wait_differences(name, a, b)


def _called_alike(
    before: Mapping[str, Kind], after: Mapping[str, Kind]
) -> tuple[Mapping[str, Kind], Mapping[str, Kind]]:
    """Routines by their names alone where neither side has several tasks."""
    tasks = [{name.rpartition("/")[0] for name in side} for side in (before, after)]
    if max(map(len, tasks)) > 1:
        return before, after
    old, new = ({n.rpartition("/")[2]: v for n, v in side.items()} for side in (before, after))
    return old, new


def _told(state: StationState, other: StationState) -> dict[str, Program]:
    """Programs of a state, without those that cannot be read on the other side.

    What is in these nobody can tell from what is gone.
    """
    pairs = paired(*_called_alike(state.routines, other.routines))
    unread = {name for name, _, b in pairs if b is not None and b.program is None}
    return {
        name: program
        for name, program in state.programs.items()
        if not {name, name.rpartition("/")[2]} & unread
    }


def _tools(state: StationState, programs: Mapping[str, Program]) -> dict[str, Tool]:
    declared = {} if state.backup is None else dict(state.backup.tools)
    return {**tools_of(programs), **declared}


def _frames(state: StationState, programs: Mapping[str, Program]) -> dict[str, WorkObject]:
    declared = {} if state.backup is None else dict(state.backup.frames)
    return {**frames_of(programs), **declared}


def _of_stations(one: StationState, other: StationState) -> Iterator[Difference]:
    """Robots, signals and entries of backups."""
    if one.backup is None or other.backup is None:
        return
    old, new = one.backup, other.backup
    yield from value_differences(Differing.ROBOT, _types(old), _types(new), str)
    yield from value_differences(Differing.BASE, _bases(old), _bases(new), pose_text)
    yield from value_differences(Differing.RANGE, _joints(old), _joints(new), _range_text)
    yield from value_differences(Differing.SIGNAL, _signals(old), _signals(new), str)
    yield from value_differences(Differing.ENTRY, _files(old), _files(new), str)


def _types(backup: Backup) -> dict[str, str]:
    return {known.unit: known.written or "not named" for known in backup.robots}


def _bases(backup: Backup) -> dict[str, Pose]:
    return {known.unit: known.robot.base for known in backup.robots if known.robot is not None}


def _joints(backup: Backup) -> dict[str, Joint]:
    return {
        f"{known.unit} {joint.name}": joint
        for known in backup.robots
        if known.robot is not None
        for joint in (*known.robot.joints, *(axis.joint for axis in known.robot.external_axes))
    }


def _range_text(joint: Joint) -> str:
    return f"{joint.shown(joint.lower)} to {joint.shown(joint.upper)}"


def _signals(backup: Backup) -> dict[str, str]:
    return {s.name: f"{s.kind.value} {s.address or ''}".strip() for s in backup.signals}


def _files(backup: Backup) -> dict[str, str]:
    return {entry.name: entry.file for task in backup.tasks for entry in task.entries}


def _driven(name: str, one: Routine | None, other: Routine | None) -> RoutineDifference:
    before, after = _faults(one), _faults(other)
    readable = other is not None and other.program is not None
    mended = tuple(fault for fault in before if fault not in after) if readable else ()
    return RoutineDifference(
        name,
        (_time(one), _time(other)),
        _distance(one, other),
        (_clearance(one), _clearance(other)),
        tuple(fault for fault in after if fault not in before),
        mended,
        tuple(fault for fault in after if fault in before),
    )


def _time(side: Routine | None) -> float | None:
    return None if side is None or side.run is None else side.run.report.cycle_time


def _clearance(side: Routine | None) -> float | None:
    nearest = None if side is None or side.run is None else side.run.report.to_cell
    return None if nearest is None else nearest.distance


def _faults(side: Routine | None) -> tuple[str, ...]:
    """What cannot be driven, without the places, which move with every line put in."""
    if side is None:
        return ()
    if side.run is None:
        return (_PLACE.sub("", side.error),) if side.error else ()
    moves = side.run.program.moves
    found = (
        f"{moves[fault.move].target.name or f'move {fault.move + 1}'}: {fault.message}"
        for fault in side.run.faults
    )
    return tuple(dict.fromkeys(found))


def _distance(one: Routine | None, other: Routine | None) -> float | None:
    if one is None or other is None or one.run is None or other.run is None:
        return None
    from ...core.difference.paths import greatest_distance

    found = greatest_distance(one.run.trajectory.position, other.run.trajectory.position)
    whole = _time(one) is not None and _time(other) is not None
    return found if whole or found > SAME_TIME else None


def _near(one: float | None, other: float | None) -> bool:
    return one is not None and other is not None and math.isclose(one, other, abs_tol=SAME_TIME)
