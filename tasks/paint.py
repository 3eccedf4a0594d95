"""A robot program that leaves an even coat on a part, and the map to prove it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .options import texts
from .options.keywords import by_keywords
from .painting.options import PaintOptions
from .painting.values import coat_errors, thickness

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..problems.paint.coating.coat import Coat
    from ..problems.paint.executable.execute import Executable
    from ..problems.paint.executable.station import Station
    from ..problems.paint.executable.writing import DriveOptions
    from ..problems.paint.painting import Painting
    from ..problems.paint.surface.part import Part
    from .results.painted import PaintedPart

FINEST = 0.06
"""Longest edge of the part's triangles by the footprint's radius, so that it is judged finely."""
STEP = 0.3
"""Longest segment by the footprint's radius, where none is given."""


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
    from .painting.choices import drive_of, limits_of, plan_of, region_of, station_of

    drive = drive_of(options)
    station, notes = station_of(options, drive)
    options.say("reading the part")
    from ..problems.paint.painting import Wishes
    from ..problems.paint.painting import paint as find
    from ..problems.paint.spray.footprint_file import load_footprint
    from .results.painted import PaintedPart

    inputs = (Path(part), Path(footprint), *options.inputs())
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
        return PaintedPart(source, painting, None, {}, inputs)
    options.say("the robot's way of holding the gun")
    made, sources = _executed(painting, station, drive, limits.speed, options.say)
    made = replace(made, notes=(*notes, *made.notes))
    return PaintedPart(source, painting, made, sources, inputs, station)


paint = by_keywords(paint_with, PaintOptions)


def _sized(file: Path, options: PaintOptions, finest: float) -> Part:
    """The part, fine enough; coarse first, so that wrong units are reported before it is cut up."""
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
