"""How far averages over time take a motion off its path, whatever its speed.

A motion passes the place ℓ_c at the middle of the average's kernel k, and gets within τ seconds no
further than τ along Θ (`course`). Let Λ be its place as k weighs it, and λ = E Λ. Then (Peano)

    E q(Λ) − q(λ) = ∫ G(ν) dq'(ν),    0 ≤ G(ν) ≤ min(E(Λ − ν)⁺, E(ν − Λ)⁺):

a straight path is not left, and from others all that counts is how they turn where Λ may be, stops
included. Ahead of ℓ_c, with S(c) = P(τ > c) and v the greatest ℓ̇,

    E(Λ − ν)⁺ ≤ ∫ v S(Θ − Θ_c) dΘ    from ν on,    ∫ S = κ(c) = E(τ − c)⁺,

and likewise behind. **A ramp** is an average of the way λ(ℓ) over T: by Jensen's inequality its
place is no further ahead on average than k ∗ box(T) has it, but for the change of dλ/dℓ.

The averaged motion's **velocity and acceleration** are means of what the path's intervals allow
where it may be. A ramp changes them by −∫ k' D and ∫ k'' D, D = ∫ G dp being how far a mean of
joints over T is from the joints of the mean place, p = dq/dλ. For the longest averages k' w₁ is
±1 times what the others make of two instants, k'' w₁ w₂ of four, and k''' w₁ w₂ w₃ of eight, half
of them with plus. As G ≥ 0, D is within −∫ G dp⁻ and ∫ G dp⁺: with R the greatest of the one and of
the other nearby, added, it makes R by w₁, 2 R by w₁ w₂, and 4 R by w₁ w₂ w₃.

Slow motions cannot accelerate for long: k has one hump, so that for any y, of which a velocity and
its part beside the path are examples,

    |∫ k ẏ| = |∫ k' y| ≤ k(0) (max y − min y),    k(0) = P(|τ₂| < w₁ / 2) / w₁,

extremes being those within reach and τ₂ what all averages but the longest make. Time that comes up
to speed only makes y less. Ramps count among the averages, w₁ included.

At a rest in which joints turn, the first half of it counts as what was before, the other as what
comes. How far E Λ may be beyond the place of the rest then is added to how far joints are off.

κ of a cascade of moving averages w is a sum of powers (−c ± w₁/2 ± w₂/2 …)₊ⁿ⁺¹.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .allowed import Allowed
from .averaging_kernels import (
    Cells,
    Offsets,
    bound_accelerations,
    bound_means,
    bound_offsets,
    bound_ramp,
    bound_veer,
    greatest_between,
    tail,
)
from .course import Course
from .smoothing import Smoothing
from .velocity_ranges import velocity_ranges

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Rates(NamedTuple):
    """How averages move the joints, at each of C cells of a course.

    Args:
        speed, push: (C,), greatest mean of |ℓ̇| and |ℓ̈|.
        veer: (C, N), bounds of the velocity but for that along the path.
        ramped, jolted: (C, N), bounds of what a ramp does to the acceleration and to the jerk.
    """

    speed: FloatArray
    push: FloatArray
    veer: FloatArray
    ramped: FloatArray
    jolted: FloatArray


class Averages:
    """Bounds of what averages make of motions on a path.

    Args:
        course: of the path.
        smoothing: what is done to the joints in time.
        ramp: s, what the place is averaged over before.
    """

    def __init__(self, course: Course, smoothing: Smoothing, ramp: float) -> None:
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
        self._peak = peak(self._all)
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

    def rates(self, start: float, more: float) -> Rates:
        """How they move the joints; `offsets` come before.

        Args:
            start: s, over which time comes up to speed.
            more: by which accelerations may be greater then.
        """
        course, off = self._course, self._of_ramp()
        speed = self.mean(course.speed[:, None], 0.0)[:, 0]
        push = more * self.mean(course.push[:, None], start)[:, 0]
        push = self.slowly(push, self._ranges(np.zeros_like(course.speed), course.speed))
        veer = np.zeros_like(course.turn)
        bound_veer(
            self._cells,
            course.speed,
            self._all,
            self._half,
            self._first,
            self._last,
            veer,
        )
        if off.any():
            third, second, first = (0.0, 0.0, 0.0, *self._widths)[-3:]
            veer += divided(off, first)
            return Rates(
                speed,
                push,
                veer,
                divided(2.0 * off, first * second),
                divided(4.0 * off, first * second * third),
            )
        return Rates(speed, push, veer, off, off)

    def accelerations(
        self, allowed: Allowed, matrix: FloatArray, about: FloatArray, start: float, more: float
    ) -> FloatArray:
        """(C, N), bounds of |A (q̈ − d ℓ̈)|, ramps left out.

        Args:
            allowed: what the path's limits allow.
            matrix: (C, N, N), A.
            about: (C, N), d.
            start, more: as in `rates`.
        """
        out, course = np.zeros_like(about), self._course
        ddq = allowed.accelerations
        bound_accelerations(
            self._cells,
            course.interval,
            self._all,
            self._half,
            start,
            self._first,
            self._last,
            ddq.push,
            ddq.left,
            ddq.right,
            allowed.corners,
            allowed.count,
            matrix,
            about,
            out,
        )
        ranges = velocity_ranges(
            course.theta,
            course.interval,
            course.speed,
            self._half,
            self._first,
            self._last,
            allowed.slope,
            matrix,
            about,
        )
        return self.slowly(more * out, ranges)

    def velocity_ranges(self, allowed: Allowed) -> FloatArray:
        """(C, N), by how much joints' velocities differ at most within reach of the averages."""
        k, speed = self._course.interval, self._course.speed[:, None]
        # At rests the last interval's, by no speed.
        ends = allowed.slope.min(axis=0)[k] * speed, allowed.slope.max(axis=0)[k] * speed
        pairs = zip(*(values.T for values in ends), strict=True)
        return np.stack([self._ranges(least, most) for least, most in pairs], -1)

    def slowly(self, accelerations: FloatArray, ranges: FloatArray) -> FloatArray:
        """Bounds of mean accelerations, where velocities have ranges (of the same shape)."""
        return _least(accelerations, self._peak, ranges)

    def jerks(self, accelerations: FloatArray, ranges: FloatArray) -> FloatArray:
        """(C, N), bounds of what joints' accelerations change by in a second, ramps left out.

        Args:
            accelerations: (C, N), bounds of them by what drives them, within reach of each cell.
            ranges: (C, N), `velocity_ranges`.
        """
        # Differences over the longest average; without it there, but within reach.
        others = np.concatenate([self._widths[:-1], self._all[len(self._widths) :]])
        longest = max(self._widths, default=0.0)
        return divided(2.0 * _least(accelerations, peak(others), ranges), longest)

    def _ranges(self, least: FloatArray, most: FloatArray) -> FloatArray:
        """(C,), from the least (C,) ≤ 0 to the most within reach of each cell, 0 included."""
        theta, used = self._course.theta, self._last >= 0
        first, last = np.zeros((2, len(most)), dtype=np.int64)
        begin, end = theta[self._first[used]] - self._half, theta[self._last[used] + 1] + self._half
        first[used] = np.searchsorted(theta[1:], begin)
        last[used] = np.searchsorted(theta[:-1], end, "right")
        return np.asarray(
            greatest_between(most, first, last) + greatest_between(-least, first, last)
        )

    def mean(self, values: FloatArray, start: float) -> FloatArray:
        """(C, D), the greatest means of values (C, D) ≥ 0 that the averages can make of them."""
        out = np.zeros_like(values)
        bound_means(
            self._cells.theta,
            self._all,
            self._half,
            start,
            self._first,
            self._last,
            values,
            out,
        )
        return out

    def _of_ramp(self) -> FloatArray:
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


