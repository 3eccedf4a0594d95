"""Reverse of `timing`: instants and rests, carried back to the stamp and its samples."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import FloatArray
from ..geometry import quintic
from ..path.tcp_samples import States
from ..timing.timing import Timing


@dataclass
class Seeds:
    """Gradient of a number with respect to a timing.

    Args:
        states: the samples along ℓ.
        x, t: (K + 1,), the stamp, without rests.
        spacing: (K,), ℓ of the intervals.
        rests: (S,), the rests at stops on the way.
    """

    states: States
    x: FloatArray
    t: FloatArray
    spacing: FloatArray = field(repr=False)
    rests: FloatArray = field(repr=False)

    @classmethod
    def zeros(cls, timing: Timing) -> Seeds:
        """A gradient to add to."""
        samples, size = timing.along.states.q.shape
        knots = len(timing.stamp.x)
        return cls(
            States.zeros(samples, size),
            np.zeros(knots),
            np.zeros(knots),
            np.zeros(knots - 1),
            np.zeros(len(timing.rests.knot)),
        )


def seed_configuration(timing: Timing, t: float, weights: FloatArray, out: Seeds) -> None:
    """Add the gradient of weights · q at time t (s), waits included; see `Timing.states_at`."""
    k = max(int(np.searchsorted(timing.begin, t, side="right")) - 1, 0)
    whole = float(timing.end[k] - timing.begin[k])
    tau = float(np.clip(t - timing.begin[k], 0.0, whole))
    z = _share(timing, k, tau)
    z_bar = _pull_quintic(timing, k, z, weights, out)
    if 0.0 < tau < whole:
        begin_bar = -_pull_share(timing, k, tau, z, z_bar, out)
        out.t[k] += begin_bar
        out.rests[timing.rests.knot <= k] += begin_bar


def pull_rests(timing: Timing, out: Seeds) -> None:
    """Carry the gradient of the rests back to the stamp and its samples.

    A rest that is counted from when an axis j comes into the window, |q_j − q_j(stop)| = window,
    has the derivative dt_in − dt_stop, with dt_in = −d(q_j − q_j(stop)) / q̇_j at t_in.
    """
    rests, stamp = timing.rests, timing.stamp
    entries = rests.entries
    if entries is None:
        return
    ends = timing.path.pieces.interval_ends
    for i in np.flatnonzero(rests.counted & (out.rests != 0.0)):
        bar, stop = float(out.rests[i]), rests.knot[i]
        out.t[stop] -= bar
        k = int(entries.interval[i])
        if k < 0:
            out.t[entries.begin[i]] += bar
            continue
        z, tau = float(entries.share[i]), float(entries.t[i] - stamp.t[k])
        axis = np.eye(out.states.q.shape[1])[entries.axis[i]]
        weights = -bar / _velocity(timing, k, z, axis) * axis
        z_bar = _pull_quintic(timing, k, z, weights, out)
        out.t[k] -= _pull_share(timing, k, tau, z, z_bar, out)
        out.states.q[ends[stop - 1, 1]] -= weights


def _share(timing: Timing, k: int, tau: float) -> float:
    """z of interval k, tau s after it was entered."""
    x0, length = timing.stamp.x[k], timing.along.spacing[k]
    return float(tau * (np.sqrt(x0) + 0.5 * timing.stamp.u[k] * tau) / length)


def _pull_share(timing: Timing, k: int, tau: float, z: float, z_bar: float, out: Seeds) -> float:
    """Reverse of `_share`: adds to the gradient of x and of spacing, returns that of tau."""
    x0, x1 = timing.stamp.x[k], timing.stamp.x[k + 1]
    length = float(timing.along.spacing[k])
    u, rate = (x1 - x0) / (2 * length), np.sqrt(x0)
    step_bar = z_bar / length
    out.spacing[k] -= z_bar * z / length + step_bar * 0.5 * tau**2 * u / length
    if rate > 0:
        out.x[k] += step_bar * tau * 0.5 / rate
    out.x[k] -= step_bar * tau**2 / (4 * length)
    out.x[k + 1] += step_bar * tau**2 / (4 * length)
    return float(step_bar * (rate + u * tau))


def _pull_quintic(timing: Timing, k: int, z: float, w: FloatArray, out: Seeds) -> float:
    """Reverse of w · q at share z of interval k: adds to the gradient of samples and spacing,
    returns that of z."""
    data, factors, powers = _data(timing, k)
    ends = timing.path.pieces.interval_ends[k]
    values, length = quintic.basis(z), float(timing.along.spacing[k])
    for i, bar in enumerate((out.states.q, out.states.dq, out.states.ddq)):
        bar[ends] += np.outer((values * factors)[[i, 3 + i]], w)
    along = factors * (data @ w)
    out.spacing[k] += float(np.sum(values * powers * along)) / length
    return float(np.sum(quintic.slopes(z) * along))


def _velocity(timing: Timing, k: int, z: float, w: FloatArray) -> float:
    """w · q̇ at share z of interval k."""
    data, factors, _ = _data(timing, k)
    x0, x1 = timing.stamp.x[k], timing.stamp.x[k + 1]
    slope = float(np.sum(quintic.slopes(z) * factors * (data @ w)))
    return slope / float(timing.along.spacing[k]) * float(np.sqrt(x0 + z * (x1 - x0)))


def _data(timing: Timing, k: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """q, q', q'' at both samples of interval k (6, N), what the quintic multiplies each with (6,),
    and the power of the interval's length in that (6,)."""
    ends, states = timing.path.pieces.interval_ends[k], timing.along.states
    data = np.concatenate([part[[end]] for end in ends for part in states[:3]])
    powers = np.array([0, 1, 2, 0, 1, 2])
    return data, float(timing.along.spacing[k]) ** powers, powers
