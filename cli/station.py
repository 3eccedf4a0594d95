"""``flyby station``: several robots on one clock, and their clearances to each other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..tasks.files.outputs import check_outputs, picture_kind, write_all
from ..tasks.pages.file import check_page, write_page
from ..tasks.station.station import StationOptions, station_with
from .output.console import fail, print_json, print_rich, print_table, progress, warn
from .parameters import AsJson, Force, PageFile, with_options

if TYPE_CHECKING:
    from ..tasks.results.stations import DrivenStation

StationFiles = Annotated[
    list[Path],
    typer.Argument(help="Station file (TOML), or backups: one of several robots, or several."),
]


@with_options
def station(
    files: StationFiles,
    options: StationOptions,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", help="Draw moves, waits and signals over time: PNG, PDF or SVG."),
    ] = None,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Run several robots on one clock: who waits for whom, and whether they keep clear.

    The exit status is 1 if the station never ends, or is proven to keep its clearance neither in
    time nor in every order that the signals allow.
    """
    if plot is not None:
        picture_kind(plot, "--plot")
    check_outputs({"--plot": plot}, files, replace_existing=force)
    check_page(report, files, force)
    with progress("reading the station") as say:
        made = station_with(files, replace(options, report=say))
        if plot is not None:
            write_all("--plot", {plot: made.picture(picture_kind(plot, "--plot"))})
        written = write_page(report, made)
    if json:
        print_json(made.as_json())
    else:
        _tell(made)
        if plot is not None:
            print_rich(f"wrote {plot}")
        for path in written:
            print_rich(f"wrote {path}")
    if made.deadlock is not None or not made.clear:
        raise typer.Exit(1)


def _tell(made: DrivenStation) -> None:
    from ..tasks.results.stations import PAIRS, ROBOTS, SAVINGS, WAITS

    print_table(ROBOTS, made.robot_rows())
    if rows := made.wait_rows():
        print_table(WAITS, rows)
    if rows := made.pair_rows():
        print_table(PAIRS, rows)
    if rows := made.saving_rows():
        print_table(SAVINGS, rows)
    if made.deadlock is None:
        print_rich(f"station time {made.duration:.3f} s; {made.bottleneck} ends last")
    for note in made.notes:
        warn(str(note))
    for finding in made.findings():
        fail(finding)
