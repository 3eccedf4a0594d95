"""What elastic joints lead their links by at most, place by place, at any speed.

With q_s the smoothed motion, the lead is A(q_s) q̈_s + c(q_s, q̇_s). At a cell of the course
(`course`, `averaging`) with the tangent d, q̇_s = d v + y, and with A and c at the cell's middle the
lead is A q̈_s + v² c(d), but for

- how far q_s is from there, δ in the sum over joints: derivatives of a Jacobian's column, and of a
  mass's place in general, are at most as long as its longest column λ,
  |∂J_j/∂q_i| = |a_min(i,j) × J_max(i,j)| ≤ λ, and so λ grows by at most exp δ;
- y in the centrifugal terms, at most λ (2 v ‖d‖₁ + ‖y‖₁) ‖y‖₁;
- slack, which adds s (tanh((l + h) / s) − tanh(h / s)) to a lead l, h being what the gear holds at
  rest (`elasticity`): for |l| ≤ L it is greatest where h is against l, and of all |h| from a to b
  with c, the one nearest to L / 2, s (tanh((L − c) / s) + tanh(c / s)), which is below L and 2 s.
  From the cell's middle h changes by no more than |spring| δ_j and weight |g| λ exp(δ) δ;
- lag, |lag| |q̇_s|.

Where the path is straight within reach, A q̈_s is A d times an acceleration, and that one way is
told from what is left; elsewhere joints are bounded one by one. What torques on other joints add
is B times these bounds (`Elasticity.mixture`).

**Leads are worked out every** `LEAD_STEP`; a cubic spline through values within ±F stays within
1.549 F (its Lebesgue constant is (1 + 3 √3)/4); with slopes up to M it is off by 0.775 M
`LEAD_STEP` at most (the integral of its Peano kernel, greatest half way between two values).
Values n steps away count (2 − √3)ⁿ, so that those of `_SPLINE` around are all that matters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..robot.chain_kernels import jacobians, motions
from ..robot.model import Robot
from .allowed import Allowed
from .averaging import Averages, Rates, near
from .averaging_kernels import Offsets
from .course import Course
from .elasticity import LEAD_STEP, Carried, Elasticity
from .point_masses import chain_to_axis, filled
from .start_ramp import StartRamp

FloatArray = NDArray[np.float64]

_SPLINE_MOST, SPLINE_BY_SLOPE = 1.55, 0.775
_SPLINE = 24 * LEAD_STEP
"""s: (2 − √3)²⁴ is 2e-14."""


@dataclass(frozen=True)
class Leads:
    """Leads at C cells of a course: sums of ways and of what is left.

    Args:
        ways: (C, 2, N), by acceleration along the path, by velocity.
        share: (C, 2, 2), least (≤ 0) and greatest (≥ 0) factor of each.
        rest: (C, N), bounds of what is left.
    """

    ways: FloatArray
    share: FloatArray
    rest: FloatArray

    def mixed(self, mixture: FloatArray) -> Leads:
        """Of what joints lead by as ``mixture`` (N, N) makes them share leads."""
        rest = _bounded(self.rest, np.abs(mixture))
        return Leads(self.ways @ mixture.T, self.share, rest)

    @property
    def most(self) -> FloatArray:
        """(C, N), bounds of the leads."""
        factor = np.abs(self.share).max(axis=2)
        return np.asarray(self.rest + np.einsum("cwn,cw->cn", np.abs(self.ways), factor))


@dataclass(frozen=True)
class _Mass:
    """A mass at the cells' middles.

    Args:
        moving: (N,) bool, the joints that move it.
        given: (N,), its leads.
        J: (C, 3, N), its Jacobian.
        turn: (C, 3), its acceleration at a steady dq/dt = d.
    """

    moving: NDArray[np.bool_]
    given: FloatArray
    J: FloatArray
    turn: FloatArray

    @classmethod
    def of(cls, mass: Carried, robot: Robot, course: Course) -> _Mass:
        chain = chain_to_axis(robot, mass.joint, "elasticity.carried")
        q, d = np.ascontiguousarray(course.middle), np.ascontiguousarray(course.tangent)
        size = q.shape[1]
        return cls(
            np.isin(np.arange(size), chain.joint),
            filled(mass.lead, size),
            jacobians(chain, q)[:, :3],
            motions(chain, q, d, np.zeros_like(d))[1][:, :3],
        )

    @property
    def matrix(self) -> FloatArray:
        """(C, N, N), its part of A."""
        return np.asarray(self.given[:, None] * np.einsum("cin,cim->cnm", self.J, self.J))

    @property
    def centrifugal(self) -> FloatArray:
        """(C, N), its part of c(d)."""
        return np.asarray(self.given * np.einsum("cin,ci->cn", self.J, self.turn))

    def total(self, values: FloatArray) -> FloatArray:
        """(C,), sums of values (C, N) ≥ 0 over the joints that move it."""
        return np.asarray(values[:, self.moving].sum(axis=1))


@dataclass(frozen=True)
class _Bounds:
    """Bounds of the smoothed joints at each cell, (C, N) each.

    Args:
        off: how far they are from the cell's middle.
        tangent: |d|.
        velocity, veer: |q̇_s|, and |y|.
        acceleration, jerk: |q̈_s|, and how it changes.
        speed: (C,), v.
    """

    off: FloatArray
    tangent: FloatArray
    velocity: FloatArray
    veer: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    speed: FloatArray


def most_leads(
    elasticity: Elasticity,
    robot: Robot,
    allowed: Allowed,
    course: Course,
    averages: Averages,
    offsets: Offsets,
    start: StartRamp,
) -> Leads:
    """Bounds of what commanded joints lead their links by.

    Args:
        elasticity: of the joints.
        robot: that drives the path.
        allowed: what its limits allow.
        course: of the path.
        averages, offsets: of the motion.
        start: how time comes up to speed.
    """
    count, size = course.tangent.shape
    late = start.length, start.most_acceleration
    rates = averages.rates(*late)
    own = filled(elasticity.own, size)
    masses = [_Mass.of(mass, robot, course) for mass in elasticity.carried]
    A = np.tile(np.diag(own), (count, 1, 1)) + sum(mass.matrix for mass in masses)
    none = np.zeros_like(course.tangent)
    along = np.einsum("cnm,cm->cn", A, course.tangent)
    apart = averages.accelerations(allowed, A, course.tangent, *late)
    whole = averages.accelerations(allowed, A, none, *late)
    # One way and the rest, or all joints for themselves, whichever leaves less.
    straight = apart.sum(axis=1) < 0.5 * whole.sum(axis=1)
    rest = np.where(straight[:, None], apart, whole)
    rest += np.einsum("cnm,cm->cn", np.abs(A), rates.ramped)
    push = np.where(straight, rates.push, 0.0)
    still = np.zeros_like(push)
    share = np.stack([np.stack([-push, push], -1), np.stack([still, rates.speed**2], -1)], 1)
    turned = sum((mass.centrifugal for mass in masses), none)
    bounds = _bounds(averages, allowed, course, offsets, rates, late)
    for mass in masses:
        rest = rest + _change(mass, bounds)
    leads = Leads(np.stack([along, turned], axis=1), share, rest)
    slope = np.full_like(none, np.inf)
    if np.isfinite(bounds.jerk).all():
        slope = np.abs(own) * bounds.jerk + sum(_slope(mass, bounds) for mass in masses)
    away = averages.reach + _SPLINE
    held = Held.of(elasticity, robot, course, masses, bounds)
    slack, mixture = filled(elasticity.slack, size), elasticity.mixture(robot, size)
    taken = held.taken(slack, leads.most)
    # By l slack has a slope from 0 to 1, by h from −1 to 1, as squares of 1 / cosh have.
    soft = np.where(slack > 0.0, slope + held.slope, 0.0)
    slope = _bounded(slope, np.abs(mixture)) + soft
    leads = leads.mixed(mixture)
    more = _beside(elasticity, course, bounds, taken, leads.most, slope, away)
    return Leads(leads.ways, share, leads.rest + more)


def _bounds(
    averages: Averages,
    allowed: Allowed,
    course: Course,
    offsets: Offsets,
    rates: Rates,
    late: tuple[float, float],
) -> _Bounds:
    tangent, (start, more) = np.abs(course.tangent), late
    most = allowed.greatest(allowed.accelerations, np.abs)[course.interval]
    most[~course.moves] = 0.0
    mean = more * averages.mean(most, start)
    ranges = averages.velocity_ranges(allowed)
    off = course.half + offsets.aside
    off += np.abs(offsets.axis) * np.abs(offsets.along).max(axis=1, keepdims=True)
    nearby = np.stack([near(course, a, averages.reach + start) for a in mean.T], -1)
    jerk = averages.jerks(nearby, ranges) + rates.jolted
    velocity = tangent * rates.speed[:, None] + rates.veer
    acceleration = averages.slowly(mean, ranges) + rates.ramped
    return _Bounds(off, tangent, velocity, rates.veer, acceleration, jerk, rates.speed)


def _change(mass: _Mass, bounds: _Bounds) -> FloatArray:
    """(C, N), by how much a mass's part is another than at the cells' middles."""
    lever = np.linalg.norm(mass.J, axis=1)
    D, y, A, off = map(mass.total, (bounds.tangent, bounds.veer, bounds.acceleration, bounds.off))
    v, longest = bounds.speed, lever.max(axis=1) * np.exp(off)
    bent = (v * D + y) ** 2
    apart = longest * (off * (A + bent) + (2.0 * v * D + y) * y)
    more = lever * apart[:, None] + (longest**2 * off * (A + bent))[:, None]
    return np.asarray(np.abs(mass.given) * more * mass.moving)


def _slope(mass: _Mass, bounds: _Bounds) -> FloatArray:
    """(C, N), what a mass's part changes by in a second."""
    lever = np.linalg.norm(mass.J, axis=1)
    V, A, jerk, off = map(
        mass.total, (bounds.velocity, bounds.acceleration, bounds.jerk, bounds.off)
    )
    longest = lever.max(axis=1) * np.exp(off)
    change = longest**2 * (jerk + 3.0 * V * A + V**3 + V * (A + V**2))
    return np.asarray(np.abs(mass.given) * change[:, None] * mass.moving)


