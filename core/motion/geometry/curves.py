"""Closed-form curves over the path parameter σ: values, three derivatives, and their reverse.

A curve is v(σ) = Σᵢ Cᵢ bᵢ(s(σ)) with control vectors Cᵢ and scalar basis functions bᵢ:

    line          1, s
    polynomial    1, f, g, h, k₁, k₂                     (see `blend`)
    arc           1, cos Θ s, sin Θ s

and s(σ) undoes the monotone rational quadratic map (Gregory & Delbourgo, IMA J. Numer. Anal. 2,
1982) of [0, 1] onto the window [σ₀, σ₀ + L],

    (σ − σ₀) / L = (s² + d₀ s (1 − s)) / (1 + (d₀ + d₁ − 2) s (1 − s)),

whose slopes at the ends, L d₀ and L d₁ per s, make dv/dσ continuous across a zone's edges, where
the scales of neighbouring curves differ. For the parabola it is a quadratic.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean

LINE, POLYNOMIAL, ARC = 0, 1, 2


class Curves(NamedTuple):
    """P curves with values in D dimensions.

    Args:
        kind: (P,) `LINE`, `POLYNOMIAL` or `ARC`.
        window: (P, 4), σ₀, L, d₀, d₁ of each.
        control: (P, 6, D), control vectors; those that a kind does not use are zero.
        angle: (P,) rad, Θ of arcs.
        coefficients: (6, C), the polynomial basis by rising powers of s.
    """

    kind: NDArray[np.int64]
    window: FloatArray
    control: FloatArray
    angle: FloatArray
    coefficients: FloatArray

    @staticmethod
    def empty(count: int, dimension: int, coefficients: FloatArray) -> Curves:
        """``count`` curves that stand still at zero."""
        window = np.tile(np.array([0.0, 1.0, 1.0, 1.0]), (count, 1))
        return Curves(
            np.zeros(count, dtype=np.int64),
            window,
            np.zeros((count, len(coefficients), dimension)),
            np.zeros(count),
            np.ascontiguousarray(coefficients, dtype=float),
        )

    def zeros_like(self) -> Curves:
        """A gradient to add to."""
        return Curves(self.kind, *(np.zeros(a.shape) for a in self[1:]))


class TcpCurves(NamedTuple):
    """The curves of TCP-space motion, one set for a whole path.

    Args:
        position: D = 3, m in the work object.
        turning: D = 6, the rotation vectors A and B of `orientation_curves`.
        reference: (P, 3, 3), R_ref of each turning curve.
        prescribed: D = number of prescribed axes.
    """

    position: Curves
    turning: Curves
    reference: FloatArray
    prescribed: Curves

    def zeros_like(self) -> TcpCurves:
        """A gradient to add to."""
        return TcpCurves(
            self.position.zeros_like(),
            self.turning.zeros_like(),
            np.zeros_like(self.reference),
            self.prescribed.zeros_like(),
        )


class CurveTangents(NamedTuple):
    """How the numbers of P curves change along K directions.

    Args:
        window: (P, 4, K).
        control: (P, 6, D, K).
        angle: (P, K).
    """

    window: FloatArray
    control: FloatArray
    angle: FloatArray

    @staticmethod
    def zeros(curves: Curves, directions: int) -> CurveTangents:
        """Of curves that stay as they are."""
        shapes = curves.window.shape, curves.control.shape, curves.angle.shape
        return CurveTangents(*(np.zeros((*shape, directions)) for shape in shapes))


class Samples(NamedTuple):
    """Where a path is sampled: σ and, for each channel, which curve is evaluated there (S,)."""

    sigma: FloatArray
    position: IntArray
    turning: IntArray
    prescribed: IntArray

    def rows(self, start: int, stop: int) -> Samples:
        """A view of some of them."""
        own = slice(start, stop)
        return Samples(self.sigma[own], self.position[own], self.turning[own], self.prescribed[own])

    def last(self) -> Samples:
        """The last sample alone."""
        return Samples(self.sigma[-1:], self.position[-1:], self.turning[-1:], self.prescribed[-1:])


@inner
def _map_jet(s: float, d0: float, d1: float) -> tuple[float, float, float, float]:
    """The rational map at s and its first three derivatives."""
    across, rate = s * (1 - s), 1 - 2 * s
    e = d0 + d1 - 2
    n0, n1, n2 = s * s + d0 * across, 2 * s + d0 * rate, 2 - 2 * d0
    m0, m1, m2 = 1 + e * across, e * rate, -2 * e
    f0 = n0 / m0
    f1 = (n1 - f0 * m1) / m0
    f2 = (n2 - 2 * f1 * m1 - f0 * m2) / m0
    f3 = (-3 * f2 * m1 - 3 * f1 * m2) / m0
    return f0, f1, f2, f3


@inner
def _parameter(window: FloatArray, sigma: float) -> float:
    """s at σ."""
    y = (sigma - window[0]) / window[1]
    b = window[2] - (window[2] + window[3] - 2) * y
    return float(2 * y / (b + math.sqrt(b * b + 4 * (1 - b) * y)))


@lean
def parameter_jet(window: FloatArray, sigma: float) -> tuple[float, float, float, float]:
    """s and its first three derivatives with respect to σ."""
    length = window[1]
    if window[2] == 1.0 and window[3] == 1.0:
        return (sigma - window[0]) / length, 1 / length, 0.0, 0.0
    s = _parameter(window, sigma)
    _, f1, f2, f3 = _map_jet(s, window[2], window[3])
    s1 = 1 / (f1 * length)
    return s, s1, -f2 / f1**3 / length**2, (3 * f2 * f2 - f1 * f3) / f1**5 / length**3


def parameter_slopes(window: FloatArray, sigma: FloatArray) -> FloatArray:
    """ds/dσ (P,) of windows (P, 4) at σ (P,)."""
    slopes = np.empty(len(sigma))
    _fill_slopes(np.ascontiguousarray(window), np.ascontiguousarray(sigma), slopes)
    return slopes


@lean
def _fill_slopes(window: FloatArray, sigma: FloatArray, slopes: FloatArray) -> None:
    for k in range(sigma.size):
        slopes[k] = parameter_jet(window[k], sigma[k])[1]


@inner
def _slope_jet(window: FloatArray, sigma: float, end: int) -> tuple[float, float, float]:
    """Derivative of s, s', s'' (with respect to σ) with respect to the slope d₀ or d₁.

    From y = F(s; d): ∂s/∂d = −F_d / F', differentiated twice along y.
    """
    length, d0, d1 = window[1], window[2], window[3]
    s = _parameter(window, sigma)
    f0, f1, f2, f3 = _map_jet(s, d0, d1)
    across, rate = s * (1 - s), 1 - 2 * s
    e = d0 + d1 - 2
    m0, m1, m2 = 1 + e * across, e * rate, -2 * e
    own = 1.0 if end == 0 else 0.0
    p0 = (own - f0) * across / m0
    p1 = ((own - f0) * rate - f1 * across - p0 * m1) / m0
    p2 = (-2 * (own - f0) - 2 * f1 * rate - f2 * across - 2 * p1 * m1 - p0 * m2) / m0
    g0 = -p0 / f1
    g1 = -p1 / f1 + p0 * f2 / f1**2
    g2 = -p2 / f1 + (2 * p1 * f2 + p0 * f3) / f1**2 - 2 * p0 * f2**2 / f1**3
    s1, s2 = 1 / f1, -f2 / f1**3
    return g0, g1 * s1 / length, (g2 * s1 * s1 + g1 * s2) / length**2


@inner
def _basis(curves: Curves, piece: int, s: float, basis: FloatArray) -> int:
    """Write bᵢ and three derivatives with respect to s, (6, 4); how many are in use."""
    basis[0, 0] = 1.0
    basis[0, 1] = basis[0, 2] = basis[0, 3] = 0.0
    kind = curves.kind[piece]
    if kind == LINE:
        basis[1, 0], basis[1, 1] = s, 1.0
        basis[1, 2] = basis[1, 3] = 0.0
        return 2
    if kind == ARC:
        angle = curves.angle[piece]
        c, n = math.cos(angle * s), math.sin(angle * s)
        basis[1, 0], basis[1, 1] = c, -angle * n
        basis[1, 2], basis[1, 3] = -(angle**2) * c, angle**3 * n
        basis[2, 0], basis[2, 1] = n, angle * c
        basis[2, 2], basis[2, 3] = -(angle**2) * n, -(angle**3) * c
        return 3
    for i in range(1, curves.coefficients.shape[0]):
        b0 = b1 = b2 = b3 = 0.0
        for j in range(curves.coefficients.shape[1] - 1, -1, -1):
            b3 = b3 * s + 3 * b2
            b2 = b2 * s + 2 * b1
            b1 = b1 * s + b0
            b0 = b0 * s + curves.coefficients[i, j]
        basis[i, 0], basis[i, 1], basis[i, 2], basis[i, 3] = b0, b1, b2, b3
    return len(curves.coefficients)


def pull_parameter_slopes(
    window: FloatArray, sigma: FloatArray, bar: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Reverse of `parameter_slopes`: the gradients of windows (P, 4) and σ (P,)."""
    window_bar, sigma_bar = np.empty(window.shape), np.empty(len(sigma))
    _fill_slope_gradients(np.ascontiguousarray(window), sigma, window_bar, sigma_bar)
    return bar[:, None] * window_bar, bar * sigma_bar


