"""Lines and blends as sums of points times polynomials (paper C, equation 2).

On a segment q(s) = Σ_p P_p c_p(s), with two points on a line and three on a blend:

    line    c = (1 − φ, φ),   φ = b + s (1 − a − b),   b = r_B/ℓ behind, a = r_A/ℓ ahead
    blend   c = (a A, 1 − a A − b G, b G),   A = (1 − p̃)(1 − s),   G = p̃ s,
            a = r_A/ℓ of the leg before, b = r_B/ℓ of the leg after

These are the five pieces (I to V) of the paper's p_i, sorted by segment. All derivatives are with
respect to θ = (s, r₁, ℓ₁, r₂, ℓ₂), the two cuts in the order of the legs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.polynomial import Polynomial

from ...core.arrays import FloatArray

PARAMETERS = 5
"""s, r₁, ℓ₁, r₂, ℓ₂."""


@dataclass(frozen=True)
class Weights:
    """How much each point counts, at R nodes.

    Args:
        value: (R, p).
        slope: (R, p, 5), derivatives with respect to θ.
        curvature: (R, p, 5, 5).
    """

    value: FloatArray
    slope: FloatArray
    curvature: FloatArray


class Curve(Protocol):
    """The polynomials of one kind of segment.

    Attributes:
        points: p, how many points act on it.
    """

    @property
    def points(self) -> int:
        """p."""
        ...

    def weights(self, theta: FloatArray, order: int) -> Weights:
        """The ``order``-th derivatives in s of c (R, p), at θ (R, 5)."""
        ...


class Line:
    """Of a line between two zones."""

    points = 2

    def weights(self, theta: FloatArray, order: int) -> Weights:
        """See `Curve`."""
        s, share = theta[:, 0], _shares(theta)
        along = 1.0 - share[:, 0] - share[:, 1]
        value, slope, curvature = _zeros(len(theta), 1)
        if order == 0:
            value[:, 0] = share[:, 0] + s * along
            slope[:, 0] = np.stack([along, 1.0 - s, -s], axis=1)
            curvature[:, 0, 0, 1:] = curvature[:, 0, 1:, 0] = -1.0
        elif order == 1:
            value[:, 0] = along
            slope[:, 0, 1:] = -1.0
        base = np.array([1.0, 0.0]) if order == 0 else np.zeros(2)
        return _gather(theta, base, np.array([[-1.0], [1.0]]), value, slope, curvature)


class BlendCurve:
    """Of a blend at a via point.

    Args:
        alpha: coefficients of p̃ by rising powers of s, p̃(0) = 0 and p̃(1) = 1.

    Attributes:
        entry_slope, exit_slope: how fast the legs are left and met, |q′|/r: 1 where p̃′ vanishes
            there.
    """

    points = 3

    def __init__(self, alpha: tuple[float, ...]) -> None:
        p, fade = Polynomial(alpha), Polynomial([1.0, -1.0])
        before, after = (1.0 - p) * fade, p * Polynomial([0.0, 1.0])
        self._derivatives = [
            (before.deriv(k), after.deriv(k)) if k else (before, after) for k in range(5)
        ]
        self.entry_slope = -float(before.deriv()(0.0))
        self.exit_slope = float(after.deriv()(1.0))

    def weights(self, theta: FloatArray, order: int) -> Weights:
        """See `Curve`."""
        s, share = theta[:, 0], _shares(theta)
        value, slope, curvature = _zeros(len(theta), 2)
        for f in range(2):
            zeroth, first, second = (self._derivatives[order + k][f](s) for k in range(3))
            value[:, f] = share[:, f] * zeroth
            slope[:, f, 0], slope[:, f, 1 + f] = share[:, f] * first, zeroth
            curvature[:, f, 0, 0] = share[:, f] * second
            curvature[:, f, 0, 1 + f] = curvature[:, f, 1 + f, 0] = first
        base = np.array([0.0, 1.0, 0.0]) if order == 0 else np.zeros(3)
        spread = np.array([[1.0, 0.0], [-1.0, -1.0], [0.0, 1.0]])
        return _gather(theta, base, spread, value, slope, curvature)


def _shares(theta: FloatArray) -> FloatArray:
    """r/ℓ of both cuts (R, 2)."""
    return np.asarray(theta[:, 1::2] / theta[:, 2::2])


def _zeros(rows: int, functions: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    return (
        np.zeros((rows, functions)),
        np.zeros((rows, functions, 3)),
        np.zeros((rows, functions, 3, 3)),
    )


def _gather(
    theta: FloatArray,
    base: FloatArray,
    spread: FloatArray,
    value: FloatArray,
    slope: FloatArray,
    curvature: FloatArray,
) -> Weights:
    """Weights c = base + spread φ from functions φ (R, f) of (s, r₁/ℓ₁, r₂/ℓ₂)."""
    r, length = theta[:, 1::2], theta[:, 2::2]
    chain = np.zeros((len(theta), 3, PARAMETERS))
    bend = np.zeros((len(theta), 3, PARAMETERS, PARAMETERS))
    chain[:, 0, 0] = 1.0
    for k in range(2):
        at, by = 1 + 2 * k, 2 + 2 * k
        chain[:, 1 + k, at] = 1.0 / length[:, k]
        chain[:, 1 + k, by] = -r[:, k] / length[:, k] ** 2
        bend[:, 1 + k, at, by] = bend[:, 1 + k, by, at] = -1.0 / length[:, k] ** 2
        bend[:, 1 + k, by, by] = 2.0 * r[:, k] / length[:, k] ** 3
    full_slope = slope @ chain
    turned = np.swapaxes(chain, 1, 2)[:, None] @ curvature @ chain[:, None]
    turned += (slope @ bend.reshape(len(theta), 3, -1)).reshape(turned.shape)
    return Weights(
        base + value @ spread.T,
        np.einsum("pf,rfa->rpa", spread, full_slope),
        np.einsum("pf,rfab->rpab", spread, turned),
    )
