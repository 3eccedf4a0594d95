"""What painting works with, from its options: the plan, limits, the region, robot and gun."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.door import given, spelt
from ...core.errors import InputError, OptionError
from ..options import texts
from ..setup import setup_of
from .values import box, speed_range

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.errors import Note
    from ...core.program.tool import Tool, WorkObject
    from ...core.spatial.pose import Pose
    from ...problems.paint.executable.station import Station
    from ...problems.paint.executable.writing import DriveOptions
    from ...problems.paint.initial.plan import SweepPlan
    from ...problems.paint.spray.footprint import Footprint
    from ...problems.paint.surface.part import Part
    from ...problems.paint.thickness.options import PaintLimits
    from .options import PaintOptions, SweepOptions

SHARE = 0.72
"""Sweep width by the radius of the footprint, where none is given."""
REACH = 0.2
"""Share of the planned distance by which the gun may be nearer or farther."""


def plan_of(footprint: Footprint, options: SweepOptions, step: float) -> SweepPlan:
    """The first curve.

    Args:
        footprint: of the gun.
        options: what is asked.
        step: m between waypoints at most, where none is given.
    """
    from ...problems.paint.initial.plan import Coats, Gun, Method, SweepPlan

    view, heading = options.view, options.heading
    return SweepPlan(
        SHARE * footprint.radius if options.sweep is None else options.sweep,
        footprint.reference_distance if options.distance is None else options.distance,
        longest_segment=step if options.step is None else options.step,
        overhang=options.overhang,
        method=Method(options.method),
        view=None if view is None else texts.direction(view, spelt("view")),
        heading=None if heading is None else texts.direction(heading, spelt("heading")),
        coats=Coats(options.coats),
        turns=Gun(options.turns),
    )


def limits_of(distance: float, options: SweepOptions) -> PaintLimits:
    """Limits of the optimisation.

    Args:
        distance: planned, m.
        options: what is asked.
    """
    from ...problems.paint.thickness.options import PaintLimits

    return PaintLimits(
        distance=((1.0 - REACH) * distance, (1.0 + REACH) * distance),
        tilt=options.tilt,
        speed=speed_range(options.speed, spelt("speed")),
        deviation=options.deviation,
    )


def region_of(part: Part, plan: SweepPlan, options: SweepOptions) -> Part:
    """The part with what is to be painted narrowed down.

    Args:
        part: whose painted triangles are chosen from.
        plan: for the direction in which the gun looks.
        options: what is asked.

    Raises:
        InputError: nothing is left to paint.
    """
    from ...problems.paint.initial.raster import view_of
    from ...problems.paint.surface.region import facing, within_box

    triangles = part.vertices, part.faces
    chosen = part.painted_faces
    if options.facing is not None:
        chosen &= facing(*triangles, -view_of(part, plan), options.facing)
    if options.inside is not None:
        chosen &= within_box(*triangles, *box(options.inside, spelt("inside")))
    if options.covered is not None:
        chosen &= ~within_box(*triangles, *box(options.covered, spelt("covered")))
    if (chosen == part.painted_faces).all():
        return part
    if not chosen.any():
        raise InputError(
            f"{part.name}: {spelt('facing')}, {spelt('inside')} and {spelt('covered')} leave "
            "nothing of it to paint"
        )
    return part.with_painted(chosen)


def station_of(
    options: PaintOptions, drive: DriveOptions
) -> tuple[Station | None, tuple[Note, ...]]:
    """Robot, gun and place, None without a robot, and what there is to say of the cell.

    Args:
        options: what is asked.
        drive: with the signals that the robot's language has to send.

    Raises:
        InputError: naming the option.
    """
    if options.robot is None and options.cell is None:
        return None, ()
    from ...problems.paint.executable.station import Station
    from ...problems.paint.spray.signals import output_words

    setup = setup_of(options)
    where, notes = setup.before_programs(no_floor=options.no_floor)
    gun = _gun(where, options.tool)
    made = Station(setup.vendor, where, gun, _part_frame(where, options.frame, options.place))
    if drive.signals is not None:
        output_words(drive.signals, made.vendor)
    return made, notes


def _gun(cell: Cell, name: str | None) -> Tool:
    from ...problems.paint.executable.station import PLAIN_GUN

    if name is not None:
        return cell.tool(name)
    named = [tool for key, tool in cell.tools.items() if key != "tool0"]
    if len(named) > 1:
        raise InputError(
            f"which tool of the cell is the gun? Give {spelt('tool')}: "
            f"{', '.join(t.name for t in named)}"
        )
    return named[0] if named else PLAIN_GUN


def _part_frame(cell: Cell, name: str | None, place: str | Pose | None) -> WorkObject:
    from ...core.program.tool import WorkObject

    if name is not None:
        if place is not None:
            raise OptionError(
                f"{spelt('frame')} and {spelt('place')} both say where the part stands: give one"
            )
        return cell.frame(name)
    if place is None:
        raise OptionError(
            f"where does the part stand? Give {given('place', 'POSE')} in the world, or "
            f"{spelt('frame')}"
        )
    return WorkObject("part", texts.pose(place, spelt("place")))


def drive_of(options: PaintOptions) -> DriveOptions:
    """How the trajectory is driven."""
    from ...problems.paint.executable.writing import DriveOptions
    from ...problems.paint.spray.signals import GunSignals

    signals = None
    if options.signal is not None:
        signals = GunSignals(options.signal, options.flow, delay=options.delay)
    return DriveOptions(options.zone, options.run, signals)
