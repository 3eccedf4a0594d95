"""Bounds of how fast torques and the TCP's velocity can bend, for what happens between samples.

On a stretch with |q_j^(k)| ≤ r_j[k] every vector of the equations of motion is bounded in length
with its derivatives by Leibniz' rule: a vector v that is fixed to a body turning at ω has

    v^(k+1) = Σ_i C(k, i) ω^(i) × v^(k−i),        |v^(k+1)| ≤ Σ_i C(k, i) Ω[i] V[k−i],

and angular velocities, lever arms, forces m (c̈ − g) and moments d(I ω)/dt are sums and products of
such. Nothing is said of directions, so that the bounds are generous; they are multiplied by the
square of the samples' spacing.
"""

from __future__ import annotations

from math import comb

import numpy as np

from .....core.arrays import FloatArray
from .....core.robot.inertia import Inertia
from .....core.robot.joint import JointKind
from .....core.robot.model import Robot
from .....core.spatial.pose import Pose

_ORDERS = 5


class BendBounds:
    """|τ̈| of the arm's joints and |p⃛| of the TCP on M stretches.

    Args:
        robot: with the inertias of its links, if torques are asked for.
        load: in the flange's frame.
        tcp: in the flange's frame.
        rates: (M, N, 5), bounds of |q|, |q̇| and on to |q⁗|.
    """

    def __init__(self, robot: Robot, load: Inertia | None, tcp: Pose, rates: FloatArray) -> None:
        self._robot = robot
        self._stages = robot.arm_stages()
        self._bodies = _bodies(robot, load)
        self._count = len(rates)
        ends = [_length(turning.placement) for turning, _ in self._stages[1:]]
        ends.append(_length(robot.flange @ tcp))
        turn = np.zeros((self._count, _ORDERS))
        self._axis, self._turn, self._step = [], [], []
        for (joint, j), end in zip(self._stages, ends, strict=True):
            axis = _carried(turn, 1.0)
            own = _product(axis, np.concatenate([rates[:, j, 1:], 0 * rates[:, j, :1]], axis=1))
            slides = joint.kind is JointKind.PRISMATIC
            slide = _product(axis, rates[:, j]) if slides else 0.0
            turn = turn if slides else turn + own
            self._axis.append(axis)
            self._turn.append(turn)
            self._step.append((slide, _carried(turn, end)))

    def tcp(self) -> FloatArray:
        """(M,) m/s³, bound of the second derivative of the TCP's velocity."""
        return np.asarray(np.sum([(slide + step)[:, 3] for slide, step in self._step], axis=0))

    def torques(self) -> FloatArray:
        """(M, n), bounds of |τ̈| of the arm's joints, N m/s² or N/s²."""
        gravity = float(np.linalg.norm(self._robot.gravity))
        forces, moments, arms = [], [], []
        place = np.zeros((self._count, _ORDERS))
        for i, body in enumerate(self._bodies):
            place = place + self._step[i][0]
            arm = _carried(self._turn[i], float(np.linalg.norm(body.centre)))
            acceleration = np.roll(place + arm, -2, axis=1)[:, :3].copy()
            acceleration[:, 0] += gravity
            forces.append(body.mass * acceleration)
            moments.append(self._moment(i, body))
            arms.append(arm)
            place = place + self._step[i][1]
        out = np.zeros((self._count, self._robot.arm_size))
        for k, (joint, j) in enumerate(self._stages):
            slides = joint.kind is JointKind.PRISMATIC
            pull = np.zeros((self._count, 3))
            lever = np.zeros((self._count, _ORDERS))
            for i in range(k, len(self._stages)):
                if i > k:
                    lever = lever + self._step[i][0]
                if slides:
                    pull = pull + forces[i]
                else:
                    pull = pull + _product((lever + arms[i])[:, :3], forces[i]) + moments[i]
                lever = lever + self._step[i][1]
            out[:, j] += _product(self._axis[k][:, :3], pull)[:, 2]
        return out

    def _moment(self, i: int, body: Inertia) -> FloatArray:
        """(M, 3), |d(I ω)/dt| about the centre of mass and two derivatives."""
        turn = self._turn[i]
        size = float(np.abs(np.linalg.eigvalsh(np.array(body.tensor))).max())
        # A tensor turns from both sides.
        tensor = _carried(2.0 * turn, size)
        return _product(tensor, turn)[:, 1:4]


def _bodies(robot: Robot, load: Inertia | None) -> list[Inertia]:
    """Those behind each stage of the arm; what followers stand between has none."""
    bodies: list[Inertia] = []
    for index in robot.along if robot.links else ():
        bodies += [*(Inertia(0.0) for _ in robot.joints[index].followers), robot.links[index]]
    if bodies and load is not None:
        bodies[-1] = bodies[-1] + load.placed(robot.flange)
    return bodies


def _length(pose: Pose) -> float:
    return float(np.linalg.norm(pose.position))


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """Leibniz' rule for bounds (M, k) of two factors and their derivatives."""
    orders = min(a.shape[1], b.shape[1])
    out = np.zeros((len(a), orders))
    for k in range(orders):
        for i in range(k + 1):
            out[:, k] += comb(k, i) * a[:, i] * b[:, k - i]
    return out


def _carried(turn: FloatArray, length: float) -> FloatArray:
    """(M, 5), of a vector of some length fixed to a body whose |ω| and derivatives are bounded."""
    out = np.zeros((len(turn), _ORDERS))
    out[:, 0] = length
    for k in range(_ORDERS - 1):
        for i in range(k + 1):
            out[:, k + 1] += comb(k, i) * turn[:, i] * out[:, k - i]
    return out
