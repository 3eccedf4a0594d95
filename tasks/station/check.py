"""What is odd about the programs of a station, each by itself and beside the others."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..check import CheckOptions, check_with
from ..options.keywords import by_keywords
from ..setup import setup_of_program
from .station import StationOptions, station_with

if TYPE_CHECKING:
    from ...core.errors import Span
    from ...core.station.station import StationRobot
    from .findings import StationFindings


_READER = "reader"
"""The rule that says what is kept and not carried out."""


@dataclass(frozen=True, kw_only=True)
class StationCheckOptions(StationOptions):
    """How a station is checked."""


def station_check_with(source: str | Path, options: StationCheckOptions) -> StationFindings:
    """Check the programs of a station, and what they do beside each other.

    Args:
        source: a station file.

    Returns:
        The findings in each program, and those of the station.

    Raises:
        InputError: a file cannot be read, or joins signals that are not there.
        MotionError: a move of a program cannot be driven.
    """
    from ..results.findings import Findings
    from .findings import StationFindings

    driven = station_with(source, options)
    found = {}
    for name, member in driven.station.members.items():
        options.say(f"checking {name}")
        known = {action.span for action in driven.actions[name]}
        found[name] = Findings(
            # What the station carries out is nothing odd.
            finding
            for finding in check_with(member.program, CheckOptions())
            if finding.rule != _READER
            or not (finding.span in known or _answered(member, finding.span))
        )
    return StationFindings(driven, found)


def _answered(member: StationRobot, span: Span | None) -> bool:
    """Whether the station knows what a program by itself leaves open at a place: with which moves
    of others one is made together, and what turns its work object."""
    from ...core.source.reading import Reading

    reading = member.program.reading
    if span is None or not isinstance(reading, Reading) or span.file not in reading.files:
        return False
    text = reading.files[span.file].text[span.start : span.end]
    speaks = setup_of_program(member.program).vendor.speaks
    words = None if speaks is None else speaks.signals
    if words is not None and words.together is not None and words.together(text) is not None:
        return True
    turned = {axis for moves in member.carried for axis in moves.axes.values()}
    frames = (move.work_object for move in member.program.moves)
    return text.casefold() in {f.name.casefold() for f in frames if f.moved_by in turned}


station_check = by_keywords(station_check_with, StationCheckOptions)
