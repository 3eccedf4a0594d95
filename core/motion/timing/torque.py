"""Limits of torque: what joints can accelerate by depends on posture, speed and each other.

A controller that knows its arm's dynamics accelerates as its motors allow. The share of its limit
that a joint takes is

    T = diag(own) q̈ + Σ_b diag(carried_b) J_bᵀ (p̈_b - diag(weight) g),    |T| ≤ 1 - diag(fade) q̇²,

each b a point mass on the axis of one of the arm's joints, at p_b with Jacobian J_b; p̈_b contains
the centrifugal and Coriolis terms, g is gravity. ``own`` is what does not depend on the posture:
the motor's own inertia behind its gear. A joint whose weight is balanced by a spring has no
``weight``; motors have the less torque the faster they run. Along a path q(ℓ), with u = ℓ̈ and
x = ℓ̇², T = a u + b x + h and q̇² = q'² x, so that all of it is linear in u and x (Bobrow, Dubowsky
and Gibson, "Time-optimal control of robotic manipulators along specified paths", Int. J. Robotics
Research 4(3), 1985).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numba import njit

from ...arrays import FloatArray
from ...errors import InputError
from ...robot.chain import Chain
from ...robot.chain_kernels import acceleration_gradient, jacobians, motions, velocity_gradient
from ...robot.model import Robot
from ..model.point_masses import chain_to_axis, filled, row_of
from .torque_rows import Shares

_TOGETHER = 20_000
"""Samples whose Jacobians are made in one go."""


@dataclass(frozen=True)
class Borne:
    """A mass on the axis of a joint, as the motors before it feel it.

    Args:
        joint: of the arm, counted from one.
        share: s²/m² (share of the limit per N m, times kg) of each joint before it, first to last.
    """

    joint: int
    share: tuple[float, ...]

    @property
    def entry(self) -> dict[str, Any]:
        """As the file has it."""
        return {"joint": self.joint, "share_s2_per_m2": self.share}


@dataclass(frozen=True)
class Torque:
    """What share of its torque's limit a motion takes of each joint.

    Args:
        own: s²/rad, share per acceleration of the joint itself that does not depend on the posture;
            the L joints that have one are limited by torque, those beyond by their acceleration.
        carried: masses on the arm.
        weight: share of the masses' weight that the joint's motor holds; joints beyond hold none.
        fade: s²/rad², share of the limit that is lost per square of the joint's speed.
    """

    own: tuple[float, ...] = ()
    carried: tuple[Borne, ...] = ()
    weight: tuple[float, ...] = ()
    fade: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        for key, values in (
            ("own_s2", self.own),
            ("weight", self.weight),
            ("fade_s2", self.fade),
            *(("carried.share_s2_per_m2", mass.share) for mass in self.carried),
        ):
            for value in values:
                if not 0 <= value < math.inf:
                    raise InputError(f"torque.{key} must be finite and zero or more, not {value}")
        for mass in self.carried:
            if mass.joint < 1 or len(mass.share) >= mass.joint:
                raise InputError(
                    "torque.carried: a mass on the axis of joint b (counted from one) is carried "
                    f"by the joints before it; joint {mass.joint} has {mass.joint - 1}, "
                    f"share_s2_per_m2 has {len(mass.share)}"
                )
        most = max(map(len, (self.weight, self.fade, *(mass.share for mass in self.carried))))
        if most > len(self.own):
            raise InputError(
                f"torque.own_s2 has {len(self.own)} entries, one for each joint that torque "
                f"limits; weight, fade_s2 or carried go on to joint {most}"
            )
        if not all(value > 0 for value in self.own):
            raise InputError(f"torque.own_s2 must be above zero, not {list(self.own)}")

    @property
    def figures(self) -> tuple[str, ...]:
        """The dotted keys of what is stated."""
        stated = (
            ("own_s2", self.own),
            ("carried", self.carried),
            ("weight", self.weight),
            ("fade_s2", self.fade),
        )
        return tuple(f"torque.{name}" for name, value in stated if value)

    def along(self, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray) -> Shares:
        """Shares on a path at configurations (S, N) with derivatives with respect to ℓ.

        Raises:
            InputError: the arm has fewer joints.
        """
        q, dq, ddq = (np.ascontiguousarray(array) for array in (q, dq, ddq))
        count = len(self.own)
        if count > robot.arm_size:
            raise InputError(
                f"torque.own_s2: {robot.name} has {robot.arm_size} joints, not {count}"
            )
        own, weight = np.array(self.own), filled(self.weight, count)
        a, b, h = own * dq[:, :count], own * ddq[:, :count], np.zeros((len(q), count))
        gravity = np.array(robot.gravity)
        parts = [slice(first, first + _TOGETHER) for first in range(0, len(q), _TOGETHER)]
        for mass, part in product(self.carried, parts):
            chain, share = self._at(robot, mass)
            J = jacobians(chain, q[part])[:, :3, :count]
            v, pull = motions(chain, q[part], dq[part], ddq[part])
            a[part] += share * np.einsum("sij,si->sj", J, v[:, :3])
            b[part] += share * np.einsum("sij,si->sj", J, pull[:, :3])
            h[part] -= share * weight * np.einsum("sij,i->sj", J, gravity)
        fade = filled(self.fade, count) * dq[:, :count] ** 2
        return Shares(a, b, h, fade)

    def taken(self, robot: Robot, q: FloatArray, dq: FloatArray, ddq: FloatArray) -> FloatArray:
        """Shares (T, L) that a motion takes at configurations, velocities and accelerations, with
        what is lost to speed; one is the limit."""
        _, inertial, weight, fade = self.along(robot, q, dq, ddq)
        return np.abs(inertial + weight) + fade

    def pull(
        self,
        robot: Robot,
        path: tuple[FloatArray, FloatArray, FloatArray],
        bar: Shares,
        out: tuple[FloatArray, FloatArray, FloatArray],
    ) -> None:
        """Reverse of `along`.

        Args:
            robot: that drives it.
            path: q and its derivatives (S, N).
            bar: gradient with respect to the shares.
            out: gradients (S, N) with respect to q and its derivatives, added to.
        """
        q, dq, ddq = (np.ascontiguousarray(array) for array in path)
        count, own = len(self.own), np.array(self.own)
        out[1][:, :count] += own * bar.a
        out[1][:, :count] += 2 * filled(self.fade, count) * dq[:, :count] * bar.fade
        out[2][:, :count] += own * bar.b
        weight, gravity = filled(self.weight, count), np.array(robot.gravity)
        for mass in self.carried:
            chain, share = self._at(robot, mass)
            seeds = [np.zeros_like(q) for _ in range(3)]
            for seed, part in zip(seeds, (bar.a, bar.b, -weight * bar.h), strict=True):
                seed[:, :count] = share * part
            _pull_mass(chain, q, dq, ddq, gravity, seeds[0], seeds[1], seeds[2], *out)

    def _at(self, robot: Robot, mass: Borne) -> tuple[Chain, FloatArray]:
        chain = chain_to_axis(robot, mass.joint, "torque.carried")
        return chain, filled(mass.share, len(self.own))


WITHOUT_LIMIT = Torque()


@njit(cache=True, error_model="numpy")
def _pull_mass(
    chain: Chain,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    gravity: FloatArray,
    along: FloatArray,
    across: FloatArray,
    held: FloatArray,
    q_bar: FloatArray,
    dq_bar: FloatArray,
    ddq_bar: FloatArray,
) -> None:
    """Add the gradient of Σ (J along)·(J q') + (J across)·p'' + (J held)·g to that of the path."""
    size = q.shape[1]
    w = np.zeros(6)
    J = jacobians(chain, q)
    v, pull = motions(chain, q, dq, ddq)
    for s in range(q.shape[0]):
        w[:3] = v[s, :3]
        velocity_gradient(chain, q[s], along[s], w, q_bar[s])
        w[:3] = pull[s, :3]
        velocity_gradient(chain, q[s], across[s], w, q_bar[s])
        w[:3] = gravity
        velocity_gradient(chain, q[s], held[s], w, q_bar[s])
        for i in range(3):
            w[i] = 0.0
            for j in range(size):
                w[i] += J[s, i, j] * along[s, j]
        velocity_gradient(chain, q[s], dq[s], w, q_bar[s])
        for j in range(size):
            dq_bar[s, j] += J[s, 0, j] * w[0] + J[s, 1, j] * w[1] + J[s, 2, j] * w[2]
        for i in range(3):
            w[i] = 0.0
            for j in range(size):
                w[i] += J[s, i, j] * across[s, j]
        acceleration_gradient(chain, q[s], dq[s], ddq[s], w, q_bar[s], dq_bar[s])
        for j in range(size):
            ddq_bar[s, j] += J[s, 0, j] * w[0] + J[s, 1, j] * w[1] + J[s, 2, j] * w[2]


def torque(table: dict[str, Any], base: Torque = WITHOUT_LIMIT) -> Torque:
    """Limits of torque from the table of a motion model's file; ``base`` where it states nothing.

    Raises:
        InputError: a key is unknown or a value has the wrong type or range.
    """
    unknown = set(table) - {"own_s2", "carried", "weight", "fade_s2"}
    if unknown:
        raise InputError(
            f"torque.{min(unknown)}: no such key; there are own_s2, carried, weight and fade_s2"
        )
    values: dict[str, Any] = {
        key.removesuffix("_s2"): row_of(f"torque.{key}", table[key])
        for key in ("own_s2", "weight", "fade_s2")
        if key in table
    }
    if "carried" in table:
        entries = table["carried"]
        if not isinstance(entries, list):
            raise InputError(f"torque.carried: a list of tables is expected, not {entries!r}")
        values["carried"] = tuple(_borne(entry) for entry in entries)
    return replace(base, **values)


def _borne(entry: Any) -> Borne:
    if not isinstance(entry, Mapping) or set(entry) != {"joint", "share_s2_per_m2"}:
        raise InputError(
            f"torque.carried: tables of joint and share_s2_per_m2 are expected, not {entry!r}"
        )
    joint = entry["joint"]
    if isinstance(joint, bool) or not isinstance(joint, int):
        raise InputError(f"torque.carried.joint: a whole number is expected, not {joint!r}")
    return Borne(joint, row_of("torque.carried.share_s2_per_m2", entry["share_s2_per_m2"]))
