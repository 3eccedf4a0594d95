"""``flyby zones``: every zone of a program as large as obstacles and rules let it be."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .console import print_json, print_table, progress
from .delivery import deliver
from .loading import Source, cell_of, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    Clearance,
    Entry,
    Force,
    Freed,
    InPlace,
    MotionFile,
    NoFloor,
    OtherFiles,
    Out,
    Predefined,
    ProgramFile,
    RobotName,
    Start,
    WholeCell,
)
from .patching import Patching, Places
from .places import place_json, short_place
from .solution_report import solution_json, tell_solution
from .task_options import clearance_of, freed_stops, move_index, rounding_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..core.cell.cell import Cell
    from ..core.program.program import Program
    from ..core.program.zone import Zone
    from ..core.vendor import Vendor
    from ..problems.improve.zones.changes import ZoneChange
    from ..problems.improve.zones.maximize import ZoneSolution
    from ..problems.improve.zones.options import ZoneOptions

COLUMNS = (
    ("move", "right"),
    ("line", "left"),
    ("zone before", "right"),
    ("after", "right"),
    ("no larger because of", "left"),
)


def zones(
    program: ProgramFile,
    cell: WholeCell = None,
    robot: RobotName = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    clearance: Clearance = None,
    no_floor: NoFloor = False,
    predefined: Predefined = False,
    free: Freed = None,
    keep: Annotated[
        list[int] | None,
        typer.Option("--keep", help="A move whose zone stays; may be given several times."),
    ] = None,
    own: Annotated[
        bool,
        typer.Option(
            "--own", help="Moves that share one datum, or compute their zone, get one of their own."
        ),
    ] = False,
    out: Out = None,
    in_place: InPlace = False,
    unproven: Annotated[
        bool,
        typer.Option("--unproven", help="Write the program even if its clearance is not proven."),
    ] = False,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Make zones as large as they can be without collision, and prove the new program.

    The exit status is 1 if the new program is not proven to keep its clearance.
    """
    source = Source.of(program, entry, io, others, start)
    places = Places(out, in_place, source.inputs(cell, motion), force)
    places.check()
    with progress("reading the program") as say:
        from ..core.motion.emulator.controller import Controller
        from ..problems.improve.zones.maximize import maximize_zones

        vendor, arm = robot_of(robot, cell, motion)
        parsed = source.read(vendor, arm)
        tools = dict.fromkeys(move.tool for move in parsed.moves)
        where = cell_of((vendor, arm), cell, tools, no_floor=no_floor)
        options = _options(parsed, vendor, where, clearance, predefined, free, keep, own, start)
        patching = Patching(vendor, where.robot, own)
        controller = Controller(vendor, where.robot)
        made = maximize_zones(controller, parsed, where, options, patching.read_back, say)
        delivery = deliver(made, vendor, patching.files, places, unproven)
    if json:
        print_json(_json(delivery.made, where, delivery.written))
    else:
        _tell(program, delivery.made, where, delivery.written)
    delivery.end(told=not json)


def _options(
    program: Program,
    vendor: Vendor,
    cell: Cell,
    clearance: float | None,
    predefined: bool,
    free: list[str] | None,
    keep: list[int] | None,
    own: bool,
    start: str | None,
) -> ZoneOptions:
    from ..problems.improve.zones.options import ZoneOptions
    from ..problems.improve.zones.sizes import pattern_for

    kept = [move_index(program, str(number), "--keep") for number in keep or []]
    return ZoneOptions(
        clearance=clearance_of(clearance),
        freed=freed_stops(program, free or [], kept),
        pattern=pattern_for(vendor.speaks),
        kept=kept,
        apart=own,
        rounding=rounding_of(vendor, predefined),
        start=start_of(start, cell.robot),
    )


def _tell(program: Path, made: ZoneSolution, cell: Cell, written: Sequence[Path]) -> None:
    print_table(COLUMNS, [_row(program, change) for change in made.zones])
    tell_solution(program, made, cell, written)


def _row(program: Path, change: ZoneChange) -> tuple[str, ...]:
    return (
        str(change.move + 1),
        short_place(program, change.span),
        zone_shown(change.before),
        zone_shown(change.after),
        change.limit,
    )


def zone_shown(zone: Zone) -> str:
    """A zone in the units of the shop floor."""
    from ..core.program.zone import Angle, ContourFraction, Radius

    match zone:
        case Radius(tcp):
            return zone.name or f"{1e3 * tcp:.5g} mm"
        case ContourFraction(fraction):
            return f"{100 * fraction:.3g} %"
        case Angle(angle):
            return f"{math.degrees(angle):.4g}°"
    return "fine"


def _json(made: ZoneSolution, cell: Cell, written: Sequence[Path]) -> dict[str, Any]:
    zones = [_change_json(change) for change in made.zones]
    return {**solution_json(made, cell, written), "zones": zones}


def _change_json(change: ZoneChange) -> dict[str, Any]:
    return {
        "move": change.move + 1,
        "before": zone_shown(change.before),
        "after": zone_shown(change.after),
        "clear_to": change.clear,
        "fails_at": change.fails,
        "limit": change.limit,
        **place_json(change.span),
    }