@lean
def _fill_slope_gradients(
    window: FloatArray, sigma: FloatArray, by_window: FloatArray, by_sigma: FloatArray
) -> None:
    for k in range(sigma.size):
        _, s1, s2, _ = parameter_jet(window[k], sigma[k])
        length = window[k, 1]
        by_sigma[k] = s2
        by_window[k, 0] = -s2
        by_window[k, 1] = -((sigma[k] - window[k, 0]) * s2 + s1) / length
        by_window[k, 2] = _slope_jet(window[k], sigma[k], 0)[1]
        by_window[k, 3] = _slope_jet(window[k], sigma[k], 1)[1]


@lean
def evaluate(
    curves: Curves, piece: int, sigma: float, basis: FloatArray, value: FloatArray
) -> None:
    """Write the value and its first two derivatives with respect to σ.

    Args:
        curves: the curves.
        piece: which of them.
        sigma: where.
        basis: (6, 4) scratch.
        value: (3, D), written.
    """
    s0, s1, s2, _ = parameter_jet(curves.window[piece], sigma)
    if curves.kind[piece] == LINE:
        for d in range(value.shape[1]):
            control = curves.control[piece, 1, d]
            value[0, d] = curves.control[piece, 0, d] + control * s0
            value[1, d], value[2, d] = control * s1, control * s2
        return
    count = _basis(curves, piece, s0, basis)
    value[:, :] = 0.0
    for i in range(count):
        b0 = basis[i, 0]
        b1 = basis[i, 1] * s1
        b2 = basis[i, 2] * s1 * s1 + basis[i, 1] * s2
        for d in range(value.shape[1]):
            control = curves.control[piece, i, d]
            value[0, d] += control * b0
            value[1, d] += control * b1
            value[2, d] += control * b2


