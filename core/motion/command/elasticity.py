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
rest is in the joints that a log starts from.

What torque bends beside the gear that it passes, bearings and links, moves other joints' axes too:
the compliance K⁻¹ is then no diagonal matrix. A joint leads by a share of what the torque on
another joint makes that one's gear give way by, l + B l with B zero on the diagonal.

The servos of a measured arm may follow, each by its own lag. What all have in
common is an offset in time; the differences bend the path by lag q̇, of the motors as of the links
that they drive.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.kinematics.chain_kernels import jacobians, motions
from ...robot.model import Robot
from ..model.elasticity import Elasticity
from ..model.point_masses import chain_to_axis, filled
from .smoothing import States

LEAD_STEP = 1e-3
"""s between the times at which leads are worked out; between them they are cubic."""


def leads(
    elasticity: Elasticity, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray
) -> FloatArray:
    """By how much motors are ahead of the smoothed motion, (T, N) in rad or m.

    What gears give way by, and the servos' lags, at configurations, velocities and
    accelerations (T, N).
    """
    out = filled(elasticity.own, q.shape[1]) * ddq
    q, dq, ddq = (np.ascontiguousarray(array) for array in (q, dq, ddq))
    for mass in elasticity.carried:
        chain = chain_to_axis(robot, mass.joint, "elasticity.carried")
        J = jacobians(chain, q)[:, :3]
        pull = motions(chain, q, dq, ddq)[1][:, :3]
        out += filled(mass.lead, q.shape[1]) * np.einsum("tij,ti->tj", J, pull)
    lead = out @ mixture(elasticity, robot, q.shape[1]).T
    slack = filled(elasticity.slack, q.shape[1])
    if slack.any():
        used, span = held_at_rest(elasticity, robot, q), np.where(slack > 0.0, slack, 1.0)
        lead += slack * (np.tanh((out + used) / span) - np.tanh(used / span))
    return np.asarray(lead + filled(elasticity.lag, q.shape[1]) * dq)


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


def held_at_rest(elasticity: Elasticity, robot: Robot, q: FloatArray) -> FloatArray:
    """What gears hold at rest (T, N), in rad (m) of lead, at configurations (T, N)."""
    out = filled(elasticity.spring, q.shape[1]) * np.sin(q)
    weight, gravity = filled(elasticity.weight, q.shape[1]), np.array(robot.gravity)
    for mass in elasticity.carried if weight.any() else ():
        J = jacobians(chain_to_axis(robot, mass.joint, "elasticity.carried"), q)[:, :3]
        out -= weight * filled(mass.lead, q.shape[1]) * np.einsum("tij,i->tj", J, gravity)
    return np.asarray(out)


def derivatives_of(
    t: FloatArray, values: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values (T, N) and two derivatives, at rest outside, of the cubic spline through samples."""
    # Imported here: it takes longer than all else that a start of the command line needs.
    from scipy.interpolate import CubicSpline

    if len(t) < 2:
        zero = np.zeros((len(at), values.shape[1]))
        return zero, zero, zero
    spline = CubicSpline(t, values, bc_type="clamped")
    inside = np.clip(at, t[0], t[-1])
    return np.asarray(spline(inside)), np.asarray(spline(inside, 1)), np.asarray(spline(inside, 2))