def peak(widths: FloatArray) -> float:
    """1/s, the greatest value of the kernel of averages of these widths; inf of none."""
    if not len(widths):
        return np.inf
    *others, longest = np.sort(widths)
    return float((1.0 - 2.0 * tail(np.array(others), 0, 0.5 * longest)) / longest)


def _least(accelerations: FloatArray, most: float, ranges: FloatArray) -> FloatArray:
    """The less of accelerations and of ranges of velocities by the kernel's greatest value."""
    if not np.isfinite(most):
        return accelerations
    return np.minimum(accelerations, most * ranges)


def divided(values: FloatArray, widths: float) -> FloatArray:
    """Values by a product of widths; inf where that is zero, as there are too few of them."""
    return values / widths if widths > 0.0 else np.full_like(values, np.inf)


def near(course: Course, values: FloatArray, away: float) -> FloatArray:
    """(C,), the greatest of values (C,) on cells that are within ``away`` s by Θ."""
    return np.asarray(greatest_between(values, *_within(course, away)))


def _within(course: Course, away: float) -> tuple[IntArray, IntArray]:
    """(C,) each, the first cell within ``away`` s, and the one behind the last."""
    theta = course.theta
    first = np.searchsorted(theta[1:], theta[:-1] - away)
    return first, np.searchsorted(theta[:-1], theta[1:] + away, "right")
