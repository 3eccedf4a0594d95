"""What the numbers of speeds and zones are in a language, by the unit that stands behind them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...errors import InputError
from ...program.speed import Speed
from ...program.zone import Fine, Radius, VendorZone
from ...robot.model import Robot

ZONE = "zone"
"""The size of a zone: how far before the point it begins."""
BEHIND = "behind"
"""How far it goes on behind the point, where that is a distance of its own."""
PASSING = "passing"
"""Whether there is one: 0 for a stop, 1 for any other."""
ZONES = frozenset({ZONE, BEHIND, PASSING})


@dataclass(frozen=True, slots=True)
class Amount:
    """What a number in the text is.

    Args:
        name: of a field of `Speed`; `ZONE`, `BEHIND` or `PASSING` for a number of a zone.
        scale: SI units, or whole, of one of it: 0.001 of mm, 0.01 of percent; where each arm has
            its own (percent of its greatest speed), what it is for an arm.
    """

    name: str
    scale: float | Callable[[Robot], float]

    def of(self, robot: Robot | None) -> Amount:
        """The same for an arm; None where nobody knows which."""
        if robot is None or not callable(self.scale):
            return self
        return Amount(self.name, self.scale(robot))

    @property
    def one(self) -> float:
        """What one of it is, in SI units.

        Raises:
            InputError: that depends on the arm, and nobody knows which.
        """
        if callable(self.scale):
            raise InputError(
                "how much this number is depends on the arm: name the robot that drives the program"
            )
        return self.scale


Units = Mapping[str, Amount]
"""What numbers are, by the unit that stands behind them; ``""`` where none does."""


def of_arm(units: Units, robot: Robot | None) -> Units:
    """The same for an arm."""
    return {unit: amount.of(robot) for unit, amount in units.items()}


def stated(speed: Speed, units: Units) -> tuple[str, float] | None:
    """The first unit of which a speed states a number, and that number; None if it states none."""
    for unit, amount in units.items():
        value = getattr(speed, amount.name)
        if value is not None:
            return unit, value / amount.one
    return None


def with_number(speed: Speed, name: str, value: float) -> Speed:
    """A speed with another number."""
    numbers: dict[str, Any] = {name: value}
    return replace(speed, **numbers)


def overridden(speed: Speed, share: float, joint: bool) -> Speed:
    """A speed of which a share is driven, of a joint move or another one; accelerations stay.

    Raises:
        InputError: nothing of it is driven.
    """
    if share <= 0:
        raise InputError(f"with an override of {100 * share:g} % the robot stands still")
    numbers: dict[str, Any] = {
        name: value * share
        for name in ("tcp", "reorientation", "joint", *(("joint_fraction",) if joint else ()))
        if (value := getattr(speed, name)) is not None
    }
    if speed.duration is not None:
        numbers["duration"] = speed.duration / share
    return replace(speed, **numbers)


def zone_number(zone: object, amount: Amount) -> float:
    """A number of a zone, in the text's own unit: of a stop all are 0."""
    if amount.name == PASSING:
        return float(not isinstance(zone, Fine))
    if isinstance(zone, Radius):
        return zone.tcp / amount.one
    if not isinstance(zone, VendorZone):
        return 0.0
    return zone.size * (zone.ratio if amount.name == BEHIND else 1.0) / amount.one
