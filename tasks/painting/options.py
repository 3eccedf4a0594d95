"""The options of painting: the surface, the sweeps, the robot's program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.errors import OptionError
from ..options import texts
from ..options.entries import (
    ANGLE,
    COUNT,
    LENGTH,
    MILLISECONDS,
    NOT_NEGATIVE,
    POSITIVE,
    REQUIRED,
    Extent,
    choice,
    number,
    value,
)
from ..setup import CellOptions
from .values import box, coat_errors, speed_range, thickness

if TYPE_CHECKING:
    from ...core.spatial.pose import Pose

LARGEST = Extent(0.0, 1e4, "[)")


@dataclass(frozen=True, kw_only=True)
class SurfaceOptions(CellOptions):
    """What of a part is to be painted, and how much."""

    target: str | float = value(
        REQUIRED, "Thickness wanted, with its unit: 50um.", thickness, numbers="m"
    )
    units: str | None = choice(
        None, "Of the part's numbers: m, cm, mm, in; as the file says.", ("m", "cm", "mm", "in")
    )
    view: str | Sequence[float] | None = value(
        None, "Direction in which the gun looks at the part, such as 0,0,-1.", texts.direction
    )
    facing: float | None = number(
        None,
        "Paint only what faces the gun to within so many {unit}.",
        ANGLE,
        Extent(0.0, 180.0, "(]"),
    )
    inside: str | Sequence[float] | None = value(
        None, "Paint only what lies in a box: x,y,z,x,y,z in mm.", box, numbers="m"
    )
    covered: str | Sequence[float] | None = value(
        None, "Leave out what lies in a box: x,y,z,x,y,z in mm.", box, numbers="m"
    )


@dataclass(frozen=True, kw_only=True)
class SweepOptions(SurfaceOptions):
    """The first curve, and within what it may change."""

    sweep: float | None = number(None, "Sweep width, {unit}.", LENGTH, POSITIVE)
    distance: float | None = number(
        None, "Of the gun from the part, {unit}; the footprint's if unset.", LENGTH, POSITIVE
    )
    overhang: float = number(100.0, "Of sweeps beyond the edge, {unit}.", LENGTH, NOT_NEGATIVE)
    step: float | None = number(None, "Between waypoints at most, {unit}.", LENGTH, POSITIVE)
    heading: str | Sequence[float] | None = value(
        None, "Direction of the sweeps; along the longer side if unset.", texts.direction
    )
    method: str = choice("sideways", "sideways or raster.", ("raster", "sideways"))
    coats: str = choice(
        "one", "one, or crossed: two of half the paint, at right angles.", ("one", "crossed")
    )
    turns: str = choice("on", "Whether the gun paints in turns: on, off.", ("on", "off"))
    speed: str | Sequence[float] = value(
        "50,800", "Least and largest speed, mm/s.", speed_range, numbers="m/s"
    )
    tilt: float = number(
        20.0, "Of the gun off the normal at most, {unit}.", ANGLE, Extent(0.0, 80.0, "()")
    )
    deviation: float = number(
        100.0, "Of waypoints from the first curve at most, {unit}.", LENGTH, POSITIVE
    )
    errors: str | Sequence[float] | None = value(
        None,
        "That the coat shall stand: height in mm, footprint's radius in %: 3,2.",
        coat_errors,
        numbers="m and a share",
    )
    points: int = number(2600, "Of the part on which to optimise.", COUNT, Extent(100))
    seed: int = number(0, "Of the choice of these points.", COUNT, Extent(0))


@dataclass(frozen=True, kw_only=True)
class PaintOptions(SweepOptions):
    """The robot's program: where the part stands, and what switches the gun."""

    tool: str | None = value(None, "The gun among the cell's tools.")
    place: str | Pose | None = value(None, "Pose of the part in the world, as for fk.", texts.pose)
    frame: str | None = value(None, "Instead: a frame of the cell that the part stands in.")
    zone: float = number(20.0, "Zone at the waypoints, {unit}.", LENGTH, LARGEST)
    run: float = number(50.0, "Run-in and run-out with the gun off, {unit}.", LENGTH, LARGEST)
    signal: str | None = value(None, "Output that switches the gun.")
    flow: str | None = value(None, "Output that sets the flow.")
    delay: float = number(0.0, "From signal to paint, {unit}.", MILLISECONDS, LARGEST)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.signal is None and (self.flow is not None or self.delay):
            raise OptionError(
                f"{self.spelt('flow')} and {self.spelt('delay')} are of the gun's signals: name "
                f"its switch by {self.spelt('signal')}"
            )
        if self.robot is None and self.cell is None:
            for name in ("motion", "tool", "frame"):
                if getattr(self, name) is not None:
                    raise OptionError(
                        f"{self.spelt(name)} is of a robot: name it by {self.spelt('robot')} or "
                        f"{self.spelt('cell')}"
                    )