@lean
def pull(
    curves: Curves,
    piece: int,
    sigma: float,
    basis: FloatArray,
    value_bar: FloatArray,
    gradient: Curves,
) -> float:
    """Carry a gradient of (value, derivatives) back to the curve's own numbers and to σ.

    Args:
        curves, piece, sigma, basis: as in `evaluate`.
        value_bar: (3, D), gradient with respect to value and derivatives.
        gradient: added to (the arrays of a `Curves`).

    Returns:
        The gradient with respect to σ, the window held.
    """
    window = curves.window[piece]
    s0, s1, s2, s3 = parameter_jet(window, sigma)
    count = _basis(curves, piece, s0, basis)
    length = window[1]
    xi = (sigma - window[0]) / length
    p0, p1, p2 = _slope_jet(window, sigma, 0)
    r0, r1, r2 = _slope_jet(window, sigma, 1)
    sigma_bar = length_bar = entry_bar = exit_bar = angle_bar = 0.0
    angle = curves.angle[piece] if curves.kind[piece] == ARC else 1.0
    for i in range(count):
        c0, c1, c2, c3 = basis[i, 0], basis[i, 1], basis[i, 2], basis[i, 3]
        b1 = c1 * s1
        b2 = c2 * s1 * s1 + c1 * s2
        b3 = c3 * s1**3 + 3 * c2 * s1 * s2 + c1 * s3
        w0 = w1 = w2 = 0.0
        for d in range(value_bar.shape[1]):
            control = curves.control[piece, i, d]
            w0 += control * value_bar[0, d]
            w1 += control * value_bar[1, d]
            w2 += control * value_bar[2, d]
            gradient.control[piece, i, d] += (
                c0 * value_bar[0, d] + b1 * value_bar[1, d] + b2 * value_bar[2, d]
            )
        if i == 0:
            continue
        sigma_bar += b1 * w0 + b2 * w1 + b3 * w2
        length_bar -= xi * b1 * w0 + (xi * b2 + b1 / length) * w1
        length_bar -= (xi * b3 + 2 * b2 / length) * w2
        # With r a variation of s(σ): δb = b' r, and two more derivatives with respect to σ.
        e0, e1, e2 = c1, c2 * s1, c3 * s1 * s1 + c2 * s2
        entry_bar += e0 * p0 * w0 + (e1 * p0 + e0 * p1) * w1
        entry_bar += (e2 * p0 + 2 * e1 * p1 + e0 * p2) * w2
        exit_bar += e0 * r0 * w0 + (e1 * r0 + e0 * r1) * w1
        exit_bar += (e2 * r0 + 2 * e1 * r1 + e0 * r2) * w2
        angle_bar += e0 * s0 * w0 + (e1 * s0 + e0 * s1) * w1
        angle_bar += (e2 * s0 + 2 * e1 * s1 + e0 * s2) * w2
        if curves.kind[piece] == POLYNOMIAL:
            _pull_coefficients(gradient.coefficients[i], s0, s1, s2, w0, w1, w2)
    gradient.window[piece, 0] -= sigma_bar
    gradient.window[piece, 1] += length_bar
    gradient.window[piece, 2] += entry_bar
    gradient.window[piece, 3] += exit_bar
    if curves.kind[piece] == ARC:
        gradient.angle[piece] += angle_bar / angle
    return sigma_bar


