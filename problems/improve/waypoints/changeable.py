"""Which of a program's points and zones may change, and why the others stay.

Tasks stay where they are: stop points, and the ends of moves whose path the process fixes. What
moves is via points: waypoints of `MoveJ` and `MoveL` that the robot passes. Stops that may be
passed get small zones to begin with, and are such points then.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Hashable, Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ....core.collision.proof.certificate import SceneOf
from ....core.collision.scene.bodies import BodyKind
from ....core.collision.scene.handled_pairs import RESTING
from ....core.collision.scene.scene import TouchingPairs
from ....core.errors import InputError, MotionError, Note, UnknownNameError
from ....core.motion.emulator.controller import Controller
from ....core.motion.path.path import Path
from ....core.program.move import Move, MoveC
from ....core.program.origin import Origin, Ownership
from ....core.program.program import Program
from ....core.program.target import JointTarget
from ....core.program.zone import ContourFraction, Fine, Radius, VendorZone
from ....core.robot.model import Robot
from ..process_paths import why_process
from ..zones.points import passable_stops
from .options import Freedom, WaypointTask
from .oriented import stays_oriented
from .point_limits import Fixed, PointLimit

_RADII = (0.01, 0.003, 0.001)
"""m that freed stops begin with: the first with which every waypoint is still driven."""

STAYS = "stays as it is"


@dataclass(frozen=True)
class Selection:
    """What may change.

    Args:
        points: groups of moves (indices) whose targets are one datum each, and may move.
        zones: groups of moves whose zones are one datum each, and may change.
        reasons: why a fly-by point, or its zone, stays, by the index of its move.
        passed: indices of the moves whose waypoint the robot passes.
        alone: which of both stays where the other one may change: ``target`` or ``zone``.
    """

    points: tuple[tuple[int, ...], ...]
    zones: tuple[tuple[int, ...], ...]
    reasons: dict[int, str]
    passed: tuple[int, ...]
    alone: dict[int, str] = field(default_factory=dict)

    @property
    def stays(self) -> dict[int, str]:
        """The reasons in sentences."""
        parts = {i: f"its {part} " for i, part in self.alone.items()}
        return {i: f"{parts.get(i, '')}{STAYS}: {why}" for i, why in self.reasons.items()}


def select(program: Program, path: Path, robot: Robot, task: WaypointTask) -> Selection:
    """What of a driven program may change.

    Args:
        program: the program.
        path: its path, which says where the robot stops.
        robot: that drives it.
        task: the user's wishes.

    Raises:
        InputError: a move or speed is named that the program does not have.
    """
    moves = program.moves
    process = _process_moves(program, task)
    work = {i: why_process(output) for i, output in task.process.items()} | process
    passed = tuple(
        owner
        for zone, owner in zip(path.route.zones, path.route.zone_moves, strict=True)
        if not isinstance(zone, Fine)
    )
    after = _following(path)
    why_zone: dict[int, str] = {}
    why_point: dict[int, str] = {}
    for i in passed:
        asked = i in task.freed or not isinstance(task.limits.get(i, Fixed()), Fixed)
        reason = task.settled.get(task.given_move(i))
        reason = reason or _why_untouched(i, after[i], process if asked else work)
        if reason is None and not _sizable(moves[i]):
            why_zone[i] = "its zone has no radius to change"
        elif reason is not None:
            why_zone[i] = reason
        reason = reason or _why_fixed(moves, i, after[i], task)
        reason = reason or _why_oriented(moves[i], i, robot, task)
        if reason is not None:
            why_point[i] = reason
    points = _groups(moves, passed, why_point, "target")
    zones = _groups(moves, passed, why_zone, "zone")
    reasons = {i: why for i, why in why_zone.items() if not any(i in g for g in zones)}
    alone = dict.fromkeys(reasons, "zone")
    if task.freedom is not Freedom.ZONES:
        still = {i: why for i, why in why_point.items() if not any(i in g for g in points)}
        alone |= dict.fromkeys(still, "target")
        alone = {i: part for i, part in alone.items() if not (i in reasons and i in still)}
        reasons |= still
    return Selection(points, zones, dict(sorted(reasons.items())), passed, alone)


def beside_parts(task: WaypointTask, program: Program, path: Path, scenes: SceneOf) -> WaypointTask:
    """The task with what has to stay where parts are taken and released.

    Args:
        task: of the program as it was given, with its `handling`.
        program: that one.
        path: of it.
        scenes: of its moves.
    """
    assert task.handling is not None
    moves, driven = program.moves, path.route.moves
    settled = dict.fromkeys(task.handling.targets, "a part is taken or released there")
    limits: dict[int, PointLimit] = {}
    ways: set[int] = set()
    for k, i in enumerate(driven):
        for touching in scenes(moves[i].tool, i).left_out:
            ways.add(i)
            if i < touching.moves[1]:
                settled.setdefault(i, "what a part touches is not apart yet there")
            leaving, coming = (_depth(touching, end) for end in (0, 1))
            if leaving > RESTING:
                limits[i] = Fixed(_SUNK.format(1e3 * leaving, "releases", "out of"))
            if coming > RESTING and k:
                limits[driven[k - 1]] = Fixed(_SUNK.format(1e3 * coming, "takes", "into"))
    return replace(task, settled=settled, ways=ways, limits=dict(task.limits) | limits)


_SUNK = "the tool's shape is {:.1f} mm in the part that it {} there, so no other way {} it is known"


def _depth(touching: TouchingPairs, end: int) -> float:
    """m by which a tool is in a part at an end of a move, at most."""
    scene, deepest = touching.scene, 0.0
    for pair, floor in zip(scene.pairs, touching.floor[:, end], strict=True):
        kinds = {scene.bodies[k].kind for k in pair}
        if kinds == {BodyKind.TOOL, BodyKind.PART} and np.isfinite(floor):
            deepest = max(deepest, -float(floor) - RESTING)
    return deepest


def _process_moves(program: Program, task: WaypointTask) -> dict[int, str]:
    """Moves that stay as they are, and why."""
    moves = program.moves
    for i in (*task.keep, *task.limits):
        if not 0 <= i < len(moves):
            raise InputError(f"move {i + 1} is to be kept, but the program has {len(moves)} moves")
    names = {move.speed.name for move in moves if move.speed.name is not None}
    for name in task.keep_speeds:
        if name not in names:
            raise UnknownNameError("speed of the program", name, names)
    found: dict[int, str] = {}
    for i, move in enumerate(moves):
        if i in task.keep:
            found[i] = "it is to be kept"
        elif move.speed.name is not None and move.speed.name in task.keep_speeds:
            found[i] = f"its speed {move.speed.name} is the process's"
        elif move.events:
            found[i] = "something is switched on its way"
        elif move.speed.duration is not None:
            found[i] = "it takes a programmed time"
    return found


def _following(path: Path) -> dict[int, int]:
    """The move driven after each move whose zone counts."""
    return dict(zip(path.route.zone_moves, path.route.moves[1:], strict=True))


def _why_untouched(i: int, after: int, process: dict[int, str]) -> str | None:
    for near in (i, after):
        if near in process:
            return process[near] if near == i else f"move {near + 1} begins here: {process[near]}"
    return None


def _sizable(move: Move) -> bool:
    return isinstance(move.zone, Radius | ContourFraction | VendorZone)


def _why_fixed(moves: Sequence[Move], i: int, after: int, task: WaypointTask) -> str | None:
    if task.freedom is Freedom.ZONES:
        return "only zones are to change"
    limit = task.limits.get(i, task.limit)
    if isinstance(limit, Fixed):
        return limit.why
    if isinstance(moves[i], MoveC) or isinstance(moves[after], MoveC):
        return "an arc begins or ends there"
    return None


def _why_oriented(move: Move, i: int, robot: Robot, task: WaypointTask) -> str | None:
    """Why a target cannot move at all while its tool keeps its orientation."""
    target = move.target
    if task.turn_at(i) != 0.0 or not isinstance(target, JointTarget):
        return None
    axes = task.free_axes(robot)
    if not stays_oriented(target, robot.arm_chain, axes):
        return None
    return "the joints that may change cannot move it without turning the tool: allow a tilt"


def _groups(
    moves: Sequence[Move], passed: Collection[int], reasons: dict[int, str], part: str
) -> tuple[tuple[int, ...], ...]:
    """Passed moves that may change, those together that read one datum; completes ``reasons``."""
    readers: defaultdict[Hashable, set[int]] = defaultdict(set)
    for i, move in enumerate(moves):
        for key in _keys(move, i, part):
            readers[key].add(i)
    found: list[tuple[int, ...]] = []
    for i in passed:
        if i in reasons or any(i in group for group in found):
            continue
        group = _joined(i, moves, readers, part)
        why = _why_group_stays(i, group, passed, reasons, moves, part)
        if why is None:
            found.append(tuple(sorted(group)))
        else:
            reasons[i] = why
    return tuple(found)


def _joined(
    i: int, moves: Sequence[Move], readers: defaultdict[Hashable, set[int]], part: str
) -> set[int]:
    """All moves that share data with move i, and those with them."""
    group, todo = {i}, [i]
    while todo:
        for key in _keys(moves[todo.pop()], i, part):
            new = readers[key] - group
            group |= new
            todo += new
    return group


def _keys(move: Move, index: int, part: str) -> Iterable[Hashable]:
    """What a part is read from: its instruction, and the literals behind it."""
    if move.origin is None:
        return [index]
    origin: Origin = getattr(move.origin, part)
    spans = [span for span in origin.numbers if span is not None]
    return [move.origin.statement, *spans] if origin.numbers else [move.origin.statement]


def _why_group_stays(
    i: int,
    group: Collection[int],
    passed: Collection[int],
    reasons: dict[int, str],
    moves: Sequence[Move],
    part: str,
) -> str | None:
    move = moves[i]
    if move.origin is not None:
        origin: Origin = getattr(move.origin, part)
        if origin.ownership is Ownership.DERIVED:
            return f"the program computes its {part}"
        if origin.ownership is Ownership.SHARED and origin.numbers and len(group) == 1:
            return f"an expression of the program reads its {part} too"
    if any(getattr(moves[j], part) != getattr(move, part) for j in group):
        return f"its {part} shares numbers with another one that has others too"
    for j in sorted(group):
        if j not in passed:
            return f"move {j + 1} has the same {part} and stops there"
        if j in reasons:
            return f"move {j + 1} has the same {part}: {reasons[j]}"
    return None


def with_freed_stops(
    controller: Controller, program: Program, task: WaypointTask, notes: list[Note]
) -> Program:
    """The program with small zones at stops that may be passed.

    Args:
        controller: drives it.
        program: the program.
        task: names the stops.
        notes: stops at which no zone can be driven are listed here, and stay.

    Raises:
        InputError: a move is named that is no stop, or one for a reason.
    """
    passable, moves = passable_stops(program), program.moves
    for i in task.freed:
        if not 0 <= i < len(moves) or i not in passable:
            raise InputError(
                f"move {i + 1} cannot be passed: it is no stop, or one for a reason (the "
                "last move, a wait, something that is switched there)"
            )
    for radius in _RADII:
        freed = _freed(program, task.freed, radius, task)
        if _driven(controller, program, freed, task):
            return freed
    made = program
    for i in task.freed:
        freed = _freed(made, [i], _RADII[-1], task)
        if _driven(controller, program, freed, task):
            made = freed
        else:
            notes.append(Note("stays a stop: its neighbours leave it no room for a zone", i))
    return made


def _freed(program: Program, stops: Collection[int], radius: float, task: WaypointTask) -> Program:
    moves = list(program.moves)
    for i in stops:
        moves[i] = replace(moves[i], zone=task.pattern.resized(radius))
    return program.with_moves(tuple(moves))


def _driven(controller: Controller, given: Program, freed: Program, task: WaypointTask) -> bool:
    """Whether the same waypoints are driven."""
    try:
        route = controller.plan(freed, task.start).route
    except MotionError:
        return False
    return route.moves == controller.plan(given, task.start).route.moves
