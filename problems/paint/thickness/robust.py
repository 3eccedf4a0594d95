"""Errors that a coat shall stand: of the gun's height and of the footprint's radius.

Differences between trajectories below about 1 µm are less than what such errors make of them. With
scenarios in its objective an optimisation finds the trajectory whose coat is even on average.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...checks import not_negative
from ..coating.deposition import Deposition
from .objective import Scenario


@dataclass(frozen=True, slots=True)
class PaintErrors:
    """Standard deviations of what is not known.

    Args:
        height: of the gun over the surface, m.
        radius: of the footprint, as a share of it.
    """

    height: float = 0.0
    radius: float = 0.0

    def __post_init__(self) -> None:
        for name in ("height", "radius"):
            not_negative(f"PaintErrors.{name}", getattr(self, name))


NO_ERRORS = PaintErrors()
_SPREAD = math.sqrt(3.0)


def scenarios(deposition: Deposition, errors: PaintErrors) -> tuple[Scenario, ...]:
    """The deposition as it is thought to be, and with each error to either side.

    Errors are placed and weighted as Gauss–Hermite's rule of three points has it in each of two
    directions: the mean squared error over normal errors is exact for coats that are quadratic in
    them, but for the product of the two.
    """
    footprint = deposition.footprint
    found = []
    if errors.height:
        found += [
            footprint.with_height_error(sign * _SPREAD * errors.height) for sign in (1.0, -1.0)
        ]
    if errors.radius:
        found += [
            footprint.with_radius_error(sign * _SPREAD * errors.radius) for sign in (1.0, -1.0)
        ]
    rest = 1.0 / 6.0
    others = tuple(Scenario(deposition.with_footprint(each), rest) for each in found)
    return (Scenario(deposition, 1.0 - rest * len(found)), *others)
