"""Several robots in one cell: times, who waits for whom, and proven clearances to each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import switched
from ...core.errors import InputError, Note, OptionError
from ..options.entries import MILLISECONDS, Extent, TaskOptions, number, switch
from ..options.keywords import by_keywords
from .opening import open_station

if TYPE_CHECKING:
    from ...core.station.clearances import PairClearance, StationProver
    from ...core.station.clock import StationRun
    from ...core.station.interlocks import Saving
    from ...core.station.passing import Passed
    from ..results.stations import DrivenStation

JITTER = 50.0
"""ms, as it is typed."""
_UNSURE = (
    "the jitter says at many waits behind zones whether the robot stops there or passes: in time "
    "no more is proven than at any time"
)

_FIRST = (
    "which robot comes first hangs on less than the jitter: in time is what is proven of each order"
)
_SHAPELESS = (
    "{}: its cell has no shape of what it turns, and nothing is said of its clearances: give the "
    "table and what lies on it as [[obstacle]] with carried_by"
)


@dataclass(frozen=True, kw_only=True)
class StationOptions(TaskOptions):
    """What is asked of a station."""

    jitter: float = number(
        JITTER,
        "{unit} by which each robot may be early or late when clearances are proven in time.",
        MILLISECONDS,
        Extent(0.0, 10_000.0),
    )
    no_proof: bool = switch("Only run the station: prove no clearances.")
    interlocks: bool = switch(
        "Look for waits that could go and outputs that could be set earlier, proven in every order."
    )


def station_with(
    source: str | Path | Sequence[str | Path], options: StationOptions
) -> DrivenStation:
    """Run the programs of several robots on one clock, and prove that they keep clear.

    Args:
        source: a station file, or backups: one of several robots, or several.

    Raises:
        InputError: a file cannot be read, or joins signals that are not there.
        MotionError: a move of a program cannot be driven.
    """
    from ...core.station.awaited import bearing
    from ...core.station.clearances import StationProver
    from ...core.station.clock import StationClock
    from ...core.station.deadlock import deadlock
    from ...core.station.early_late import other_orders
    from ...core.station.interlocks import savings
    from ...core.station.orders import explore
    from ...core.station.passing import passed_in_time
    from ..results.stations import DrivenStation

    if options.no_proof and options.interlocks:
        raise OptionError(
            f"{switched('interlocks')} rests on proofs, which {switched('no_proof')} leaves out"
        )
    opened = open_station(source, options.say, proven=not options.no_proof)
    station, actions = opened.station, opened.actions
    options.say("running all programs on one clock")
    clock = StationClock(station, actions)
    run = clock.run()
    stuck = deadlock(station, run, actions, clock)
    notes = [*opened.notes, *opened.unknown, *run.notes]
    orders, ordered = None, bearing(station, actions)
    try:
        orders = None if opened.unknown else explore(station, ordered)
    except InputError as error:
        notes.append(Note(str(error)))
    clearances = []
    if not options.no_proof:
        options.say("sweeping motions")
        prover = StationProver(station, ordered)
        clearances = prover.all(run, options.jitter, orders, options.say)
        notes += [Note(_SHAPELESS.format(name)) for name in prover.shapeless]
        quicker = passed_in_time(station, actions, options.jitter)
        if quicker is None:
            # Any of the paths may be driven then.
            clearances = [replace(pair, in_time=pair.any_time) for pair in clearances]
            notes.append(Note(_UNSURE))
        others = other_orders(station, actions, run, options.jitter)
        for other in others:
            clearances = _both(clearances, prover, other, options.jitter)
        for passed in quicker or ():
            options.say("the same where robots pass through zones that waits stand behind")
            through = _prover_of(passed)
            more = other_orders(passed.station, passed.actions, passed.run, options.jitter)
            for other in (passed.run, *more):
                clearances = _both(clearances, through, other, options.jitter)
            others += more
        if others:
            notes.append(Note(_FIRST))
    found: list[Saving] = []
    if options.interlocks and orders is not None and clearances:
        options.say("looking for interlocks that hold robots up needlessly")
        if any(member.passing is not None for member in station.members.values()):
            why = (
                "interlocks that could be shorter are not looked for where waits stand behind zones"
            )
            notes.append(Note(why))
        else:
            found = savings(station, ordered, prover, clearances, orders)
    return DrivenStation(
        station,
        actions,
        run,
        stuck,
        orders,
        tuple(clearances),
        options.jitter,
        tuple(found),
        tuple(notes),
    )


def _prover_of(passed: Passed) -> StationProver:
    """Of robots that pass through zones, which then are their only paths."""
    from ...core.station.awaited import bearing
    from ...core.station.clearances import StationProver

    station, actions, _ = passed
    bare = {name: replace(robot, passing=None) for name, robot in station.members.items()}
    return StationProver(replace(station, members=bare), bearing(station, actions))


def _both(
    clearances: Sequence[PairClearance], prover: StationProver, run: StationRun, jitter: float
) -> list[PairClearance]:
    """Clearances in time of both: as they are known, and of another run."""
    found = []
    for pair in clearances:
        other, least, at = prover.in_time(*pair.robots, run, jitter)
        if pair.in_time.proven and not other.proven:
            pair = replace(pair, in_time=other)
        if least < pair.least:
            pair = replace(pair, least=least, least_at=at)
        found.append(pair)
    return found


station = by_keywords(station_with, StationOptions)
