"""Compiled bounds of a curve's derivatives on an interval of σ.

A curve is v(s(σ)), see `flyby.core.motion.geometry.curves`. On [s_a, s_b] the derivatives
of v by s are bounded from its Taylor expansion about a point within, those of s by σ from the
rational map

    F(s) = (s² + d₀ s (1 − s)) / (1 + e s (1 − s)),    e = d₀ + d₁ − 2,
    F'(s) = (d₀ (1 − s)² + 2 s (1 − s) + d₁ s²) / (1 + e s (1 − s))² > 0,

whose inverse has s' = 1 / F', s'' = −F'' / F'³ and s''' = (3 F''² − F' F''') / F'⁵.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ...robot.kinematics.lean import inner
from .curves import ARC, LINE, Curves, Samples, TcpCurves, parameter_jet

Bounds = tuple[float, float, float]
"""Of the first, second and third derivative."""


@inner
def map_bounds(window: FloatArray, first: float, last: float) -> Bounds:
    """Bounds of |ds/dσ|, |d²s/dσ²| and |d³s/dσ³| for s from ``first`` to ``last``."""
    length, d0, d1 = window[1], window[2], window[3]
    e = d0 + d1 - 2
    if e == 0.0 and d0 == 1.0:
        return 1 / length, 0.0, 0.0
    across_least = min(first * (1 - first), last * (1 - last))
    across_most = max(first * (1 - first), last * (1 - last))
    if first < 0.5 < last:
        across_most = 0.25
    m0_least = 1 + min(e * across_least, e * across_most)
    m0_most = 1 + max(e * across_least, e * across_most)
    m1 = abs(e) * max(abs(1 - 2 * first), abs(1 - 2 * last))
    m2 = 2 * abs(e)
    slope = d0 * (1 - last) ** 2 + 2 * across_least + d1 * first**2
    f1_least = slope / m0_most**2
    slope = d0 * (1 - first) ** 2 + 2 * across_most + d1 * last**2
    f1 = slope / m0_least**2
    f2 = (abs(2 - 2 * d0) + 2 * f1 * m1 + m2) / m0_least
    f3 = (3 * f2 * m1 + 3 * f1 * m2) / m0_least
    s1 = 1 / (f1_least * length)
    return s1, f2 * s1**3 * length, (3 * f2 * f2 + f1 * f3) * s1**5 * length**2


@inner
def expand(curves: Curves, piece: int, s: float, begin: int, end: int, taylor: FloatArray) -> None:
    """Taylor coefficients by s of a polynomial's or line's components about ``s``.

    Args:
        curves: the curves.
        piece: which of them; no arc.
        s: where.
        begin, end: the components wanted.
        taylor: (C, D) with C columns of the polynomial basis (2 at least) and D = end − begin,
            written.
    """
    taylor[:, :] = 0.0
    degree = curves.coefficients.shape[1]
    if curves.kind[piece] == LINE:
        for d in range(begin, end):
            taylor[0, d - begin] = curves.control[piece, 0, d] + s * curves.control[piece, 1, d]
            taylor[1, d - begin] = curves.control[piece, 1, d]
        return
    for i in range(curves.coefficients.shape[0]):
        for k in range(degree):
            factor = curves.coefficients[i, k]
            if factor != 0.0:
                for d in range(begin, end):
                    taylor[k, d - begin] += factor * curves.control[piece, i, d]
    # Horner's scheme, repeated: the coefficients about s instead of 0.
    for start in range(degree - 1):
        for k in range(degree - 2, start - 1, -1):
            for d in range(end - begin):
                taylor[k, d] += s * taylor[k + 1, d]


@inner
def _own_bounds(
    curves: Curves, piece: int, s: float, reach: float, begin: int, end: int, taylor: FloatArray
) -> Bounds:
    """Bounds of |dv/ds| and on to the third derivative within ``reach`` of s."""
    control = curves.control[piece]
    if curves.kind[piece] == ARC:
        square = 0.0
        for d in range(begin, end):
            square += control[1, d] ** 2 + control[2, d] ** 2
        radius, angle = math.sqrt(square), abs(curves.angle[piece])
        return radius * angle, radius * angle**2, radius * angle**3
    expand(curves, piece, s, begin, end, taylor)
    b1 = b2 = b3 = 0.0
    power = 1.0
    for k in range(1, taylor.shape[0]):
        square = 0.0
        for d in range(end - begin):
            square += taylor[k, d] ** 2
        norm = math.sqrt(square)
        b1 += k * norm * power
        if k >= 2:
            b2 += k * (k - 1) * norm * power / reach
        if k >= 3:
            b3 += k * (k - 1) * (k - 2) * norm * power / reach**2
        power *= reach
    return b1, b2, b3


@inner
def curve_bounds(
    curves: Curves,
    piece: int,
    sigma: float,
    half: float,
    begin: int,
    end: int,
    taylor: FloatArray,
) -> Bounds:
    """Bounds of |dv/dσ| to |d³v/dσ³| on [σ − half, σ + half].

    Args:
        curves: the curves.
        piece: which of them.
        sigma, half: the interval, inside the curve's window but for rounding.
        begin, end: the components of v whose norm is meant.
        taylor: (C, at least end − begin) scratch.
    """
    window = curves.window[piece]
    if curves.kind[piece] == LINE and window[2] == 1.0 and window[3] == 1.0:
        square = 0.0
        for d in range(begin, end):
            square += curves.control[piece, 1, d] ** 2
        return math.sqrt(square) / window[1], 0.0, 0.0
    first = parameter_jet(window, max(sigma - half, window[0]))[0]
    last = parameter_jet(window, min(sigma + half, window[0] + window[1]))[0]
    middle = 0.5 * (first + last)
    # Not below rounding: it divides.
    reach = 0.5 * (last - first) + 1e-15
    first, last = max(first, 0.0), min(last, 1.0)
    s1, s2, s3 = map_bounds(window, first, last)
    b1, b2, b3 = _own_bounds(curves, piece, middle, reach, begin, end, taylor)
    return b1 * s1, b2 * s1 * s1 + b1 * s2, b3 * s1**3 + 3 * b2 * s1 * s2 + b1 * s3


@inner
def _turn_bounds(
    curves: Curves, piece: int, sigma: float, half: float, begin: int, taylor: FloatArray
) -> Bounds:
    """Bounds of |ω|, |ω'| and |ω''| of exp(φ), φ three components of a turning curve.

    With ω = ∫ exp(t φ) φ' dt over t from 0 to 1, and exp(t φ) itself turning at t |φ'| at most:
    |ω| ≤ |φ'|, |ω'| ≤ |φ''| + |φ'|² / 2, |ω''| ≤ |φ'''| + 3/2 |φ'| |φ''| + |φ'|³ / 2.
    """
    b1, b2, b3 = curve_bounds(curves, piece, sigma, half, begin, begin + 3, taylor)
    if curves.kind[piece] == LINE:
        # A line through zero: the axis stands still.
        return b1, b2, b3
    return b1, b2 + 0.5 * b1 * b1, b3 + 1.5 * b1 * b2 + 0.5 * b1**3


@inner
def turning_bounds(
    curves: Curves, piece: int, sigma: float, half: float, taylor: FloatArray
) -> Bounds:
    """Bounds of |ω|, |ω'| and |ω''| by σ of R_ref exp(A) exp(B) on [σ − half, σ + half].

    Args:
        curves: turning curves, D = 6.
        piece, sigma, half: as in `curve_bounds`.
        taylor: (C, at least 3) scratch.
    """
    a1, a2, a3 = _turn_bounds(curves, piece, sigma, half, 0, taylor)
    b1, b2, b3 = _turn_bounds(curves, piece, sigma, half, 3, taylor)
    return a1 + b1, a2 + a1 * b1 + b2, a3 + (a2 + a1 * a1) * b1 + 2 * a1 * b2 + b3


@njit(cache=True, error_model="numpy")
def make_taylor(curves: TcpCurves) -> FloatArray:
    """Scratch of `bound_jerk`."""
    width = max(
        curves.position.coefficients.shape[1],
        curves.turning.coefficients.shape[1],
        curves.prescribed.coefficients.shape[1],
    )
    return np.empty((width, 3))


@inner
def bound_jerk(
    curves: TcpCurves,
    samples: Samples,
    m: int,
    sigma: float,
    half: float,
    taylor: FloatArray,
    out: FloatArray,
) -> None:
    """Write bounds of third derivatives by σ on [σ − half, σ + half].

    Args:
        curves: the TCP's path, with K prescribed axes.
        samples: the m-th of them says which curves.
        m, sigma, half: where.
        taylor: scratch.
        out: (2 + K,), written: of the position, of the angular velocity's second derivative, of
            each prescribed axis.
    """
    position, turning, prescribed = samples.position[m], samples.turning[m], samples.prescribed[m]
    out[0] = curve_bounds(curves.position, position, sigma, half, 0, 3, taylor)[2]
    out[1] = turning_bounds(curves.turning, turning, sigma, half, taylor)[2]
    for j in range(curves.prescribed.control.shape[2]):
        out[2 + j] = curve_bounds(curves.prescribed, prescribed, sigma, half, j, j + 1, taylor)[2]


@njit(cache=True, error_model="numpy")
def jerk_bounds(curves: TcpCurves, samples: Samples, half: FloatArray) -> FloatArray:
    """`bound_jerk` on M intervals about the samples, half (M,) wide to both sides: (M, 2 + K)."""
    bounds = np.empty((samples.sigma.size, 2 + curves.prescribed.control.shape[2]))
    taylor = make_taylor(curves)
    for m in range(samples.sigma.size):
        bound_jerk(curves, samples, m, samples.sigma[m], half[m], taylor, bounds[m])
    return bounds
