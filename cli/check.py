"""``flyby check``: what is odd about a program, with line, rule and fix."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ..core.errors import FlybyError, OptionError
from ..tasks.check import CheckOptions, check_with, unread
from ..tasks.files.source_places import place_json
from ..tasks.pages.file import check_page, write_page
from ..tasks.read import SourceOptions
from ..tasks.setup import setup_of, setup_of_program
from ..tasks.station.check import StationCheckOptions, station_check_with
from .output.changed_station import is_station, refuse_given
from .output.console import fail, print_json, print_rich, print_table, progress
from .output.told_robot import read_for_robot
from .parameters import AsJson, Force, PageFile, ProgramFile, with_options

if TYPE_CHECKING:
    from ..core.lint.finding import Finding
    from ..core.program.program import Program
    from ..tasks.results.findings import Findings


@with_options
def check(
    program: ProgramFile,
    source: SourceOptions,
    options: CheckOptions,
    report: PageFile = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Look for what goes wrong, or other than it seems: zones, limits, configurations, speeds.

    Of a station file all programs are checked, by themselves and beside each other. The exit status
    is 1 if there is an error among the findings.
    """
    if is_station(program):
        refuse_given([source, options], ())
        if report is not None:
            raise OptionError("--report does not go with a station: 'flyby station' makes its page")
        _station(program, json)
        return
    check_page(report, [program, *source.inputs()], force)
    with progress("checking the program") as say:
        read, robot, found = _findings(program, source, options)
        if report is not None:
            say("making the page")
        written = write_page(report, found, program=read)
    if json:
        print_json({"robot": robot, "findings": [_json(finding) for finding in found]})
    else:
        _tell(program, found)
        for path in written:
            print_rich(f"wrote {path}")
    if found.errors:
        raise typer.Exit(1)


def _station(file: Path, json: bool) -> None:
    """All programs of a station."""
    with progress("checking the station") as say:
        found = station_check_with(file, StationCheckOptions(report=say))
    if json:
        robots = {name: [_json(f) for f in one] for name, one in found.robots.items()}
        print_json({"station": found.driven.as_json(), "findings": robots})
    else:
        for name, one in found.robots.items():
            _tell(Path(found.driven.station.members[name].program.name), one)
        for finding in found:
            fail(finding)
        keeps = "its robots are proven to keep clear of each other"
        print_rich(f"{file}: {'see above' if found.errors else keeps}")
    if found.errors:
        raise typer.Exit(1)


def _findings(
    program: Path, source: SourceOptions, options: CheckOptions
) -> tuple[Program | None, str | None, Findings]:
    """The program, None if it cannot be read; the robot's name, None of a backup that cannot be
    read; and what is found."""
    named = source.robot is not None or source.cell is not None
    robot = setup_of(source).robot.name if named else None
    try:
        read = read_for_robot(program, source, told=False)
    except OptionError:
        raise
    except FlybyError as error:
        return None, robot, unread(error)
    return read, setup_of_program(read).robot.name, check_with(read, options)


def _tell(program: Path, found: Findings) -> None:
    from ..tasks.results.findings import COLUMNS

    if found:
        print_table(COLUMNS, found.rows(program))
    print_rich(f"{program}: {found.said}")


def _json(finding: Finding) -> dict[str, Any]:
    return {
        "rule": finding.rule,
        "severity": str(finding.severity),
        "message": finding.message,
        "fix": finding.fix,
        "move": None if finding.move is None else finding.move + 1,
        **place_json(finding.span),
    }
