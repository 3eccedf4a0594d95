"""The numbers of a program that an optimisation changes, as one vector.

A joint target contributes its free joints (rad or m), or shifts of a tool that keeps its
orientation (`oriented`); a pose target a shift of its position and a
turn of its orientation (rotation vector) about the axes of its work object, a zone its radius in m
(or its share of the contour). Data that several moves read are one set of variables.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.motion.geometry.segments import left_jacobian
from ....core.motion.gradients.derivatives import ProgramGradient
from ....core.program.move import Move
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import ContourFraction, Radius
from ....core.robot.model import Robot
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import matrix_from_rotation_vector, quaternion_from_matrix
from ..rounding import Rounding
from .changeable import Selection
from .options import WaypointTask
from .oriented import OrientedPoint
from .point_limits import Box, PointLimit

JOINT_STEP, POSITION_STEP, TURN_STEP = 0.1, 0.1, 0.1
"""Changes of a joint, a position and an orientation that matter about equally: rad, m, rad."""
RADIUS_STEP, SHARE_STEP = 0.05, 0.2
LEAST_RADIUS, LEAST_SHARE = 1e-3, 1e-2
"""m and share: zones are not made smaller, as their derivatives vanish with them."""
_LIMIT_MARGIN = 1e-6
"""rad or m that joint targets keep from the joints' limits."""


@dataclass(frozen=True)
class JointPoint:
    """A joint target.

    Args:
        moves: that read it.
        target: as it was given.
        axes: those of the arm's joints that may change.
        lower, upper: (len(axes),) of their values.
    """

    moves: tuple[int, ...]
    target: JointTarget
    axes: tuple[int, ...]
    lower: FloatArray
    upper: FloatArray

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.axes)

    def values(self) -> FloatArray:
        """Those of the program that was given."""
        return np.array([self.target.joints[axis] for axis in self.axes])

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper ones."""
        return self.lower, self.upper

    def scale(self) -> FloatArray:
        """Changes that matter about equally."""
        return np.full(self.size, JOINT_STEP)

    def applied(self, move: Move, values: FloatArray) -> Move:
        """A move with these values."""
        joints = list(self.target.joints)
        for axis, value in zip(self.axes, values, strict=True):
            joints[axis] = float(value)
        return replace(move, target=replace(self.target, joints=tuple(joints)))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with these values rounded; joints that have not changed stay to the last digit."""
        given = self.values()
        rounded = [
            now if now == then else rounding.angle(now, lower, upper)
            for now, then, lower, upper in zip(values, given, self.lower, self.upper, strict=True)
        ]
        return self.applied(move, np.array(rounded))

    def along(self, change: FloatArray) -> FloatArray:
        """The change of the variables that makes one of the joints (arm's axes,)."""
        return change[list(self.axes)]

    def slope(self, values: FloatArray) -> FloatArray:
        """(len(axes), size), how the joints change with the variables."""
        return np.eye(self.size)

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        """From the program's parameters to the variables."""
        return np.asarray(made.joints[list(self.moves)][:, list(self.axes)].sum(axis=0))


@dataclass(frozen=True)
class PosePoint:
    """A pose target.

    Args:
        moves: that read it.
        target: as it was given.
        shift: (3,) m, largest one along each axis of the work object.
        turn: rad, largest component of the turn.
    """

    moves: tuple[int, ...]
    target: PoseTarget
    shift: FloatArray
    turn: float

    @property
    def size(self) -> int:
        """Number of variables."""
        return 6

    def values(self) -> FloatArray:
        """Those of the program that was given."""
        return np.zeros(6)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper ones."""
        most = np.concatenate([self.shift, np.full(3, self.turn)])
        return -most, most

    def scale(self) -> FloatArray:
        """Changes that matter about equally."""
        return np.repeat([POSITION_STEP, TURN_STEP], 3)

    def along(self, change: FloatArray) -> FloatArray:
        """The change of the variables that shifts the TCP in its work object by (3,) m."""
        return np.concatenate([change, np.zeros(3)])

    def applied(self, move: Move, values: FloatArray) -> Move:
        """A move with these values."""
        matrix = self.target.pose.matrix()
        x, y, z = (float(v) for v in matrix[:3, 3] + values[:3])
        turned = matrix_from_rotation_vector(values[3:]) @ matrix[:3, :3]
        w, i, j, k = (float(v) for v in quaternion_from_matrix(turned))
        pose = Pose((x, y, z), (w, i, j, k))
        return replace(move, target=replace(self.target, pose=pose))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with these values rounded; what has not changed stays to the last digit."""
        applied = self.applied(move, values).target
        assert isinstance(applied, PoseTarget)
        given = np.array(self.target.pose.position)
        position, quaternion = self.target.pose.position, self.target.pose.quaternion
        if np.any(values[:3] != 0.0):
            wanted = applied.pose.position
            position = rounding.position(wanted, given - self.shift, given + self.shift)
        if np.any(values[3:] != 0.0):
            quaternion = rounding.quaternion(applied.pose.quaternion)
        return replace(move, target=replace(self.target, pose=Pose(position, quaternion)))

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        """From the program's parameters to the variables."""
        rows = list(self.moves)
        turn = left_jacobian(values[3:]).T @ made.turn[rows].sum(axis=0)
        return np.concatenate([made.position[rows].sum(axis=0), turn])


