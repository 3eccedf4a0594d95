"""How soon the places of a path can be passed, at any speed that its limits allow.

With X the greatest ℓ̇² that limits leave anywhere, Θ(ℓ) = ∫ dℓ / √X is the time of a motion that is
as fast as possible everywhere. Rests take their time in it too. Whatever the speed, the override
or the way in which time comes up to speed, no motion runs faster than Θ: within τ seconds it gets
no further than τ along it. The path is cut into cells by it, rests included.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...motion.command.ramp import way_slopes
from ...motion.timing.timing import Timing
from .speed_bounds import Allowed

_ROUNDING = 1e-12
"""Share of a tangent by which it may turn through rounding."""


@dataclass(frozen=True)
class EarliestTimes:
    """A path in C cells, the first and the last of them rests.

    Args:
        theta: (C + 1,) s, Θ of their edges.
        place: (C + 1,), ℓ of their edges.
        sigma: (C + 1,), σ of their edges.
        moves: (C,) bool, which cells are no rests.
        speed: (C,), greatest ℓ̇.
        way: (C, 2), least and greatest dλ/dℓ, λ being what ramps are means over; at rests those
            of the cells beside.
        bent: (C,), greatest |d²λ/dℓ²|.
        tangent: (C, N), dq/dℓ at the middle.
        turn: (C, N), by how much dq/dℓ changes.
        uneven: (C, N), bound of ∫ |q'' − its mean| dℓ.
        parts: (C,) bool, the middles of rests, in which joints turn.
    """

    theta: FloatArray
    place: FloatArray
    sigma: FloatArray
    moves: NDArray[np.bool_]
    speed: FloatArray
    way: FloatArray
    bent: FloatArray
    tangent: FloatArray
    turn: FloatArray
    uneven: FloatArray
    parts: NDArray[np.bool_]

    @classmethod
    def of(
        cls, timing: Timing, allowed: Allowed, rests: FloatArray, step: float, reach: float
    ) -> EarliestTimes:
        """Cut a path.

        Args:
            timing: of it.
            allowed: what its limits allow.
            rests: (S,) s, at stops on the way, beside programmed waits; at least.
            step: s, the longest cell.
            reach: s, the longest rest that makes a difference.
        """
        most = np.sqrt(allowed.most)
        span = 2.0 * allowed.spacing / (most[:-1] + most[1:])
        count = np.maximum(np.ceil(span / step), 1.0).astype(np.int64)
        k = np.repeat(np.arange(len(span)), count)
        n = np.arange(len(k)) - np.repeat(np.cumsum(count) - count, count)
        share = np.stack([n, n + 1], -1) / count[k, None]
        pace = most[k, None] + share * (most[k + 1] - most[k])[:, None]
        z = span[k, None] * share * (most[k, None] + pace) / (2.0 * allowed.spacing[k, None])
        z[n == 0, 0], z[n + 1 == count[k], 1] = 0.0, 1.0
        moving = _moving(timing, allowed, k, z, pace.max(axis=1), span[k] / count[k])
        return _with_rests(moving, *_rests(timing, allowed, rests, reach), count, step, reach)


def _moving(
    timing: Timing,
    allowed: Allowed,
    k: IntArray,
    z: FloatArray,
    speed: FloatArray,
    span: FloatArray,
) -> EarliestTimes:
    """The cells of the path from shares z (C, 2) to z of its intervals k (C,)."""
    part = slice(allowed.first, allowed.first + len(allowed.spacing))
    way, bent = _ways(timing, part)
    step = (z[:, 1] - z[:, 0]) * allowed.spacing[k]
    end = timing.path.pieces.interval_samples[part.stop - 1] + 1
    middle = z.mean(axis=1)
    at = [_values(allowed.slope, k, share) for share in (z[:, 0], middle, z[:, 1])]
    spread = np.ptp(allowed.bend, axis=0)[k]
    whole = np.repeat(np.cumsum(allowed.spacing)[k] - allowed.spacing[k], 2).reshape(-1, 2)
    return EarliestTimes(
        np.concatenate([[0.0], np.cumsum(span)]),
        np.append(whole[:, 0] + z[:, 0] * allowed.spacing[k], allowed.spacing.sum()),
        np.append(_sigma(timing, part.start + k, z[:, 0]), timing.path.sigma[end]),
        np.ones(len(k), dtype=np.bool_),
        speed,
        way[k],
        bent[k],
        at[1],
        at[2] - at[0],
        spread * step[:, None],
        np.zeros(len(k), dtype=np.bool_),
    )


def _values(coefficients: FloatArray, k: IntArray, z: FloatArray) -> FloatArray:
    """(C, N), polynomials by their Bernstein coefficients (D, K, N), after de Casteljau."""
    values = coefficients[:, k]
    share = z[:, None]
    while len(values) > 1:
        values = (1.0 - share) * values[:-1] + share * values[1:]
    return np.asarray(values[0])


def _sigma(timing: Timing, k: IntArray, z: FloatArray) -> FloatArray:
    """(C,), σ at shares z of intervals k, as `Timing` has it."""
    left = timing.path.pieces.interval_samples[k]
    sigma, rate, spacing = timing.path.sigma, timing.along.rate, timing.along.spacing[k]
    rise = sigma[left + 1] - sigma[left]
    lead, tail = spacing / rate[left] - rise, rise - spacing / rate[left + 1]
    return np.asarray(sigma[left] + z * (rise + (1 - z) * ((1 - z) * lead + z * tail)))


def _ways(timing: Timing, part: slice) -> tuple[FloatArray, FloatArray]:
    """(K, 2), least and greatest dλ/dℓ in each interval, and (K,) greatest |d²λ/dℓ²|.

    Without ramp ℓ itself will do for λ.
    """
    left, spacing = timing.path.pieces.interval_samples[part], timing.along.spacing[part]
    if timing.ramp == 0.0:
        return np.ones((len(left), 2)), np.zeros(len(left))
    slope = way_slopes(timing.along.states)
    ends = np.stack([slope[left], slope[left + 1]], -1)
    return np.sort(ends, axis=1), np.abs(ends[:, 1] - ends[:, 0]) / spacing


def _rests(
    timing: Timing, allowed: Allowed, rests: FloatArray, reach: float
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Knots (R,) where the path rests or turns, for how long (R,) s, and how it turns (R, N)."""
    inside = slice(allowed.first, allowed.first + len(allowed.spacing) - 1)
    wait = np.minimum(timing.waits(rests)[inside], reach)
    turn = allowed.slope[0, 1:] - allowed.slope[4, :-1]
    steep = np.abs(allowed.slope).max(axis=(0, 2))
    turned = np.abs(turn).max(axis=1) > _ROUNDING * np.maximum(steep[1:], steep[:-1])
    knots = np.flatnonzero((wait > 0.0) | turned) + 1
    return knots, wait[knots - 1], turn[knots - 1]


