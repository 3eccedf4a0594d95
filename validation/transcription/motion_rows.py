"""Joint velocities and accelerations at nodes (paper C, equations 3 and 4).

With s even in time on each segment of duration t, w = ṡ t and z = s̈ t,

    q̇ⱼ = q′ⱼ w/t,      q̈ⱼ = q″ⱼ (w/t)² + q′ⱼ z/t,      q = Σ_p P_p c_p(θ).

Both are Σ_p P_pj (κ₁ c′_p + κ₂ c″_p) with factors κ of w, z and t, which is how the derivatives
below come about: linear in P, and a product of functions of θ and of (w, z, t).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from ...core.arrays import FloatArray, IntArray
from .curves import PARAMETERS, Curve, Weights
from .last import Last


class Nodes:
    """Nodes on segments of one kind.

    Args:
        curve: of the segments.
        points: (R, p, n) indices of the joint values of the points that act on each.
        theta: (R, 5) indices of θ.
    """

    def __init__(self, curve: Curve, points: IntArray, theta: IntArray) -> None:
        self.curve, self.points, self.theta = curve, points, theta
        self._weights = [Last(partial(curve.weights, order=order)) for order in range(3)]

    def at(self, x: FloatArray, order: int) -> Weights:
        """The weights' ``order``-th derivatives in s, up to the second."""
        return self._weights[order](x[self.theta])

    def only(self, rows: IntArray) -> Nodes:
        """Some of them, in this order."""
        return Nodes(self.curve, self.points[rows], self.theta[rows])


@dataclass(frozen=True)
class Factor:
    """κ at R nodes: value (R,), slope (R, Y) and curvature (R, Y, Y) in the variables of time."""

    value: FloatArray
    slope: FloatArray
    curvature: FloatArray


class Law(Protocol):
    """How κ₁ and κ₂ follow from the variables of time."""

    def factors(self, y: FloatArray) -> tuple[Factor, ...]:
        """κ₁, and κ₂ where it is not zero, of variables y (R, Y)."""
        ...


class Velocity:
    """κ₁ = w/t of y = (w, t)."""

    def factors(self, y: FloatArray) -> tuple[Factor, ...]:
        """See `Law`."""
        return (_ratio(y, 0, 1),)


class StraightAcceleration:
    """κ₁ = z/t of y = (z, t), where q″ = 0."""

    def factors(self, y: FloatArray) -> tuple[Factor, ...]:
        """See `Law`."""
        return (_ratio(y, 0, 1),)


class Acceleration:
    """κ₁ = z/t and κ₂ = (w/t)² of y = (w, z, t)."""

    def factors(self, y: FloatArray) -> tuple[Factor, ...]:
        """See `Law`."""
        w, t = y[:, 0], y[:, 2]
        slope, curvature = np.zeros((len(y), 3)), np.zeros((len(y), 3, 3))
        slope[:, 0], slope[:, 2] = 2.0 * w / t**2, -2.0 * w**2 / t**3
        curvature[:, 0, 0], curvature[:, 2, 2] = 2.0 / t**2, 6.0 * w**2 / t**4
        curvature[:, 0, 2] = curvature[:, 2, 0] = -4.0 * w / t**3
        return _ratio(y, 1, 2), Factor((w / t) ** 2, slope, curvature)


def _ratio(y: FloatArray, over: int, under: int) -> Factor:
    """y[over] / y[under]."""
    a, t = y[:, over], y[:, under]
    slope, curvature = np.zeros_like(y), np.zeros((*y.shape, y.shape[1]))
    slope[:, over], slope[:, under] = 1.0 / t, -a / t**2
    curvature[:, over, under] = curvature[:, under, over] = -1.0 / t**2
    curvature[:, under, under] = 2.0 * a / t**3
    return Factor(a / t, slope, curvature)


class MotionRows:
    """Rows −1 ≤ q̇ⱼ/limitⱼ ≤ 1, or the same of q̈.

    Args:
        nodes: where (R).
        times: (R, Y) indices of the law's variables.
        law: see `Law`.
        limit: (n,) rad/s or rad/s² (m for sliding joints).
    """

    def __init__(self, nodes: Nodes, times: IntArray, law: Law, limit: FloatArray) -> None:
        self._nodes, self._times, self._law = nodes, times, law
        self._scale = 1.0 / limit
        rows, p, n = nodes.points.shape
        self.lower, self.upper = np.full(rows * n, -1.0), np.full(rows * n, 1.0)
        own = np.swapaxes(nodes.points, 1, 2)  # a row of joint j has its own joint's values only
        others = np.concatenate([nodes.theta, times], axis=1)[:, None]
        columns = np.concatenate([own, np.repeat(others, n, axis=1)], axis=2)
        self.jacobian_places = (
            np.repeat(np.arange(rows * n), columns.shape[2]),
            columns.ravel(),
        )
        every = np.concatenate([nodes.points.reshape(rows, -1), others[:, 0]], axis=1)
        size = every.shape[1]
        a, b = np.indices((size, size))
        self._kept = np.maximum(a, b) >= p * n  # nothing is quadratic in the points
        self.hessian_places = every[:, a[self._kept]].ravel(), every[:, b[self._kept]].ravel()

    def values(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        terms = self._terms(x)
        motion = sum(f.value[:, None] * c.value for f, c in terms)
        q = np.einsum("rpj,rp->rj", x[self._nodes.points], motion)
        return np.asarray((q * self._scale).ravel())

    def slopes(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        P = x[self._nodes.points]
        rows, p, n = P.shape
        width = self._times.shape[1]
        out = np.zeros((rows, n, p + PARAMETERS + width))
        for f, c in self._terms(x):
            out[:, :, :p] += (f.value[:, None] * c.value)[:, None]
            turned = np.swapaxes(P, 1, 2)
            out[:, :, p : p + PARAMETERS] += f.value[:, None, None] * (turned @ c.slope)
            q = (turned @ c.value[:, :, None])[:, :, 0]
            out[:, :, p + PARAMETERS :] += q[:, :, None] * f.slope[:, None]
        return (out * self._scale[:, None]).ravel()

    def curvatures(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Rows`."""
        P = x[self._nodes.points]
        rows, p, n = P.shape
        mu = multipliers.reshape(rows, n) * self._scale
        M = np.einsum("rpj,rj->rp", P, mu)
        first, second = p * n, p * n + PARAMETERS
        size = second + self._times.shape[1]
        H = np.zeros((rows, size, size))
        for f, c in self._terms(x):
            by_theta = f.value[:, None, None] * c.slope
            by_time = c.value[:, :, None] * f.slope[:, None]
            for block, part in (
                (slice(first, second), by_theta),
                (slice(second, size), by_time),
            ):
                outer = part[:, :, None] * mu[:, None, :, None]
                H[:, :first, block] += outer.reshape(rows, first, -1)
            H[:, first:second, second:] += (M[:, None] @ c.slope)[:, 0, :, None] * f.slope[:, None]
            bend = np.einsum("rp,rpab->rab", M, c.curvature)
            H[:, first:second, first:second] += 0.5 * f.value[:, None, None] * bend
            pull = np.einsum("rp,rp->r", M, c.value)
            H[:, second:, second:] += 0.5 * pull[:, None, None] * f.curvature
        H += np.swapaxes(H, 1, 2)
        return np.asarray(H[:, self._kept].ravel())

    def _terms(self, x: FloatArray) -> list[tuple[Factor, Weights]]:
        factors = self._law.factors(x[self._times])
        return [(factor, self._nodes.at(x, 1 + k)) for k, factor in enumerate(factors)]
