"""Constraints and running cost at the samples: torques, torques that fall with speed, TCP speed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .....core.arrays import FloatArray
from .....core.motion.model.consumption import Consumption, Rounded
from ..motion.layout import VariableLayout
from ..task.limits import TorqueLimits
from ..task.sampled import State, TcpSpeed, TorqueField
from .rows import Places

Curvature = Callable[[FloatArray], FloatArray]
"""Symmetric blocks (Z, k, k) → what stands for them in the Hessian."""


class SamplePlaces:
    """Where the variables z = (q, d, e, S) of each sample stand in x.

    Args:
        layout: the variables.
        scale: T₀, s.
    """

    def __init__(self, layout: VariableLayout, scale: float) -> None:
        point, rise, self._leg = layout.samples.T
        parts = [layout.q[point], layout.d[point], layout.e[rise]]
        zero = np.zeros((len(point), 1), dtype=np.int64)
        self.columns = np.hstack([*parts, zero])
        self._scale = scale

    def __len__(self) -> int:
        return len(self.columns)

    def state(self, x: FloatArray) -> State:
        """The samples in time."""
        q, d, e = np.split(x[self.columns[:, :-1]], 3, axis=1)
        time = self._scale * np.sqrt(x[0])
        return State(q, d / time, e / time**2, self._leg)

    def hessian_places(self) -> Places:
        """Of a block (size, size) for every sample."""
        size = self.columns.shape[1]
        rows = np.repeat(self.columns, size, axis=1).ravel()
        return rows, np.tile(self.columns, (1, size)).ravel()


class TorqueRows:
    """−1 ≤ (τ + slope q̇) / most ≤ 1 at every sample.

    Args:
        layout: the variables.
        field: torques.
        limits: of the torques.
        curvature: what stands for its second derivatives.
    """

    def __init__(
        self,
        layout: VariableLayout,
        field: TorqueField,
        limits: TorqueLimits,
        curvature: Curvature,
    ) -> None:
        self._places = SamplePlaces(layout, field.scale)
        self._field = field
        self._limits = limits
        self._curvature = curvature
        count = len(self._places) * len(limits.axis)
        self.lower, self.upper = -np.ones(count), np.ones(count)

    def tightened(self, margin: FloatArray) -> TorqueRows:
        """With shares (Z, R) of the limits left as a margin."""
        self.lower, self.upper = -1.0 + margin.ravel(), 1.0 - margin.ravel()
        return self

    def values(self, x: FloatArray) -> FloatArray:
        state = self._places.state(x)
        return self._limits.shares(self._field.torques(state), self._field.rates(state)).ravel()

    @property
    def jacobian_places(self) -> Places:
        columns = self._places.columns
        wide = np.repeat(columns, len(self._limits.axis), axis=0)
        return np.repeat(np.arange(len(wide)), wide.shape[1]), wide.ravel()

    def jacobian(self, x: FloatArray) -> FloatArray:
        state, S = self._places.state(x), float(x[0])
        axis, most, slope = self._limits
        slopes = self._field.slopes(state, S)[:, axis]
        slopes += slope[:, None] * self._field.rate_slopes(state, S)[:, axis]
        return np.asarray((slopes / most[:, None]).ravel())

    @property
    def hessian_places(self) -> Places:
        return self._places.hessian_places()

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        state, S = self._places.state(x), float(x[0])
        axis, most, slope = self._limits
        y = multipliers.reshape(len(self._places), -1) / most
        driven, sped = np.zeros((2, *self._field.rates(state).shape))
        np.add.at(driven.T, axis, y.T)
        np.add.at(sped.T, axis, (y * slope).T)
        H = bends_where(self._field, state, S, driven)
        H += self._field.rate_bends(state, S, sped)
        return self._curvature(H).ravel()


def convex_part(H: FloatArray) -> FloatArray:
    """The positive semidefinite part of symmetric blocks (Z, k, k).

    At time-optimal motions nearly as many limits are active as there are variables, so that the
    curvature left out costs no iterations, and what is left needs no further convexification.
    """
    values, vectors = np.linalg.eigh(H)
    return np.asarray(np.einsum("zij,zj,zkj->zik", vectors, np.maximum(values, 0.0), vectors))


def exact(H: FloatArray) -> FloatArray:
    """Blocks (Z, k, k) as they are, for methods that take indefinite Hessians: with energy fewer
    limits are active, and what `convex_part` leaves out costs most iterations."""
    return H


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
        curvature: what stands for its second derivatives.
    """

    def __init__(
        self,
        layout: VariableLayout,
        speed: TcpSpeed,
        limit: float,
        scale: float,
        curvature: Curvature,
    ) -> None:
        self._places = SamplePlaces(layout, scale)
        self._speed, self._square = speed, limit**2
        self._curvature = curvature
        count = len(self._places)
        self.lower, self.upper = np.full(count, -np.inf), np.ones(count)

    def tightened(self, margin: FloatArray) -> TcpSpeedRows:
        """With shares (Z,) of the limit left as a margin."""
        self.upper = (1.0 - margin) ** 2
        return self

    def values(self, x: FloatArray) -> FloatArray:
        return np.asarray(self._speed.squares(self._places.state(x)).ravel() / self._square)

    @property
    def jacobian_places(self) -> Places:
        columns = self._places.columns
        return np.repeat(np.arange(len(columns)), columns.shape[1]), columns.ravel()

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.asarray(
            (self._speed.slopes(self._places.state(x), float(x[0])) / self._square).ravel()
        )

    @property
    def hessian_places(self) -> Places:
        return self._places.hessian_places()

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        y = multipliers[:, None] / self._square
        bends = self._speed.bends(self._places.state(x), float(x[0]), y)
        return self._curvature(bends).ravel()


