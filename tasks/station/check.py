"""What is odd about the programs of a station, each by itself and beside the others."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..check import CheckOptions, check_with
from ..options.keywords import by_keywords
from .station import StationOptions, station_with
from .taken import carried_out

if TYPE_CHECKING:
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
        found[name] = Findings(
            # What the station carries out is nothing odd.
            finding
            for finding in check_with(member.program, CheckOptions())
            if finding.rule != _READER
            or not carried_out(member, driven.actions[name], finding.span)
        )
    return StationFindings(driven, found)


station_check = by_keywords(station_check_with, StationCheckOptions)