@dataclass(frozen=True)
class ZoneRadius:
    """The radius of a zone; its other parts keep their proportion to it.

    Args:
        moves: that read it.
        zone: as it was given.
        chosen: whether it stays what it is, one of those to choose from.
    """

    moves: tuple[int, ...]
    zone: Radius
    chosen: bool = False

    @property
    def size(self) -> int:
        """Number of variables."""
        return 1

    def values(self) -> FloatArray:
        """Those of the program that was given."""
        return np.array([self.zone.tcp or LEAST_RADIUS])

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper ones."""
        if self.chosen:
            return self.values(), self.values()
        return np.minimum(self.values(), LEAST_RADIUS), np.array([np.inf])

    def scale(self) -> FloatArray:
        """Changes that matter about equally."""
        return np.array([RADIUS_STEP])

    def applied(self, move: Move, values: FloatArray) -> Move:
        """A move with these values."""
        radius = float(values[0])
        zone = Radius(radius) if self.zone.tcp == 0.0 else self.zone.resized(radius)
        return replace(move, zone=zone)

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with a zone rounded down."""
        return _with_rounded_zone(self.applied(move, values), rounding)

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        """From the program's parameters to the variables."""
        rows = list(self.moves)
        total = float(made.zone[rows].sum())
        if self.zone.tcp > 0.0:
            for name, part in (
                ("zone_reorientation", self.zone.reorientation),
                ("zone_external", self.zone.external),
                ("zone_angle", self.zone.angle),
            ):
                total += float(getattr(made, name)[rows].sum()) * part / self.zone.tcp
        return np.array([total])


@dataclass(frozen=True)
class ZoneShare:
    """The share of the contour that a KRL zone takes.

    Args:
        moves: that read it.
        zone: as it was given.
    """

    moves: tuple[int, ...]
    zone: ContourFraction

    @property
    def size(self) -> int:
        """Number of variables."""
        return 1

    def values(self) -> FloatArray:
        """Those of the program that was given."""
        return np.array([self.zone.fraction or LEAST_SHARE])

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper ones."""
        return np.minimum(self.values(), LEAST_SHARE), np.array([1.0])

    def scale(self) -> FloatArray:
        """Changes that matter about equally."""
        return np.array([SHARE_STEP])

    def applied(self, move: Move, values: FloatArray) -> Move:
        """A move with these values."""
        return replace(move, zone=ContourFraction(float(np.clip(values[0], 0.0, 1.0))))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with a zone rounded down."""
        return _with_rounded_zone(self.applied(move, values), rounding)

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        """From the program's parameters to the variables."""
        return np.array([made.zone[list(self.moves)].sum()])


ViaPoint = JointPoint | OrientedPoint | PosePoint
Part = ViaPoint | ZoneRadius | ZoneShare
"""Variables of one datum: their values, bounds and scale, and what they do to a move."""


def _with_rounded_zone(move: Move, rounding: Rounding) -> Move:
    return replace(move, zone=rounding.zone(move.zone))


