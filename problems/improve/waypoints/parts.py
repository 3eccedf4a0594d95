"""The numbers of one datum that an optimisation changes, and what they do to its moves.

A joint target contributes its free joints (rad or m), or shifts of a tool that keeps its
orientation (`oriented`); a pose target a shift of its position and a turn of its orientation
(rotation vector) about the axes of its work object, a zone its radius in m (or its share of the
contour).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.motion.geometry.segments import left_jacobian
from ....core.motion.gradients.derivatives import ProgramGradient
from ....core.program.move import Move
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import ContourFraction, Radius, VendorZone
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import matrix_from_rotation_vector, quaternion_from_matrix
from ..rounding import Rounding

JOINT_STEP, POSITION_STEP, TURN_STEP = 0.1, 0.1, 0.1
"""Changes of a joint, a position and an orientation that matter about equally: rad, m, rad."""
RADIUS_STEP, SHARE_STEP = 0.05, 0.2
LEAST_RADIUS, LEAST_SHARE = 1e-3, 1e-2
"""m and share: zones are not made smaller, as their derivatives vanish with them."""


@dataclass(frozen=True)
class ProgramPart(ABC):
    """The variables of one datum.

    Args:
        moves: indices of the moves that read it.
    """

    moves: tuple[int, ...]

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.values())

    @abstractmethod
    def values(self) -> FloatArray:
        """Those of the program that was given."""

    @abstractmethod
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lower and upper ones."""

    @abstractmethod
    def scale(self) -> FloatArray:
        """Changes that matter about equally."""

    @abstractmethod
    def applied(self, move: Move, values: FloatArray) -> Move:
        """A move with these values.

        Raises:
            MotionError: the tool cannot be there.
        """

    @abstractmethod
    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with these values rounded; what has not changed stays to the last digit."""

    @abstractmethod
    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        """From the program's parameters to the variables."""


def _total(rows: FloatArray, moves: tuple[int, ...]) -> FloatArray:
    """The sum of some moves' rows."""
    return np.asarray(rows[moves[0]] if len(moves) == 1 else rows[list(moves)].sum(axis=0))


class ViaPoint(ProgramPart):
    """The target of a via point."""

    @abstractmethod
    def along(self, change: FloatArray) -> FloatArray:
        """The change of the variables that comes nearest to one of the joints (arm's axes,), or to
        a shift (3,) m of a pose in its work object."""


@dataclass(frozen=True)
class JointPoint(ViaPoint):
    """A joint target.

    Args:
        target: as it was given.
        axes: those of the arm's joints that may change.
        lower, upper: (len(axes),) of their values.
    """

    target: JointTarget
    axes: tuple[int, ...]
    lower: FloatArray
    upper: FloatArray

    @property
    def given(self) -> FloatArray:
        """(len(axes),), the joints as they were given."""
        return np.array([self.target.joints[axis] for axis in self.axes])

    def values(self) -> FloatArray:
        return self.given

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        return self.lower, self.upper

    def scale(self) -> FloatArray:
        return np.full(self.size, JOINT_STEP)

    def applied(self, move: Move, values: FloatArray) -> Move:
        joints = list(self.target.joints)
        for axis, value in zip(self.axes, values, strict=True):
            joints[axis] = float(value)
        return replace(move, target=replace(self.target, joints=tuple(joints)))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        bounds = zip(values, self.given, self.lower, self.upper, strict=True)
        rounded = [
            now if now == then else rounding.angle(now, lower, upper)
            for now, then, lower, upper in bounds
        ]
        # Of joints, whatever the variables of a kind of point are.
        return JointPoint.applied(self, move, np.array(rounded))

    def along(self, change: FloatArray) -> FloatArray:
        return change[list(self.axes)]

    def slope(self, values: FloatArray) -> FloatArray:
        """(len(axes), size), how the joints change with the variables."""
        return np.eye(self.size)

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        by_joint = np.asarray(_total(made.joints, self.moves)[list(self.axes)])
        return self._pulled(by_joint, values)

    def _pulled(self, by_joint: FloatArray, values: FloatArray) -> FloatArray:
        """From the gradient (len(axes),) by the joints to that by the variables."""
        return by_joint


