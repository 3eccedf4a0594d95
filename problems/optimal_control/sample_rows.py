"""Constraints and running cost at the samples: torques, torques that fall with speed, TCP speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .layout import Layout
from .limits import Limits
from .motor import RunningCost
from .rows import Places
from .sampled import State, TcpSpeed, TorqueField

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class SamplePlaces:
    """Where the variables z = (q, d, e, S) of each sample stand in x.

    Args:
        layout: the variables.
    """

    def __init__(self, layout: Layout) -> None:
        point, rise, self.leg = layout.samples.T
        parts = [layout.q[point], layout.d[point], layout.e[rise]]
        zero = np.zeros((len(point), 1), dtype=np.int64)
        self.columns = np.hstack([*parts, zero])
        self._joints = layout.joints

    def __len__(self) -> int:
        return len(self.columns)

    def split(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, float]:
        """q, d, e (Z, n) and S."""
        n = self._joints
        z = x[self.columns[:, :-1]]
        return z[:, :n], z[:, n : 2 * n], z[:, 2 * n :], float(x[0])

    def hessian_places(self) -> Places:
        """Of a block (size, size) for every sample."""
        size = self.columns.shape[1]
        rows = np.repeat(self.columns, size, axis=1).ravel()
        return rows, np.tile(self.columns, (1, size)).ravel()


class TorqueRows:
    """−1 ≤ τ / τ_max ≤ 1 and −1 ≤ (τ + slope q̇) / most ≤ 1 at every sample.

    Args:
        layout: the variables.
        field: torques.
        limits: of the joints.
        scale: T₀, s.
    """

    def __init__(self, layout: Layout, field: TorqueField, limits: Limits, scale: float) -> None:
        self._places = SamplePlaces(layout)
        self._field = field
        self._scale = scale
        own = np.flatnonzero(np.isfinite(limits.torque))
        self.joint = np.concatenate([own, limits.line_joint])
        self._most = np.concatenate([limits.torque[own], limits.line_most])
        self._slope = np.concatenate([np.zeros(len(own)), limits.line_slope])
        count = len(self._places) * len(self.joint)
        self.lower, self.upper = -np.ones(count), np.ones(count)

    def tightened(self, margin: FloatArray) -> TorqueRows:
        """With shares (Z, R) of the limits left as a margin."""
        self.lower, self.upper = -1.0 + margin.ravel(), 1.0 - margin.ravel()
        return self

    def _state(self, x: FloatArray) -> State:
        return self._field.state(*self._places.split(x), self._places.leg)

    def values(self, x: FloatArray) -> FloatArray:
        state = self._state(x)
        driven = self._field.torques(state)[:, self.joint] + self._slope * state.dq[:, self.joint]
        return np.asarray((driven / self._most).ravel())

    @property
    def jacobian_places(self) -> Places:
        columns = self._places.columns
        wide = np.repeat(columns, len(self.joint), axis=0)
        return np.repeat(np.arange(len(wide)), wide.shape[1]), wide.ravel()

    def jacobian(self, x: FloatArray) -> FloatArray:
        state, S = self._state(x), float(x[0])
        slopes = self._field.slopes(state, S)[:, self.joint]
        n, time = state.q.shape[1], self._scale * np.sqrt(S)
        rows = np.arange(len(self.joint))
        slopes[:, rows, n + self.joint] += self._slope / time
        slopes[:, rows, -1] -= 0.5 * self._slope * state.dq[:, self.joint] / S
        return np.asarray((slopes / self._most[:, None]).ravel())

    @property
    def hessian_places(self) -> Places:
        return self._places.hessian_places()

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        state, S = self._state(x), float(x[0])
        y = multipliers.reshape(len(self._places), -1) / self._most
        count, n = state.q.shape
        weights = np.zeros((count, n))
        np.add.at(weights.T, self.joint, y.T)
        H = bends_where(self._field, state, S, weights)
        sped = np.zeros((count, n))
        np.add.at(sped.T, self.joint, (y * self._slope).T)
        time = self._scale * np.sqrt(S)
        edge = -0.5 * sped / time / S
        H[:, n : 2 * n, -1] += edge
        H[:, -1, n : 2 * n] += edge
        H[:, -1, -1] += 0.75 * np.sum(sped * state.dq, axis=1) / S**2
        return convex_part(H).ravel()


def convex_part(H: FloatArray) -> FloatArray:
    """The positive semidefinite part of symmetric blocks (Z, k, k).

    At time-optimal motions nearly as many limits are active as there are variables, so that the
    curvature left out costs no iterations, and what is left needs no further convexification.
    """
    values, vectors = np.linalg.eigh(H)
    return np.asarray(np.einsum("zij,zj,zkj->zik", vectors, np.maximum(values, 0.0), vectors))


def bends_where(field: TorqueField, state: State, S: float, weights: FloatArray) -> FloatArray:
    """`TorqueField.bends`, worked out only where a weight is not zero."""
    size = 3 * state.q.shape[1] + 1
    H = np.zeros((len(weights), size, size))
    rows = np.flatnonzero(weights.any(axis=1))
    if len(rows):
        part = State(state.q[rows], state.dq[rows], state.ddq[rows], state.leg[rows])
        H[rows] = field.bends(part, S, weights[rows])
    return H


class TcpSpeedRows:
    """|ṗ|² / limit² ≤ 1 at every sample.

    Args:
        layout: the variables.
        speed: of the TCP.
        limit: m/s.
        scale: T₀, s.
    """

    def __init__(self, layout: Layout, speed: TcpSpeed, limit: float, scale: float) -> None:
        self._places = SamplePlaces(layout)
        self._speed, self._square, self._scale = speed, limit**2, scale
        count = len(self._places)
        self.lower, self.upper = np.full(count, -np.inf), np.ones(count)

    def tightened(self, margin: FloatArray) -> TcpSpeedRows:
        """With shares (Z,) of the limit left as a margin."""
        self.upper = (1.0 - margin) ** 2
        return self

    def _state(self, x: FloatArray) -> tuple[State, float]:
        q, d, e, S = self._places.split(x)
        time = self._scale * np.sqrt(S)
        return State(q, d / time, e / time**2, self._places.leg), S

    def values(self, x: FloatArray) -> FloatArray:
        return np.asarray(self._speed.squares(self._state(x)[0]).ravel() / self._square)

    @property
    def jacobian_places(self) -> Places:
        columns = self._places.columns
        return np.repeat(np.arange(len(columns)), columns.shape[1]), columns.ravel()

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.asarray((self._speed.slopes(*self._state(x)) / self._square).ravel())

    @property
    def hessian_places(self) -> Places:
        return self._places.hessian_places()

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        y = multipliers[:, None] / self._square
        return convex_part(self._speed.bends(*self._state(x), y)).ravel()


class EnergyTerm:
    """∫ Σ_j ℓ(τ_j, q̇_j) dt by the grid's quadrature.

    Args:
        layout: the variables.
        field: torques.
        cost: ℓ.
        scale: T₀, s.
    """

    def __init__(self, layout: Layout, field: TorqueField, cost: RunningCost, scale: float) -> None:
        self._layout, self._field, self._cost, self._scale = layout, field, cost, scale
        self._places = SamplePlaces(layout)
        self._interval, self._sample, self._share = layout.quadrature

    def _weights(self, x: FloatArray) -> FloatArray:
        """(Z,), widths of scaled time that the samples stand for."""
        widths = self._layout.width(x)[self._interval] * self._share
        return np.asarray(np.bincount(self._sample, widths, len(self._places)), np.float64)

    def _state(self, x: FloatArray) -> State:
        return self._field.state(*self._places.split(x), self._places.leg)

    def value(self, x: FloatArray) -> float:
        state = self._state(x)
        cost = self._cost(self._field.torques(state), state.dq).value.sum(axis=1)
        return float(self._scale * np.sqrt(x[0]) * (self._weights(x) @ cost))

    def _speeds(self, state: State, S: float) -> FloatArray:
        """∂q̇/∂z, (Z, n, 3 n + 1)."""
        count, n = state.q.shape
        out = np.zeros((count, n, 3 * n + 1))
        out[:, np.arange(n), n + np.arange(n)] = 1.0 / (self._scale * np.sqrt(S))
        out[:, :, -1] = -0.5 * state.dq / S
        return out

    def _by_stretch(self, x: FloatArray, values: FloatArray) -> FloatArray:
        """Entries (terms,) of ∂(Σ weight · values)/∂stretch."""
        rate = self._layout.grid.width[self._interval] * self._share
        return np.asarray(rate * values[self._sample])

    def gradient(self, x: FloatArray) -> FloatArray:
        """(size,)."""
        state, S = self._state(x), float(x[0])
        found = self._cost(self._field.torques(state), state.dq)
        local = np.einsum("zj,zjk->zk", found.by_torque, self._field.slopes(state, S))
        local += np.einsum("zj,zjk->zk", found.by_speed, self._speeds(state, S))
        time, weights = self._scale * np.sqrt(S), self._weights(x)
        out = np.bincount(
            self._places.columns.ravel(),
            (time * weights[:, None] * local).ravel(),
            self._layout.size,
        )
        cost = found.value.sum(axis=1)
        out[0] += 0.5 * time / S * (weights @ cost)
        if self._layout.stretches:
            columns = self._layout.stretch[self._interval]
            np.add.at(out, columns, time * self._by_stretch(x, cost))
        return np.asarray(out)

    @property
    def hessian_places(self) -> Places:
        rows, columns = self._places.hessian_places()
        if not self._layout.stretches:
            return rows, columns
        wide = self._places.columns[self._sample]
        own = np.repeat(self._layout.stretch[self._interval], wide.shape[1])
        other = wide.ravel()
        return np.concatenate([rows, own, other]), np.concatenate([columns, other, own])

    def hessian(self, x: FloatArray, factor: float) -> FloatArray:
        state, S = self._state(x), float(x[0])
        found = self._cost(self._field.torques(state), state.dq)
        J, V = self._field.slopes(state, S), self._speeds(state, S)
        n, time = state.q.shape[1], self._scale * np.sqrt(S)
        H = bends_where(self._field, state, S, found.by_torque)
        mixed = np.einsum("zji,zj,zjk->zik", J, found.by_torque_speed, V)
        H += np.einsum("zji,zj,zjk->zik", J, found.by_torque_torque, J)
        H += mixed + mixed.transpose(0, 2, 1)
        H += np.einsum("zji,zj,zjk->zik", V, found.by_speed_speed, V)
        edge = -0.5 * found.by_speed / time / S
        H[:, n : 2 * n, -1] += edge
        H[:, -1, n : 2 * n] += edge
        H[:, -1, -1] += 0.75 * np.sum(found.by_speed * state.dq, axis=1) / S**2
        local = np.einsum("zj,zjk->zk", found.by_torque, J)
        local += np.einsum("zj,zjk->zk", found.by_speed, V)
        cost = found.value.sum(axis=1)
        # The factor T₀ √S before the sum.
        H[:, :, -1] += 0.5 / S * local
        H[:, -1, :] += 0.5 / S * local
        H[:, -1, -1] -= 0.25 / S**2 * cost
        blocks = (factor * time * self._weights(x)[:, None, None] * convex_part(H)).ravel()
        if not self._layout.stretches:
            return np.asarray(blocks)
        local[:, -1] += 0.5 / S * cost
        rate = self._layout.grid.width[self._interval] * self._share
        cross = (factor * time * rate[:, None] * local[self._sample]).ravel()
        return np.concatenate([blocks, cross, cross])
