"""Questions of a proof, each about one pair of bodies on one interval, and their answers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray


class Items(NamedTuple):
    """K questions, each about one pair of bodies on one interval.

    Args:
        interval: (K,), rising; rows of the enclosures.
        pair: (K,), rows of the pairs.
        normal: (K, 3), unit normals (towards the pair's first body) of planes to try; zero for
            none.
        distance: (K,) m, lower bounds of the distance at the middle; −inf where not known.
    """

    interval: IntArray
    pair: IntArray
    normal: FloatArray
    distance: FloatArray

    @staticmethod
    def every(intervals: int, pairs: int) -> Items:
        """Every pair on every interval."""
        rows, columns = (index.ravel() for index in np.indices((intervals, pairs)))
        return Items(rows, columns, np.zeros((len(rows), 3)), np.full(len(rows), -math.inf))

    def chosen(self, which: NDArray[np.bool_]) -> Items:
        """Some of them."""
        return Items(
            self.interval[which], self.pair[which], self.normal[which], self.distance[which]
        )

    @staticmethod
    def joined(*parts: Items) -> Items:
        """Items in the order of their intervals."""
        interval = np.concatenate([part.interval for part in parts])
        order = np.argsort(interval, kind="stable")
        return Items(
            interval[order],
            np.concatenate([part.pair for part in parts])[order],
            np.concatenate([part.normal for part in parts])[order],
            np.concatenate([part.distance for part in parts])[order],
        )

    def on_both_halves(self) -> Items:
        """The same questions on the halves 2 i and 2 i + 1 of interval i, distances not known."""
        unknown = np.full(len(self.pair), -math.inf)
        left = self._replace(interval=2 * self.interval, distance=unknown)
        return Items.joined(left, left._replace(interval=left.interval + 1))


class Sweeps(NamedTuple):
    """The answers.

    Args:
        lower: (K,) m, the pair keeps at least this distance on the interval.
        motion: (K,) m, how far one body moves at most against the other from where they are at
            the middle.
        travel: (K,) m, of it what the path makes.
        deviation: (K,) m, what the joints' deviations and the residual may take of the distance
            at the middle, along the plane's normal if there is one.
    """

    lower: FloatArray
    motion: FloatArray
    travel: FloatArray
    deviation: FloatArray
