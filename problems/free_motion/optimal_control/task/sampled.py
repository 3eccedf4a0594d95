"""Torques and TCP speeds at the samples, with derivatives by what the samples hang on.

At a sample z = (q, d, e, S): τ(z) = τ(q, d / (T₀ √S), e / (T₀² S)). The equations of motion are
linear in q̈ and quadratic in q̇, so most second derivatives follow from first ones; those by q are
difference quotients of Pinocchio's analytic first derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .....core.arrays import FloatArray, IntArray
from .....core.errors import InputError
from .....core.program.tool import WORLD, Tool
from .....core.robot.kinematics.chain_derivatives import hessians
from .....core.robot.kinematics.chain_kernels import jacobians
from .....core.robot.work_chain import work_chain
from .task import MotionTask

_STEP = 1e-6
"""rad or m, for difference quotients of derivatives."""


@dataclass(frozen=True)
class State:
    """Z samples in time.

    Args:
        q, dq, ddq: (Z, n), joints that move, rad or m, per s and s².
        leg: (Z,).
    """

    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    leg: IntArray


class Plant:
    """The equations of motion with the loads of the legs: torques of all N axes, by the n joints
    that move. Axes that stand still have to be held.

    An external axis that stands still, and whose inertia is not known, counts nothing.

    Args:
        task: what is asked.

    Attributes:
        moving: (n,), indices of the joints that move.
        size: N.

    Raises:
        InputError: inertias are not known.
    """

    def __init__(self, task: MotionTask) -> None:
        self._task = task
        self.moving, self.size = task.moving, task.robot.size
        self._dynamics = [task.robot.dynamics(task.load(leg)) for leg in range(task.legs)]
        self._unknown = self._checked_unknown()

    def _checked_unknown(self) -> IntArray:
        """Axes whose torques are not known; none of them moves."""
        at = self._task.stations[:1]
        torque = self._dynamics[0].torques(at, np.zeros_like(at), np.zeros_like(at))[0]
        unknown = np.flatnonzero(~np.isfinite(torque))
        moving = np.intersect1d(unknown, self.moving)
        if len(moving):
            raise InputError(
                f"torques need the inertia of axis {self._task.robot.axis_names[moving[0]]}, "
                "which is not known"
            )
        return unknown

    def rates(self, state: State) -> FloatArray:
        """(Z, N), velocities of all axes."""
        return self._spread(state.dq)

    def _spread(self, part: FloatArray) -> FloatArray:
        """(Z, N) from derivatives (Z, n) of the joints that move."""
        whole = np.zeros((len(part), self.size))
        whole[:, self.moving] = part
        return whole

    def torques(self, state: State) -> FloatArray:
        """(Z, N) N m or N."""
        out = np.empty((len(state.q), self.size))
        for leg, rows in self._legs(state.leg):
            out[rows] = self._dynamics[leg].torques(*self._motion(state, rows))
        out[:, self._unknown] = 0.0
        return out

    def derivatives(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
        """∂τ/∂q, ∂τ/∂q̇, ∂τ/∂q̈, each (Z, N, n)."""
        out = np.empty((3, len(state.q), self.size, state.q.shape[1]))
        for leg, rows in self._legs(state.leg):
            parts = self._dynamics[leg].torque_derivatives(*self._motion(state, rows))
            for k, part in enumerate(parts):
                out[k, rows] = part[:, :, self.moving]
        out[:, :, self._unknown] = 0.0
        return out[0], out[1], out[2]

    def _motion(self, state: State, rows: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        return (
            self._task.whole(state.q[rows]),
            self._spread(state.dq[rows]),
            self._spread(state.ddq[rows]),
        )

    def _legs(self, leg: IntArray) -> list[tuple[int, IntArray]]:
        return [(int(k), np.flatnonzero(leg == k)) for k in np.unique(leg)]


class TorqueField:
    """τ (Z, N) as a function of z = (q, d, e, S), first and contracted second derivatives.

    Args:
        plant: the equations of motion.
        scale: T₀, s.
    """

    def __init__(self, plant: Plant, scale: float) -> None:
        self._plant = plant
        self.scale = scale

    def torques(self, state: State) -> FloatArray:
        """(Z, N)."""
        return self._plant.torques(state)

    def rates(self, state: State) -> FloatArray:
        """(Z, N), q̇."""
        return self._plant.rates(state)

    def rate_slopes(self, state: State, S: float) -> FloatArray:
        """∂q̇/∂z, (Z, N, 3 n + 1)."""
        count, n = state.q.shape
        out = np.zeros((count, self._plant.size, 3 * n + 1))
        out[:, self._plant.moving, n + np.arange(n)] = 1.0 / (self.scale * np.sqrt(S))
        out[:, :, -1] = -0.5 * self._plant.rates(state) / S
        return out

    def rate_bends(self, state: State, S: float, weights: FloatArray) -> FloatArray:
        """Σ_j weights_j ∂²q̇_j/∂z², (Z, 3 n + 1, 3 n + 1), weights (Z, N)."""
        count, n = state.q.shape
        own = weights[:, self._plant.moving]
        H = np.zeros((count, 3 * n + 1, 3 * n + 1))
        _edge(H, slice(n, 2 * n), 3 * n, -0.5 * own / (self.scale * np.sqrt(S)) / S)
        H[:, -1, -1] = 0.75 * np.sum(own * state.dq, axis=1) / S**2
        return H

    def slopes(self, state: State, S: float) -> FloatArray:
        """∂τ/∂z, (Z, N, 3 n + 1)."""
        by_q, by_v, by_a = self._plant.derivatives(state)
        time = self.scale * np.sqrt(S)
        by_S = -(0.5 * _along(by_v, state.dq) + _along(by_a, state.ddq)) / S
        return np.concatenate([by_q, by_v / time, by_a / time**2, by_S[..., None]], axis=2)

    def bends(self, state: State, S: float, weights: FloatArray) -> FloatArray:
        """Σ_j weights_j ∂²τ_j/∂z², (Z, 3 n + 1, 3 n + 1), weights (Z, N)."""
        count, n = state.q.shape
        time = self.scale * np.sqrt(S)
        by_q, by_v, by_a = (
            np.einsum("zi,zij->zj", weights, part) for part in self._plant.derivatives(state)
        )
        turned, sped = self._shifted(state, weights)
        still = State(state.q, np.zeros_like(state.q), np.zeros_like(state.q), state.leg)
        gravity = np.einsum("zi,zij->zj", weights, self._plant.derivatives(still)[0])
        H = np.zeros((count, 3 * n + 1, 3 * n + 1))
        q, d, e, s = slice(0, n), slice(n, 2 * n), slice(2 * n, 3 * n), 3 * n
        own = (turned[:, :, :n] - by_q[:, None]) / _STEP
        H[:, q, q] = 0.5 * (own + own.transpose(0, 2, 1))
        _both(H, q, d, (turned[:, :, n : 2 * n] - by_v[:, None]) / _STEP / time)
        _both(H, q, e, (turned[:, :, 2 * n :] - by_a[:, None]) / _STEP / time**2)
        bend = sped - by_v[:, None]
        H[:, d, d] = 0.5 * (bend + bend.transpose(0, 2, 1)) / time**2
        # τ = (M e + c(d, d)) / (T₀² S) + g: what hangs on S falls with 1 / S.
        _edge(H, q, s, -(by_q - gravity) / S)
        _edge(H, d, s, -by_v / time / S)
        _edge(H, e, s, -by_a / time**2 / S)
        inertial = np.einsum("zj,zj->z", by_a, state.ddq)
        inertial += 0.5 * np.einsum("zj,zj->z", by_v, state.dq)
        H[:, s, s] = 2.0 * inertial / S**2
        return H

    def _shifted(self, state: State, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Contracted derivatives with one joint's angle, and one joint's speed, moved a little.

        Returns:
            (Z, n, 3 n) with the moved joint before the variable, and (Z, n, n) of ∂τ/∂q̇, which is
            linear in the speeds: there the step is 1.
        """
        count, n = state.q.shape
        step = np.eye(n)
        q = (state.q[:, None] + _STEP * step).reshape(-1, n)
        dq = (state.dq[:, None] + step).reshape(-1, n)
        same_q, same_v, same_a = (
            np.repeat(part, n, axis=0) for part in (state.q, state.dq, state.ddq)
        )
        leg, y = np.repeat(state.leg, n), np.repeat(weights, n, axis=0)
        turned = self._plant.derivatives(State(q, same_v, same_a, leg))
        sped = self._plant.derivatives(State(same_q, dq, same_a, leg))[1]
        parts = [np.einsum("zi,zij->zj", y, part).reshape(count, n, n) for part in (*turned, sped)]
        return np.concatenate(parts[:3], axis=2), parts[3]


