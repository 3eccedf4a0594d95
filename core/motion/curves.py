"""Closed-form curves over the path parameter σ: values, three derivatives, and their reverse.

A curve is v(σ) = Σᵢ Cᵢ bᵢ(s(σ)) with control vectors Cᵢ and scalar basis functions bᵢ:

    line          1, s
    polynomial    1, f, g, h, k₁, k₂                     (see `blend`)
    arc           1, cos Θ s, sin Θ s

and s(σ) is the monotone rational quadratic map (Gregory & Delbourgo, IMA J. Numer. Anal. 2,
1982) of the window [σ₀, σ₀ + L] onto [0, 1] with the slopes d₀ and d₁ (per unit of
ξ = (σ − σ₀)/L) at its ends. It makes dv/dσ continuous across a zone's edges, where the scales
of neighbouring curves differ.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .blend import BASIS

FloatArray = NDArray[np.float64]
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
            np.zeros((count, BASIS, dimension)),
            np.zeros(count),
            np.ascontiguousarray(coefficients, dtype=float),
        )

    def zeros_like(self) -> Curves:
        """A gradient to add to."""
        return Curves(self.kind, *(np.zeros_like(a) for a in self[1:]))


@njit(cache=True, error_model="numpy")
def parameter_jet(window: FloatArray, sigma: float) -> tuple[float, float, float, float]:
    """s and its first three derivatives with respect to σ."""
    length = window[1]
    xi = (sigma - window[0]) / length
    d0, d1 = window[2], window[3]
    n0, n1, n2 = xi * xi + d0 * xi * (1 - xi), 2 * xi + d0 * (1 - 2 * xi), 2 - 2 * d0
    e = d0 + d1 - 2
    m0, m1, m2 = 1 + e * xi * (1 - xi), e * (1 - 2 * xi), -2 * e
    s0 = n0 / m0
    s1 = (n1 - s0 * m1) / m0
    s2 = (n2 - 2 * s1 * m1 - s0 * m2) / m0
    s3 = (-3 * s2 * m1 - 3 * s1 * m2) / m0
    return s0, s1 / length, s2 / length**2, s3 / length**3


@njit(cache=True, error_model="numpy")
def _slope_jet(window: FloatArray, sigma: float, end: int) -> tuple[float, float, float]:
    """Derivative of s, s', s'' (with respect to σ) with respect to the slope d₀ or d₁."""
    length = window[1]
    xi = (sigma - window[0]) / length
    d0, d1 = window[2], window[3]
    e = d0 + d1 - 2
    m0, m1, m2 = 1 + e * xi * (1 - xi), e * (1 - 2 * xi), -2 * e
    s0, s1, s2, _ = parameter_jet(window, sigma)
    s1, s2 = s1 * length, s2 * length**2
    b0, b1, b2 = xi * (1 - xi), 1 - 2 * xi, -2.0
    own = 1.0 if end == 0 else 0.0
    r0 = (own * b0 - s0 * b0) / m0
    r1 = (own * b1 - s1 * b0 - s0 * b1 - r0 * m1) / m0
    r2 = (own * b2 - s2 * b0 - 2 * s1 * b1 - s0 * b2 - 2 * r1 * m1 - r0 * m2) / m0
    return r0, r1 / length, r2 / length**2


@njit(cache=True, error_model="numpy")
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
    for i in range(1, BASIS):
        b0 = b1 = b2 = b3 = 0.0
        for j in range(curves.coefficients.shape[1] - 1, -1, -1):
            b3 = b3 * s + 3 * b2
            b2 = b2 * s + 2 * b1
            b1 = b1 * s + b0
            b0 = b0 * s + curves.coefficients[i, j]
        basis[i, 0], basis[i, 1], basis[i, 2], basis[i, 3] = b0, b1, b2, b3
    return BASIS


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def _pull_coefficients(
    row: FloatArray, s0: float, s1: float, s2: float, w0: float, w1: float, w2: float
) -> None:
    """Add to the gradient of one basis polynomial's coefficients."""
    power, lower, lowest = 1.0, 0.0, 0.0
    for j in range(row.size):
        row[j] += power * w0 + j * lower * s1 * w1
        row[j] += (j * (j - 1) * lowest * s1 * s1 + j * lower * s2) * w2
        power, lower, lowest = power * s0, power, lower