@dataclass(frozen=True)
class PosePoint(ViaPoint):
    """A pose target.

    Args:
        target: as it was given.
        shift: (3,) m, largest one along each axis of the work object.
        turn: rad, largest component of the turn.
    """

    target: PoseTarget
    shift: FloatArray
    turn: float

    def values(self) -> FloatArray:
        return np.zeros(6)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        most = np.concatenate([self.shift, np.full(3, self.turn)])
        return -most, most

    def scale(self) -> FloatArray:
        return np.repeat([POSITION_STEP, TURN_STEP], 3)

    def along(self, change: FloatArray) -> FloatArray:
        return np.concatenate([change, np.zeros(3)])

    def applied(self, move: Move, values: FloatArray) -> Move:
        given = self.target.pose
        x, y, z = (float(a + b) for a, b in zip(given.position, values[:3], strict=True))
        w, i, j, k = given.quaternion
        if values[3:].any():
            turned = matrix_from_rotation_vector(values[3:]) @ given.matrix()[:3, :3]
            w, i, j, k = (float(v) for v in quaternion_from_matrix(turned))
        pose = Pose((x, y, z), (w, i, j, k))
        return replace(move, target=replace(self.target, pose=pose))

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
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
        rows = list(self.moves)
        turn = left_jacobian(values[3:]).T @ made.turn[rows].sum(axis=0)
        return np.concatenate([made.position[rows].sum(axis=0), turn])


class ZonePart(ProgramPart):
    """The size of a zone."""

    def written(self, move: Move, values: FloatArray, rounding: Rounding) -> Move:
        """A move with a zone rounded down."""
        applied = self.applied(move, values)
        return replace(applied, zone=rounding.zone(applied.zone))

    @abstractmethod
    def rates(self) -> tuple[float, float, float, float]:
        """How fast the zone's radius (or size of another kind), radius of reorientation and of
        external axes, and angle change with the variable."""

    def gradient(self, made: ProgramGradient, values: FloatArray) -> FloatArray:
        sizes = made.zone, made.zone_reorientation, made.zone_external, made.zone_angle
        pairs = zip(sizes, self.rates(), strict=True)
        found = [float(_total(size, self.moves)) * rate for size, rate in pairs if rate != 0.0]
        return np.array([sum(found)])


@dataclass(frozen=True)
class ZoneRadius(ZonePart):
    """The radius of a zone; its other parts keep their proportion to it.

    Args:
        zone: as it was given.
        chosen: whether it stays what it is, one of those to choose from.
    """

    zone: Radius
    chosen: bool = False

    def values(self) -> FloatArray:
        return np.array([self.zone.tcp or LEAST_RADIUS])

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        if self.chosen:
            return self.values(), self.values()
        return np.minimum(self.values(), LEAST_RADIUS), np.array([np.inf])

    def scale(self) -> FloatArray:
        return np.array([RADIUS_STEP])

    def applied(self, move: Move, values: FloatArray) -> Move:
        radius = float(values[0])
        zone = Radius(radius) if self.zone.tcp == 0.0 else self.zone.resized(radius)
        return replace(move, zone=zone)

    def rates(self) -> tuple[float, float, float, float]:
        if self.zone.tcp == 0.0:
            return 1.0, 0.0, 0.0, 0.0
        parts = self.zone.reorientation, self.zone.external, self.zone.angle
        turning, external, angle = (part / self.zone.tcp for part in parts)
        return 1.0, turning, external, angle


@dataclass(frozen=True)
class ZoneShare(ZonePart):
    """The share of the contour, or the size of a make's own kind, that a zone takes.

    Args:
        zone: as it was given.
    """

    zone: ContourFraction | VendorZone

    def values(self) -> FloatArray:
        return np.array([self._size or LEAST_SHARE])

    @property
    def _size(self) -> float:
        return self.zone.size if isinstance(self.zone, VendorZone) else self.zone.fraction

    @property
    def _largest(self) -> float:
        return self.zone.kind.largest if isinstance(self.zone, VendorZone) else 1.0

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        return np.minimum(self.values(), LEAST_SHARE), np.array([self._largest])

    def scale(self) -> FloatArray:
        return np.array([SHARE_STEP])

    def applied(self, move: Move, values: FloatArray) -> Move:
        size = float(np.clip(values[0], 0.0, self._largest))
        if isinstance(self.zone, VendorZone):
            return replace(move, zone=replace(self.zone, size=size))
        return replace(move, zone=ContourFraction(size))

    def rates(self) -> tuple[float, float, float, float]:
        return 1.0, 0.0, 0.0, 0.0
