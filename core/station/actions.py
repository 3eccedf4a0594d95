"""What a program does with signals and other robots on its way, and when on its own clock."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import IntArray
from ..dialect import SignalWords
from ..errors import InputError, Span
from ..motion.emulator.run import Run
from ..motion.geometry.pieces import WAYPOINT
from ..program.event import Event, EventAnchor
from ..program.move import Move, Opaque, Wait
from ..program.program import Program
from ..program.signal import Meet, SetSignal, SignalAction


@dataclass(frozen=True, slots=True)
class Action:
    """Something that a program does at a time of its own clock, waits for others left out.

    Args:
        does: a signal set, a condition or other robots waited for.
        time: s since it began.
        move: index of the move before; -1 before the first.
        text: as it stands in the source.
        span: where.
        earliest: s, when the program may be there already; None for not before `time`.
        statement: index of the statement of the program that it is, or happens on.
    """

    does: SignalAction | Meet
    time: float
    move: int
    text: str
    span: Span | None
    earliest: float | None = None
    statement: int = -1

    @property
    def soonest(self) -> float:
        """s, before which it is not done."""
        return self.time if self.earliest is None else self.earliest


class MeetingPoint(NamedTuple):
    """A statement at which a program waits for others.

    Args:
        does: which they are.
        move: index of the move before; -1 before the first.
        text: as it stands in the source.
        span: where.
    """

    does: Meet
    move: int
    text: str
    span: Span | None

    @property
    def said(self) -> str:
        """The statement with its line."""
        return self.text if self.span is None else f"{self.text} ({self.span})"


def meetings_of(program: Program, words: SignalWords | None) -> tuple[MeetingPoint, ...]:
    """Where a program waits for others, in its order.

    Args:
        program: driven or not.
        words: how its language says so; None if nobody knows, and nothing is found.

    Raises:
        InputError: one couples robots in a way that is not followed.
    """
    found: list[MeetingPoint] = []
    move = -1
    for statement in () if words is None else program.statements:
        if isinstance(statement, Move):
            move += 1
        elif isinstance(statement, Opaque):
            assert words is not None
            try:
                does = words.meets(statement.text)
            except InputError as error:
                where = "" if statement.span is None else f"{statement.span}: "
                raise InputError(f"{where}{error}") from None
            if does is not None:
                found.append(MeetingPoint(does, move, _in_a_line(statement.text), statement.span))
    return tuple(found)


def actions_of(run: Run, words: SignalWords | None) -> tuple[Action, ...]:
    """What a driven program does, in the order of its own clock.

    Outputs that are set at a fly-by point count at the zone's middle; the program may be there
    from where the zone begins. Waits count when the robot has come to rest; where it does not stop
    for them, as outputs do.

    Args:
        run: the whole program as driven.
        words: how its language says such things; None if nobody knows, and nothing is found.
    """
    if words is None:
        return ()
    places = _Places(run)
    found = [*_between(run, words, places), *_on_the_way(run, words, places)]
    return tuple(sorted(found, key=lambda action: action.time))


def _between(run: Run, words: SignalWords, places: _Places) -> Iterator[Action]:
    """Statements that stand between moves."""
    move, waited = -1, 0.0
    total = _waits(run)
    for index, statement in enumerate(run.program.statements):
        if isinstance(statement, Move):
            move, waited = move + 1, 0.0
        elif isinstance(statement, Wait):
            waited += statement.duration
        elif isinstance(statement, Opaque):
            does = words.meets(statement.text) or words.read(statement.text)
            if does is None:
                continue
            reached, left = places.of(move)
            time = max(reached, left - total.get(move, 0.0) + waited)
            ahead = isinstance(does, SetSignal) or not statement.stops
            earliest = places.entered(move) if ahead else time
            text = _in_a_line(statement.text)
            yield Action(does, time, move, text, statement.span, min(earliest, time), index)


class Stand(NamedTuple):
    """A target at which a program stops.

    Args:
        reached, left: s of its own clock.
        at: of a statement that it carries out there.
    """

    reached: float
    left: float
    at: float


def stand_of(run: Run, move: int, statement: int) -> Stand:
    """When a driven program stands at the end of a move, and is at a statement behind it.

    Args:
        run: the whole program as driven.
        move: its index.
        statement: index among the program's statements.
    """
    reached, left = _Places(run).of(move)
    waits: list[list[float]] = [[], []]
    count = -1
    for index, one in enumerate(run.program.statements):
        if isinstance(one, Move):
            count += 1
        elif isinstance(one, Wait) and count == move:
            waits[index > statement].append(one.duration)
    return Stand(reached, left, max(reached, left - sum(waits[1])))


def _waits(run: Run) -> dict[int, float]:
    """s of all waits behind each move."""
    found: dict[int, float] = {}
    move = -1
    for statement in run.program.statements:
        if isinstance(statement, Move):
            move += 1
        elif isinstance(statement, Wait):
            found[move] = found.get(move, 0.0) + statement.duration
    return found


def _on_the_way(run: Run, words: SignalWords, places: _Places) -> Iterator[Action]:
    """Events of moves."""
    for index, move in enumerate(run.program.moves):
        for event in move.events:
            does = words.read(words.event(event.text))
            if isinstance(does, SetSignal):
                time = places.passed(index, event)
                yield Action(does, time, index, _in_a_line(event.text), event.span)


def unknown_of(
    run: Run, words: SignalWords | None, names: Iterable[str]
) -> Iterator[tuple[str, Span | None]]:
    """Statements that name a signal, and of which nobody knows what they do to it.

    Args:
        run: the program as driven.
        words: how its language says such things; None if nobody knows, and nothing is found.
        names: of signals that others look at.
    """
    if words is None:
        return
    named = [re.escape("".join(name.split())) for name in names]
    one = re.compile(rf"(?<![\w$])(?:{'|'.join(named)})(?!\w)", re.IGNORECASE)
    told = [s for s in run.program.statements if isinstance(s, Opaque)]
    events = [event for move in run.program.moves for event in move.events]
    texts = [(s.text, s.text, s.span) for s in told]
    texts += [(event.text, words.event(event.text), event.span) for event in events]
    for text, meant, span in texts:
        bare = re.sub(r'"[^"]*"|\s', "", text)
        if words.read(meant) is None and named and one.search(bare):
            yield _in_a_line(text), span


class _Places:
    """When a run is at its waypoints, and at places before and behind them."""

    def __init__(self, run: Run) -> None:
        timing, route = run.timing, run.path.route
        segments = timing.interval_segments
        count = len(route.moves)
        first = np.searchsorted(segments, np.arange(count))
        last = np.searchsorted(segments, np.arange(count), "right") - 1
        driven = timing.start.driven
        self._moves = list(route.moves)
        self._reached = driven(timing.end[last])
        self._left = np.append(driven(timing.begin[first])[1:], run.duration)
        self._entered = driven(np.append(timing.begin, timing.end[-1])[_zone_begins(run)])
        self._begun = float(driven(timing.begin[first[:1]])[0])
        trajectory = run.trajectory
        steps = np.linalg.norm(np.diff(trajectory.position, axis=0), axis=1)
        self._t, self._way = trajectory.t, np.append(0.0, np.cumsum(steps))

    def of(self, move: int) -> tuple[float, float]:
        """When the end of a move is reached, and left, s; of -1 the start."""
        k = bisect_right(self._moves, move) - 1
        if k < 0:
            return 0.0, self._begun
        return float(self._reached[k]), float(self._left[k])

    def entered(self, move: int) -> float:
        """When the zone at the end of a move begins, s; at a stop when that is reached."""
        k = bisect_right(self._moves, move) - 1
        if k < 0:
            return self.of(move)[0]
        return min(float(self._entered[k]), float(self._reached[k]))

    def passed(self, move: int, event: Event) -> float:
        """When the place of an event is passed, s."""
        begin, end = self.of(move - 1)[1], self.of(move)[0]
        at, step = (begin, 1.0) if event.anchor is EventAnchor.START else (end, -1.0)
        way = float(np.interp(at, self._t, self._way)) + step * event.distance
        k = int(np.searchsorted(self._way, way, "right" if step > 0 else "left"))
        inside = 0 < k < len(self._way)
        if event.distance > 0.0 and inside:
            at = float(np.interp(way, self._way[k - 1 : k + 1], self._t[k - 1 : k + 1]))
        return max(min(max(at, begin), max(end, begin)) - event.time, 0.0)


def _zone_begins(run: Run) -> IntArray:
    """(M,), the knot of the path at which the zone at the end of each segment begins."""
    pieces = run.path.pieces
    _, first = np.unique(pieces.source[:, 0], return_index=True)
    # Where zones touch, their common edge counts as the end of the first.
    shared = (pieces.source[first, 1] == WAYPOINT) & ~pieces.stop[first]
    return np.asarray(pieces.first_interval[(first - shared)[1:]])


def _in_a_line(text: str) -> str:
    return " ".join(text.split()).rstrip(";")
