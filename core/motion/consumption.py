"""What a motion consumes: the power of torques τ (N m) at joint velocities q̇ (rad/s).

The papers' norm is Σ τⱼ² ("Towards Energy Optimization using Trajectory Smoothing", section 2). A
drive takes from the mains what its windings turn into heat and what it does mechanically,

    p = Σ κⱼ τⱼ² + τⱼ q̇ⱼ,        consumed: p where p ≥ 0,  η p where p < 0,

for all drives of a controller share one DC link, so that what one gives back another may use. What
is left over goes into the brake resistor (η = 0) or back to the mains (η up to 1).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError

FloatArray = NDArray[np.float64]


class Consumption(Protocol):
    """The power of a motion, in a unit of its own."""

    @property
    def unit(self) -> str:
        """Of its integral over time."""
        ...

    def powers(self, torque: FloatArray, rate: FloatArray) -> FloatArray:
        """What each joint takes (..., N) at torques and joint velocities (..., N)."""
        ...

    def total(self, powers: FloatArray) -> FloatArray:
        """What all joints (..., N) take together (...)."""
        ...

    def slopes(self, torque: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (..., N) of the total with respect to torques and velocities."""
        ...


@dataclass(frozen=True)
class SquaredTorque:
    """Σ wⱼ τⱼ².

    Args:
        weight: of each joint; joints beyond the last, or all of none, count 1.

    Raises:
        InputError: a weight is not finite or below zero.
    """

    weight: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        _check("SquaredTorque.weight", self.weight)

    @property
    def unit(self) -> str:
        """N² m² s."""
        return "N² m² s"

    def powers(self, torque: FloatArray, rate: FloatArray) -> FloatArray:
        """wⱼ τⱼ²."""
        return np.asarray(self.weights(torque.shape[-1]) * torque**2)

    def total(self, powers: FloatArray) -> FloatArray:
        """Their sum."""
        return np.asarray(powers.sum(axis=-1))

    def slopes(self, torque: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """2 wⱼ τⱼ and nothing."""
        return 2.0 * self.weights(torque.shape[-1]) * torque, np.zeros_like(rate)

    def weights(self, count: int) -> FloatArray:
        """(count,), of all joints."""
        return _filled(self.weight, count, 1.0)


@dataclass(frozen=True)
class Motors:
    """Heat in the windings and mechanical power, on one DC link; see the module.

    Args:
        copper: κⱼ, W/(N m)² at the joint, the winding's resistance times (current per torque)²;
            0 for joints beyond the last.
        recuperation: η in [0, 1], share of what is left over that goes back to the mains.

    Raises:
        InputError: a number out of its range.
    """

    copper: tuple[float, ...]
    recuperation: float = 0.0

    def __post_init__(self) -> None:
        _check("Motors.copper", self.copper)
        if not 0.0 <= self.recuperation <= 1.0:
            raise InputError(f"Motors.recuperation lies in [0, 1], not {self.recuperation}")

    @property
    def unit(self) -> str:
        """J."""
        return "J"

    def powers(self, torque: FloatArray, rate: FloatArray) -> FloatArray:
        """κⱼ τⱼ² + τⱼ q̇ⱼ, W."""
        return np.asarray(self.losses(torque.shape[-1]) * torque**2 + torque * rate)

    def total(self, powers: FloatArray) -> FloatArray:
        """What the mains give, W; negative where they are given."""
        p = powers.sum(axis=-1)
        return np.asarray(np.maximum(p, self.recuperation * p))

    def slopes(self, torque: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the total; one-sided where nothing flows."""
        p = self.powers(torque, rate).sum(axis=-1, keepdims=True)
        share = np.where(p >= 0.0, 1.0, self.recuperation)
        loss = self.losses(torque.shape[-1])
        return share * (2.0 * loss * torque + rate), share * torque

    def losses(self, count: int) -> FloatArray:
        """(count,), κ of all joints."""
        return _filled(self.copper, count, 0.0)


def _filled(values: Sequence[float], count: int, rest: float) -> FloatArray:
    filled = np.full(count, rest)
    filled[: min(len(values), count)] = values[:count]
    return filled


def _check(name: str, values: Sequence[float]) -> None:
    for value in values:
        if not 0.0 <= value < math.inf:
            raise InputError(f"{name} must be finite and zero or more, not {value}")


SQUARED_TORQUE = SquaredTorque()
