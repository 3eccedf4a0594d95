"""Distance of moving capsules from boxes that stand still, with exact second derivatives.

In the box's frame, with half edges h, the axis c(u) = a + u (b − a), 0 ≤ u ≤ 1, and
e = c − clip(c, −h, h), the distance of the axis is D = min_u |e|. Over u, |e|² is convex and
quadratic by pieces, so that its least value is found exactly between the places where the axis
passes the box's faces. With V = ½ D² and the u found,

    ∇V = Σ e ∂c,     ∇²V = Σ' ∂c ∂cᵀ + Σ e ∂²c − g gᵀ / Σ' δ²,     g = Σ' (δ ∂c + e ∂δ),  δ = b − a,

where Σ' is over the coordinates outside of the box's slab and the last term, what u gives way,
is there only for 0 < u < 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import FloatArray, IntArray
from .kinematics import MovingPoint
from .last import Last

_TOUCHING = 1e-9
"""m; an axis nearer to a box counts as inside of it."""


@dataclass(frozen=True)
class CapsuleAndBox:
    """A pair.

    Args:
        name: of both.
        a, b: the ends of the capsule's axis in the box's frame.
        radius: of the capsule, m.
        half: (3,) half the box's edges, m.
    """

    name: str
    a: MovingPoint
    b: MovingPoint
    radius: float
    half: FloatArray


class Witness(NamedTuple):
    """Where an axis is nearest to the box.

    Args:
        u: (R,) share of the axis.
        e: (R, 3) from the box to the axis; for an axis that enters the box, the unit normal of the
            face through which it leaves it soonest.
        distance: (R,) m of the axis; minus the depth of the axis below that face if it enters.
    """

    u: FloatArray
    e: FloatArray
    distance: FloatArray


class Clearances:
    """Distances between the surfaces of K pairs: a `Field`.

    A capsule whose axis enters the box is given minus its radius and the axis's depth below
    one face, without that function's curvature: enough to find the way out.
    """

    def __init__(self, pairs: tuple[CapsuleAndBox, ...]) -> None:
        self.pairs = pairs
        self.size = len(pairs)
        self._measured = [Last(partial(_measure, pair)) for pair in pairs]
        self._slopes = [
            Last(partial(_slope, pair, measured))
            for pair, measured in zip(pairs, self._measured, strict=True)
        ]

    def values(self, q: FloatArray) -> FloatArray:
        """(R, K) m."""
        out = np.empty((len(q), self.size))
        for k, pair in enumerate(self.pairs):
            out[:, k] = self._measured[k](q).witness.distance - pair.radius
        return out

    def jacobian(self, q: FloatArray) -> FloatArray:
        """(R, K, n)."""
        out = np.empty((len(q), self.size, q.shape[1]))
        for k in range(self.size):
            out[:, k] = self._slopes[k](q).distance
        return out

    def hessian(self, q: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Field`."""
        out = np.zeros((len(q), q.shape[1], q.shape[1]))
        for k, pair in enumerate(self.pairs):
            rows = np.flatnonzero(multipliers[:, k])
            if len(rows):
                bent = _curvature(pair, q, self._measured[k](q), self._slopes[k](q), rows)
                out[rows] += multipliers[rows, k, None, None] * bent
        return out


class _Measured(NamedTuple):
    """Axis from a along delta (R, 3), and where it is nearest."""

    delta: FloatArray
    witness: Witness


class _Slope(NamedTuple):
    """∂D/∂q (R, n), and of the axis's nearest point and of delta (R, 3, n)."""

    distance: FloatArray
    point: FloatArray
    delta: FloatArray


def _measure(pair: CapsuleAndBox, q: FloatArray) -> _Measured:
    a, b = pair.a.values(q), pair.b.values(q)
    return _Measured(b - a, nearest(a, b, pair.half))


def _slope(pair: CapsuleAndBox, measured: Last[_Measured], q: FloatArray) -> _Slope:
    _, (u, e, _) = measured(q)
    of_a, of_b = pair.a.jacobian(q), pair.b.jacobian(q)
    turning = of_b - of_a
    point = of_a + u[:, None, None] * turning
    normal = e / np.linalg.norm(e, axis=1, keepdims=True)
    return _Slope((normal[:, None] @ point)[:, 0], point, turning)


