"""Running costs: what a joint's torque and speed cost in a second.

All are sums over the joints of ℓ(τ, v), smooth, with two derivatives.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError

FloatArray = NDArray[np.float64]


class Cost(NamedTuple):
    """A cost with its derivatives, all of the shape of τ and v."""

    value: FloatArray
    by_torque: FloatArray
    by_speed: FloatArray
    by_torque_torque: FloatArray
    by_torque_speed: FloatArray
    by_speed_speed: FloatArray


class RunningCost(Protocol):
    """ℓ(τ, v) of each joint.

    Attributes:
        unit: of its integral over time.
        joints: number of joints that it has figures of; None for as many as there are.
    """

    @property
    def unit(self) -> str: ...

    @property
    def joints(self) -> int | None: ...

    def __call__(self, torque: FloatArray, speed: FloatArray) -> Cost:
        """The cost of torques and speeds (..., n) of the n joints that move."""
        ...

    def exact(self, torque: FloatArray, speed: FloatArray) -> FloatArray:
        """The cost (..., n) without smoothing, for reports."""
        ...


@dataclass(frozen=True, slots=True)
class SquaredTorque:
    """The papers' energy norm: ℓ = τ².

    Args:
        weights: of the joints that move; empty for one each.
    """

    weights: tuple[float, ...] = ()

    @property
    def unit(self) -> str:
        return "N² m² s"

    @property
    def joints(self) -> int | None:
        return len(self.weights) or None

    def __call__(self, torque: FloatArray, speed: FloatArray) -> Cost:
        weight = np.broadcast_to(np.array(self.weights or 1.0), torque.shape)
        zero = np.zeros_like(torque)
        return Cost(weight * torque**2, 2 * weight * torque, zero, 2 * weight, zero, zero)

    def exact(self, torque: FloatArray, speed: FloatArray) -> FloatArray:
        return self(torque, speed).value


SQUARED_TORQUE = SquaredTorque()


@dataclass(frozen=True, slots=True)
class Motors:
    """Electric motors: copper loss and mechanical power, ℓ = c τ² + P⁺ − η P⁻ with P = τ v.

    With a winding's resistance R, a torque constant k and a gear ratio i, c = R / (k i)². P⁺ and P⁻
    are the positive and negative part of P: braking gives η of its power back. In the optimisation
    |P| is √(P² + δ²), which is too large by δ at most. Joint by joint: no joint uses what another
    gives back, as the one DC link of `core.motion.consumption` lets it, so this is never less.

    Args:
        copper: c in W / (N m)² of each joint that moves.
        recuperation: η, from 0 (braking is burnt) to 1 (all of it comes back).
        smoothing: δ, W.

    Raises:
        InputError: a number out of its range.
    """

    copper: tuple[float, ...]
    recuperation: float = 0.0
    smoothing: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.recuperation <= 1.0:
            raise InputError(f"recuperation is between 0 and 1, not {self.recuperation}")
        if not all(0.0 <= c < math.inf for c in self.copper):
            raise InputError(f"copper losses are zero or more, not {self.copper}")
        if not 0.0 < self.smoothing < math.inf:
            raise InputError(f"smoothing is above zero, not {self.smoothing}")

    @property
    def unit(self) -> str:
        return "J"

    @property
    def joints(self) -> int | None:
        return len(self.copper)

    def __call__(self, torque: FloatArray, speed: FloatArray) -> Cost:
        copper = np.array(self.copper)
        power = torque * speed
        size = np.sqrt(power**2 + self.smoothing**2)
        kept, lost = 0.5 * (1.0 + self.recuperation), 0.5 * (1.0 - self.recuperation)
        slope = kept + lost * power / size
        bend = lost * self.smoothing**2 / size**3
        return Cost(
            copper * torque**2 + kept * power + lost * size,
            2 * copper * torque + slope * speed,
            slope * torque,
            2 * copper + bend * speed**2,
            slope + bend * power,
            bend * torque**2,
        )

    def exact(self, torque: FloatArray, speed: FloatArray) -> FloatArray:
        power = torque * speed
        braked = self.recuperation * np.minimum(power, 0.0)
        return np.asarray(np.array(self.copper) * torque**2 + np.maximum(power, 0.0) + braked)
