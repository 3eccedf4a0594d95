"""``flyby check``: what is odd about a program, with line, rule and fix."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from ..core.errors import FlybyError, MotionError, SourceError
from .console import print_json, print_rich, print_table, progress
from .loading import Source, robot_of, start_of
from .options import (
    AnswersFile,
    AsJson,
    CellFile,
    Entry,
    MotionFile,
    OtherFiles,
    ProgramFile,
    RobotName,
    Start,
)
from .places import place_json, short_place

if TYPE_CHECKING:
    from pathlib import Path

    from ..core.lint.finding import Finding
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

COLUMNS = (
    ("line", "right"),
    ("", "left"),
    ("rule", "left"),
    ("finding", "left"),
    ("what to do", "left"),
)


def check(
    program: ProgramFile,
    robot: RobotName = None,
    cell: CellFile = None,
    motion: MotionFile = None,
    entry: Entry = None,
    io: AnswersFile = None,
    others: OtherFiles = None,
    start: Start = None,
    json: AsJson = False,
) -> None:
    """Look for what goes wrong, or other than it seems: zones, limits, configurations, speeds.

    The exit status is 1 if there is an error among the findings.
    """
    from ..core.lint.finding import Severity

    with progress("checking the program"):
        vendor, arm = robot_of(robot, cell, motion)
        found = _findings(Source.of(program, entry, io, others, start), vendor, arm, start)
    if json:
        print_json({"robot": arm.name, "findings": [_json(finding) for finding in found]})
    else:
        _tell(program, found)
    if any(finding.severity is Severity.ERROR for finding in found):
        raise typer.Exit(1)


def _findings(
    source: Source, vendor: Vendor, robot: Robot, start: str | None
) -> tuple[Finding, ...]:
    from ..core.lint.check import check, unreadable

    stand = start_of(start, robot)
    try:
        parsed = source.read(vendor, robot)
    except FlybyError as error:
        # A text without a place is a wrong file or option, no finding in a program.
        if not isinstance(error, SourceError | MotionError) or error.span is None:
            raise
        return (unreadable(error),)
    return check(parsed, vendor, robot, stand)


def _tell(program: Path, found: tuple[Finding, ...]) -> None:
    if found:
        print_table(COLUMNS, [_row(program, finding) for finding in found])
    counts = [_counted(_count(found, kind), kind) for kind in _kinds(found)]
    print_rich(f"{program}: {', '.join(counts) if counts else 'nothing found'}")


def _counted(count: int, kind: str) -> str:
    return f"{count} {kind}" if count == 1 else f"{count} {kind}s"


def _kinds(found: tuple[Finding, ...]) -> list[str]:
    from ..core.lint.finding import Severity

    return [kind for kind in Severity if _count(found, kind)]


def _count(found: tuple[Finding, ...], kind: str) -> int:
    return sum(finding.severity == kind for finding in found)


def _row(program: Path, finding: Finding) -> tuple[str, ...]:
    line = short_place(program, finding.span)
    return line, str(finding.severity), finding.rule, finding.message, finding.fix


def _json(finding: Finding) -> dict[str, Any]:
    return {
        "rule": finding.rule,
        "severity": str(finding.severity),
        "message": finding.message,
        "fix": finding.fix,
        "move": None if finding.move is None else finding.move + 1,
        **place_json(finding.span),
    }