class Variables:
    """A program's variables.

    Args:
        program: as it was given.
        parts: of the vector, in order.

    Attributes:
        offsets: (len(parts) + 1,), where each part begins.
        lower, upper, scale, start: (n,).
    """

    def __init__(self, program: Program, parts: Sequence[Part]) -> None:
        self.program = program
        self.parts = tuple(parts)
        self.offsets = np.concatenate([[0], np.cumsum([part.size for part in parts])]).astype(int)
        empty = [np.zeros(0)]
        self.lower = np.concatenate([part.bounds()[0] for part in parts] or empty)
        self.upper = np.concatenate([part.bounds()[1] for part in parts] or empty)
        self.scale = np.concatenate([part.scale() for part in parts] or empty)
        self.start = np.clip(
            np.concatenate([part.values() for part in parts] or empty), self.lower, self.upper
        )

    @property
    def size(self) -> int:
        """Number of variables."""
        return int(self.offsets[-1])

    def of(self, part: int, x: FloatArray) -> FloatArray:
        """The values of one part."""
        return x[self.offsets[part] : self.offsets[part + 1]]

    def applied(self, x: FloatArray) -> Program:
        """The program with these values."""
        moves = list(self.program.moves)
        for index, part in enumerate(self.parts):
            for i in part.moves:
                moves[i] = part.applied(moves[i], self.of(index, x))
        return self.program.with_moves(tuple(moves))

    def written(self, x: FloatArray, rounding: Rounding) -> Program:
        """The program with numbers near these values, as a person would write them."""
        moves = list(self.program.moves)
        for index, part in enumerate(self.parts):
            for i in part.moves:
                moves[i] = part.written(moves[i], self.of(index, x), rounding)
        return self.program.with_moves(tuple(moves))

    def with_chosen_zones(self, x: FloatArray, rounding: Rounding) -> Variables:
        """The same with each radius held at the predefined one that is nearest below x."""
        least = min(rounding.predefined, key=lambda zone: zone.tcp)
        parts: list[Part] = []
        for index, part in enumerate(self.parts):
            if isinstance(part, ZoneRadius):
                zone = rounding.zone(Radius(float(self.of(index, x)[0])))
                part = ZoneRadius(part.moves, zone if isinstance(zone, Radius) else least, True)
            parts.append(part)
        return Variables(self.program, parts)

    def with_smaller_zone(self, x: FloatArray, move: int, by: float) -> FloatArray:
        """Values x with a smaller zone at a move, by m or a share; x if it has none here."""
        smaller = x.copy()
        for index, part in enumerate(self.parts):
            if isinstance(part, ZoneRadius | ZoneShare) and move in part.moves:
                smaller[self.offsets[index]] -= by
        return np.asarray(np.maximum(smaller, self.lower))

    def gradient(self, made: ProgramGradient, x: FloatArray) -> FloatArray:
        """(n,) from the gradient with respect to the program's parameters."""
        found = [part.gradient(made, self.of(k, x)) for k, part in enumerate(self.parts)]
        return np.concatenate(found or [np.zeros(0)])


def make_variables(
    program: Program, robot: Robot, selection: Selection, task: WaypointTask
) -> Variables:
    """The variables of a selection: of every via point its target, then its zone."""
    parts: list[Part] = [_point(program, robot, group, task) for group in selection.points]
    for group in selection.zones:
        zone = program.moves[group[0]].zone
        if isinstance(zone, ContourFraction):
            parts.append(ZoneShare(group, zone))
        elif isinstance(zone, Radius):
            parts.append(ZoneRadius(group, zone))
    order = sorted(range(len(parts)), key=lambda k: (parts[k].moves[0], k))
    return Variables(program, [parts[k] for k in order])


def _point(program: Program, robot: Robot, group: tuple[int, ...], task: WaypointTask) -> Part:
    target = program.moves[group[0]].target
    limits = [task.limits.get(i, task.limit) for i in group]
    turns = [turn for i in group if (turn := task.turn_at(i)) is not None]
    if isinstance(target, JointTarget):
        return _joint_point(target, robot, group, task, limits, min(turns, default=np.inf))
    shift = np.full(3, np.inf)
    for limit in limits:
        position = getattr(limit, "position", None)
        if position is not None:
            shift = np.minimum(shift, position)
    return PosePoint(group, target, shift, min(turns, default=np.inf))


def _joint_point(
    target: JointTarget,
    robot: Robot,
    group: tuple[int, ...],
    task: WaypointTask,
    limits: Sequence[PointLimit],
    turn: float,
) -> JointPoint | OrientedPoint:
    axes = task.free_axes(robot.arm_size)
    now = np.array(target.joints)[axes]
    lower = robot.limits.lower[axes] + _LIMIT_MARGIN
    upper = robot.limits.upper[axes] - _LIMIT_MARGIN
    for limit in limits:
        if isinstance(limit, Box) and limit.joints is not None:
            ranges = np.array(limit.joints)[axes]
            lower, upper = np.maximum(lower, now - ranges), np.minimum(upper, now + ranges)
    bounds = np.minimum(lower, now), np.maximum(upper, now)
    if turn == 0.0:
        return OrientedPoint(group, target, robot.arm_chain, tuple(axes), *bounds, JOINT_STEP)
    return JointPoint(group, target, tuple(axes), *bounds)