class TcpSpeed:
    """|ṗ|² of the TCP as a function of z.

    Args:
        task: robot and TCP.
        scale: T₀, s.
    """

    def __init__(self, task: MotionTask, scale: float) -> None:
        self._chain = work_chain(task.robot, Tool("tcp", task.tcp), WORLD)
        self._task, self._moving, self._scale = task, task.moving, scale

    def velocity(self, q: FloatArray, dq: FloatArray) -> FloatArray:
        """(Z, 3) m/s."""
        return _along(self._jacobian(q), dq)

    def _jacobian(self, q: FloatArray) -> FloatArray:
        found = jacobians(self._chain, self._task.whole(q))
        return np.asarray(found[:, :3][:, :, self._moving])

    def _rates(self, q: FloatArray, dq: FloatArray) -> FloatArray:
        """∂ṗ/∂q, (Z, 3, n)."""
        found = hessians(self._chain, self._task.whole(q))[:, :3]
        part = found[:, :, self._moving[:, None], self._moving]
        return np.asarray(np.einsum("zijk,zj->zik", part, dq))

    def squares(self, state: State) -> FloatArray:
        """|ṗ|², (Z, 1)."""
        return np.asarray(np.sum(self.velocity(state.q, state.dq) ** 2, axis=1, keepdims=True))

    def slopes(self, state: State, S: float) -> FloatArray:
        """(Z, 1, 3 n + 1)."""
        n, time = state.q.shape[1], self._scale * np.sqrt(S)
        velocity, J = self.velocity(state.q, state.dq), self._jacobian(state.q)
        out = np.zeros((len(state.q), 1, 3 * n + 1))
        out[:, 0, :n] = 2 * np.einsum("zi,zij->zj", velocity, self._rates(state.q, state.dq))
        out[:, 0, n : 2 * n] = 2 * np.einsum("zi,zij->zj", velocity, J) / time
        out[:, 0, -1] = -np.sum(velocity**2, axis=1) / S
        return out

    def bends(self, state: State, S: float, weights: FloatArray) -> FloatArray:
        """weights · ∂²/∂z², (Z, 3 n + 1, 3 n + 1), weights (Z, 1)."""
        count, n = state.q.shape
        plain = self.slopes(state, S)[:, 0]
        H = np.zeros((count, 3 * n + 1, 3 * n + 1))
        for j in range(n):
            moved = State(state.q + _STEP * np.eye(n)[j], state.dq, state.ddq, state.leg)
            H[:, j] = (self.slopes(moved, S)[:, 0] - plain) / _STEP
        H[:, :n, :n] = 0.5 * (H[:, :n, :n] + H[:, :n, :n].transpose(0, 2, 1))
        H[:, n:, :n] = H[:, :n, n:].transpose(0, 2, 1)
        J, d, s = self._jacobian(state.q), slice(n, 2 * n), 3 * n
        H[:, d, d] = 2 * np.einsum("zij,zik->zjk", J, J) / self._scale**2 / S
        _edge(H, d, s, -plain[:, d] / S)
        H[:, s, s] = -2 * plain[:, s] / S
        return np.asarray(weights[:, :, None] * H)


def _along(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Matrices (Z, i, j) times vectors (Z, j)."""
    return np.asarray(np.einsum("zij,zj->zi", matrix, vector))


def _both(H: FloatArray, rows: slice, columns: slice, block: FloatArray) -> None:
    H[:, rows, columns] = block
    H[:, columns, rows] = block.transpose(0, 2, 1)


def _edge(H: FloatArray, rows: slice, column: int, values: FloatArray) -> None:
    H[:, rows, column] = values
    H[:, column, rows] = values
