"""Exact reverse-mode derivative of a time stamp, through both sweeps.

With the active half-planes fixed, each squared speed is the coordinate of a vertex. At the
vertex of n_i · (y, z) = h_i and n_j · (y, z) = h_j, with (1, 0) = λ_i n_i + λ_j n_j,

    dy = λ_i (dh_i - dn_i · (y, z)) + λ_j (dh_j - dn_j · (y, z))

and a step of the sweep forward is z = (h_i - p_i y) / q_i. A row ``a u + b x_e = h`` has
dh - dn · (y, z) = dh - u da - x_e db + a u dΔ / Δ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import InputError
from ...robot.kinematics.lean import inner, lean
from ..timing.stamping import Stamp
from ..timing.stamping_kernels import CEILING, NEXT, StampRows, bound_normal, half_plane


@dataclass(frozen=True, slots=True, eq=False)
class StampGradient:
    """Derivative of a scalar with respect to what ``stamp`` was given; shapes as in ``Limits``."""

    spacing: FloatArray
    a: FloatArray
    b: FloatArray
    lower: FloatArray
    upper: FloatArray
    ceiling: FloatArray
    x_start: float
    x_end: float


def stamp_adjoint(
    stamp: Stamp, x_bar: FloatArray | None = None, t_bar: FloatArray | None = None
) -> StampGradient:
    """Derivative of a scalar J(x, t) with respect to the limits, from ∂J/∂x and ∂J/∂t.

    The active half-planes are those of ``stamp``: at a tie the derivative is one-sided. A knot at
    which the path stops stays a stop (the derivative of time there is infinite): its x counts as
    constant.

    Args:
        stamp: the stamp.
        x_bar: (K + 1,), ∂J/∂x at each knot; None is zero.
        t_bar: (K + 1,), ∂J/∂t at each knot; None is zero. J = duration: 0, …, 0, 1.
    """
    limits = stamp.limits
    count = len(limits.spacing)
    x_seed = _seed(x_bar, "x_bar", count)
    t_seed = _seed(t_bar, "t_bar", count)
    spacing, ceiling, top = np.zeros(count), np.zeros(count + 1), np.zeros(count + 1)
    out = StampRows(*(np.zeros(limits.a.shape) for _ in range(4)))
    pull_times(limits.spacing, stamp.x, t_seed, x_seed, spacing)
    pull_forth(limits.spacing, limits.rows, stamp.x, stamp.source, x_seed, top, out, spacing)
    free_start = stamp.x[0] < stamp.top[0]
    if not free_start:
        top[0] += x_seed[0]
    pull_back(
        limits.spacing,
        limits.rows,
        limits.ceiling,
        stamp.top,
        stamp.partner,
        stamp.pair,
        top,
        out,
        spacing,
        ceiling,
    )
    free_end = stamp.top[-1] < limits.ceiling[-1]
    if not free_end:
        ceiling[-1] += top[-1]
    x_start = float(x_seed[0]) if free_start else 0.0
    x_end = float(top[-1]) if free_end else 0.0
    return StampGradient(spacing, *out, ceiling, x_start, x_end)


def _seed(bar: FloatArray | None, name: str, count: int) -> FloatArray:
    if bar is None:
        return np.zeros(count + 1)
    seed = np.array(bar, dtype=np.float64)
    if seed.shape != (count + 1,):
        raise InputError(f"{name} has shape {seed.shape}; it must be ({count + 1},)")
    return seed


@lean
def pull_times(
    spacing: FloatArray,
    x: FloatArray,
    t_bar: FloatArray,
    x_bar: FloatArray,
    spacing_bar: FloatArray,
) -> None:
    """Pull ``t_bar`` back to ``x_bar`` and ``spacing_bar``, through T = 2Δ / (√y + √z)."""
    later = 0.0
    for k in range(spacing.shape[0] - 1, -1, -1):
        later += t_bar[k + 1]
        left, right = np.sqrt(x[k]), np.sqrt(x[k + 1])
        rate = 2.0 / (left + right)
        spacing_bar[k] += later * rate
        slope = later * spacing[k] * rate * rate / 4.0
        if left > 0.0:
            x_bar[k] -= slope / left
        if right > 0.0:
            x_bar[k + 1] -= slope / right


@inner
def _add_row(
    m: float,
    code: int,
    k: int,
    spacing: FloatArray,
    y: float,
    z: float,
    rows: StampRows,
    out: StampRows,
    spacing_bar: FloatArray,
) -> None:
    """Add m · (dh - dn · (y, z)) of a row's half-plane to the derivatives of its numbers."""
    a = rows.a
    i = code >> 1
    end = 1 if i >= a.shape[2] else 0
    r = i - end * a.shape[2]
    u = (z - y) * (0.5 / spacing[k])
    if code & 1:
        out.upper[k, end, r] += m
    else:
        out.lower[k, end, r] -= m
        m = -m
    out.a[k, end, r] -= m * u
    out.b[k, end, r] -= m * (z if end else y)
    spacing_bar[k] += m * a[k, end, r] * u / spacing[k]


@lean
def pull_forth(
    spacing: FloatArray,
    rows: StampRows,
    x: FloatArray,
    source: IntArray,
    x_bar: FloatArray,
    top_bar: FloatArray,
    out: StampRows,
    spacing_bar: FloatArray,
) -> None:
    """Pull ``x_bar`` back through the sweep forth; ``x_bar[0]`` is complete afterwards."""
    for k in range(spacing.shape[0] - 1, -1, -1):
        seed = x_bar[k + 1]
        code = source[k]
        if seed == 0.0 or x[k + 1] == 0.0:
            continue
        if code == NEXT:
            top_bar[k + 1] += seed
            continue
        p, q, _ = half_plane(code, k, 0.5 / spacing[k], rows)
        _add_row(seed / q, code, k, spacing, x[k], x[k + 1], rows, out, spacing_bar)
        x_bar[k] -= seed * p / q


@inner
def _normal(
    code: int, k: int, w: float, rows: StampRows, ceiling: float, following: float
) -> tuple[float, float]:
    """(p, q) of any half-plane of interval k."""
    if code >= 0:
        p, q, _ = half_plane(code, k, w, rows)
    else:
        p, q = bound_normal(code, ceiling, following)
    return p, q


@lean
def pull_back(
    spacing: FloatArray,
    rows: StampRows,
    ceiling: FloatArray,
    top: FloatArray,
    partner: FloatArray,
    pair: IntArray,
    top_bar: FloatArray,
    out: StampRows,
    spacing_bar: FloatArray,
    ceiling_bar: FloatArray,
) -> None:
    """Pull ``top_bar`` back through the sweep back; ``top_bar[K]`` is complete afterwards."""
    for k in range(spacing.shape[0]):
        seed = top_bar[k]
        if seed == 0.0 or top[k] == 0.0:
            continue
        i, j = pair[k, 0], pair[k, 1]
        w = 0.5 / spacing[k]
        pi, qi = _normal(i, k, w, rows, ceiling[k], top[k + 1])
        pj, qj = _normal(j, k, w, rows, ceiling[k], top[k + 1])
        determinant = pi * qj - pj * qi
        for code, share in ((i, qj / determinant), (j, -qi / determinant)):
            m = seed * share
            if code >= 0:
                _add_row(m, code, k, spacing, top[k], partner[k], rows, out, spacing_bar)
            elif code == CEILING:
                ceiling_bar[k] += m
            elif code == NEXT:
                top_bar[k + 1] += m
