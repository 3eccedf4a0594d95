"""What the path itself costs: residuals r with the cost ½ r·r, so that Gauss and Newton's matrix
serves here too."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from scipy import sparse

from ....core.arrays import FloatArray
from ..spray.trajectory import PaintTrajectory
from .options import PaintWeights

_SHORT = 1e-9


class PathCost:
    """Uneven steps, bends, turns of the nozzle and changes of the speed along a path.

    Matrices are over positions and angles of each waypoint, then durations: (k, 5 W + S).

    Args:
        weights: of the costs.
        waypoints: W.
    """

    def __init__(self, weights: PaintWeights, waypoints: int) -> None:
        self._weights = weights
        self._waypoints = waypoints
        step, self._change = _differences(waypoints), _differences(waypoints - 1)
        springs = math.sqrt(2.0 * weights.position) * step
        bends = math.sqrt(2.0 * weights.bend) * (self._change @ step)
        three = sparse.eye_array(3)
        self._position = sparse.csr_array(sparse.kron(sparse.vstack((springs, bends)), three))
        self._turn = sparse.csr_array(sparse.kron(math.sqrt(2.0 * weights.direction) * step, three))
        place = sparse.kron(sparse.eye_array(waypoints), sparse.eye_array(3, 5))
        none = sparse.csr_array((self._position.shape[0], waypoints - 1))
        self._of_position = sparse.hstack((self._position @ place, none))

    def residuals(self, trajectory: PaintTrajectory) -> FloatArray:
        """r (k,)."""
        changes = math.sqrt(2.0 * self._weights.speed) * np.diff(trajectory.speeds)
        position: FloatArray = self._position @ trajectory.position.ravel()
        nozzle: FloatArray = self._turn @ trajectory.nozzle.ravel()
        return np.concatenate((position, nozzle, changes))

    def slopes(self, trajectory: PaintTrajectory) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Slopes of the cost by positions (W, 3), nozzles (W, 3) and durations (S,)."""
        found = self.residuals(trajectory)
        sizes = self._position.shape[0], self._turn.shape[0]
        bend, turn, change = np.split(found, np.cumsum(sizes))
        position = (self._position.T @ bend).reshape(-1, 3)
        nozzle = (self._turn.T @ turn).reshape(-1, 3)
        by_speed = math.sqrt(2.0 * self._weights.speed) * (self._change.T @ change)
        pull, by_duration = _speed_slopes(trajectory)
        pulled = by_speed[:, None] * pull
        position[1:] += pulled
        position[:-1] -= pulled
        return position, nozzle, by_speed * by_duration

    def jacobian(self, trajectory: PaintTrajectory, turns: FloatArray) -> sparse.csr_array:
        """∂r by positions, angles and durations (k, 5 W + S).

        Args:
            turns: (W, 2, 3) derivatives of the nozzles by their angles.
        """
        segments = self._waypoints - 1
        each = np.arange(self._waypoints)
        rows = 3 * each[:, None, None] + np.arange(3)[None, None, :] + np.zeros((1, 2, 1), int)
        columns = (
            5 * each[:, None, None] + np.array((3, 4))[None, :, None] + np.zeros((1, 1, 3), int)
        )
        shape = (3 * self._waypoints, 5 * self._waypoints)
        nozzle = sparse.csr_array((turns.ravel(), (rows.ravel(), columns.ravel())), shape=shape)
        none = sparse.csr_array((self._turn.shape[0], segments))
        speeds = math.sqrt(2.0 * self._weights.speed) * (self._change @ _speed_matrix(trajectory))
        parts = (self._of_position, sparse.hstack((self._turn @ nozzle, none)), speeds)
        return sparse.csr_array(sparse.vstack(parts))


@lru_cache(maxsize=8)
def path_cost(weights: PaintWeights, waypoints: int) -> PathCost:
    """The cost, which rounds of one optimisation share."""
    return PathCost(weights, waypoints)


def _differences(count: int) -> sparse.csr_array:
    """Differences of neighbours (count - 1, count)."""
    rows = np.repeat(np.arange(max(count - 1, 0)), 2)
    data = np.tile((-1.0, 1.0), len(rows) // 2)
    columns = rows + np.tile((0, 1), len(rows) // 2)
    return sparse.csr_array((data, (rows, columns)), shape=(max(count - 1, 0), count))


def _speed_slopes(trajectory: PaintTrajectory) -> tuple[FloatArray, FloatArray]:
    """∂ speeds by the ends of their segments, less by the beginnings (S, 3), and by their durations
    (S,)."""
    chord = np.diff(trajectory.position, axis=0)
    length = np.maximum(trajectory.lengths, _SHORT)
    pull = chord / (length * trajectory.duration)[:, None]
    return pull, -trajectory.speeds / trajectory.duration


def _speed_matrix(trajectory: PaintTrajectory) -> sparse.csr_array:
    """∂ speeds by positions, angles and durations (S, 5 W + S)."""
    segments = trajectory.segments
    pull, by_duration = _speed_slopes(trajectory)
    segment = np.arange(segments)
    here = 5 * segment[:, None] + np.arange(3)
    duration = 5 * (segments + 1) + segment
    rows = np.concatenate((np.repeat(segment, 6), segment))
    columns = np.concatenate((np.concatenate((here, here + 5), axis=1).ravel(), duration))
    pulls = np.concatenate((-pull, pull), axis=1).ravel()
    data = np.concatenate((pulls, by_duration))
    return sparse.csr_array((data, (rows, columns)), shape=(segments, 6 * segments + 5))
