"""What the lead of elastic joints does not exceed on a path, at any speed.

All joints move along one path, so what they ask of each other is bounded at once, interval by
interval (`allowed`), and not as if each were at its own limit. With J the Jacobian of a mass, J_j
its column of joint j and |·| of joints their sum (‖q̇‖₁ ≤ V, ‖q̈‖₁ ≤ A), two facts do the rest:

- derivatives of a column, and of p in general, are at most as long as the longest column λ,
  |∂J_j/∂q_i| = |a_min(i,j) × J_max(i,j)| ≤ λ, and so λ grows by at most exp ‖δq‖₁ over a change δq;
- a symmetric kernel of variance s² keeps a function with slope V within V s of its mean, on
  average.

**Between samples** the lead is that of the middle's Jacobian and q' with the interval's own
accelerations, plus what either changes by.

**Smoothing in time** makes q̈ and q̇ their means, where the lead is not linear. With q̈ₛ the mean and
p̈ₛ what the mass does on the smoothed motion, p̈ₛ differs from the mean of p̈ by at most

    λ (D A + 2 s² A² + D V²),    D = V s + A s²/2:

the change of J under q̈, of q̇ about its mean under the centrifugal terms, and of these with q. The
lead J_jᵀ p̈ differs by that times the lever, and by λ D times the greatest |p̈|.

**Leads are worked out every** `LEAD_STEP`; a cubic spline through values within ±F stays within
0.549 F more (its Lebesgue constant is (1 + 3 √3)/4), or, with slopes M, within 0.275 M `LEAD_STEP`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..robot.chain_kernels import jacobians, motions
from ..robot.model import Robot
from .allowed import Allowed, Linear
from .elasticity import LEAD_STEP, Carried, Elasticity
from .point_masses import chain_to_axis, filled
from .smoothing import Smoothing
from .start_ramp import StartRamp

FloatArray = NDArray[np.float64]

Near = Callable[[FloatArray], FloatArray]

_OVER, _OVER_BY_SLOPE = 0.55, 0.275


@dataclass(frozen=True)
class _Mass:
    """A mass on a path: its share of the leads, and bounds for what smoothing makes of them.

    Args:
        lead: (5, K, N) of either corner, of what leads the middle's Jacobian makes.
        error: (K, N), how far leads in the interval may be from that.
        factor: (N,), |lead| per J_jᵀ p̈.
        lever: (K, N), greatest |J_j| in each interval.
        longest: (K,), λ.
        speed, acceleration: (K,), V and A nearby, of the joints that move it.
        pull: (K,), greatest |p̈| nearby.
    """

    lead: Linear
    error: FloatArray
    factor: FloatArray
    lever: FloatArray
    longest: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    pull: FloatArray

    def started(self, start: StartRamp) -> _Mass:
        """The same where time comes up to speed: q̈ and p̈ by at most as much as accelerations."""
        more = start.most_acceleration
        return replace(self, acceleration=more * self.acceleration, pull=more * self.pull)

    def turned(self, start: StartRamp) -> FloatArray:
        """(N,) by which leads exceed the same share where time comes up to speed.

        There q̈ = ṡ² q̈(s) + q̇(s) / T, and J_jᵀ ṗ(s) is the sum of J_jᵀ p̈ up to then but for how
        J_j changes since.
        """
        since = 0.5 * start.length
        V, A = self.speed.max(), self.acceleration.max()
        moved = min(V * since, 0.5 * A * since**2)
        return np.asarray(0.5 * self.factor * self.longest.max() * moved * self.pull.max())

    def smoothed(self, smoothing: Smoothing) -> tuple[FloatArray, FloatArray]:
        """(K, N) by which leads may be beyond those unsmoothed, and (K, N) how fast they change."""
        variance, A, V = 2.0 * smoothing.stray, self.acceleration, self.speed
        off = 0.5 * variance * A
        apart = V * np.sqrt(variance) + off
        longest = self.longest * np.exp(0.5 * V * smoothing.window + off)
        lever = self.lever + (longest * off)[:, None]
        pull = longest * (apart * A + 2.0 * variance * A**2 + apart * V**2)
        more = self.factor * (lever * pull[:, None] + (longest * apart * self.pull)[:, None])
        if not smoothing.widths:
            return more, np.full_like(more, np.inf)
        jerk = 2.0 * A / max(smoothing.widths)
        change = longest * (jerk + 3.0 * V * A + V**3)
        slope = lever * change[:, None] + (longest * V * (self.pull + pull))[:, None]
        return more, self.factor * slope


def most_lead(
    elasticity: Elasticity,
    robot: Robot,
    allowed: Allowed,
    smoothing: Smoothing,
    start: StartRamp,
) -> FloatArray:
    """(N,) rad or m, what no commanded joint leads its link by.

    Args:
        elasticity: of the joints.
        robot: that drives the path.
        allowed: what its limits allow.
        smoothing: in time, of the commanded motion.
        start: how time comes up to speed.
    """
    ddq = allowed.accelerations
    size = ddq.left.shape[2]
    near = _near(allowed, 0.5 * smoothing.window + start.length)
    own = filled(elasticity.own, size)
    masses = [_mass(mass, robot, allowed, ddq, near) for mass in elasticity.carried]
    lead = Linear(
        *(
            own * part + sum(more)
            for part, *more in zip(ddq, *(m.lead for m in masses), strict=True)
        )
    )
    error = sum((mass.error for mass in masses), np.zeros(lead.left.shape[1:]))
    most = start.most_acceleration * near(allowed.greatest(lead, np.abs) + error)
    a = start.most_acceleration * allowed.greatest(ddq, np.abs).max(axis=0)
    lag = np.abs(filled(elasticity.lag, size))
    slope = np.abs(own) * 2.0 * a / max(smoothing.widths, default=np.inf)
    for mass in masses:
        most += mass.turned(start)
        more, change = mass.started(start).smoothed(smoothing)
        most, slope = most + more, slope + change.max(axis=0)
    most = most.max(axis=0)
    slack = filled(elasticity.slack, size)
    slope = np.where(slack > 0.0, 2.0, 1.0) * slope + lag * a
    most = most + np.minimum(slack, most) + lag * allowed.velocities.max(axis=0)
    if not smoothing.widths:
        return np.asarray((1.0 + _OVER) * most)
    return np.asarray(most + np.minimum(_OVER * most, _OVER_BY_SLOPE * LEAD_STEP * slope))


def _near(allowed: Allowed, away: float) -> Near:
    """What finds the greatest of values (K, …) on intervals that s are enough to come from."""
    edge = np.concatenate(
        [[0.0], np.cumsum(allowed.spacing / np.sqrt(np.maximum(allowed.fastest, 1e-12)))]
    )
    first = np.searchsorted(edge[1:], edge[:-1] - away)
    last = np.searchsorted(edge[:-1], edge[1:] + away, "right")

    def near(values: FloatArray) -> FloatArray:
        return np.stack([values[i:j].max(axis=0) for i, j in zip(first, last, strict=True)])

    return near


def _mass(mass: Carried, robot: Robot, allowed: Allowed, ddq: Linear, near: Near) -> _Mass:
    chain = chain_to_axis(robot, mass.joint, "elasticity.carried")
    size = allowed.slope.shape[2]
    moving = np.isin(np.arange(size), chain.joint)
    middle = np.tensordot(np.array([1, 5, 10, 10, 5, 1]) / 32.0, allowed.points, 1)
    rate = np.tensordot(np.array([1, 4, 6, 4, 1]) / 16.0, allowed.slope, 1)
    J = jacobians(chain, middle)[:, :3]
    turn = motions(chain, middle, rate, np.zeros_like(rate))[1][:, :3]
    share = np.arange(5)[:, None, None] / 4.0
    pull = Linear(
        np.einsum("kin,ckn->cki", J, ddq.push),
        np.einsum("kin,ckn->cki", J, ddq.left) + (1.0 - share) * turn,
        np.einsum("kin,ckn->cki", J, ddq.right) + share * turn,
    )

    def joints(values: FloatArray) -> FloatArray:
        return np.asarray(np.abs(values[..., moving]).sum(axis=-1))

    def length(values: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(values, axis=-1))

    steepest, x = joints(allowed.slope).max(axis=0), allowed.fastest
    reach = 0.5 * allowed.spacing * steepest
    lever = np.linalg.norm(J, axis=1)
    longest = lever.max(axis=1) * np.exp(reach)
    bent = joints(allowed.slope - rate).max(axis=0)
    acceleration = allowed.greatest(ddq, joints)
    off = reach * (acceleration + steepest**2 * x) + (2.0 * joints(rate) + bent) * bent * x
    off *= longest
    most = allowed.greatest(pull, length) + off
    given = filled(mass.lead, size)
    error = np.abs(given) * ((longest * reach * most)[:, None] + lever * off[:, None])
    return _Mass(
        Linear(*(given * np.einsum("kin,cki->ckn", J, part) for part in pull)),
        error,
        np.abs(given),
        lever + (longest * reach)[:, None],
        longest,
        near(steepest * np.sqrt(x)),
        near(acceleration),
        near(most),
    )
