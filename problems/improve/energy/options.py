"""What a user may say about the energy of a program."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from ....core.errors import InputError
from ....core.motion.model.consumption import SQUARED_TORQUE, Consumption
from ...checks import positive, within
from ..waypoints import WaypointTask as Wishes


class EnergyScope(StrEnum):
    """What of a program may change."""

    SPEEDS = "speeds"
    """Speeds and accelerations of its moves alone."""
    ZONES = "zones"
    """Zones too."""
    WAYPOINTS = "waypoints"
    """Zones and via points too."""


@dataclass(frozen=True)
class EnergyTask:
    """What is wanted, and what must stay.

    Args:
        scope: what may change.
        consumption: whose integral over the cycle is the energy.
        wishes: what stays, where points may go, what clearance is kept, as for
            `improve.waypoints`; its weight of time and its number of via points do not count.
        slowest: share of the speed that a move reaches now below which it is not driven.

    Raises:
        InputError: a number out of its range.
    """

    scope: EnergyScope = EnergyScope.WAYPOINTS
    consumption: Consumption = SQUARED_TORQUE
    wishes: Wishes = field(default_factory=Wishes)
    slowest: float = 0.02

    def __post_init__(self) -> None:
        if not 0.0 < self.slowest <= 1.0:
            raise InputError(f"EnergyTask.slowest lies in (0, 1], not {self.slowest}")


@dataclass(frozen=True)
class Goal:
    """a T + b E, as small as possible, with T ≤ the latest end.

    Args:
        time: a, per s.
        energy: b, per unit of the consumption.
        latest: s; None for any duration.

    Raises:
        InputError: weights below zero or none above, or a latest end that is no time.
    """

    time: float = 1.0
    energy: float = 0.0
    latest: float | None = None

    def __post_init__(self) -> None:
        weights = self.time, self.energy
        if not all(0.0 <= w < math.inf for w in weights) or max(weights) == 0.0:
            raise InputError(f"Goal: weights are zero or more and not both zero, not {weights}")
        if self.latest is not None and not 0.0 < self.latest < math.inf:
            raise InputError(f"Goal.latest is above zero, not {self.latest}")

    @classmethod
    def weighted(cls, weight: float, time: float, energy: float) -> Goal:
        """w T / T₀ + (1 − w) E / E₀.

        Args:
            weight: w in [0, 1].
            time, energy: T₀ and E₀ above zero.

        Raises:
            InputError: a number out of its range.
        """
        within("Goal.weighted, weight", weight, 0.0, 1.0)
        positive("Goal.weighted, time", time)
        positive("Goal.weighted, energy", energy)
        return cls(weight / time, (1.0 - weight) / energy)
