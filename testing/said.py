"""Hypothesis strategies of what a dialect has words for: zones, speeds, events."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from hypothesis import strategies as st

from ..core.dialect import Dialect, MoveWords, OutputWords
from ..core.program.arc_orientation import ArcOrientation
from ..core.program.event import Event, EventAnchor
from ..core.program.move import Move, MoveC, MoveJ, MoveL
from ..core.program.speed import Speed
from ..core.program.zone import FINE, ContourFraction, Radius, Zone, ZoneKind
from .strategies import radii

DRIVEN_ZONES = (Radius, ContourFraction)
"""Kinds that the checks of driven paths know the reach of."""
DRIVEN_SPEEDS = ("tcp", "reorientation", "acceleration_override")
"""Numbers that programs are driven with beside those that must be stated."""
_INSTEAD = "duration"
"""A time takes the place of speeds in some languages, and stands beside them in others."""
_SMALLEST, _LARGEST = 0.01, 5.0
_PERCENT = st.integers(1, 100).map(lambda percent: percent / 100)


def words_of(spoken: Dialect, kind: type[Move]) -> MoveWords:
    """What a dialect says of a kind of move."""
    return {MoveJ: spoken.joint, MoveL: spoken.line, MoveC: spoken.arc}[kind]


def kinds_in(spoken: Dialect) -> tuple[type[Move], ...]:
    """The kinds of move that a dialect has words for."""
    return (MoveJ, MoveL, MoveC) if spoken.arc_orientations else (MoveJ, MoveL)


def arcs_in(spoken: Dialect) -> st.SearchStrategy[ArcOrientation]:
    """How the tool turns along arcs; one that follows an arc rigidly would have to end turned."""
    if spoken.rigid_arcs or not spoken.arc_orientations:
        return st.just(ArcOrientation.FIXED_FRAME)
    return st.sampled_from(sorted(spoken.arc_orientations))


def zones_in(spoken: Dialect, kinds: tuple[type[Zone] | ZoneKind, ...]) -> st.SearchStrategy[Zone]:
    """Stops, and zones of some kinds."""
    found: list[st.SearchStrategy[Zone]] = [st.just(FINE)]
    for kind in kinds:
        found.append(_radii(spoken) if kind is Radius else _others(kind))
    return st.one_of(found)


def _radii(spoken: Dialect) -> st.SearchStrategy[Zone]:
    if spoken.zone_parts:
        return radii()
    return radii().map(lambda zone: Radius(zone.tcp, zone.tcp, zone.tcp))


def _others(kind: type[Zone] | ZoneKind) -> st.SearchStrategy[Zone]:
    """Shares, and angles up to a rad: what other kinds of zone have is one number."""
    if isinstance(kind, ZoneKind):
        return _of_own_kind(kind)
    return _PERCENT.map(lambda share: kind(share))  # type: ignore[call-arg, arg-type]


def _of_own_kind(kind: ZoneKind) -> st.SearchStrategy[Zone]:
    """Sizes as they are written: distances up to 5 cm, shares up to the largest."""
    if kind.sizes:
        return st.sampled_from(kind.sizes).map(kind.sized)
    largest = min(kind.largest, 0.05) if kind.reach is None else kind.largest
    step = kind.step or kind.unit
    most = math.floor(largest / step + 1e-9)
    return st.integers(1, most).map(lambda steps: kind.sized(kind.rounded(steps * step)))


def speeds_in(spoken: Dialect, words: MoveWords, driven: bool = False) -> st.SearchStrategy[Speed]:
    """Speeds of a kind of move.

    Args:
        spoken: what it says of greatest numbers.
        words: of the kind of move.
        driven: whether programs are driven with them: numbers are moderate, and few.
    """
    instead = {_INSTEAD} - words.exclusive
    more = words.speeds & {*DRIVEN_SPEEDS} if driven else words.speeds - instead
    chosen = words.needs | more
    alone = sorted(chosen & words.exclusive) or [""]
    return st.one_of(
        [_built(spoken, words, chosen - (words.exclusive - {one}), driven) for one in alone]
    )


def _built(
    spoken: Dialect, words: MoveWords, names: frozenset[str], driven: bool
) -> st.SearchStrategy[Speed]:
    parts: Mapping[str, st.SearchStrategy[float | None]] = {
        name: _numbers(spoken, name, driven, name not in words.needs and not driven)
        for name in sorted(names)
    }
    return st.builds(Speed, **parts)


def _numbers(
    spoken: Dialect, name: str, driven: bool, optional: bool
) -> st.SearchStrategy[float | None]:
    most = spoken.most.get(name, _LARGEST)
    if name == "acceleration_override":
        share = round(100 * min(most, 2.0 if driven else most))
        return st.integers(20, share).map(lambda percent: percent / 100)
    if "fraction" in name:
        least = 1 if name == "joint_fraction" else round(100 * spoken.least_acceleration_share)
        return st.integers(least, 100).map(lambda percent: percent / 100)
    if driven and name == "tcp":
        highest = round(1000 * min(3.0, spoken.fastest))
        return st.integers(5, highest).map(lambda mm: mm / 1000)
    if driven and name == "reorientation":
        highest = min(500, math.floor(math.degrees(spoken.most.get(name, 10.0))))
        return st.integers(5, highest).map(math.radians)
    if name == "tcp":
        most = min(most, spoken.fastest)
    number = st.floats(_SMALLEST, most)
    return st.none() | number if optional else number


def events_in(outputs: OutputWords | None, name: str) -> st.SearchStrategy[tuple[Event, ...]]:
    """Up to two events that set an output; none where a language sets none on the way.

    Args:
        outputs: how they are set.
        name: of the output, as the language spells it.
    """
    if outputs is None:
        return st.just(())
    leads = st.integers(0, math.floor(1e3 * min(0.2, outputs.longest_lead)))
    one = st.builds(
        Event,
        text=st.booleans().map(lambda on: outputs.switch(name, on)),
        anchor=st.sampled_from(EventAnchor) if outputs.from_start else st.just(EventAnchor.END),
        distance=st.integers(0, 8).map(lambda mm: mm / 1000),
        time=leads.map(lambda ms: ms / 1000),
    )
    return st.lists(one, max_size=2).map(tuple)


def with_events(move: Move, events: tuple[Event, ...], outputs: OutputWords | None) -> Move:
    """The move with those of the events that its language has a place for."""
    taken = [] if outputs is None else [e for e in events if outputs.takes(e, move)]
    most = 0 if outputs is None else min(outputs.most, len(taken))
    return replace(move, events=tuple(taken[: int(most)]))
