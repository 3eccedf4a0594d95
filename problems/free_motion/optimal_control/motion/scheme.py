"""Schemes: what a motion is between the nodes of an interval.

The acceleration over an interval is a polynomial in its share u from 0 to 1 through values e_i at
the scheme's shares; velocity and position are its integrals, so that rows between nodes are exact:

    q(u) = q₀ + u w d₀ + w² Σ_i A_i(u) e_i,     d(u) = d₀ + w Σ_i B_i(u) e_i

with w the interval's width, d and e first and second derivatives by scaled time. Every polynomial
lies within the hull of its Bernstein coefficients (G. Farin, Curves and Surfaces for CAGD, 5th
edition, 2002, section 4): what bounds those bounds the motion between nodes, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from math import comb

import numpy as np
from numpy.polynomial import polynomial as P

from .....core.arrays import FloatArray


class SchemeKind(StrEnum):
    """How accelerations run over an interval."""

    CONSTANT = "constant"
    """Constant, with steps at the nodes: the papers' low order."""
    LINEAR = "linear"
    """Linear and continuous: cubic splines."""
    HERMITE_SIMPSON = "hermite_simpson"
    """Quadratic and continuous, with a node half way: quartics, Simpson's rule."""


_SHARES = {
    SchemeKind.CONSTANT: (0.0,),
    SchemeKind.LINEAR: (0.0, 1.0),
    SchemeKind.HERMITE_SIMPSON: (0.0, 0.5, 1.0),
}


@dataclass(frozen=True)
class Scheme:
    """A scheme's numbers.

    Args:
        kind: which one.
    """

    kind: SchemeKind

    @property
    def shares(self) -> FloatArray:
        """(m,), where in the interval the acceleration's values stand."""
        return np.array(_SHARES[self.kind])

    @property
    def continuous(self) -> bool:
        """Whether neighbouring intervals share an acceleration."""
        return self.kind is not SchemeKind.CONSTANT

    @property
    def steps(self) -> int:
        """Nodes that an interval adds to the one it begins at."""
        return 2 if self.kind is SchemeKind.HERMITE_SIMPSON else 1

    @property
    def order(self) -> int:
        """Degree of the acceleration."""
        return len(self.shares) - 1

    @cached_property
    def acceleration(self) -> FloatArray:
        """(m, order + 1), coefficients of the Lagrange polynomials by rising powers of u."""
        rows = []
        for i, at in enumerate(self.shares):
            row = np.array([1.0])
            for other in np.delete(self.shares, i):
                row = P.polymul(row, np.array([-other, 1.0]) / (at - other))
            rows.append(np.pad(row, (0, self.order + 1 - len(row))))
        return np.array(rows)

    @cached_property
    def velocity(self) -> FloatArray:
        """(m, order + 2), of the B_i."""
        return np.array([P.polyint(row) for row in self.acceleration])

    @cached_property
    def position(self) -> FloatArray:
        """(m, order + 3), of the A_i."""
        return np.array([P.polyint(row, 2) for row in self.acceleration])

    def position_at(self, share: float) -> FloatArray:
        """(m,), A_i(u)."""
        return np.asarray(P.polyval(share, self.position.T))

    def velocity_at(self, share: float) -> FloatArray:
        """(m,), B_i(u)."""
        return np.asarray(P.polyval(share, self.velocity.T))

    @cached_property
    def velocity_hull(self) -> FloatArray:
        """(order + 2, m), Bernstein coefficients of the B_i."""
        return bernstein(self.velocity.T)

    @cached_property
    def acceleration_hull(self) -> FloatArray:
        """(order + 1, m), of the acceleration."""
        return bernstein(self.acceleration.T)

    @cached_property
    def jerk_hull(self) -> FloatArray:
        """(order, m), of the acceleration's derivative by u."""
        powers = np.arange(1, self.order + 1)[:, None]
        return bernstein(powers * self.acceleration.T[1:])


def bernstein(coefficients: FloatArray) -> FloatArray:
    """Bernstein coefficients (C, ...) on [0, 1] of polynomials given by rising powers (C, ...)."""
    count = len(coefficients)
    if count == 0:
        return coefficients
    table = np.array(
        [
            [comb(i, k) / comb(count - 1, k) if k <= i else 0.0 for k in range(count)]
            for i in range(count)
        ]
    )
    return np.asarray(np.tensordot(table, coefficients, 1))
