"""How far averages over time take a motion off its path, whatever its speed.

A motion passes the place ℓ_c at the middle of the average's kernel k, and gets within τ seconds no
further than τ along Θ (`earliest_times`). Let Λ be its place as k weighs it, and
λ = E Λ. Then (Peano)

    E q(Λ) − q(λ) = ∫ G(ν) dq'(ν),    0 ≤ G(ν) ≤ min(E(Λ − ν)⁺, E(ν − Λ)⁺):

a straight path is not left, and from others all that counts is how they turn where Λ may be, stops
included. Ahead of ℓ_c, with S(c) = P(τ > c) and v the greatest ℓ̇,

    E(Λ − ν)⁺ ≤ ∫ v S(Θ − Θ_c) dΘ    from ν on,    ∫ S = κ(c) = E(τ − c)⁺,

and likewise behind. **A ramp** is an average of the way λ(ℓ) over T: by Jensen's inequality its
place is no further ahead on average than k ∗ box(T) has it, but for the change of dλ/dℓ.

The averaged motion's **velocity** is a mean of what the path's intervals allow where it may be. A
ramp changes it by −∫ k' D, D = ∫ G dp being how far a mean of joints over T is from the joints of
the mean place, p = dq/dλ. For the longest average k' w is ±1 times what the others make of two
instants. As G ≥ 0, D is within −∫ G dp⁻ and ∫ G dp⁺: with R the greatest of the one and of the
other nearby, added, it makes R by w.

At a rest in which joints turn, the first half of it counts as what was before, the other as what
comes. How far E Λ may be beyond the place of the rest then is added to how far joints are off.

κ of a cascade of moving averages w is a sum of powers (−c ± w₁/2 ± w₂/2 …)₊ⁿ⁺¹.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...motion.command.smoothing import Smoothing
from .averaging_kernels import (
    Cells,
    Offsets,
    bound_means,
    bound_offsets,
    bound_ramp,
    bound_veer,
    greatest_between,
)
from .earliest_times import EarliestTimes


class Rates(NamedTuple):
    """How averages move the joints, at each of C cells of a course.

    Args:
        speed: (C,), greatest mean of |ℓ̇|.
        veer: (C, N), bounds of the velocity but for that along the path.
    """

    speed: FloatArray
    veer: FloatArray


class Averages:
    """Bounds of what averages make of motions on a path.

    Args:
        course: of the path.
        smoothing: what is done to the joints in time.
        ramp: s, what the place is averaged over before.
    """

    def __init__(self, course: EarliestTimes, smoothing: Smoothing, ramp: float) -> None:
        self._course, self._ramp = course, ramp
        self._widths = sorted(smoothing.widths)
        self._all = np.array([*self._widths, ramp] if ramp > 0.0 else self._widths)
        self._half = 0.5 * float(self._all.sum())
        self._fast = course.speed * course.way[:, 1]
        self._cells = Cells(
            course.theta,
            course.place,
            self._fast,
            course.way[:, 0],
            course.tangent,
            course.turn,
            course.uneven,
            course.moves,
            course.parts,
        )
        count = len(course.moves)
        self._first, self._last = np.full(count, count), np.full(count, -1)

    @property
    def reach(self) -> float:
        """s by Θ that two places are apart at most which both count at one time."""
        return 2.0 * self._half

    def offsets(self) -> Offsets:
        """How far they take joints off the path."""
        count, size = self._course.turn.shape
        made = Offsets(np.zeros((count, size)), np.zeros((count, 2)), np.zeros((count, size)))
        bound_offsets(self._cells, self._all, self._half, made, self._first, self._last)
        return made

    def rates(self) -> Rates:
        """How they move the joints; `offsets` come before."""
        course, off = self._course, self.over_ramp()
        speed, veer = np.zeros_like(course.speed), np.zeros_like(course.turn)
        within = self._all, self._half, self._first, self._last
        bound_means(course.theta, *within, course.speed[:, None], speed[:, None])
        bound_veer(self._cells, course.speed, *within, veer)
        if off.any():
            longest = max(self._widths, default=0.0)
            veer += off / longest if longest > 0.0 else np.inf
        return Rates(speed, veer)

    def over_ramp(self) -> FloatArray:
        """(C, N), R: the range of how far means of joints over a ramp are from the mean place's."""
        course, least = self._course, self._course.way[:, :1]
        found = np.zeros_like(course.turn)
        if self._ramp == 0.0:
            return found
        # dp = dq'/λ' − q' dλ'/λ'², the second to either side.
        change = course.bent * np.diff(course.place) + np.where(
            course.moves, 0.0, np.ptp(course.way, axis=1)
        )
        aside = self._steepest() * (change[:, None] / least**2)
        for side in (-1.0, 1.0):
            turned = np.maximum(side * course.turn, 0.0) + 0.5 * course.uneven
            off = np.zeros_like(found)
            widths = np.array([self._ramp])
            bound_ramp(self._cells, widths, 0.5 * self._ramp, turned / least + aside, off)
            # Of all instants that count the middles are within the averages' half of one.
            reach = self.reach - 0.5 * self._ramp
            found += np.stack([near(course, values, reach) for values in off.T], -1)
        return found

    def _steepest(self) -> FloatArray:
        """(C, N), bounds of |dq/dℓ|; at rests in which joints turn, of the cells beside."""
        course = self._course
        steepest = np.abs(course.tangent) + np.abs(course.turn) + course.uneven
        moving = np.flatnonzero(course.moves)
        turns = np.flatnonzero(~course.moves & course.turn.any(axis=1))
        after = np.searchsorted(moving, turns)
        beside = steepest[moving[after - 1]], steepest[moving[after]]
        steepest[turns] = np.maximum(*beside)
        return steepest


def near(course: EarliestTimes, values: FloatArray, away: float) -> FloatArray:
    """(C,), the greatest of values (C,) on cells that are within ``away`` s by Θ."""
    return np.asarray(greatest_between(values, *_within(course, away)))


def _within(course: EarliestTimes, away: float) -> tuple[IntArray, IntArray]:
    """(C,) each, the first cell within ``away`` s, and the one behind the last."""
    theta = course.theta
    first = np.searchsorted(theta[1:], theta[:-1] - away)
    return first, np.searchsorted(theta[:-1], theta[1:] + away, "right")
