"""A robot program that leaves an even coat on a part, and the map to prove it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .options import texts
from .options.entries import (
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
from .options.keywords import by_keywords
from .paint_values import box, coat_errors, speed_range, thickness
from .setup import CellOptions

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.spatial.pose import Pose
    from ..problems.paint.coating.coat import Coat
    from ..problems.paint.executable.execute import Executable
    from ..problems.paint.executable.station import Station
    from ..problems.paint.executable.writing import DriveOptions
    from ..problems.paint.painting import Painting
    from ..problems.paint.surface.part import Part
    from .painted import PaintedPart

FINEST = 0.06
"""Longest edge of the part's triangles by the footprint's radius, so that it is judged finely."""
STEP = 0.3
"""Longest segment by the footprint's radius, where none is given."""
LARGEST = Extent(0.0, 1e4, "[)")


@dataclass(frozen=True, kw_only=True)
class SurfaceOptions(CellOptions):
    """What of a part is to be painted, and how much."""

    target: str | float = value(REQUIRED, "Thickness wanted, with its unit: 50um.", thickness)
    units: str | None = value(None, "Of the part's numbers: m, cm, mm, in; as the file says.")
    view: str | Sequence[float] | None = value(
        None, "Direction in which the gun looks at the part, such as 0,0,-1.", texts.direction
    )
    facing: float | None = number(
        None,
        "Paint only what faces the gun to within so many degrees.",
        ANGLE,
        Extent(0.0, 180.0, "(]"),
    )
    inside: str | Sequence[float] | None = value(
        None, "Paint only what lies in a box: x,y,z,x,y,z in mm.", box
    )
    covered: str | Sequence[float] | None = value(
        None, "Leave out what lies in a box: x,y,z,x,y,z in mm.", box
    )


@dataclass(frozen=True, kw_only=True)
class SweepOptions(SurfaceOptions):
    """The first curve, and within what it may change."""

    sweep: float | None = number(None, "Sweep width, mm.", LENGTH, POSITIVE)
    distance: float | None = number(
        None, "Of the gun from the part, mm; the footprint's if unset.", LENGTH, POSITIVE
    )
    overhang: float = number(100.0, "Of sweeps beyond the edge, mm.", LENGTH, NOT_NEGATIVE)
    step: float | None = number(None, "Between waypoints at most, mm.", LENGTH, POSITIVE)
    heading: str | Sequence[float] | None = value(
        None, "Direction of the sweeps; along the longer side if unset.", texts.direction
    )
    method: str = choice("sideways", "sideways or raster.", ("raster", "sideways"))
    coats: str = choice(
        "one", "one, or crossed: two of half the paint, at right angles.", ("one", "crossed")
    )
    turns: str = choice("on", "Whether the gun paints in turns: on, off.", ("on", "off"))
    speed: str | Sequence[float] = value("50,800", "Least and largest speed, mm/s.", speed_range)
    tilt: float = number(
        20.0, "Of the gun off the normal at most, degrees.", ANGLE, Extent(0.0, 80.0, "()")
    )
    deviation: float = number(
        100.0, "Of waypoints from the first curve at most, mm.", LENGTH, POSITIVE
    )
    errors: str | Sequence[float] | None = value(
        None,
        "That the coat shall stand: height in mm, footprint's radius in %: 3,2.",
        coat_errors,
    )
    points: int = number(2600, "Of the part on which to optimise.", COUNT, Extent(100))
    seed: int = number(0, "Of the choice of these points.", COUNT, Extent(0))


@dataclass(frozen=True, kw_only=True)
class PaintOptions(SweepOptions):
    """The robot's program: where the part stands, and what switches the gun."""

    tool: str | None = value(None, "The gun among the cell's tools.")
    place: str | Pose | None = value(None, "Pose of the part in the world, as for fk.", texts.pose)
    frame: str | None = value(None, "Instead: a frame of the cell that the part stands in.")
    zone: float = number(20.0, "Zone at the waypoints, mm.", LENGTH, LARGEST)
    run: float = number(50.0, "Run-in and run-out with the gun off, mm.", LENGTH, LARGEST)
    signal: str | None = value(None, "Output that switches the gun.")
    flow: str | None = value(None, "Output that sets the flow.")
    delay: float = number(0.0, "From signal to paint, ms.", MILLISECONDS, LARGEST)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.signal is None and (self.flow is not None or self.delay):
            raise InputError(
                f"{self.spelt('flow')} and {self.spelt('delay')} are of the gun's signals: name "
                f"its switch by {self.spelt('signal')}"
            )
        if self.robot is None and self.cell is None:
            for name in ("motion", "tool", "frame"):
                if getattr(self, name) is not None:
                    raise InputError(
                        f"{self.spelt(name)} is of a robot: name it by {self.spelt('robot')} or "
                        f"{self.spelt('cell')}"
                    )


