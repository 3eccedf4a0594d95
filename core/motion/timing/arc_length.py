"""A path's samples over a parameter ℓ that runs evenly in zones.

With a blend law that is flat at its ends (α' = 0), σ runs very unevenly along the curve: through
the middle of a zone two to three times as fast as at its edges. Stamping takes σ̇² to be linear
between samples and would lose time there. So it is ℓ that is stamped,

    dℓ/dσ = w(σ) = n(σ) / d(σ),    n² = |x'|² + ε²,

with x' the joints' rate (each joint in units of its acceleration limit) where the corner is blended
in joint space, the TCP's where it is blended in TCP space, and d(σ) linear between the values of n
at the zone's edges. Elsewhere, and at the edges, ℓ runs as σ does. ε keeps ℓ regular where a
blend turns back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
from ..geometry.corners import JOINT_CORNER, POSITION
from ..geometry.layout import Layout
from ..geometry.pieces import Pieces
from ..path.tcp_samples import States

_FLOOR = 0.01
"""ε² as a share of the mean of |x'|² at a zone's two edges."""
_TURNING = 0.1
"""m that a turn of the tool by one rad counts."""
_LEAST = 0.2
"""Share of the trapezium rule below which the corrected length of an interval is not trusted."""


class _Rates(NamedTuple):
    """w = dℓ/dσ of the samples (S,), and dw/dσ."""

    w: FloatArray
    turn: FloatArray


@dataclass(frozen=True)
class ArcLength:
    """The samples of a path with respect to ℓ.

    Args:
        states: (S,) samples; derivatives are with respect to ℓ.
        rate: (S,), dℓ/dσ.
        spacing: (K,), ℓ of each interval.
        zones: (Z, 3), of each zone its first and its last sample, and whether it is blended in
            joint space.
        weights: (N,), what the square of each axis's rate counts in joint space.
    """

    states: States
    rate: FloatArray
    spacing: FloatArray
    zones: IntArray
    weights: FloatArray

    @classmethod
    def of(
        cls,
        layout: Layout,
        pieces: Pieces,
        flat: NDArray[np.bool_],
        sigma: FloatArray,
        samples: States,
        acceleration: FloatArray,
    ) -> ArcLength:
        """The samples of a path.

        Args:
            layout, pieces: of the path.
            flat: (M − 1,), corners whose blend law is flat at its ends.
            sigma: (S,), of the samples.
            samples: (S,), with respect to σ.
            acceleration: (N,) rad/s² or m/s², the axes' limits.
        """
        zones, weights = _zones(layout, pieces, flat), 1.0 / acceleration**2
        rates = _Rates(np.ones(len(sigma)), np.zeros(len(sigma)))
        states = States(samples.q, *(array.copy() for array in samples[1:]))
        _even(samples, sigma, zones, weights, rates, states)
        left = pieces.interval_samples
        spacing = np.empty(len(left))
        _measure(sigma, left, rates, spacing)
        return cls(states, rates.w, spacing, zones, weights)

    def pull(
        self,
        pieces: Pieces,
        sigma: FloatArray,
        samples: States,
        bar: States,
        spacing_bar: FloatArray,
        sigma_bar: FloatArray,
    ) -> States:
        """Reverse of `of`: the gradient with respect to ``samples``.

        Args:
            pieces, sigma, samples: as in `of`.
            bar: gradient with respect to ``states``; used up.
            spacing_bar: (K,).
            sigma_bar: (S,), added to.
        """
        rates = _Rates(np.ones(len(sigma)), np.zeros(len(sigma)))
        rates_bar = _Rates(np.zeros(len(sigma)), np.zeros(len(sigma)))
        scratch = States(*(np.empty_like(array) for array in samples))
        _even(samples, sigma, self.zones, self.weights, rates, scratch)
        _pull_measure(sigma, pieces.interval_samples, rates, spacing_bar, sigma_bar, rates_bar)
        _pull_even(samples, sigma, self.zones, self.weights, rates, bar, rates_bar, sigma_bar)
        return bar


def _zones(layout: Layout, pieces: Pieces, flat: NDArray[np.bool_]) -> IntArray:
    """Samples and space of every zone that has an extent and whose law is flat at its ends."""
    zones = np.empty((len(flat), 3), dtype=np.int64)
    edge, samples, kind = pieces.edge, pieces.first_sample, layout.corners.kind
    return zones[: _find_zones(layout.waypoint, layout.extent, flat, kind, edge, samples, zones)]


@lean
def _find_zones(
    waypoint: FloatArray,
    extent: FloatArray,
    flat: NDArray[np.bool_],
    kind: IntArray,
    edge: FloatArray,
    samples: IntArray,
    zones: IntArray,
) -> int:
    """Write the zones; how many they are."""
    count, p = 0, 0
    for i in range(flat.size):
        before, after = extent[i, POSITION, 0], extent[i, POSITION, 1]
        if not (flat[i] and before > 0.0 and after > 0.0):
            continue
        begin, end = waypoint[i + 1] - before, waypoint[i + 1] + after
        # Pieces whose middle lies between the zone's edges.
        while p < edge.size - 1 and 0.5 * (edge[p] + edge[p + 1]) < begin:
            p += 1
        zones[count, 0] = samples[p]
        while p < edge.size - 1 and 0.5 * (edge[p] + edge[p + 1]) < end:
            p += 1
        zones[count, 1] = samples[p] - 1
        zones[count, 2] = kind[i] == JOINT_CORNER
        count += 1
    return count


@inner
def _square(states: States, k: int, joint: int, weights: FloatArray) -> tuple[float, float]:
    """|x'|² and x' · x'' of sample k."""
    square = mixed = 0.0
    if joint:
        for j in range(weights.size):
            square += weights[j] * states.dq[k, j] ** 2
            mixed += weights[j] * states.dq[k, j] * states.ddq[k, j]
        return square, mixed
    for i in range(6):
        weight = 1.0 if i < 3 else _TURNING**2
        square += weight * states.v[k, i] ** 2
        mixed += weight * states.v[k, i] * states.a[k, i]
    return square, mixed


@inner
def _ends(
    states: States, first: int, last: int, joint: int, weights: FloatArray
) -> tuple[float, float, float]:
    """ε² of a zone, and n at its two edges."""
    begin, _ = _square(states, first, joint, weights)
    end, _ = _square(states, last, joint, weights)
    floor = 0.5 * _FLOOR * (begin + end)
    return floor, np.sqrt(begin + floor), np.sqrt(end + floor)


@lean
def _even(
    states: States,
    sigma: FloatArray,
    zones: IntArray,
    weights: FloatArray,
    rates: _Rates,
    out: States,
) -> None:
    """Write w and dw/dσ of the samples in zones, and their derivatives with respect to ℓ."""
    for z in range(zones.shape[0]):
        first, last, joint = zones[z, 0], zones[z, 1], zones[z, 2]
        floor, n0, n1 = _ends(states, first, last, joint, weights)
        length = sigma[last] - sigma[first]
        if not (n0 > 0.0 and n1 > 0.0 and length > 0.0):
            continue
        slope = (n1 - n0) / length
        for k in range(first, last + 1):
            square, mixed = _square(states, k, joint, weights)
            n = np.sqrt(square + floor)
            d = n0 + slope * (sigma[k] - sigma[first])
            w = n / d
            turn = mixed / (n * d) - n * slope / d**2
            rates.w[k], rates.turn[k] = w, turn
            for j in range(weights.size):
                out.dq[k, j] = states.dq[k, j] / w
                out.ddq[k, j] = (states.ddq[k, j] - states.dq[k, j] * turn / w) / w**2
            for i in range(6):
                out.v[k, i] = states.v[k, i] / w
                out.a[k, i] = (states.a[k, i] - states.v[k, i] * turn / w) / w**2


@lean
def _measure(sigma: FloatArray, left: IntArray, rates: _Rates, spacing: FloatArray) -> None:
    """Write ℓ of the intervals: the trapezium rule with its end correction."""
    for i in range(left.size):
        k = left[i]
        h = sigma[k + 1] - sigma[k]
        plain = 0.5 * h * (rates.w[k] + rates.w[k + 1])
        corrected = plain + h * h / 12 * (rates.turn[k] - rates.turn[k + 1])
        spacing[i] = corrected if corrected > _LEAST * plain else plain


@lean
def _pull_measure(
    sigma: FloatArray,
    left: IntArray,
    rates: _Rates,
    spacing_bar: FloatArray,
    sigma_bar: FloatArray,
    rates_bar: _Rates,
) -> None:
    """Reverse of `_measure`."""
    for i in range(left.size):
        k, bar = left[i], spacing_bar[i]
        h = sigma[k + 1] - sigma[k]
        plain = 0.5 * h * (rates.w[k] + rates.w[k + 1])
        turned = rates.turn[k] - rates.turn[k + 1]
        h_bar = 0.5 * bar * (rates.w[k] + rates.w[k + 1])
        if plain + h * h / 12 * turned > _LEAST * plain:
            h_bar += bar * h / 6 * turned
            rates_bar.turn[k] += bar * h * h / 12
            rates_bar.turn[k + 1] -= bar * h * h / 12
        rates_bar.w[k] += 0.5 * bar * h
        rates_bar.w[k + 1] += 0.5 * bar * h
        sigma_bar[k + 1] += h_bar
        sigma_bar[k] -= h_bar


@inner
def _pull_square(
    states: States,
    k: int,
    joint: int,
    weights: FloatArray,
    square_bar: float,
    mixed_bar: float,
    bar: States,
) -> None:
    """Reverse of `_square`."""
    if joint:
        for j in range(weights.size):
            one, two = states.dq[k, j], states.ddq[k, j]
            bar.dq[k, j] += weights[j] * (2 * one * square_bar + two * mixed_bar)
            bar.ddq[k, j] += weights[j] * one * mixed_bar
        return
    for i in range(6):
        weight = 1.0 if i < 3 else _TURNING**2
        one, two = states.v[k, i], states.a[k, i]
        bar.v[k, i] += weight * (2 * one * square_bar + two * mixed_bar)
        bar.a[k, i] += weight * one * mixed_bar


@inner
def _pull_rates(
    first: FloatArray,
    second: FloatArray,
    w: float,
    turn: float,
    by_one: FloatArray,
    by_two: FloatArray,
) -> tuple[float, float]:
    """Reverse of the derivatives with respect to ℓ, in place; gradients of w and dw/dσ."""
    w_bar = turn_bar = 0.0
    for j in range(first.size):
        one, two = by_one[j], by_two[j]
        w_bar -= one * first[j] / w**2
        w_bar += two * (-2 * second[j] / w**3 + 3 * first[j] * turn / w**4)
        turn_bar -= two * first[j] / w**3
        by_one[j] = one / w - two * turn / w**3
        by_two[j] = two / w**2
    return w_bar, turn_bar


@lean
def _pull_even(
    states: States,
    sigma: FloatArray,
    zones: IntArray,
    weights: FloatArray,
    rates: _Rates,
    bar: States,
    rates_bar: _Rates,
    sigma_bar: FloatArray,
) -> None:
    """Reverse of `_even`; ``bar`` becomes the gradient of the path's own samples."""
    for z in range(zones.shape[0]):
        first, last, joint = zones[z, 0], zones[z, 1], zones[z, 2]
        floor, n0, n1 = _ends(states, first, last, joint, weights)
        length = sigma[last] - sigma[first]
        if not (n0 > 0.0 and n1 > 0.0 and length > 0.0):
            continue
        slope = (n1 - n0) / length
        floor_bar = n0_bar = slope_bar = begin_bar = 0.0
        for k in range(first, last + 1):
            w, turn = rates.w[k], rates.turn[k]
            a, b = _pull_rates(states.dq[k], states.ddq[k], w, turn, bar.dq[k], bar.ddq[k])
            c, e = _pull_rates(states.v[k], states.a[k], w, turn, bar.v[k], bar.a[k])
            w_bar, turn_bar = rates_bar.w[k] + a + c, rates_bar.turn[k] + b + e
            square, mixed = _square(states, k, joint, weights)
            n = np.sqrt(square + floor)
            d = n0 + slope * (sigma[k] - sigma[first])
            n_bar = w_bar / d - turn_bar * (mixed / (n * n * d) + slope / d**2)
            d_bar = -w_bar * n / d**2
            d_bar += turn_bar * (2 * n * slope / d**3 - mixed / (n * d**2))
            slope_bar += d_bar * (sigma[k] - sigma[first]) - turn_bar * n / d**2
            n0_bar += d_bar
            sigma_bar[k] += d_bar * slope
            begin_bar -= d_bar * slope
            floor_bar += 0.5 * n_bar / n
            _pull_square(states, k, joint, weights, 0.5 * n_bar / n, turn_bar / (n * d), bar)
        n1_bar = slope_bar / length
        n0_bar -= slope_bar / length
        sigma_bar[last] -= slope_bar * slope / length
        sigma_bar[first] += begin_bar + slope_bar * slope / length
        begin, end = 0.5 * n0_bar / n0, 0.5 * n1_bar / n1
        floor_bar += begin + end
        begin += 0.5 * _FLOOR * floor_bar
        end += 0.5 * _FLOOR * floor_bar
        _pull_square(states, first, joint, weights, begin, 0.0, bar)
        _pull_square(states, last, joint, weights, end, 0.0, bar)
