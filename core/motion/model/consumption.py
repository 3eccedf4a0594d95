"""What a motion consumes: the power of torques τ (N m) at joint velocities q̇ (rad/s).

All joints together have the power

    p = Σ hⱼ τⱼ² + m τⱼ q̇ⱼ,        consumed: p where p ≥ 0,  η p where p < 0.

The papers' norm is Σ τⱼ² ("Towards Energy Optimization using Trajectory Smoothing", section 2):
m = 0. Drives turn h τ² into heat in their windings and do τ q̇ mechanically, m = 1. All drives of a
controller share one DC link, so that what one gives back another may use. What is left over goes
into the brake resistor (η = 0) or back to the mains (η up to 1).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Real
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError


class Rounded(NamedTuple):
    """What is consumed (...), with its kink at p = 0 rounded, and two derivatives by p."""

    value: FloatArray
    slope: FloatArray
    bend: FloatArray


class Consumption(ABC):
    """The power of a motion, in a unit of its own."""

    @property
    @abstractmethod
    def unit(self) -> str:
        """Of its integral over time."""

    @property
    @abstractmethod
    def mechanical(self) -> float:
        """m: 1 where mechanical power counts, 0 where it does not."""

    @property
    @abstractmethod
    def returned(self) -> float:
        """η in [0, 1]: the share that comes back of what is left over."""

    @abstractmethod
    def squares(self, count: int) -> FloatArray:
        """(count,), hⱼ of all joints.

        Raises:
            InputError: figures of more joints are given.
        """

    def powers(self, torque: FloatArray, rate: FloatArray) -> FloatArray:
        """What each joint takes (..., N) at torques and joint velocities (..., N)."""
        heat = self.squares(torque.shape[-1]) * torque**2
        return np.asarray(heat + self.mechanical * torque * rate)

    def power_slopes(self, torque: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (..., N) of p with respect to torques and velocities."""
        by_torque = 2.0 * self.squares(torque.shape[-1]) * torque + self.mechanical * rate
        return by_torque, self.mechanical * torque

    def total(self, powers: FloatArray) -> FloatArray:
        """What all joints (..., N) take together (...); negative where the mains are given."""
        p = powers.sum(axis=-1)
        return np.asarray(np.maximum(p, self.returned * p))

    def flow(self, powers: FloatArray) -> FloatArray:
        """What all joints (..., N) take or leave over together, |p| (...).

        Over time it is the size of an energy that may come back: never less than what is consumed.
        """
        return np.asarray(np.abs(powers.sum(axis=-1)))

    def slopes(self, torque: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (..., N) of the total with respect to torques and velocities; one-sided
        where nothing flows."""
        p = self.powers(torque, rate).sum(axis=-1, keepdims=True)
        share = np.where(p >= 0.0, 1.0, self.returned)
        by_torque, by_rate = self.power_slopes(torque, rate)
        return share * by_torque, share * by_rate

    def rounded(self, p: FloatArray, width: float) -> Rounded:
        """What is consumed of p (...) with √(p² + width²) in the place of |p|.

        It is too large by (1 − η) / 2 · width at most, where p = 0.
        """
        kept, lost = 0.5 * (1.0 + self.returned), 0.5 * (1.0 - self.returned)
        size = np.sqrt(p**2 + width**2)
        return Rounded(kept * p + lost * size, kept + lost * p / size, lost * width**2 / size**3)


@dataclass(frozen=True)
class SquaredTorque(Consumption):
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

    @property
    def mechanical(self) -> float:
        """Torques alone count."""
        return 0.0

    @property
    def returned(self) -> float:
        """Of no effect: the sum is never negative."""
        return 1.0

    def squares(self, count: int) -> FloatArray:
        """(count,), wⱼ."""
        return _filled("SquaredTorque.weight", self.weight, count, 1.0)


@dataclass(frozen=True)
class Motors(Consumption):
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
        share: object = self.recuperation
        if not isinstance(share, Real) or not 0.0 <= float(share) <= 1.0:
            raise InputError(f"Motors.recuperation lies in [0, 1], not {share!r}")

    @property
    def unit(self) -> str:
        """J."""
        return "J"

    @property
    def mechanical(self) -> float:
        """All of it counts."""
        return 1.0

    @property
    def returned(self) -> float:
        """η."""
        return self.recuperation

    def squares(self, count: int) -> FloatArray:
        """(count,), κⱼ."""
        return _filled("Motors.copper", self.copper, count, 0.0)


def _filled(name: str, values: Sequence[float], count: int, rest: float) -> FloatArray:
    if len(values) > count:
        raise InputError(f"{name} has figures of {len(values)} joints; there are {count}")
    filled = np.full(count, rest)
    filled[: len(values)] = values
    return filled


def _check(name: str, values: object) -> None:
    if not isinstance(values, tuple | list):
        raise InputError(f"{name} must be a tuple of numbers, one a joint, not {values!r}")
    for value in values:
        if not isinstance(value, Real) or not 0.0 <= float(value) < math.inf:
            raise InputError(f"{name} must be finite and zero or more, not {value!r}")


SQUARED_TORQUE = SquaredTorque()