@lean
def push(
    curves: Curves,
    piece: int,
    sigma: float,
    basis: FloatArray,
    tangents: CurveTangents,
    sigma_dot: FloatArray,
    value_dot: FloatArray,
) -> None:
    """Write how the value changes along K directions.

    Args:
        curves, piece, sigma, basis: as in `evaluate`.
        tangents: of the curves.
        sigma_dot: (K,), how σ changes.
        value_dot: (D, K), written.
    """
    window, by_window = curves.window[piece], tangents.window[piece]
    s0, s1, _, _ = parameter_jet(window, sigma)
    count = _basis(curves, piece, s0, basis)
    xi = (sigma - window[0]) / window[1]
    entry, leave = _slope_jet(window, sigma, 0)[0], _slope_jet(window, sigma, 1)[0]
    for k in range(sigma_dot.size):
        moved = s1 * (sigma_dot[k] - by_window[0, k] - xi * by_window[1, k])
        moved += entry * by_window[2, k] + leave * by_window[3, k]
        if curves.kind[piece] == ARC:
            # cos Θ s and sin Θ s change with Θ as with s, s / Θ times as fast.
            moved += s0 / curves.angle[piece] * tangents.angle[piece, k]
        for d in range(value_dot.shape[0]):
            total = 0.0
            for i in range(count):
                total += tangents.control[piece, i, d, k] * basis[i, 0]
                total += curves.control[piece, i, d] * basis[i, 1] * moved
            value_dot[d, k] = total


@inner
def _pull_coefficients(
    row: FloatArray, s0: float, s1: float, s2: float, w0: float, w1: float, w2: float
) -> None:
    """Add to the gradient of one basis polynomial's coefficients."""
    power, lower, lowest = 1.0, 0.0, 0.0
    for j in range(row.size):
        row[j] += power * w0 + j * lower * s1 * w1
        row[j] += (j * (j - 1) * lowest * s1 * s1 + j * lower * s2) * w2
        power, lower, lowest = power * s0, power, lower