def _curvature(
    pair: CapsuleAndBox, q: FloatArray, measured: _Measured, slope: _Slope, rows: IntArray
) -> FloatArray:
    """∂²D/∂q² at some rows (r, n, n)."""
    u, e, distance = (part[rows] for part in measured.witness)
    delta, point, turning = measured.delta[rows], slope.point[rows], slope.delta[rows]
    share = u[:, None, None, None]
    bent = (1.0 - share) * pair.a.hessians(q[rows]) + share * pair.b.hessians(q[rows])
    along = np.einsum("rd,rdab->rab", e, bent)
    outside = (e != 0.0).astype(np.float64)
    V = np.swapaxes(point, 1, 2) @ (outside[:, :, None] * point) + along
    g = ((outside * delta)[:, None] @ point + e[:, None] @ turning)[:, 0]
    give = np.sum(outside * delta**2, axis=1)
    free = (u > 0.0) & (u < 1.0) & (give > 0.0)
    g = np.where(free[:, None], g, 0.0) / np.sqrt(np.where(free, give, 1.0))[:, None]
    towards = slope.distance[rows]
    V -= g[:, :, None] * g[:, None] + towards[:, :, None] * towards[:, None]
    entered = (distance <= 0.0)[:, None, None]
    return np.asarray(np.where(entered, along, V / np.maximum(distance, _TOUCHING)[:, None, None]))


def nearest(a: FloatArray, b: FloatArray, half: FloatArray) -> Witness:
    """Where axes from a to b (R, 3) are nearest to the box, all in the box's frame."""
    delta = b - a
    u = np.empty(len(a))
    _nearest_shares(a, delta, half, u)
    c = a + u[:, None] * delta
    e = c - np.clip(c, -half, half)
    distance = np.linalg.norm(e, axis=1)
    inside = np.flatnonzero(distance < _TOUCHING)
    if len(inside):
        u[inside], e[inside], distance[inside] = _way_out(a[inside], b[inside], half)
    return Witness(u, e, distance)


@njit(cache=True, error_model="numpy")
def _rise(a: FloatArray, delta: FloatArray, half: FloatArray, u: float) -> float:
    """Half the slope of |e|² in u."""
    total = 0.0
    for d in range(3):
        c = a[d] + u * delta[d]
        total += delta[d] * (c - min(max(c, -half[d]), half[d]))
    return total


@njit(cache=True, error_model="numpy")
def _nearest_shares(a: FloatArray, delta: FloatArray, half: FloatArray, out: FloatArray) -> None:
    """The u in [0, 1] at which |e|² is least, for every row: its slope rises with u and is linear
    between the places where the axis passes a face's plane."""
    for row in range(a.shape[0]):
        low, high = 0.0, 1.0
        rise_low = _rise(a[row], delta[row], half, 0.0)
        rise_high = _rise(a[row], delta[row], half, 1.0)
        if rise_low >= 0.0 or rise_high <= 0.0:
            out[row] = 0.0 if rise_low >= 0.0 else 1.0
            continue
        for d in range(3):
            for side in (-1.0, 1.0):
                if delta[row, d] == 0.0:
                    continue
                u = (side * half[d] - a[row, d]) / delta[row, d]
                if low < u < high:
                    rise = _rise(a[row], delta[row], half, u)
                    if rise < 0.0:
                        low, rise_low = u, rise
                    else:
                        high, rise_high = u, rise
        out[row] = low - rise_low * (high - low) / (rise_high - rise_low)


def _way_out(
    a: FloatArray, b: FloatArray, half: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The end of the axis that is deepest below the face that is passed soonest, that face's
    normal, and minus the depth."""
    ends = np.stack([a, b], axis=1)
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    depth = ends @ normals.T - np.concatenate([half, half])  # (R, 2, 6): minus the depth of an end
    lowest = depth.min(axis=1)
    face = np.argmax(lowest, axis=1)
    rows = np.arange(len(a))
    end = np.argmin(depth[rows, :, face], axis=1)
    return end.astype(np.float64), normals[face], lowest[rows, face]
