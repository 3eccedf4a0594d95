"""For what a free motion is the best."""

from __future__ import annotations

from dataclasses import dataclass

from ..changes import weight
from ..motors import MotorOptions
from ..options.entries import POSITIVE, TIME, number, value


@dataclass(frozen=True, kw_only=True)
class ObjectiveOptions(MotorOptions):
    """What counts, and the time that there is."""

    objective: float | str = value(
        "time",
        "time, energy, or a weight w between 0 and 1: w · time + (1 − w) · energy.",
        weight,
    )
    longest: float | None = number(None, "Seconds that the motion may take.", TIME, POSITIVE)

    @property
    def weight(self) -> float:
        """w of the objective.

        Raises:
            OptionError: it is none of what it may be.
        """
        return weight(self.objective, self.spelt("objective"))
