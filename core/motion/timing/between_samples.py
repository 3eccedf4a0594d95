"""Ceilings that keep velocity limits between samples, too.

Between two samples x = ℓ̇² is linear, and a ceiling v² / r² bends: where the rate r of a joint, the
TCP or the tool changes much from one sample to the next, as the TCP's does where it all but turns
back in a corner blended in joint space, the line between two ceilings passes what lies between. So
the rates are looked at inside of the interval, too, and of its two ceilings the higher one is
lowered until the line keeps to what is allowed there; where that is less than the lower one, both.

Joints are on the quintic that is driven, the TCP's twist on the cubic that has its derivatives.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
from ..geometry.pieces import PieceIndices
from ..geometry.quintic import slopes
from ..path.tcp_samples import States
from .control_points import most_speed, most_tool_speed, slope_points
from .rates import bind, pull_rates, rates

BETWEEN = 1 << 20
"""From here on, what stands for a row in `limits.PathLimits.binding` codes row and place inside."""
_ROOM = 1.002**2
"""Of x, by which limits may be passed: paths that are sampled well are left as they are."""
_PLACES = np.linspace(0.1, 0.9, 9)


_SLOPE = slopes(_PLACES)
"""(Z, 6), what the quintic's slope over the interval is made of."""
_TWIST = np.stack(
    [
        1 - 3 * _PLACES**2 + 2 * _PLACES**3,
        3 * _PLACES**2 - 2 * _PLACES**3,
        _PLACES - 2 * _PLACES**2 + _PLACES**3,
        _PLACES**3 - _PLACES**2,
    ],
    -1,
)
"""(Z, 4), what the twist is made of: both values and both slopes."""


def row_between(code: int) -> int:
    """The row that a code from `BETWEEN` on is of."""
    return (code - BETWEEN) // (2 * len(_PLACES))


@inner
def _least(rate: FloatArray, velocity: FloatArray) -> tuple[float, int]:
    """Greatest x at these rates, and the row that bounds it."""
    most, row = 0.0, -1
    for j in range(rate.size):
        share = abs(rate[j]) / velocity[j]
        if share > most:
            most, row = share, j
    return (1.0 / (most * most) if row >= 0 else np.inf), row


@inner
def _keeps(states: States, s: int, h: float, velocity: FloatArray, x0: float, x1: float) -> bool:
    """Whether, with x linear between two values, no limit can be passed after sample s."""
    axes = velocity.size - 2
    keeps = True
    for j in range(axes):
        c = slope_points(states, s, j, states.q[s + 1, j] - states.q[s, j], h)
        # What is not a number keeps to nothing.
        keeps = keeps and most_speed(c, x0, x1) <= _ROOM * velocity[j] ** 2
    for part in range(2):
        most = most_tool_speed(states, s, part, h, x0, x1)
        keeps = keeps and most <= _ROOM * velocity[axes + part] ** 2
    return keeps


@inner
def _inside(states: States, s: int, h: float, m: int, rate: FloatArray, twist: FloatArray) -> None:
    """Write the rates (N + 2) and the twist (6,) at place m between samples s and s + 1."""
    axes = rate.size - 2
    for j in range(axes):
        rate[j] = (
            _SLOPE[m, 3] / h * (states.q[s + 1, j] - states.q[s, j])
            + _SLOPE[m, 1] * states.dq[s, j]
            + _SLOPE[m, 4] * states.dq[s + 1, j]
            + h * (_SLOPE[m, 2] * states.ddq[s, j] + _SLOPE[m, 5] * states.ddq[s + 1, j])
        )
    for part in range(2):
        square = 0.0
        for i in range(3 * part, 3 * part + 3):
            twist[i] = (
                _TWIST[m, 0] * states.v[s, i]
                + _TWIST[m, 1] * states.v[s + 1, i]
                + h * (_TWIST[m, 2] * states.a[s, i] + _TWIST[m, 3] * states.a[s + 1, i])
            )
            square += twist[i] * twist[i]
        rate[axes + part] = np.sqrt(square)


def lower_between(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    velocity: FloatArray,
    ceiling: FloatArray,
    binding: IntArray,
) -> None:
    """Lower ceilings (K + 1,), 0 at stops, where the line between two passes a limit.

    Args:
        states: (S,) samples.
        spacing: (K,), of the intervals.
        pieces: of the path.
        velocity: (M, N + 2), limits of the segments.
        ceiling: lowered.
        binding: (K + 1, 3), becomes (sample at the left of the interval, code, segment).
    """
    scratch = np.empty((3, max(velocity.shape[1], 6)))
    _lower_between(states, spacing, pieces, velocity, ceiling, binding, scratch, np.empty((2, 2)))


