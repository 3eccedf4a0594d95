"""What the numbers of speeds and zones are in a language, by the unit that stands behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...program.speed import Speed

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
        scale: SI units, or whole, of one of it: 0.001 of mm, 0.01 of percent.
    """

    name: str
    scale: float


Units = Mapping[str, Amount]
"""What numbers are, by the unit that stands behind them; ``""`` where none does."""


def stated(speed: Speed, units: Units) -> tuple[str, float] | None:
    """The first unit of which a speed states a number, and that number; None if it states none."""
    for unit, amount in units.items():
        value = getattr(speed, amount.name)
        if value is not None:
            return unit, value / amount.scale
    return None


def speed_of(unit: str, number: float, units: Units, acceleration: float = 1.0) -> Speed:
    """The speed of a number with its unit.

    Args:
        acceleration: `Speed.acceleration_override`.
    """
    amount = units[unit]
    return with_number(
        Speed(acceleration_override=acceleration), amount.name, number * amount.scale
    )


def with_number(speed: Speed, name: str, value: float) -> Speed:
    """A speed with another number."""
    numbers: dict[str, Any] = {name: value}
    return replace(speed, **numbers)
