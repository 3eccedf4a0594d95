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

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.chain_kernels import jacobians, motions
from ...robot.model import Robot
from ..model.point_masses import chain_to_axis, filled, row_of
from .smoothing import States

LEAD_STEP = 1e-3
"""s between the times at which leads are worked out; between them they are cubic."""


@dataclass(frozen=True)
class Carried:
    """A mass on the axis of a joint, as the gears before it feel it.

    Args:
        joint: of the arm, counted from one.
        lead: s²/m² (rad of lead per N m, times kg) of each joint before it, first to last. A rigid
            mass has none below zero; what is fitted may, as joints also bend each other.
    """

    joint: int
    lead: tuple[float, ...]

    @property
    def entry(self) -> dict[str, Any]:
        """As the file has it."""
        return {"joint": self.joint, "lead_s2_per_m2": self.lead}


@dataclass(frozen=True)
class Coupled:
    """A joint that the torque on another one bends as well.

    Args:
        joint: that leads, counted from one.
        by: the joint whose torque does it, counted from one.
        share: of what the stiffness of that one alone lets it give way by.
    """

    joint: int
    by: int
    share: float

    @property
    def entry(self) -> dict[str, Any]:
        """As the file has it."""
        return {"joint": self.joint, "by": self.by, "share": self.share}


@dataclass(frozen=True)
class Elasticity:
    """What commanded joints lead their links by.

    Args:
        own: s², lead per acceleration of the joint itself that does not depend on the posture;
            joints beyond the last have none.
        carried: masses on the arm.
        slack: rad, how much farther a joint gives way at most before its gear is stiff; joints
            beyond the last have none.
        weight: how many times the masses' weight the gear of a joint holds, which uses up slack;
            joints beyond the last hold none.
        spring: rad of lead; a spring that balances the arm adds it to what the gear holds, times
            the sine of the joint. Joints beyond the last have none.
        lag: s that a joint is ahead of the others where it moves (below zero: behind), as the
            servos of a measured arm follow at different distances; joints beyond the last have
            none.
        coupled: joints that the torque on others bends as well.
    """

    own: tuple[float, ...] = ()
    carried: tuple[Carried, ...] = ()
    slack: tuple[float, ...] = ()
    lag: tuple[float, ...] = ()
    weight: tuple[float, ...] = ()
    spring: tuple[float, ...] = ()
    coupled: tuple[Coupled, ...] = ()

    def __post_init__(self) -> None:
        for key, values in (
            ("own_s2", self.own),
            ("lag_s", self.lag),
            ("weight", self.weight),
            ("spring_rad", self.spring),
            ("coupled.share", tuple(pair.share for pair in self.coupled)),
            *(("carried.lead_s2_per_m2", mass.lead) for mass in self.carried),
        ):
            for value in values:
                if not math.isfinite(value):
                    raise InputError(f"elasticity.{key} must be finite, not {value}")
        for value in self.slack:
            if not 0 <= value < math.inf:
                raise InputError(
                    f"elasticity.slack_rad must be finite and zero or more, not {value}"
                )
        for mass in self.carried:
            if mass.joint < 1 or len(mass.lead) >= mass.joint:
                raise InputError(
                    "elasticity.carried: a mass on the axis of joint b (counted from one) is "
                    f"carried by the joints before it; joint {mass.joint} has {mass.joint - 1}, "
                    f"lead_s2_per_m2 has {len(mass.lead)}"
                )
        for pair in self.coupled:
            if min(pair.joint, pair.by) < 1 or pair.joint == pair.by:
                raise InputError(
                    "elasticity.coupled: joint and by are two joints, counted from one, not "
                    f"{pair.joint} and {pair.by}"
                )

    @property
    def figures(self) -> tuple[str, ...]:
        """The dotted keys of what is stated."""
        stated = (
            ("own_s2", self.own),
            ("carried", self.carried),
            ("coupled", self.coupled),
            ("slack_rad", self.slack),
            ("lag_s", self.lag),
            ("weight", self.weight),
            ("spring_rad", self.spring),
        )
        return tuple(f"elasticity.{name}" for name, value in stated if value)

    def leads(self, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray) -> FloatArray:
        """By how much motors are ahead of the smoothed motion, (T, N) in rad or m.

        What gears give way by, and the servos' lags, at configurations, velocities and
        accelerations (T, N).
        """
        out = filled(self.own, q.shape[1]) * ddq
        q, dq, ddq = (np.ascontiguousarray(array) for array in (q, dq, ddq))
        for mass in self.carried:
            chain = chain_to_axis(robot, mass.joint, "elasticity.carried")
            J = jacobians(chain, q)[:, :3]
            pull = motions(chain, q, dq, ddq)[1][:, :3]
            out += filled(mass.lead, q.shape[1]) * np.einsum("tij,ti->tj", J, pull)
        lead = out @ self.mixture(robot, q.shape[1]).T
        slack = filled(self.slack, q.shape[1])
        if slack.any():
            held, span = self.held(robot, q), np.where(slack > 0.0, slack, 1.0)
            lead += slack * (np.tanh((out + held) / span) - np.tanh(held / span))
        return np.asarray(lead + filled(self.lag, q.shape[1]) * dq)

    def links(self, states: States, jerk: FloatArray) -> States:
        """What links do where the smoothed motion has states and a third derivative (T, N)."""
        q, dq, ddq = states
        lag = filled(self.lag, q.shape[1])
        return q + lag * dq, dq + lag * ddq, ddq + lag * jerk

    def mixture(self, robot: Robot, size: int) -> FloatArray:
        """(size, size), I + B: leads by what the stiffness of each joint alone asks for.

        Raises:
            InputError: the arm does not have a joint that is named.
        """
        out = np.eye(size)
        for pair in self.coupled:
            last = max(pair.joint, pair.by)
            if last > robot.arm_size:
                raise InputError(
                    f"elasticity.coupled: {robot.name} has {robot.arm_size} joints, no joint {last}"
                )
            out[pair.joint - 1, pair.by - 1] += pair.share
        return out

    def held(self, robot: Robot, q: FloatArray) -> FloatArray:
        """What gears hold at rest (T, N), in rad (m) of lead, at configurations (T, N)."""
        out = filled(self.spring, q.shape[1]) * np.sin(q)
        weight, gravity = filled(self.weight, q.shape[1]), np.array(robot.gravity)
        for mass in self.carried if weight.any() else ():
            J = jacobians(chain_to_axis(robot, mass.joint, "elasticity.carried"), q)[:, :3]
            out -= weight * filled(mass.lead, q.shape[1]) * np.einsum("tij,i->tj", J, gravity)
        return np.asarray(out)


