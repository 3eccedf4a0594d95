"""Where the variables of a transcription stand in its vector x.

    S = (T / T₀)²                 the duration squared, in units of the time scale
    W (G,)                        stretches of the grid's groups, if there is more than one
    q (P, n), d (P, n)            at the nodes: configuration and its derivative by scaled time
    e (M, n)                      second derivatives, at the scheme's shares of the intervals

In scaled time σ = t / T, with q̇ = d / (T₀ √S) and q̈ = e / (T₀² S): on a fixed grid the motion is
linear in x, and limits of speed and acceleration are convex.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .....core.arrays import FloatArray, IntArray
from .grid import Grid
from .scheme import Scheme


@dataclass(frozen=True)
class VariableLayout:
    """The variables.

    Args:
        grid: the intervals.
        scheme: what the motion is on them.
        joints: n.
        breaks: nodes between intervals (1 to K − 1) at which the acceleration may jump: stops,
            and where the load changes.
    """

    grid: Grid
    scheme: Scheme
    joints: int
    breaks: tuple[int, ...] = ()

    @property
    def points(self) -> int:
        """P, number of nodes, middles of intervals included."""
        return len(self.grid) * self.scheme.steps + 1

    @cached_property
    def first(self) -> IntArray:
        """(K,), point at which each interval begins."""
        return np.arange(len(self.grid)) * self.scheme.steps

    @cached_property
    def rise(self) -> IntArray:
        """(K, m), which second derivatives each interval's acceleration goes through."""
        count, shares = len(self.grid), len(self.scheme.shares)
        if not self.scheme.continuous:
            return np.arange(count)[:, None]
        jumps = np.zeros(count, dtype=np.int64)
        jumps[list(self.breaks)] = 1
        return (self.first + np.cumsum(jumps))[:, None] + np.arange(shares)

    @property
    def rises(self) -> int:
        """M."""
        return int(self.rise[-1, -1]) + 1

    @cached_property
    def samples(self) -> IntArray:
        """(Z, 3), point, second derivative and leg of every place where torques are looked at."""
        k = np.arange(len(self.grid))
        if not self.scheme.continuous:
            ends = [np.stack([self.first + i, self.rise[:, 0], self.grid.leg], 1) for i in (0, 1)]
            return np.concatenate(ends)
        parts = [
            np.stack([self.first + i, self.rise[:, i], self.grid.leg[k]], 1)
            for i in range(len(self.scheme.shares))
        ]
        return np.unique(np.concatenate(parts), axis=0)

    @cached_property
    def quadrature(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Interval, sample and share of the interval's width of every term of an integral.

        The trapezium rule, or Simpson's where there are middles.
        """
        weights = {1: (0.5, 0.5), 2: (1 / 6, 4 / 6, 1 / 6)}[self.scheme.steps]
        known = {tuple(row): z for z, row in enumerate(self.samples.tolist())}
        interval, sample, share = [], [], []
        for k in range(len(self.grid)):
            for i, weight in enumerate(weights):
                rise = int(self.rise[k, i if self.scheme.continuous else 0])
                key = (int(self.first[k]) + i, rise, int(self.grid.leg[k]))
                interval.append(k)
                sample.append(known[key])
                share.append(weight)
        return np.array(interval), np.array(sample), np.array(share)

    @property
    def stretches(self) -> int:
        """Number of variables that stretch the grid."""
        return self.grid.groups if self.grid.groups > 1 else 0

    @cached_property
    def q(self) -> IntArray:
        """(P, n), places of q in x."""
        return self._block(1 + self.stretches, self.points)

    @cached_property
    def d(self) -> IntArray:
        """(P, n)."""
        return self._block(1 + self.stretches + self.points * self.joints, self.points)

    @cached_property
    def e(self) -> IntArray:
        """(M, n)."""
        return self._block(1 + self.stretches + 2 * self.points * self.joints, self.rises)

    @property
    def size(self) -> int:
        """Number of variables."""
        return 1 + self.stretches + (2 * self.points + self.rises) * self.joints

    @cached_property
    def stretch(self) -> IntArray:
        """(K,), place in x of each interval's stretch; empty if there is none."""
        return 1 + self.grid.group if self.stretches else np.zeros(0, dtype=np.int64)

    def width(self, x: FloatArray) -> FloatArray:
        """(K,), the intervals' widths."""
        if not self.stretches:
            return self.grid.width
        return np.asarray(self.grid.width * x[self.stretch])

    def _block(self, start: int, rows: int) -> IntArray:
        return start + np.arange(rows * self.joints).reshape(rows, self.joints)
