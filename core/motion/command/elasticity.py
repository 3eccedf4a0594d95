"""How far commanded joints lead the links that they drive through elastic gears.

A controller that wants its links on the path commands the motors ahead of them by what the gears
give way under the inertial torque τ: q_motor = q + K⁻¹ τ(q, q̇, q̈) (Spong, "Modeling and control
of elastic joint robots", J. Dyn. Sys., Meas., Control 109, 1987; De Luca, "Feedforward/feedback
laws for the control of flexible robots", ICRA 2000). Logs show the motors. K⁻¹ τ is taken as

    diag(own) q̈ + Σ_b diag(carried_b) J_bᵀ p̈_b,

each b a point mass on the axis of one of the arm's joints, at p_b with Jacobian J_b; p̈_b contains
the centrifugal and Coriolis terms. Gravity is left out: logs meet their targets at rest.

Gears are softer where little torque passes them (lost motion, as in gear makers' hysteresis
curves). A joint with slack s leads by l + s tanh(l / s), l being what its stiffness alone gives. A
gear that holds a weight, or part of it where a spring balances the arm, has used up some of its
slack at rest, at h: it leads by l + s (tanh((l + h) / s) − tanh(h / s)), as what it gives way by at
rest is in the joints that a log starts from. A controller may work that out before the last of its
averages over time (`slack_averaged`).

What torque bends beside the gear that it passes, bearings and links, moves other joints' axes too:
the compliance K⁻¹ is then no diagonal matrix. A joint leads by a share of what the torque on
another joint makes that one's gear give way by, l + B l with B zero on the diagonal.

The servos of a measured arm may follow, each by its own lag. What all have in
common is an offset in time; the differences bend the path by lag q̇, of the motors as of the links
that they drive.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...errors import InputError
from ...robot.kinematics.lean import inner, lean
from ...robot.model import Robot
from ..model.elasticity import Elasticity
from ..model.point_masses import filled, mass_loads
from .smoothing import JointMotion, Smoothing, States, even_times, interpolate_at

_FINEST, _COARSEST = 1e-3, 4e-3
"""s between the times at which leads are worked out, between which they are cubic: a 16th of what
a command is averaged over, within these."""


def lead_step(window: float) -> float:
    """s between the times at which leads are worked out where commands are averaged over a time."""
    return float(np.clip(window / 16, _FINEST, _COARSEST))


def leads(
    elasticity: Elasticity, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> FloatArray:
    """By how much motors are ahead of the smoothed motion, (T, N) in rad or m.

    What gears give way by, and the servos' lags, at configurations, velocities and
    accelerations (T, N).
    """
    size = q.shape[1]
    given, used = _gears(elasticity, robot, q, dq, ddq)
    lead = given @ mixture(elasticity, robot, size).T
    loose, slack = _slack(elasticity, size)
    used, taken = used[:, loose] / slack, given[:, loose] / slack
    lead[:, loose] += slack * (np.tanh(taken + used) - np.tanh(used))
    return np.asarray(lead + filled(elasticity.lag, size) * dq)


def leads_at(
    elasticity: Elasticity,
    robot: Robot,
    smoothing: Smoothing,
    stamped: JointMotion,
    t: FloatArray,
    states: States,
) -> FloatArray:
    """`leads` of a stamped motion at times t (T,) that do not decrease, smoothed to states (T, N)
    there."""
    if not _averages_slack(elasticity, smoothing):
        return leads(elasticity, robot, *states)
    step = lead_step(smoothing.window)
    end = min(t[-1], stamped.t[-1] + smoothing.window)
    even = even_times(max(t[0], stamped.t[0]) - step, end + step, step)
    found = averaged_slack(elasticity, robot, smoothing, stamped, even, t)
    return leads(replace(elasticity, slack=()), robot, *states) + found[0]


def averaged_slack(
    elasticity: Elasticity,
    robot: Robot,
    smoothing: Smoothing,
    stamped: JointMotion,
    even: FloatArray,
    at: FloatArray,
) -> States:
    """What slack adds, (T, N), with two derivatives, where the longest average comes behind it.

    Args:
        elasticity: of the gears.
        robot: the robot.
        smoothing: of the joints.
        stamped: the stamped motion; it may begin the whole window before ``at`` does.
        even: (S,) s, even, about ``at``.
        at: (T,) s, not decreasing.
    """
    before, longest = smoothing.but_the_longest, max(smoothing.widths)
    step = float(even[1] - even[0])
    t = even_times(even[0] - longest, even[-1], step)
    states = before.command(stamped, t)
    added = leads(elasticity, robot, *states)
    added -= leads(replace(elasticity, slack=()), robot, *states)
    return JointMotion.through(t, added).averaged(longest, at)


def _averages_slack(elasticity: Elasticity, smoothing: Smoothing) -> bool:
    return elasticity.slack_averaged and any(elasticity.slack) and bool(smoothing.widths)


def lead_states_at(
    elasticity: Elasticity,
    robot: Robot,
    smoothing: Smoothing,
    stamped: JointMotion,
    t: FloatArray,
    states: States,
    at: FloatArray,
) -> States:
    """`lead_states` of a stamped motion.

    Args:
        elasticity, robot, t, states, at: see there.
        smoothing: of the joints.
        stamped: the stamped motion, from the whole window before t on.
    """
    if not _averages_slack(elasticity, smoothing):
        return lead_states(elasticity, robot, t, states, at)
    stiff = lead_states(replace(elasticity, slack=()), robot, t, states, at)
    added = averaged_slack(elasticity, robot, smoothing, stamped, t, at)
    lead, change, bend = (one + more for one, more in zip(stiff, added, strict=True))
    return lead, change, bend


def lead_states(
    elasticity: Elasticity, robot: Robot, t: FloatArray, states: States, at: FloatArray
) -> States:
    """What gears give way by, (T, N), with two derivatives in time; without the servos' lags.

    What stiffness alone gives changes with the motion's accelerations, and is cubic between even
    times. What slack adds may change much faster, and follows from that.

    Args:
        elasticity: of the gears.
        robot: the robot.
        t: (S,) s, even.
        states: (S, N) each, of the smoothed motion then.
        at: (T,) s, not decreasing.
    """
    given, used = _gears(elasticity, robot, *states)
    size = given.shape[1]
    stiff, slack = JointMotion.through(t, given), filled(elasticity.slack, size)
    held = JointMotion.through(t, used) if slack.any() else stiff
    shape = len(at), size
    lead, change, bend = np.empty(shape), np.empty(shape), np.empty(shape)
    mixed = mixture(elasticity, robot, size)
    own, rest = (stiff.q, stiff.dq), (held.q, held.dq)
    _fill_leads(t, *own, *rest, at, mixed, slack, np.empty((2, 3, size)), lead, change, bend)
    return lead, change, bend


def _slack(elasticity: Elasticity, size: int) -> tuple[BoolArray, FloatArray]:
    """(N,), which joints have slack, and that of those."""
    slack = filled(elasticity.slack, size)
    return slack > 0.0, slack[slack > 0.0]


def _gears(
    elasticity: Elasticity, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """(T, N) rad or m, what stiffness alone gives way by, and at rest."""
    masses = [(mass.joint, mass.lead) for mass in elasticity.carried]
    loads = mass_loads(robot, masses, "elasticity.carried", q, dq, ddq)
    size = q.shape[1]
    given = filled(elasticity.own, size) * ddq
    given += loads.across
    used = -filled(elasticity.weight, size) * loads.held
    for joint in np.flatnonzero(elasticity.spring[:size]):
        used[:, joint] += elasticity.spring[joint] * np.sin(q[:, joint])
    return given, used


def held_at_rest(elasticity: Elasticity, robot: Robot, q: FloatArray) -> FloatArray:
    """What gears hold at rest in configurations (T, N), and give way by where they have slack: (T,
    N) in rad or m."""
    still = np.zeros_like(q)
    return _gears(elasticity, robot, q, still, still)[1]


def links_of(elasticity: Elasticity, states: States, jerk: FloatArray) -> States:
    """What links do where the smoothed motion has states and a third derivative (T, N)."""
    q, dq, ddq = states
    lag = filled(elasticity.lag, q.shape[1])
    return q + lag * dq, dq + lag * ddq, ddq + lag * jerk


def mixture(elasticity: Elasticity, robot: Robot, size: int) -> FloatArray:
    """(size, size), I + B: leads by what the stiffness of each joint alone asks for.

    Raises:
        InputError: the arm does not have a joint that is named.
    """
    out = np.eye(size)
    for pair in elasticity.coupled:
        last = max(pair.joint, pair.by)
        if last > robot.arm_size:
            raise InputError(
                f"elasticity.coupled: {robot.name} has {robot.arm_size} joints, no joint {last}"
            )
        out[pair.joint - 1, pair.by - 1] += pair.share
    return out


@lean
def _fill_leads(
    t: FloatArray,
    given: FloatArray,
    given_slopes: FloatArray,
    used: FloatArray,
    used_slopes: FloatArray,
    at: FloatArray,
    mixed: FloatArray,
    slack: FloatArray,
    work: FloatArray,
    lead: FloatArray,
    change: FloatArray,
    bend: FloatArray,
) -> None:
    """`lead_states` of what stiffness alone gives and what is used at rest, (S, N) at times t."""
    size, k = slack.size, -1
    own, held = work[0], work[1]
    for i in range(at.size):
        k = interpolate_at(t, given, given_slopes, at[i], k, own)
        for j in range(size):
            for n in range(3):
                held[n, j] = 0.0
            for b in range(size):
                share = mixed[j, b]
                if share != 0.0:
                    for n in range(3):
                        held[n, j] += share * own[n, b]
            lead[i, j], change[i, j], bend[i, j] = held[0, j], held[1, j], held[2, j]
        interpolate_at(t, used, used_slopes, at[i], k, held)
        for j in range(size):
            if slack[j] > 0.0:
                before = _loose(slack[j], held[0, j], held[1, j], held[2, j])
                after = _loose(
                    slack[j], held[0, j] + own[0, j], held[1, j] + own[1, j], held[2, j] + own[2, j]
                )
                lead[i, j] += after[0] - before[0]
                change[i, j] += after[1] - before[1]
                bend[i, j] += after[2] - before[2]


@inner
def _loose(slack: float, lead: float, change: float, bend: float) -> tuple[float, float, float]:
    """s tanh(l / s) and two derivatives in time, of l with two derivatives."""
    bent = math.tanh(lead / slack)
    slope = 1.0 - bent * bent
    return (
        slack * bent,
        slope * change,
        slope * bend - 2.0 * bent * slope / slack * change * change,
    )
