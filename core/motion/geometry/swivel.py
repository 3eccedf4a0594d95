"""Turns of a line taken apart: a swivel of the tool's x axis, and a rotation about it.

A controller may turn the tool by two angles (KUKA: ``ORI1``, ``ORI2``). The *swivel* takes the
tool's x axis the shortest way, at an even rate; the *rotation* turns the tool about that axis, at
an even rate as well:

    R(λ) = R₀ exp(λ a) exp(λ b),    a ⊥ x,  b ∥ x,

both in the tool's axes at the start. With u the x axis at the end, seen from the start,

    a = θ / sin θ (x × u),    cos θ = x · u,    exp(b) = exp(−a) R₀ᵀ R₁.

a stays square to the turned x axis, so that the tool turns by √(a² + b²) per λ all the way, and the
way back is the same one. A limit of turning holds for the greater of both, a share κ of that.

Where x turns round, rounding decides the way it swivels; there the tool turns about one axis, b
alone.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray

_SMALL = 1e-3
"""rad below which θ / sin θ is taken from its series."""
_NO_TURN = 1e-9
"""rad; parts of smaller turns are rounding, and count whole."""
_REVERSED = np.radians(179.9)
"""A swivel from which on rounding decides the way."""


def swivel(end: FloatArray) -> FloatArray:
    """Rotation vectors a (M, 3) that take x the shortest way to unit vectors (M, 3); none to −x."""
    return np.asarray(_ratio(end)[0][:, None] * _across(end))


def pull_swivel(end: FloatArray, bar: FloatArray) -> FloatArray:
    """Reverse of `swivel`: the gradient (M, 3) with respect to small turns of the ends."""
    ratio, slope = _ratio(end)
    # x × u = (0, −u_z, u_y).
    by_end = np.stack(
        [slope * np.sum(bar * _across(end), 1), ratio * bar[:, 2], -ratio * bar[:, 1]]
    )
    return np.cross(end, by_end.T)


def push_swivel(end: FloatArray, turned: FloatArray) -> FloatArray:
    """How swivels change (M, 3, K) along small turns of the ends (M, 3, K)."""
    ratio, slope = _ratio(end)
    end_dot = np.cross(turned, end[:, :, None], axis=1)
    along = (slope[:, None] * end_dot[:, 0])[:, None] * _across(end)[:, :, None]
    across = np.stack([np.zeros_like(end_dot[:, 0]), -end_dot[:, 2], end_dot[:, 1]], 1)
    return np.asarray(along + ratio[:, None, None] * across)


def turn_shares(swivels: FloatArray, rotations: FloatArray) -> FloatArray:
    """κ (M,) of turns by rotation vectors a and b (M, 3); 1 where the tool does not turn."""
    one, two = (np.linalg.norm(part, axis=1) for part in (swivels, rotations))
    whole = np.hypot(one, two)
    turns = whole > _NO_TURN
    return np.where(turns, np.maximum(one, two) / np.where(turns, whole, 1.0), 1.0)


def pull_turn_shares(
    swivels: FloatArray, rotations: FloatArray, bar: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Reverse of `turn_shares`: gradients (M, 3) of both; at a tie, that of the rotation."""
    one, two = (np.linalg.norm(part, axis=1) for part in (swivels, rotations))
    most, least = np.maximum(one, two), np.minimum(one, two)
    # Where one part is none, κ = most / √(most² + least²) is flat.
    both = (least > 0.0) & (np.hypot(one, two) > _NO_TURN)
    cube = np.where(both, np.hypot(one, two), 1.0) ** 3
    by_most, by_least = least**2 / cube, -most * least / cube
    ahead = one > two
    found = []
    for part, size, slope in (
        (swivels, one, np.where(ahead, by_most, by_least)),
        (rotations, two, np.where(ahead, by_least, by_most)),
    ):
        weight = np.where(both, bar * slope / np.where(both, size, 1.0), 0.0)
        found.append(weight[:, None] * part)
    return found[0], found[1]


def _across(end: FloatArray) -> FloatArray:
    """x × u (M, 3)."""
    return np.stack([np.zeros(len(end)), -end[:, 2], end[:, 1]], -1)


def _ratio(end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """θ / sin θ (M,) and its derivative with respect to cos θ = x · u."""
    cosine, sine = end[:, 0], np.hypot(end[:, 1], end[:, 2])
    angle = np.arctan2(sine, cosine)
    series = angle < _SMALL
    safe = np.where((sine > 0.0) & ~series, sine, 1.0)
    ratio = np.where(series, 1.0 + angle**2 / 6.0, angle / safe)
    slope = np.where(series, -1.0 / 3.0 - 2.0 / 15.0 * angle**2, (cosine * ratio - 1.0) / safe**2)
    swivels = angle < _REVERSED
    return np.where(swivels, ratio, 0.0), np.where(swivels, slope, 0.0)
