"""The limits of the motion as rows of a nonlinear program."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from ....core.arrays import FloatArray, IntArray
from .options import PaintLimits
from .variables import ThicknessVariables

_LENGTH = 0.1
"""Unit of the rows on lengths, m."""
_SHORT = 1e-9


class PaintConstraints:
    """Rows, in this order: speed at most and at least, length of segments, distance from the
    surface, tilt, deviation.

    Args:
        limits: of the motion.
        variables: what z stands for.
        origin: (W, 3) where the waypoints were at first, m.
    """

    def __init__(
        self, limits: PaintLimits, variables: ThicknessVariables, origin: FloatArray
    ) -> None:
        self._limits = limits
        self._variables = variables
        self._origin = origin
        self._bound = np.isfinite(limits.deviation)
        self._rows, self._columns = self._places()

    @property
    def size(self) -> int:
        """m."""
        return len(self.lower)

    @property
    def lower(self) -> FloatArray:
        """(m,)."""
        return self._sides(0.0, self._limits.step[0], self._limits.distance[0], -np.inf)

    @property
    def upper(self) -> FloatArray:
        """(m,)."""
        return self._sides(np.inf, self._limits.step[1], self._limits.distance[1], 1.0)

    def values(self, z: FloatArray) -> FloatArray:
        """c (m,)."""
        position, angles, duration = self._variables.parts(z)
        limits = self._limits
        length = np.linalg.norm(np.diff(position, axis=0), axis=1)
        reference = self._variables.reference
        distance = np.einsum("ij,ij->i", position - reference.foot, reference.normal)
        parts = [
            (limits.speed[1] * duration - length) / _LENGTH,
            (length - limits.speed[0] * duration) / _LENGTH,
            length / _LENGTH,
            distance / _LENGTH,
            (angles**2).sum(axis=1) / np.tan(limits.tilt) ** 2,
        ]
        if self._bound:
            away = position - self._origin
            parts.append((away**2).sum(axis=1) / limits.deviation**2)
        return np.concatenate(parts)

    def jacobian(self, z: FloatArray) -> sparse.csc_array:
        """∂c/∂z (m, n), of one pattern."""
        position, angles, _ = self._variables.parts(z)
        limits = self._limits
        segments = self._variables.segments
        chord = np.diff(position, axis=0)
        length = np.maximum(np.linalg.norm(chord, axis=1, keepdims=True), _SHORT)
        along = chord / (length * _LENGTH)
        ends = np.concatenate((-along, along), axis=1)
        parts = [
            -ends,
            np.full((segments, 1), limits.speed[1] / _LENGTH),
            ends,
            np.full((segments, 1), -limits.speed[0] / _LENGTH),
            ends,
            self._variables.reference.normal / _LENGTH,
            2.0 * angles / np.tan(limits.tilt) ** 2,
        ]
        if self._bound:
            parts.append(2.0 * (position - self._origin) / limits.deviation**2)
        data = np.concatenate([part.ravel() for part in parts])
        shape = (self.size, self._variables.size)
        data *= self._variables.units[self._columns]
        return sparse.csc_array((data, (self._rows, self._columns)), shape=shape)

    def add_curvature(self, multipliers: FloatArray, found: FloatArray) -> None:
        """Add what circles bend: of tilt and deviation, whose multipliers are not negative.

        Args:
            multipliers: (m,).
            found: (n, n) is added to.
        """
        segments, waypoints = self._variables.segments, self._variables.waypoints
        first = 3 * segments + waypoints
        squares = self._variables.units**2
        tilt = np.maximum(multipliers[first : first + waypoints], 0.0)
        at = 5 * np.arange(waypoints)
        for k in (3, 4):
            found[at + k, at + k] += 2.0 * tilt / np.tan(self._limits.tilt) ** 2 * squares[at + k]
        if self._bound:
            away = np.maximum(multipliers[first + waypoints :], 0.0)
            for k in range(3):
                found[at + k, at + k] += 2.0 * away / self._limits.deviation**2 * squares[at + k]

    def repaired(self, z: FloatArray) -> FloatArray:
        """The point with tilts and deviations drawn into their circles, and durations into what the
        limits of the speed leave them."""
        position, angles, duration = self._variables.parts(z)
        limits = self._limits
        steepest = np.tan(limits.tilt)
        angles = angles * _shrinking(np.linalg.norm(angles, axis=1), steepest)
        if self._bound:
            away = position - self._origin
            sizes = np.linalg.norm(away, axis=1)
            position = self._origin + away * _shrinking(sizes, limits.deviation)
        length = np.linalg.norm(np.diff(position, axis=0), axis=1)
        slowest, fastest = limits.speed
        return self._variables.at(
            position, angles, np.clip(duration, length / fastest, length / slowest)
        )

    def violation(self, z: FloatArray) -> float:
        """Largest violation of a row."""
        values = self.values(z)
        return float(np.maximum(self.lower - values, values - self.upper).max(initial=0.0))

    def _sides(self, speed: float, step: float, distance: float, circle: float) -> FloatArray:
        segments, waypoints = self._variables.segments, self._variables.waypoints
        parts = [np.full(2 * segments, speed), np.full(segments, step / _LENGTH)]
        parts.append(np.full(waypoints, distance / _LENGTH))
        parts += [np.full(waypoints, circle)] * (2 if self._bound else 1)
        return np.concatenate(parts)

    def _places(self) -> tuple[IntArray, IntArray]:
        """Row and column of each entry, in the order of `jacobian`."""
        segments, waypoints = self._variables.segments, self._variables.waypoints
        segment, waypoint = np.arange(segments), np.arange(waypoints)
        ends = 5 * segment[:, None] + np.array((0, 1, 2, 5, 6, 7))
        position = 5 * waypoint[:, None] + np.arange(3)
        angles = 5 * waypoint[:, None] + np.arange(3, 5)
        duration = 5 * waypoints + segment[:, None]
        rows = [segment, segment, segments + segment, segments + segment, 2 * segments + segment]
        columns = [ends, duration, ends, duration, ends]
        first = 3 * segments + waypoint
        rows += [first, first + waypoints]
        columns += [position, angles]
        if self._bound:
            rows.append(first + 2 * waypoints)
            columns.append(position)
        across = [np.repeat(r, c.shape[1]) for r, c in zip(rows, columns, strict=True)]
        return np.concatenate(across), np.concatenate([c.ravel() for c in columns])


def _shrinking(sizes: FloatArray, most: float) -> FloatArray:
    """Factors (W, 1) that bring sizes (W,) down to ``most``."""
    return np.asarray((most / np.maximum(sizes, most))[:, None])