@lean
def _lower_between(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    velocity: FloatArray,
    ceiling: FloatArray,
    binding: IntArray,
    scratch: FloatArray,
    ends: FloatArray,
) -> None:
    first_sample, first_interval, segment = pieces
    size = velocity.shape[1]
    rate, bend, twist = scratch[0, :size], scratch[1, :size], scratch[2, :6]
    end, lowered = ends[0], ends[1]
    for p in range(segment.size):
        own, s = velocity[segment[p]], first_sample[p]
        rates(states, s, size - 2, rate, bend)
        end[1], _ = _least(rate, own)
        for i in range(first_interval[p], first_interval[p + 1]):
            end[0] = end[1]
            rates(states, s + 1, size - 2, rate, bend)
            end[1], _ = _least(rate, own)
            for e in range(2):
                lowered[e] = 0.0 if ceiling[i + e] == 0.0 else end[e]
            looked = 0 if _keeps(states, s, spacing[i], own, lowered[0], lowered[1]) else 1
            for m in range(looked * _PLACES.size):
                z = _PLACES[m]
                _inside(states, s, spacing[i], m, rate, twist)
                x, row = _least(rate, own)
                x *= _ROOM
                if (1.0 - z) * lowered[0] + z * lowered[1] <= x:
                    continue
                code = BETWEEN + 2 * (_PLACES.size * row + m)
                high = 1 if lowered[1] > lowered[0] else 0
                weight = z if high else 1.0 - z
                most = (x - (1.0 - weight) * lowered[1 - high]) / weight
                if most > lowered[1 - high]:
                    if most < ceiling[i + high]:
                        ceiling[i + high] = most
                        bind(binding, i + high, s, code, segment[p])
                    continue
                for e in range(2):
                    if x < ceiling[i + e]:
                        ceiling[i + e] = x
                        bind(binding, i + e, s, code + 1, segment[p])
            s += 1


@njit(cache=True, error_model="numpy")
def pull_between(
    states: States,
    spacing: FloatArray,
    pieces: PieceIndices,
    velocity: FloatArray,
    ceiling: FloatArray,
    binding: IntArray,
    ceiling_bar: FloatArray,
    states_bar: States,
    spacing_bar: FloatArray,
    velocity_bar: FloatArray,
) -> None:
    """Reverse of `lower_between`: adds to the last three."""
    first_sample, first_interval, segment = pieces
    size = velocity.shape[1]
    axes = size - 2
    rate, bend, twist = np.empty(size), np.empty(size), np.empty(6)
    rate_bar, bend_bar = np.zeros(size), np.zeros(size)
    for p in range(segment.size):
        own = velocity[segment[p]]
        for i in range(first_interval[p], first_interval[p + 1]):
            s, h = first_sample[p] + i - first_interval[p], spacing[i]
            for e in range(2):
                code, bar = binding[i + e, 1], ceiling_bar[i + e]
                if bar == 0.0 or code < BETWEEN or binding[i + e, 0] != s:
                    continue
                j, rest = divmod(code - BETWEEN, 2 * _PLACES.size)
                m = rest // 2
                if rest % 2 == 0:
                    weight = _PLACES[m] if e else 1.0 - _PLACES[m]
                    bar /= weight
                    if ceiling[i + 1 - e] != 0.0:
                        rates(states, s + 1 - e, axes, rate, bend)
                        x, row = _least(rate, own)
                        other = -(1.0 - weight) * bar * 2.0 * x
                        velocity_bar[segment[p], row] += other / own[row]
                        rate_bar[row] = -other / rate[row]
                        pull_rates(states, s + 1 - e, axes, rate_bar, bend_bar, states_bar)
                        rate_bar[row] = 0.0
                _inside(states, s, h, m, rate, twist)
                x = _ROOM * (own[j] / rate[j]) ** 2
                velocity_bar[segment[p], j] += 2.0 * x / own[j] * bar
                back = -2.0 * x / rate[j] * bar
                if j < axes:
                    rise = _SLOPE[m, 3] / h * back
                    states_bar.q[s + 1, j] += rise
                    states_bar.q[s, j] -= rise
                    spacing_bar[i] -= rise / h * (states.q[s + 1, j] - states.q[s, j])
                    for n in range(2):
                        states_bar.dq[s + n, j] += _SLOPE[m, 1 + 3 * n] * back
                        states_bar.ddq[s + n, j] += h * _SLOPE[m, 2 + 3 * n] * back
                        spacing_bar[i] += _SLOPE[m, 2 + 3 * n] * states.ddq[s + n, j] * back
                    continue
                for k in range(3 * (j - axes), 3 * (j - axes) + 3):
                    along = back * twist[k] / rate[j]
                    for n in range(2):
                        states_bar.v[s + n, k] += _TWIST[m, n] * along
                        states_bar.a[s + n, k] += h * _TWIST[m, 2 + n] * along
                        spacing_bar[i] += _TWIST[m, 2 + n] * states.a[s + n, k] * along