def _with_rests(
    moving: EarliestTimes,
    knots: IntArray,
    wait: FloatArray,
    turn: FloatArray,
    count: IntArray,
    step: float,
    reach: float,
) -> EarliestTimes:
    """The cells of a path with those of its rests between them, and two at its ends."""
    first = np.concatenate([[0], np.cumsum(count)])
    # The turn is made in the middle one of each rest's cells.
    parts = 2 * np.ceil(0.5 * wait / step).astype(np.int64) + 1
    at = np.concatenate([[0], np.repeat(first[knots], parts), [first[-1]]])
    length = np.concatenate([[reach], np.repeat(wait / parts, parts), [reach]])
    own = np.concatenate([[0.0], np.cumsum(np.diff(moving.theta))])
    middle = 1 + np.cumsum(parts) - parts + parts // 2
    turns = np.zeros((len(at), turn.shape[1]))
    turns[middle] = turn
    parts_there = np.zeros(len(at), dtype=np.bool_)
    parts_there[middle] = wait > 0.0

    def merged(values: FloatArray, rest: FloatArray) -> FloatArray:
        return np.insert(values, at, rest, axis=0)

    none, still = np.zeros(len(at)), np.zeros_like(turns)
    theta = np.concatenate([[0.0], np.cumsum(merged(np.diff(own), length))])
    place = np.append(merged(moving.place[:-1], moving.place[at]), moving.place[-1])
    sigma = np.append(merged(moving.sigma[:-1], moving.sigma[at]), moving.sigma[-1])
    near = np.minimum(at, len(moving.moves) - 1)
    beside = np.stack([moving.way[np.maximum(at - 1, 0)], moving.way[near]])
    way = np.stack([beside[..., 0].min(axis=0), beside[..., 1].max(axis=0)], -1)
    return EarliestTimes(
        theta,
        place,
        sigma,
        np.insert(moving.moves, at, False),
        merged(moving.speed, none),
        merged(moving.way, way),
        merged(moving.bent, none),
        merged(moving.tangent, still),
        merged(moving.turn, turns),
        merged(moving.uneven, still),
        np.insert(moving.parts, at, parts_there),
    )