def paint_with(part: str | Path, footprint: str | Path, options: PaintOptions) -> PaintedPart:
    """Paint a part evenly: first curve, optimisation, program, and the coat as emulated.

    Args:
        part: STL, PLY, OBJ, OFF, GLB or 3MF.
        footprint: of the gun, or measured strokes (TOML).

    Returns:
        The coats by stage and, where a robot is named, the program with its proof; `flyby.write`
        puts program and pictures into a folder.

    Raises:
        InputError: naming the option, or a file cannot be used.
        MotionError: the robot cannot drive it.
    """
    from .paint_choices import drive_of, limits_of, plan_of, region_of, station_of

    drive = drive_of(options)
    station = station_of(options, drive)
    options.say("reading the part")
    from ..problems.paint.painting import Wishes
    from ..problems.paint.painting import paint as find
    from ..problems.paint.spray.footprint_file import load_footprint
    from .painted import PaintedPart

    source = load_footprint(Path(footprint))
    gun = source.footprint
    plan = plan_of(gun, options, STEP * gun.radius)
    limits = limits_of(plan.distance, options)
    shape = region_of(_sized(Path(part), options, FINEST * gun.radius), plan, options)
    wishes = Wishes(
        thickness(options.target, options.spelt("target")),
        plan,
        limits,
        errors=coat_errors(options.errors, options.spelt("errors")),
        points=options.points,
        seed=options.seed,
    )
    painting = find(shape, gun, wishes, options.say, _teller(options.say))
    if station is None:
        return PaintedPart(source, painting, None, {})
    options.say("the robot's way of holding the gun")
    made, sources = _executed(painting, station, drive, limits.speed, options.say)
    return PaintedPart(source, painting, made, sources)


paint = by_keywords(paint_with, PaintOptions)


def _sized(file: Path, options: PaintOptions, finest: float) -> Part:
    """The part, fine enough; coarse first, so that wrong units are told before it is cut up."""
    from ..problems.paint.surface.loading import PLAUSIBLE_SIZE, load_part

    view = None
    if options.view is not None:
        view = texts.direction(options.view, options.spelt("view"))
    shape = load_part(file, options.units, view, longest_edge=1e6)
    doubts = [n for n in shape.notes if "numbers are probably" in n.message]
    if doubts and max(shape.vertices.max(axis=0) - shape.vertices.min(axis=0)) > PLAUSIBLE_SIZE[1]:
        raise InputError(str(doubts[0]))
    return load_part(file, options.units, view, longest_edge=finest)


def _teller(say: Callable[[str], None]) -> Callable[..., bool]:
    def tell_round(number: int, iteration: object) -> bool:
        say(f"optimising: round {number + 1} (Ctrl-C ends with the best)")
        return False

    return tell_round


def _executed(
    painting: Painting,
    station: Station,
    drive: DriveOptions,
    speed: tuple[float, float],
    say: Callable[[str], None],
) -> tuple[Executable, dict[str, str]]:
    """The program as read from its text, and the text."""
    from ..problems.paint.executable.execute import execute
    from .files.texts import written_anew
    from .setup import Setup

    setup = Setup(station.vendor, station.cell.robot)
    written: dict[str, str] = {}

    def read_back(program: Program) -> Program:
        read, sources = written_anew(setup, program)
        written.update(sources)
        return read

    def tell_round(number: int, coat: Coat) -> bool:
        say(f"as emulated, round {number + 1}: std {1e6 * coat.by_area.std:.2f} µm")
        return False

    made = execute(painting, station, drive, speed, read_back=read_back, progress=tell_round)
    return made, written
