"""A block's program driven at given values of its variables, and how its path changes with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.errors import MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.geometry.corners import Room
from ....core.motion.geometry.segments import left_jacobian
from ....core.motion.gradients.path_gradient import SINGULAR_TARGET
from ....core.motion.gradients.segment_tangents import SIZES, Directions, end_jacobians
from ....core.motion.gradients.sensitivity import (
    PathPlaces,
    Sensitivity,
    configurations,
    place_near,
)
from ....core.motion.path.path import Path
from ....core.motion.timing.timing import Timing
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from .blocks import MoveBlock
from .parts import JointPoint, PosePoint, ZonePart
from .variables import ProgramVariables

_STRAIGHT, _ZONE = 0.05, 16
"""rad of joint motion (or its like in m of path, see `segments`) between places on straight parts;
intervals of a zone."""
_LEAST, _MOST = 4, 60
_CROWD = 25
"""Places of a crowd."""


@dataclass(frozen=True)
class DrivenBlock:
    """The program at some values.

    Args:
        x: (n,) of the variables.
        program: with them.
        path, timing: as driven.
        rooms: between neighbouring zones.
        q: (L, N), configurations at the places.
    """

    x: FloatArray
    program: Program
    path: Path
    timing: Timing
    rooms: tuple[Room, ...]
    q: FloatArray


@dataclass(frozen=True)
class Change:
    """How a drive changes with the K variables that are free.

    Args:
        q: (L, N, K), of the places asked for.
        rooms: (R, K).
        waypoints: (M + 1, N, K), of the configurations at the waypoints.
    """

    q: FloatArray
    rooms: FloatArray
    waypoints: FloatArray


def drivable(
    controller: Controller, path: Path, blocks: Sequence[MoveBlock], notes: list[Note]
) -> tuple[MoveBlock, ...]:
    """The blocks that are driven alone as they are in their program; notes name the others.

    Args:
        controller: that drives them.
        path: of the whole program.
        blocks: of it.
        notes: why a block stays as it is goes here.
    """
    found: list[MoveBlock] = []
    for block in blocks:
        moves = [i - block.first for i in path.route.moves if block.first <= i <= block.last]
        why = "other waypoints are left out"
        try:
            if list(Driver(controller, block).moves) == moves:
                found.append(block)
                continue
        except MotionError as error:
            why = error.message
        notes.append(Note(f"all stays as it is until the robot stops, as alone {why}", block.first))
    return tuple(found)


class Driver:
    """Drives one block.

    Args:
        controller: that drives it.
        block: the block.
        density: how many times denser than usual places stand.
        more: further places.

    Raises:
        MotionError: the block cannot be driven as it was given.
    """

    def __init__(
        self,
        controller: Controller,
        block: MoveBlock,
        density: int = 1,
        more: PathPlaces | None = None,
    ) -> None:
        self.controller = controller
        self.variables = block.variables
        self.program = block.program
        self._first = self._path(block.variables.start)
        self.places = _places(self._first, density)
        if more is not None:
            self.places = self.places.with_more(more)

    @property
    def moves(self) -> tuple[int, ...]:
        """Indices of the moves that are driven."""
        return self._first.route.moves

    def drive(self, x: FloatArray) -> DrivenBlock | None:
        """The program at x; None where it cannot be driven."""
        planned = self._planned(x)
        if planned is None:
            return None
        program, path = planned
        try:
            timing = self.controller.stamp(program, path)
        except MotionError:
            return None
        return DrivenBlock(
            x, program, path, timing, tuple(path.rooms()), configurations(path, self.places)
        )

    def _planned(self, x: FloatArray) -> tuple[Program, Path] | None:
        """The program at x and its path, if the same moves are driven as of the one given."""
        try:
            program = self.variables.applied(x)
            path = self.controller.plan(program)
        except MotionError:
            return None
        return (program, path) if path.route.moves == self._first.route.moves else None

    def change(self, drive: DrivenBlock, which: IntArray) -> Change:
        """Derivatives at a drive, for some of the places.

        Raises:
            MotionError: a pose target is singular.
        """
        places = PathPlaces(self.places.part[which], self.places.share[which])
        directions = directions_of(self.variables, drive)
        made = Sensitivity(drive.path, directions)
        rooms = [made.reach(room.left) for room in drive.rooms]
        return Change(
            made.configurations(places, drive.q[which]),
            np.array(rooms).reshape(len(rooms), directions.count),
            directions.waypoints,
        )

    def _path(self, x: FloatArray) -> Path:
        return self.controller.plan(self.variables.applied(x))


def crowd(path: Path, sigma: float, q: FloatArray, density: int) -> PathPlaces:
    """Places close together round one at which something was met between places.

    Args:
        path: of the block.
        sigma, q: of the meeting.
        density: of the places that it lies between.
    """
    centre = place_near(path, sigma, q)
    part = int(centre.part[0])
    counts = _counts(path, density)
    spacing = 1.0 / (counts[part] if part < len(counts) else density * _ZONE)
    shares = centre.share[0] + spacing * np.linspace(-1.5, 1.5, _CROWD)
    shares = shares[(shares >= 0.0) & (shares <= 1.0)]
    return PathPlaces(np.full(len(shares), part), shares)


def _counts(path: Path, density: int) -> IntArray:
    """Intervals between the places of each straight part."""
    wanted = np.ceil(density * path.segments.scale / _STRAIGHT)
    return np.clip(wanted, density * _LEAST, density * _MOST).astype(np.int64)


def _places(path: Path, density: int) -> PathPlaces:
    """In order along the path: straight part, zone, straight part, …"""
    counts = _counts(path, density)
    part: list[IntArray] = []
    share: list[FloatArray] = []
    for k, count in enumerate(counts):
        inner = np.linspace(0.0, 1.0, count + 1)
        last = k == len(counts) - 1
        inner = inner[0 if k == 0 else 1 : None if last else -1]
        part.append(np.full(len(inner), k))
        share.append(inner)
        if not last:
            blend = np.linspace(0.0, 1.0, density * _ZONE + 1)
            part.append(np.full(len(blend), len(counts) + k))
            share.append(blend)
    return PathPlaces(np.concatenate(part), np.concatenate(share))


def directions_of(variables: ProgramVariables, drive: DrivenBlock) -> Directions:
    """One direction for each variable that is free.

    Raises:
        MotionError: a pose target is singular.
    """
    route, free = drive.path.route, variables.free
    joints, twists = _at_targets(variables, drive)
    sizes = {name: np.zeros((len(route.zone_moves), variables.size)) for name in SIZES}
    corner = {move: k for k, move in enumerate(route.zone_moves)}
    for index, part in enumerate(variables.parts):
        if isinstance(part, ZonePart):
            column = variables.offsets[index]
            for k in (corner[move] for move in part.moves if move in corner):
                for name, rate in zip(SIZES, part.rates(), strict=True):
                    sizes[name][k, column] = rate
    waypoints = _at_waypoints(drive, joints[..., free], twists[..., free])
    return Directions(waypoints, {name: size[:, free] for name, size in sizes.items()})


def _at_targets(variables: ProgramVariables, drive: DrivenBlock) -> tuple[FloatArray, FloatArray]:
    """How the joints (M, N, n) of joint targets and the poses (M, 6, n) of pose targets change."""
    path, size = drive.path, variables.size
    joints = np.zeros((len(path.route.moves), path.q.shape[1], size))
    twists = np.zeros((len(path.route.moves), 6, size))
    waypoint = {move: k for k, move in enumerate(path.route.moves)}
    for index, part in enumerate(variables.parts):
        own, values = variables.columns(index), variables.of(index, drive.x)
        if isinstance(part, JointPoint):
            slope = part.slope(values)
            for k in (waypoint[move] for move in part.moves if move in waypoint):
                joints[k, list(part.axes), own] = slope
        elif isinstance(part, PosePoint):
            slope = np.eye(6)
            slope[3:, 3:] = left_jacobian(values[3:])
            for k in (waypoint[move] for move in part.moves if move in waypoint):
                twists[k, :, own] = slope
    return joints, twists


def _at_waypoints(drive: DrivenBlock, joints: FloatArray, twists: FloatArray) -> FloatArray:
    """(M + 1, N, K), how the configurations at the waypoints change where those of joint targets
    (M, N, K) and the poses of the others (M, 6, K) do.

    Raises:
        MotionError: a pose target is singular.
    """
    route = drive.path.route
    arm, J = route.robot.arm_size, end_jacobians(route.ends.q, route.chains)[:, 1]
    waypoints = np.zeros((len(route.moves) + 1, *joints.shape[1:]))
    squares = J[:, :, route.solved]
    regular = np.zeros(len(squares), dtype=bool)
    posed = any(isinstance(drive.program.moves[i].target, PoseTarget) for i in route.moves)
    if posed and len(route.solved) == 6:
        regular = np.linalg.cond(squares) < SINGULAR_TARGET
    for k, move in enumerate(route.moves):
        target, found = drive.program.moves[move].target, waypoints[k + 1]
        # Axes that a target does not name keep the value that they had at the one before.
        named = arm + len(target.external)
        found[named:] = waypoints[k, named:]
        if isinstance(target, JointTarget):
            found[:named] = joints[k, :named]
        elif target.arm_angle is not None:
            _lead(drive.path, k, J[k], twists[k], found)
        elif not regular[k]:
            raise _singular(move)
        elif twists[k].any() or found.any() or waypoints[k].any():
            redundant = route.prescribed[route.prescribed < arm]
            found[redundant] = waypoints[k, redundant]
            wanted = twists[k] - J[k][:, route.prescribed] @ found[route.prescribed]
            found[route.solved] = np.linalg.solve(squares[k], wanted)
    return waypoints


def _lead(path: Path, k: int, J: FloatArray, twist: FloatArray, found: FloatArray) -> None:
    """Write how the configuration (N, K) at the target of segment k changes, which states an arm
    angle: that stays, and tells where the third axis stands.

    Raises:
        MotionError: it is singular.
    """
    arm, q = path.route.robot.arm_size, path.route.ends.q[k, 1]
    square = np.vstack([J[:, :arm], path.route.robot.arm_angle_slope(q)])
    if not np.linalg.cond(square) < SINGULAR_TARGET:
        raise _singular(path.route.moves[k])
    wanted = np.zeros((arm, twist.shape[1]))
    wanted[:6] = twist - J[:, arm:] @ found[arm:]
    found[:arm] = np.linalg.solve(square, wanted)


def _singular(move: int) -> MotionError:
    return MotionError("the arm is singular at the target, where derivatives do not exist", move)