@dataclass(frozen=True)
class Held:
    """What gears hold at rest, in rad of lead, (C, N) each.

    Args:
        least, most: bounds of its size at each cell.
        slope: what it changes by in a second.
    """

    least: FloatArray
    most: FloatArray
    slope: FloatArray

    @classmethod
    def of(
        cls,
        elasticity: Elasticity,
        robot: Robot,
        course: Course,
        masses: list[_Mass],
        bounds: _Bounds,
    ) -> Held:
        size = course.middle.shape[1]
        spring = np.abs(filled(elasticity.spring, size))
        weight = np.linalg.norm(robot.gravity) * np.abs(filled(elasticity.weight, size))
        change, slope = spring * bounds.off, spring * bounds.velocity
        for mass in masses:
            off = mass.total(bounds.off)
            longest = np.linalg.norm(mass.J, axis=1).max(axis=1) * np.exp(off)
            turned = longest[:, None] * np.abs(mass.given) * weight * mass.moving
            change = change + turned * off[:, None]
            slope = slope + turned * mass.total(bounds.velocity)[:, None]
        # No bound times nothing is none.
        slope = np.where(np.isnan(slope), np.inf, slope)
        middle = np.abs(elasticity.held(robot, course.middle))
        return cls(np.maximum(middle - change, 0.0), middle + change, slope)

    def taken(self, slack: FloatArray, lead: FloatArray) -> FloatArray:
        """(C, N), what slack (N,) adds to leads within ``lead`` (C, N) at most."""
        span = np.where(slack > 0.0, slack, 1.0)
        against = np.clip(0.5 * lead, self.least, self.most)
        return np.asarray(slack * (np.tanh((lead - against) / span) + np.tanh(against / span)))


def _bounded(bounds: FloatArray, factors: FloatArray) -> FloatArray:
    """(C, N), sums of bounds (C, N), none of which may be known, by factors (N, N) ≥ 0."""
    parts = np.zeros((len(bounds), *factors.shape))
    # No bound times nothing is nothing.
    np.multiply(bounds[:, None, :], factors, out=parts, where=factors > 0.0)
    return np.asarray(parts.sum(axis=2))


def _beside(
    elasticity: Elasticity,
    course: Course,
    bounds: _Bounds,
    taken: FloatArray,
    most: FloatArray,
    slope: FloatArray,
    away: float,
) -> FloatArray:
    """(C, N), what slack, lag and interpolation add to leads within ``most``.

    ``taken`` (C, N) is what slack adds. ``slope`` (C, N) bounds what both change by in a second;
    those within ``away`` s matter.
    """
    lag = np.abs(filled(elasticity.lag, most.shape[1]))
    more = taken + lag * bounds.velocity
    slope = slope + lag * bounds.acceleration
    over = np.minimum(_SPLINE_MOST * (most + more), SPLINE_BY_SLOPE * LEAD_STEP * slope)
    return more + np.stack([near(course, values, away) for values in over.T], -1)
