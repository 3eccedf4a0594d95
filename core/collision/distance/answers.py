"""Answers of a collision scene as values."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from .closed_form import Measured
from .engine import Witness

MOST_KEPT = 8
LARGEST_KEPT = 100_000
"""Answers kept, and the most distances that one of them may have."""


@dataclass(frozen=True, slots=True)
class Distances:
    """Signed distances of P pairs at M configurations.

    Args:
        distance: (M, P) m; negative by the depth where bodies overlap. Pairs that are at least
            as far apart as was asked for have that value.
        point_a, point_b: (M, P, 3) m, nearest points of the pair's first and second body in the
            world; point_a - point_b = distance · normal. Zero where the pair is farther.
        normal: (M, P, 3), unit vectors that lead the first body away from the second. Zero where
            the pair is farther.
        measured: (M, P) bool, False where bodies overlap in a way that has no depth: the core of
            a body goes through the surface of a mesh. ``distance`` is then the least depth
            possible and ``normal`` a likely way out, from the crossing to the body's middle.
    """

    distance: FloatArray
    point_a: FloatArray
    point_b: FloatArray
    normal: FloatArray
    measured: NDArray[np.bool_]

    @classmethod
    def farther(cls, samples: int, pairs: int, within: float) -> Distances:
        """All pairs at least ``within`` m apart."""
        shape = (samples, pairs)
        point_a, point_b, normal = (np.zeros((*shape, 3)) for _ in range(3))
        known = np.ones(shape, dtype=np.bool_)
        return cls(np.full(shape, within), point_a, point_b, normal, known)

    @property
    def numbers(self) -> Measured:
        """The arrays that compiled batches fill in."""
        return Measured(self.distance, self.point_a, self.point_b, self.normal)

    def at(self, sample: int, pair: int) -> Witness:
        """One entry."""
        entry = (sample, pair)
        return Witness(
            float(self.distance[entry]),
            self.point_a[entry],
            self.point_b[entry],
            self.normal[entry],
            bool(self.measured[entry]),
        )

    def freeze(self) -> None:
        """Let nobody write to the arrays any more."""
        for array in (*self.numbers, self.measured):
            array.flags.writeable = False

    def put(self, sample: int, pair: int, witness: Witness) -> None:
        """Fill in one entry."""
        entry = (sample, pair)
        self.distance[entry] = witness.distance
        self.point_a[entry] = witness.point_a
        self.point_b[entry] = witness.point_b
        self.normal[entry] = witness.normal
        self.measured[entry] = witness.measured


class RecentDistances:
    """The last answers, by configurations and range: value and gradient ask for the same ones."""

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[bytes, float, float], Distances] = OrderedDict()

    def get(self, key: tuple[bytes, float, float], measure: Callable[[], Distances]) -> Distances:
        """What is kept for ``key``, measured if nothing is."""
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        found = measure()
        found.freeze()
        if found.distance.size <= LARGEST_KEPT:
            self._kept[key] = found
            if len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        return found


@dataclass(frozen=True, slots=True)
class Contact:
    """Two bodies that touch.

    Args:
        first, second: names of the bodies.
        depth: m by which they overlap; None if that has no measure.
        position: (3,) m, a point between them, in the world.
    """

    first: str
    second: str
    depth: float | None
    position: tuple[float, float, float]

    @classmethod
    def of(cls, first: str, second: str, witness: Witness) -> Contact:
        """The contact of two bodies by name."""
        x, y, z = (float(v) for v in 0.5 * (witness.point_a + witness.point_b))
        depth = max(-witness.distance, 0.0) if witness.measured else None
        return cls(first, second, depth, (x, y, z))

    def __str__(self) -> str:
        place = ", ".join(f"{1e3 * x:.1f}" for x in self.position)
        depth = "" if self.depth is None else f" by {1e3 * self.depth:.3g} mm"
        return f"{self.first} and {self.second} overlap{depth} at ({place}) mm"
