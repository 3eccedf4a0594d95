"""``flyby zones``: every zone of a program as large as obstacles and rules let it be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.program.zone import zone_shown
from ..tasks.files.outputs import check_outputs, picture_kind
from ..tasks.files.places import FilePlaces
from ..tasks.files.source_places import place_json
from ..tasks.pages.file import check_page
from ..tasks.read import SourceOptions
from ..tasks.setup import setup_of_program
from ..tasks.zones import ZoneOptions, zones_with
from .output.changed_station import changed_station, is_station, refuse_given
from .output.console import print_json, print_table, progress
from .output.delivery import deliver
from .output.solution_report import ChangedMove, changed_rows, solution_json, tell_solution
from .output.told_robot import read_for_robot
from .parameters import (
    AsJson,
    CellPlot,
    Force,
    InPlace,
    Out,
    PageFile,
    ProgramFile,
    with_options,
)

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..problems.improve.zones.changes import ZoneChange
    from ..problems.improve.zones.maximize import ZoneSolution

COLUMNS = (
    ("move", "right"),
    ("line", "left"),
    ("zone before", "right"),
    ("after", "right"),
    ("gained, s", "right"),
    ("no larger because of", "left"),
)


@with_options
def zones(
    program: ProgramFile,
    source: SourceOptions,
    options: ZoneOptions,
    out: Out = None,
    in_place: InPlace = False,
    unproven: Annotated[
        bool,
        typer.Option("--unproven", help="Write the program even if its clearance is not proven."),
    ] = False,
    plot: CellPlot = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Make zones as large as they can be without collision, and prove the new program.

    Of a station file the programs of all robots change, and are proven beside each other. The exit
    status is 1 if a new program is not proven to keep its clearance.
    """
    places = FilePlaces(out, in_place, [program, *source.inputs()], force)
    if is_station(program):
        refuse_given([], (), plot=plot, unproven=unproven)
        _station(program, source, options, places, json, report)
        return
    places.check()
    check_page(report, places.inputs, force)
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, places.inputs, force)
    with progress("reading the program") as say:
        read = read_for_robot(program, source, writes=places.anywhere)
        setup = setup_of_program(read)
        cell = setup.surroundings(read, no_floor=options.no_floor)
        made = zones_with(read, replace(options, report=say))
        delivery = deliver(made, setup, places, unproven)
        delivery = delivery.with_page(report, say, cell)
        if plot is not None:
            say("drawing")
            delivery = delivery.with_picture(plot, cell)
    if json:
        print_json(_json(made, cell, delivery.written))
    else:
        _tell(program, made, cell, delivery.written)
    delivery.end(told=not json)


def _station(
    file: Path,
    source: SourceOptions,
    options: ZoneOptions,
    places: FilePlaces,
    json: bool,
    page: Path | None,
) -> None:
    """Zones of all robots of a station."""
    from ..tasks.station.zones import StationZoneOptions, station_zones_with

    taken = ("keep", "free", "predefined", "own")
    refuse_given([source, options], taken)
    wanted = StationZoneOptions(**{name: getattr(options, name) for name in taken})
    changed_station(
        file, lambda say: station_zones_with(file, replace(wanted, report=say)), places, json, page
    )


def _tell(program: Path, made: ZoneSolution, cell: Cell, written: Sequence[Path]) -> None:
    changed = [
        ChangedMove(one.move, one.span, (zone_shown(one.before), zone_shown(one.after), one.limit))
        for one in made.zones
    ]
    rows = [
        (moves, line, *zones, gained, limit)
        for moves, line, (*zones, limit), gained in changed_rows(program, changed, made.gained)
    ]
    print_table(COLUMNS, rows)
    tell_solution(program, made, cell, written)


def _json(made: ZoneSolution, cell: Cell, written: Sequence[Path]) -> dict[str, Any]:
    zones = [_change_json(change, made.gained.get(change.move)) for change in made.zones]
    return {**solution_json(made, cell, written), "zones": zones}


def _change_json(change: ZoneChange, gained: float | None) -> dict[str, Any]:
    return {
        "move": change.move + 1,
        "before": zone_shown(change.before),
        "after": zone_shown(change.after),
        "clear_to": change.clear,
        "fails_at": change.fails,
        "limit": change.limit,
        "gained_s": gained,
        **place_json(change.span),
    }
