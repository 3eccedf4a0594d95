"""Zones of all robots of a station as large as their cells and the other robots let them be."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..options.entries import switch
from ..options.keywords import by_keywords
from ..zones import ZoneOptions, zones_beside
from .changing import Share, StationChangeOptions, changed_station

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...problems.improve.solve_round_verify import Beside
    from ...problems.improve.zones.maximize import ZoneSolution
    from .changed import ChangedStation


@dataclass(frozen=True, kw_only=True)
class StationZoneOptions(StationChangeOptions):
    """How zones of a station are made larger."""

    predefined: bool = switch("Choose among the vendor's predefined zones.")


def station_zones_with(source: str | Path, options: StationZoneOptions) -> ChangedStation:
    """Make the zones of all robots of a station as large as they can be, and prove the station.

    Args:
        source: a station file.

    Returns:
        The new programs, read back from their texts, proven each in its cell and beside the others.

    Raises:
        InputError: a file cannot be read, or an option names nothing.
        MotionError: the station never ends, or does not keep its clearances, as it is.
    """

    def larger(program: Program, share: Share, beside: Beside) -> ZoneSolution:
        wanted = ZoneOptions(
            keep=share.keep,
            free=share.free,
            predefined=options.predefined,
            own=options.own,
            report=options.report,
        )
        return zones_beside(program, wanted, beside)

    return changed_station(source, options, larger)


station_zones = by_keywords(station_zones_with, StationZoneOptions)
