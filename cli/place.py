"""``flyby place``: where a robot stands best for a program."""

from __future__ import annotations

from dataclasses import replace

import typer

from ..tasks.read import SourceOptions
from ..tasks.station.place import PlaceOptions, place_with, station_place_with
from .output.changed_station import is_station, refuse_given
from .output.console import print_json, print_rich, print_table, progress, warn_of
from .output.told_robot import read_for_robot
from .parameters import AsJson, ProgramFile, with_options


@with_options
def place(
    program: ProgramFile,
    source: SourceOptions,
    options: PlaceOptions,
    json: AsJson = False,
) -> None:
    """Find the base from which the program is driven fastest, all targets in reach, and prove it.

    Targets stay where they are in the world. Of a station file --of names the robot; it keeps clear
    of the others, too. The exit status is 1 if no base is proven.
    """
    with progress("reading the program") as say:
        if is_station(program):
            refuse_given([source], ())
            made = station_place_with(program, replace(options, report=say))
        else:
            made = place_with(read_for_robot(program, source), replace(options, report=say))
    if json:
        print_json(made.as_json())
    else:
        from ..tasks.station.placed import COLUMNS

        print_table(COLUMNS, made.rows())
        warn_of(made.notes)
        found = made.found
        print_rich(
            f"{program}: of {found.looked} bases {found.reached} have all targets in reach, "
            f"{found.emulated} were driven from"
        )
        if made.order:
            print_rich(f"tasks: {', '.join(made.order)}")
        print_rich(made.line or "no base is proven to keep the clearance")
    if not made.proven:
        raise typer.Exit(1)