RIGID = Elasticity()


def elasticity(table: dict[str, Any], base: Elasticity = RIGID) -> Elasticity:
    """Elasticity from the table of a motion model's file; ``base`` where it states nothing.

    Raises:
        InputError: a key is unknown or a value has the wrong type or range.
    """
    rows = {
        "own_s2": "own",
        "slack_rad": "slack",
        "weight": "weight",
        "spring_rad": "spring",
        "lag_s": "lag",
    }
    unknown = set(table) - {*rows, "carried", "coupled"}
    if unknown:
        raise InputError(
            f"elasticity.{min(unknown)}: no such key; there are own_s2, carried, coupled, "
            "slack_rad, weight, spring_rad and lag_s"
        )
    values: dict[str, Any] = {
        name: row_of(f"elasticity.{key}", table[key]) for key, name in rows.items() if key in table
    }
    if "carried" in table:
        entries = table["carried"]
        if not isinstance(entries, list):
            raise InputError(f"elasticity.carried: a list of tables is expected, not {entries!r}")
        values["carried"] = tuple(_carried(entry) for entry in entries)
    if "coupled" in table:
        entries = table["coupled"]
        if not isinstance(entries, list):
            raise InputError(f"elasticity.coupled: a list of tables is expected, not {entries!r}")
        values["coupled"] = tuple(_coupled(entry) for entry in entries)
    return replace(base, **values)


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


def _carried(entry: Any) -> Carried:
    if not isinstance(entry, Mapping) or set(entry) != {"joint", "lead_s2_per_m2"}:
        raise InputError(
            f"elasticity.carried: tables of joint and lead_s2_per_m2 are expected, not {entry!r}"
        )
    joint = _joint("elasticity.carried.joint", entry["joint"])
    return Carried(joint, row_of("elasticity.carried.lead_s2_per_m2", entry["lead_s2_per_m2"]))


def _coupled(entry: Any) -> Coupled:
    if not isinstance(entry, Mapping) or set(entry) != {"joint", "by", "share"}:
        raise InputError(
            f"elasticity.coupled: tables of joint, by and share are expected, not {entry!r}"
        )
    return Coupled(
        _joint("elasticity.coupled.joint", entry["joint"]),
        _joint("elasticity.coupled.by", entry["by"]),
        row_of("elasticity.coupled.share", [entry["share"]])[0],
    )


def _joint(key: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError(f"{key}: a whole number is expected, not {value!r}")
    return value
