"""The user's limits on via points as constraints, where bounds on the variables do not say them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.motion.path.path import Path
from ....core.robot.kinematics.chain import Chain
from ....core.robot.kinematics.chain_kernels import jacobian, poses
from ....core.spatial.rotation import rotation_vector, skew
from .blocks import MoveBlock
from .options import WaypointTask
from .parts import PosePoint, ViaPoint
from .point_limits import PointBox, PointCone, PointLimit

Measure = Callable[[FloatArray, FloatArray], tuple[float, FloatArray]]
"""Position (3,) and rotation (3, 3) of the TCP in the work object → a value that is to be zero or
more, and its derivative (6,) with respect to shift and turn of the TCP there."""
_NO_TURN = 1e-9


@dataclass(frozen=True)
class PointRow:
    """One constraint on a via point.

    Args:
        waypoint: which.
        chain: from its work object to the TCP.
        measure: what is constrained.
    """

    waypoint: int
    chain: Chain
    measure: Measure

    def value(self, path: Path) -> float:
        """What is to be zero or more."""
        q = path.segments.ends.q[self.waypoint - 1, 1]
        (R,), (p,) = poses(self.chain, np.ascontiguousarray(q)[None])
        return self.measure(p, R)[0]

    def slope(self, path: Path, waypoints: FloatArray) -> FloatArray:
        """Its derivative (n,).

        Args:
            path: where.
            waypoints: (M + 1, N, n), of the configurations at the waypoints.
        """
        q = path.segments.ends.q[self.waypoint - 1, 1]
        R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, len(q)))
        jacobian(self.chain, np.ascontiguousarray(q), R, p, J)
        return np.asarray(self.measure(p, R)[1] @ J @ waypoints[self.waypoint])


def point_rows(block: MoveBlock, path: Path, task: WaypointTask) -> tuple[PointRow, ...]:
    """The constraints of a block's via points.

    Args:
        block: the block.
        path: of its program as it was given.
        task: with the limits.
    """
    waypoint = {move: k + 1 for k, move in enumerate(path.route.moves)}
    rows: list[PointRow] = []
    for part in block.variables.parts:
        if not isinstance(part, ViaPoint):
            continue
        for move in part.moves:
            limit = task.limits.get(block.first + move, task.limit)
            turn = task.turn_at(block.first + move)
            if turn is None and not isinstance(limit, PointBox | PointCone):
                continue
            chain = path.route.chains[waypoint[move] - 1]
            q = np.ascontiguousarray(path.segments.ends.q[waypoint[move] - 1, 1])
            (R,), (p,) = poses(chain, q[None])
            bounded = isinstance(part, PosePoint)
            rows += [
                PointRow(waypoint[move], chain, measure)
                for measure in _measures(limit, turn, p, R, bounded)
            ]
    return tuple(rows)


def _measures(
    limit: PointLimit,
    turn: float | None,
    p: FloatArray,
    R: FloatArray,
    position_is_bounded: bool,
) -> Iterator[Measure]:
    position = limit.position if isinstance(limit, PointBox | PointCone) else None
    if position is not None and not position_is_bounded:
        for axis in range(3):
            yield _side(p[axis] - position[axis], axis, 1.0)
            yield _side(p[axis] + position[axis], axis, -1.0)
    if isinstance(limit, PointCone):
        direction = np.array(limit.axis) / math.hypot(*limit.axis)
        yield _cone(R @ direction, direction, math.cos(limit.angle))
    elif turn:
        # No turn at all is said by the variables: it leaves a step no room.
        yield _turn(R, turn)


def _side(bound: float, axis: int, sign: float) -> Measure:
    slope = np.zeros(6)
    slope[axis] = sign
    return lambda p, R: (sign * float(p[axis] - bound), slope)


def _cone(programmed: FloatArray, axis: FloatArray, cosine: float) -> Measure:
    """programmed · R axis ≥ cosine."""

    def measure(p: FloatArray, R: FloatArray) -> tuple[float, FloatArray]:
        now = R @ axis
        slope = np.concatenate([np.zeros(3), -programmed @ skew(now)])
        return float(programmed @ now) - cosine, slope

    return measure


def _turn(programmed: FloatArray, most: float) -> Measure:
    """most − |log(R programmedᵀ)|; its slope is against the axis of the turn."""

    def measure(p: FloatArray, R: FloatArray) -> tuple[float, FloatArray]:
        vector = rotation_vector(R @ programmed.T)
        size = float(np.linalg.norm(vector))
        unit = vector / size if size > _NO_TURN else np.zeros(3)
        return most - size, np.concatenate([np.zeros(3), -unit])

    return measure
