"""A block's program driven at given values of its variables, and how its path changes with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray, IntArray
from ....core.errors import MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.geometry.corners import Room
from ....core.motion.geometry.segments import left_jacobian
from ....core.motion.geometry.zones import ZonePlanner
from ....core.motion.gradients.sensitivity import (
    Directions,
    PathPlaces,
    configurations,
    has_tangents,
    place_near,
    reach_tangent,
    tangents,
)
from ....core.motion.path.path import Path
from ....core.motion.timing.timing import Timing
from ....core.program.program import Program
from ....core.robot.kinematics.chain_kernels import jacobians
from .blocks import MoveBlock
from .parts import JointPoint, PosePoint, ViaPoint

_STRAIGHT, _ZONE = 0.05, 16
"""rad of joint motion (or its like in m of path, see `segments`) between places on straight parts;
intervals of a zone."""
_LEAST, _MOST = 4, 60
_CROWD = 25
"""Places of a crowd."""
_DIFFERENCE = 1e-4
"""Step of difference quotients, in units of a variable's scale."""
_REACHES = 3
"""Waypoints that many moves apart change no stretch of the path in common."""


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
    """How a drive changes with the variables.

    Args:
        q: (L, N, n), of the places asked for.
        rooms: (R, n).
        waypoints: (M + 1, N, n), of the configurations at the waypoints.
    """

    q: FloatArray
    rooms: FloatArray
    waypoints: FloatArray