class EnergyTerm:
    """∫ of a consumption over time, with its kink rounded, by the grid's quadrature.

    Args:
        layout: the variables.
        field: torques.
        consumption: what is integrated.
        scale: T₀, s.
        width: W, of the kink; see `Consumption.rounded`.
        curvature: what stands for its second derivatives.
    """

    def __init__(
        self,
        layout: VariableLayout,
        field: TorqueField,
        consumption: Consumption,
        scale: float,
        width: float,
        curvature: Curvature = convex_part,
    ) -> None:
        self._layout, self._field, self._scale = layout, field, scale
        self._consumption, self._width = consumption, width
        self._curvature = curvature
        self._places = SamplePlaces(layout, scale)
        self._interval, self._sample, self._share = layout.quadrature

    def _weights(self, x: FloatArray) -> FloatArray:
        """(Z,), widths of scaled time that the samples stand for."""
        widths = self._layout.width(x)[self._interval] * self._share
        return np.asarray(np.bincount(self._sample, widths, len(self._places)), np.float64)

    def _driven(self, state: State) -> tuple[FloatArray, FloatArray, Rounded]:
        """Torques and velocities (Z, N), and what they consume (Z,)."""
        torque, rate = self._field.torques(state), self._field.rates(state)
        power = self._consumption.powers(torque, rate).sum(axis=1)
        return torque, rate, self._consumption.rounded(power, self._width)

    def size(self, x: FloatArray) -> float:
        """∫ |p| dt: what is consumed and what is left over, added up."""
        state = self._places.state(x)
        torque, rate = self._field.torques(state), self._field.rates(state)
        flow = self._consumption.flow(self._consumption.powers(torque, rate))
        return float(self._scale * np.sqrt(x[0]) * (self._weights(x) @ flow))

    def value(self, x: FloatArray) -> float:
        found = self._driven(self._places.state(x))[2]
        return float(self._scale * np.sqrt(x[0]) * (self._weights(x) @ found.value))

    def _by_stretch(self, x: FloatArray, values: FloatArray) -> FloatArray:
        """Entries (terms,) of ∂(Σ weight · values)/∂stretch."""
        rate = self._layout.grid.width[self._interval] * self._share
        return np.asarray(rate * values[self._sample])

    def gradient(self, x: FloatArray) -> FloatArray:
        """(size,)."""
        state, S = self._places.state(x), float(x[0])
        torque, rate, found = self._driven(state)
        by_torque, by_rate = self._consumption.power_slopes(torque, rate)
        local = np.einsum("zj,zjk->zk", by_torque, self._field.slopes(state, S))
        local += np.einsum("zj,zjk->zk", by_rate, self._field.rate_slopes(state, S))
        time, weights = self._scale * np.sqrt(S), self._weights(x)
        out = np.bincount(
            self._places.columns.ravel(),
            (time * (weights * found.slope)[:, None] * local).ravel(),
            self._layout.size,
        )
        out[0] += 0.5 * time / S * (weights @ found.value)
        if self._layout.stretches:
            columns = self._layout.stretch[self._interval]
            np.add.at(out, columns, time * self._by_stretch(x, found.value))
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
        state, S = self._places.state(x), float(x[0])
        torque, rate, found = self._driven(state)
        by_torque, by_rate = self._consumption.power_slopes(torque, rate)
        J, V = self._field.slopes(state, S), self._field.rate_slopes(state, S)
        # Of the power p: Σ hⱼ τⱼ² + m τⱼ q̇ⱼ.
        squares = self._consumption.squares(torque.shape[1])
        H = 2.0 * np.einsum("zji,j,zjk->zik", J, squares, J)
        mixed = self._consumption.mechanical * np.einsum("zji,zjk->zik", J, V)
        H += mixed + mixed.transpose(0, 2, 1)
        H += bends_where(self._field, state, S, by_torque)
        H += self._field.rate_bends(state, S, by_rate)
        slope = np.einsum("zj,zjk->zk", by_torque, J) + np.einsum("zj,zjk->zk", by_rate, V)
        # Of what is consumed of it.
        H *= found.slope[:, None, None]
        H += found.bend[:, None, None] * slope[:, :, None] * slope[:, None, :]
        local = found.slope[:, None] * slope
        # The factor T₀ √S before the sum.
        H[:, :, -1] += 0.5 / S * local
        H[:, -1, :] += 0.5 / S * local
        H[:, -1, -1] -= 0.25 / S**2 * found.value
        time = self._scale * np.sqrt(S)
        blocks = (factor * time * self._weights(x)[:, None, None] * self._curvature(H)).ravel()
        if not self._layout.stretches:
            return np.asarray(blocks)
        local[:, -1] += 0.5 / S * found.value
        width = self._layout.grid.width[self._interval] * self._share
        cross = (factor * time * width[:, None] * local[self._sample]).ravel()
        return np.concatenate([blocks, cross, cross])
