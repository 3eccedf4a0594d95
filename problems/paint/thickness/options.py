"""Options of the optimisation of a painting trajectory."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....core.errors import InputError
from ...checks import not_negative


@dataclass(frozen=True, slots=True)
class PaintLimits:
    """Limits of the motion; lengths in m, angles in rad, speeds in m/s.

    Args:
        distance: least and largest distance of the TCP from the surface.
        tilt: of the nozzle off the surface's normal, at most; below 80°.
        speed: least and largest speed of the TCP.
        step: least and largest length of a segment.
        deviation: of a waypoint from where it was at first, at most; without such a limit
            neighbouring sweeps may pair up.
    """

    distance: tuple[float, float] = (0.2, 0.3)
    tilt: float = math.radians(20.0)
    speed: tuple[float, float] = (0.05, 0.8)
    step: tuple[float, float] = (0.005, 0.3)
    deviation: float = 0.1

    def __post_init__(self) -> None:
        for name in ("distance", "speed", "step"):
            low, high = getattr(self, name)
            if not 0.0 < low < high < math.inf:
                raise InputError(f"{name}: 0 < least < largest is needed, not {low:g}, {high:g}")
        if not 0.0 < self.tilt < math.radians(80.0):
            raise InputError(f"tilt: between 0 and 80° is needed, not {math.degrees(self.tilt):g}°")
        if not self.deviation > 0.0:
            raise InputError(f"deviation: a length above zero is needed, not {self.deviation!r}")


@dataclass(frozen=True, slots=True)
class PaintWeights:
    """What counts beside the evenness, which is half the mean squared error in per cent² of the
    target; a standard deviation of 1 % is worth 0.5.

    Args:
        time: of a second.
        paint: of as much paint as the coat has at the target; it raises the transfer efficiency.
        position: of Σ |step|² between neighbouring waypoints, 1/m².
        bend: of Σ |change of the step|² from segment to segment, 1/m²; it straightens the path.
        direction: of Σ |change of the nozzle's unit vector|² between neighbouring waypoints.
        speed: of Σ (change of the speed)² from segment to segment, s²/m²; robots cannot jump.
    """

    time: float = 0.0
    paint: float = 0.0
    position: float = 1e-2
    bend: float = 0.1
    direction: float = 0.1
    speed: float = 0.1

    def __post_init__(self) -> None:
        for name in ("time", "paint", "position", "bend", "direction", "speed"):
            not_negative(f"PaintWeights.{name}", getattr(self, name))


@dataclass(frozen=True, slots=True)
class OuterLoop:
    """How the solution proceeds: outer iterations, each in a box of its own round where it starts.

    Args:
        rounds: outer iterations, at most.
        iterations: of the SQP solver in each, at most.
        position: the box's half width for positions, m.
        angle: for the nozzle's two angles, rad; as far as ``position`` at the gun's distance.
        duration: for durations, as a share of them; below 1.
        enough: rounds end where the objective falls by less than this share.
    """

    rounds: int = 5
    iterations: int = 3
    position: float = 0.03
    angle: float = math.radians(7.0)
    duration: float = 0.7
    enough: float = 0.25

    def __post_init__(self) -> None:
        if self.rounds < 1 or self.iterations < 1:
            raise InputError("rounds and iterations: whole numbers >= 1 are needed")
        if not (self.position > 0.0 and self.angle > 0.0 and 0.0 < self.duration < 1.0):
            raise InputError("the box of a round needs room: sizes above 0, durations below 1")
