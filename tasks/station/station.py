"""Several robots in one cell: times, who waits for whom, and proven clearances to each other."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.errors import InputError, Note
from ..options.entries import MILLISECONDS, Extent, TaskOptions, number, switch
from ..options.keywords import by_keywords
from .opening import open_station

if TYPE_CHECKING:
    from ..results.stations import DrivenStation

_JITTER = 50e-3


@dataclass(frozen=True, kw_only=True)
class StationOptions(TaskOptions):
    """What is asked of a station."""

    jitter: float = number(
        _JITTER,
        "{unit} by which each robot may be early or late when clearances are proven in time.",
        MILLISECONDS,
        Extent(0.0, 10_000.0),
    )
    no_proof: bool = switch("Only run the station: prove no clearances.")


def station_with(source: str | Path, options: StationOptions) -> DrivenStation:
    """Run the programs of several robots on one clock, and prove that they keep clear.

    Args:
        source: a station file.

    Raises:
        InputError: a file cannot be read, or joins signals that are not there.
        MotionError: a move of a program cannot be driven.
    """
    from ...core.station.clearances import StationProver
    from ...core.station.clock import StationClock
    from ...core.station.deadlock import deadlock
    from ...core.station.orders import explore
    from ..results.stations import DrivenStation

    station, actions = open_station(Path(source), options.say)
    options.say("running all programs on one clock")
    clock = StationClock(station, actions)
    run = clock.run()
    stuck = deadlock(station, run, actions, clock)
    notes = [*run.notes]
    orders = None
    try:
        orders = explore(station, actions)
    except InputError as error:
        notes.append(Note(str(error)))
    clearances = []
    if not options.no_proof:
        options.say("sweeping motions")
        prover = StationProver(station, actions)
        clearances = prover.all(run, options.jitter, orders, options.say)
    return DrivenStation(
        station, actions, run, stuck, orders, tuple(clearances), options.jitter, tuple(notes)
    )


station = by_keywords(station_with, StationOptions)