class _Shifted:
    """A path beside that of a drive.

    Args:
        path: the path.
        places: at which its configurations count.
    """

    def __init__(self, path: Path, places: PathPlaces) -> None:
        self.path = path
        self.rooms = rooms_of(path)
        self.q = configurations(path, places)


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
            x, program, path, timing, rooms_of(path), configurations(path, self.places)
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
        """Derivatives at a drive, for some of the places."""
        places = PathPlaces(self.places.part[which], self.places.share[which])
        if has_tangents(drive.path):
            return self._by_formulas(drive, places)
        return self._by_differences(drive, which)

    def _path(self, x: FloatArray) -> Path:
        return self.controller.plan(self.variables.applied(x))

    # ---------------------------------------------------------- paths of joint moves alone

    def _by_formulas(self, drive: DrivenBlock, places: PathPlaces) -> Change:
        directions = self._directions(drive)
        rooms = [reach_tangent(room.left, directions) for room in drive.rooms]
        return Change(
            tangents(drive.path, places, directions),
            np.array(rooms).reshape(len(rooms), self.variables.size),
            directions.waypoints,
        )

    def _directions(self, drive: DrivenBlock) -> Directions:
        """One direction for each variable."""
        path, variables = drive.path, self.variables
        count, axes = path.segments.ends.q.shape[0], path.segments.ends.q.shape[2]
        made = Directions(
            np.zeros((count + 1, axes, variables.size)), np.zeros((count - 1, variables.size))
        )
        waypoint = {move: k + 1 for k, move in enumerate(path.route.moves)}
        corner = {move: k for k, move in enumerate(path.route.zone_moves)}
        for index, part in enumerate(variables.parts):
            columns = np.arange(variables.offsets[index], variables.offsets[index + 1])
            for move in part.moves:
                if isinstance(part, JointPoint):
                    slope = part.slope(variables.of(index, drive.x))
                    rows = np.array(part.axes)[:, None]
                    made.waypoints[waypoint[move], rows, columns] = slope
                elif isinstance(part, PosePoint):
                    turned = variables.of(index, drive.x)
                    k = waypoint[move]
                    made.waypoints[k][:, columns] = _pose_tangents(path, k, turned)
                else:
                    made.radii[corner[move], columns] = 1.0
        return made

    # ------------------------------------------------------------------- all other paths

    def _by_differences(self, drive: DrivenBlock, which: IntArray) -> Change:
        """Difference quotients; variables that change nothing in common are moved at once."""
        variables = self.variables
        step = _DIFFERENCE * variables.scale
        count, axes = drive.path.segments.ends.q.shape[0], drive.q.shape[1]
        made = Change(
            np.zeros((len(which), axes, variables.size)),
            np.zeros((len(drive.rooms), variables.size)),
            np.zeros((count + 1, axes, variables.size)),
        )
        places = PathPlaces(self.places.part[which], self.places.share[which])
        for together in self._colours:
            moved = drive.x.copy()
            moved[together] += step[together]
            sign = 1.0
            planned = self._planned(moved)
            if planned is None:
                sign = -1.0
                moved[together] -= 2.0 * step[together]
                planned = self._planned(moved)
            other = None if planned is None else _Shifted(planned[1], places)
            if other is None or len(other.rooms) != len(drive.rooms):
                continue
            self._take(drive, other, which, together, sign * step, made)
        return made

    def _take(
        self,
        drive: DrivenBlock,
        other: _Shifted,
        which: IntArray,
        together: IntArray,
        step: FloatArray,
        made: Change,
    ) -> None:
        """Difference quotients of variables that were moved at once."""
        by_place = other.q - drive.q[which]
        pairs = zip(drive.rooms, other.rooms, strict=True)
        by_room = np.array([b.left.value - a.left.value for a, b in pairs])
        by_waypoint = _waypoints(other.path) - _waypoints(drive.path)
        near_place = self._near(_place_waypoints(drive.path, self.places, which))
        near_room = self._near(np.array([[r.corner + 0.0, r.corner + 2.0] for r in drive.rooms]))
        near_waypoint = self._near(np.stack([np.arange(len(by_waypoint)) * 1.0] * 2, -1))
        for column in together:
            rows = near_place[:, column]
            made.q[rows, :, column] = by_place[rows] / step[column]
            rows = near_waypoint[:, column]
            made.waypoints[rows, :, column] = by_waypoint[rows] / step[column]
            if len(by_room):
                rows = near_room[:, column]
                made.rooms[rows, column] = by_room[rows] / step[column]

    @cached_property
    def _owners(self) -> list[FloatArray]:
        """The waypoints that each variable changes."""
        waypoint = {move: k + 1 for k, move in enumerate(self._first.route.moves)}
        corner = {move: k + 1 for k, move in enumerate(self._first.route.zone_moves)}
        owners: list[FloatArray] = []
        for part in self.variables.parts:
            known = waypoint if isinstance(part, ViaPoint) else corner
            owners += [np.array([known[move] for move in part.moves], dtype=float)] * part.size
        return owners

    def _near(self, spans: FloatArray) -> NDArray[np.bool_]:
        """(len(spans), n), which variables' waypoints lie in spans (., 2) of waypoints."""
        if not len(spans):
            return np.zeros((0, self.variables.size), dtype=bool)
        columns = [
            ((spans[:, :1] <= own) & (own <= spans[:, 1:])).any(axis=1) for own in self._owners
        ]
        return np.stack(columns, -1)

    @cached_property
    def _colours(self) -> list[IntArray]:
        """Variables that may be moved at once: one component each of distant waypoints."""
        colours: list[list[int]] = []
        taken: list[FloatArray] = []
        for column, own in enumerate(self._owners):
            for colour, others in zip(colours, taken, strict=True):
                if np.abs(own[:, None] - others).min() >= _REACHES:
                    colour.append(column)
                    break
            else:
                colours.append([column])
                taken.append(own)
                continue
            index = next(i for i, colour in enumerate(colours) if column in colour)
            taken[index] = np.concatenate([taken[index], own])
        return [np.array(colour) for colour in colours]


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


def rooms_of(path: Path) -> tuple[Room, ...]:
    """What room the vendor's rules leave between neighbouring zones of a path."""
    route = path.route
    planner = ZonePlanner(path.segments, route.chains, path.model, route.moves, route.robot.limits)
    return tuple(planner.rooms(route.zones))


def _waypoints(path: Path) -> FloatArray:
    q = path.segments.ends.q
    return np.concatenate([q[:1, 0], q[:, 1]])


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


def _place_waypoints(path: Path, places: PathPlaces, which: IntArray) -> FloatArray:
    """(K, 2), first and last waypoint whose variables change a place."""
    count = len(path.segments.scale)
    part = places.part[which]
    zone = part >= count
    middle = np.where(zone, part - count + 1, part)
    return np.stack([middle - zone, middle + 1], -1).astype(float)


def _pose_tangents(path: Path, waypoint: int, turned: FloatArray) -> FloatArray:
    """(N, 6), how the configuration at a waypoint changes with its pose target's variables."""
    route = path.route
    q = np.ascontiguousarray(_waypoints(path)[waypoint : waypoint + 1])
    J = jacobians(route.chains[waypoint - 1], q)[0][:, route.solved]
    twist = np.eye(6)
    twist[3:, 3:] = left_jacobian(turned[3:])
    out = np.zeros((q.shape[1], 6))
    out[route.solved] = np.linalg.solve(J, twist)
    return out
