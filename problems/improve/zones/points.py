"""The fly-by points of a program, and which of them share one zone."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from ....core.door import spelt
from ....core.errors import InputError, MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.path.path import Route
from ....core.program.move import Move, Opaque, Wait
from ....core.program.origin import Ownership
from ....core.program.program import Program
from ....core.program.target import JointTarget
from ....core.program.zone import Fine, Zone
from ..process_paths import why_process
from ..rounding import SMALLEST
from .sizes import Growth, size_of

_TINY = 0.01 * SMALLEST
"""Size at which no two zones overlap."""


@dataclass(frozen=True)
class Points:
    """What may grow, and where.

    Args:
        route: of the program with tiny zones: every waypoint is there.
        move: index of the move that programs the zone of each corner.
        growths: of the zones that may change, by corner.
        groups: corners that must have one and the same zone, because one datum or instruction
            of the source states it.
        notes: which points stay as they are, and why.
    """

    route: Route
    move: tuple[int, ...]
    growths: Mapping[int, Growth]
    groups: tuple[tuple[int, ...], ...]
    notes: tuple[Note, ...]


def find_points(
    controller: Controller,
    program: Program,
    start: JointTarget | None,
    freed: Mapping[int, Zone],
    kept: Collection[int],
    apart: bool,
    process: Mapping[int, str],
) -> Points:
    """The points of a program whose zones may change.

    Args:
        controller: that drives it.
        program: the program.
        start: where the robot stands; None for the program's own.
        freed: indices of moves whose stop may become a zone, and one of its proportions.
        kept: indices of moves whose zone stays as it is.
        apart: whether zones that the source states in one datum may part.
        process: see `ZoneTask`.

    Raises:
        InputError: a move that is freed cannot be passed, or nothing can be.
        MotionError: the program cannot be driven.
    """
    moves = program.moves
    _check_freed(moves, freed)
    notes: list[Note] = []
    driven = controller.plan(program, start).route
    skipped = _beside_left_out(driven)
    # Of moves that go nowhere no zone is driven.
    beside = dict(zip(driven.zone_moves, pairwise(driven.moves), strict=True))
    patterns: dict[int, Growth] = {}
    for i, move in enumerate(moves):
        if i in kept or (isinstance(move.zone, Fine) and i not in freed):
            continue
        if size_of(freed.get(i, move.zone)) == 0:
            continue
        output = next((process[j] for j in beside.get(i, ()) if j in process), None)
        if output is not None and i not in freed:
            notes.append(_note(moves, i, why_process(output)))
        elif i in skipped:
            notes.append(_note(moves, i, skipped[i]))
        else:
            patterns[i] = Growth.of(freed.get(i, move.zone))
    tiny = tuple(
        replace(move, zone=patterns[i].zone(_TINY)) if i in patterns else move
        for i, move in enumerate(moves)
    )
    route = controller.plan(program.with_moves(tiny), start).route
    growths: dict[int, Growth] = {}
    for corner, index in enumerate(route.zone_moves):
        if index not in patterns:
            continue
        reason = _reason(moves[index], route.zones[corner], apart)
        if reason is None:
            growths[corner] = patterns[index]
        else:
            notes.append(_note(moves, index, reason))
    if not growths and not skipped:
        raise InputError(_nothing(moves, patterns, notes))
    groups = _groups(moves, route, growths, apart)
    return Points(route, route.zone_moves, growths, groups, tuple(notes))


def _beside_left_out(route: Route) -> dict[int, str]:
    """Moves whose zones decide that a waypoint is left out, and why they stay: it would return."""
    found: dict[int, str] = {}
    for i in route.left_out:
        why = f"the controller leaves the waypoint of move {i + 1} out, as blends overlap there"
        found.update((near, why) for near in (i - 1, i, i + 1))
    return found


def passable_stops(program: Program) -> list[int]:
    """Indices of the moves that end in a stop for no reason but that it is programmed."""
    found: list[int] = []
    index = -1
    for statement in program.statements:
        if isinstance(statement, Wait) or (isinstance(statement, Opaque) and statement.stops):
            if found and found[-1] == index:
                found.pop()
        elif not isinstance(statement, Opaque):
            index += 1
            if isinstance(statement.zone, Fine) and not statement.events:
                found.append(index)
    return [i for i in found if i < len(program.moves) - 1]


def _check_freed(moves: Sequence[Move], freed: Collection[int]) -> None:
    for index in freed:
        if not 0 <= index < len(moves):
            raise InputError(
                f"move {index + 1} cannot be given a zone: the program has {len(moves)} moves"
            )
        move = moves[index]
        if index == len(moves) - 1:
            message = "the last move ends in a stop, and cannot have a zone"
            raise MotionError(message, index, move.statement)
        if move.events:
            message = "something is set where it ends, so it stays a stop; do not free it"
            raise MotionError(message, index, move.statement)


def _note(moves: Sequence[Move], index: int, reason: str) -> Note:
    return Note(f"its zone stays as it is: {reason}", index, moves[index].statement)


def _reason(move: Move, driven: Zone, apart: bool) -> str | None:
    """Why a programmed zone cannot change."""
    if isinstance(driven, Fine):
        return "the robot stops here, for a wait or another instruction"
    computed = move.origin is not None and move.origin.zone.ownership is Ownership.DERIVED
    return "the program computes it" if computed and not apart else None


def _nothing(moves: Sequence[Move], patterns: Collection[int], notes: Sequence[Note]) -> str:
    if notes:
        return "no zone can be changed: " + "; ".join(str(note) for note in notes)
    if patterns:
        return "no zone can be changed: the program's zones lie where the robot does not move"
    if all(isinstance(move.zone, Fine) for move in moves):
        return (
            "the program stops at every point, so there is no zone to make larger: free stops that "
            f"the robot may pass ({spelt('free')})"
        )
    return "no zone can be changed: all of them are to be kept"


def _groups(
    moves: Sequence[Move], route: Route, growths: Collection[int], apart: bool
) -> tuple[tuple[int, ...], ...]:
    """Corners by what states their zone; those whose zone is their own are groups of one."""
    found: dict[object, list[int]] = {}
    for corner in growths:
        index = route.zone_moves[corner]
        found.setdefault(_statement(moves[index], index, apart), []).append(corner)
    return tuple(map(tuple, found.values()))


def _statement(move: Move, index: int, apart: bool) -> object:
    """What in the source states the zone of a move: equal for moves that have it in common."""
    if move.origin is None:
        return index
    zone = move.origin.zone
    if zone.ownership is Ownership.SHARED and zone.numbers and not apart:
        return zone.numbers
    # One instruction of a loop is several moves.
    return zone.span
