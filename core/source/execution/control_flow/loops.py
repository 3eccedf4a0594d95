"""A loop of a program, and one execution of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Generic

from ....errors import Span
from ..host import Snapshot
from ..limits import Meter
from .steps import NOTHING, Block

_IDLE = 10
"""Passes in a row without a move, of a loop that a state drives, after which no more is read."""
_BOUNDS = {"<": 1.0, "<=": 1.0, ">": -1.0, ">=": -1.0}
"""Comparisons that let a loop go on: the sign of what is left up to the bound."""


def to_bound(symbol: str, counter: object, bound: object) -> float | None:
    """How far a counter is from the bound that it is compared with; None of what is no number."""
    sign = _BOUNDS.get(symbol)
    for value in (counter, bound):
        if not isinstance(value, int | float) or isinstance(value, bool):
            return None
    return None if sign is None else sign * (float(bound) - float(counter))  # type: ignore[arg-type]


def passes_to(start: object, stop: object, step: object) -> int | None:
    """How often a loop runs that counts; None where nothing but numbers would tell."""
    found = [one for one in (start, stop, step) if isinstance(one, int | float) and one == one]
    if len(found) < 3 or not found[2]:
        return None
    return max(0, math.floor((found[1] - found[0]) / found[2]) + 1)


def _nothing() -> None:
    pass


@dataclass(frozen=True, slots=True)
class Loop(Generic[Block]):
    """A loop.

    Args:
        body: what runs again and again.
        span: in whose line the user answers how often it runs.
        words: what messages call it, as the text does: ``WHILE TRUE``.
        reads: names of the data that its condition reads.
        asks: whether routines of the program have a part in its condition.
        writes: names of the data that the loop itself steps on.
        endless: whether no condition ends it.
        counts: whether it counts to an end by itself, whatever its body does.
        labels: that stand in it beside those of its body.
        distance: how far its condition is from ending it, as a number that falls to zero; None
            where it says nothing of that kind.
        ended: gives the data that its condition reads values with which it does not let the loop
            go on, for a loop that is left though they say that it goes on.
    """

    body: Block
    span: Span
    words: str
    reads: frozenset[str] = NOTHING
    asks: bool = False
    writes: frozenset[str] = NOTHING
    endless: bool = False
    counts: bool = False
    labels: frozenset[str] = NOTHING
    distance: Callable[[], float | None] = _nothing
    ended: Callable[[], None] = _nothing


@dataclass(frozen=True, slots=True)
class Start:
    """What had happened in a run when a loop began.

    Args:
        skips: branches that were not taken.
        asked: see `Outputs.mark`.
        moves: that were read.
        statements: in a row without a move, so far.
        driven: see `Meter.driven`.
    """

    skips: int
    asked: int
    moves: int
    statements: int
    driven: int = 0


@dataclass(slots=True)
class Passes(Generic[Block]):
    """One execution of a loop.

    Args:
        start: when it began.

    Attributes:
        mark: in what is asked of outputs: since when this pass runs.
        count: passes that have been read.
        most: passes to be read, once it is found that nobody knows.
        watched: names of the data that decide when it ends, as far as was known before this pass.
        written: names of the data that a pass may write.
        skips: branches that had not been taken when ``watched`` was found.
        looked: whether the state before this pass is known; it is not where a jump is met first.
        snapshot, turned, asked, place, held: this state: data, answers in turn, questions for the
            position, the position, and outputs.
        still: all data that a pass may write, while it has not moved the robot and might.
        begun: for each pass, how many moves had been read before it.
        left_to_others: whether outputs that its condition reads have just been left to others: it
            is to be asked again.
        distances: how far its condition was from ending it half way to `FORESEEN` passes, half way
            from there, and then.
        moved, row: how many moves had been read half way, and statements in a row without one.
        runs_out: whether it is foreseen that it counts to its end.
        left: passes that it has left, as was foreseen, where these are too many to be read; None
            if that was not foreseen.
        polled: whether what its motion depends on has been left to others.
        heads: where passes of one without an end began: how many moves had been read, how many
            statements had moved the robot, and the data that decide about its motion.
    """

    loop: Loop[Block]
    start: Start
    mark: int = field(init=False)
    count: int = 0
    most: int | None = None
    snapshot: Snapshot | None = None
    watched: frozenset[str] | None = NOTHING
    written: frozenset[str] = NOTHING
    skips: int = 0
    looked: bool = False
    turned: int = 0
    asked: int = 0
    place: object = None
    held: dict[str, bool | float] = field(default_factory=dict)
    still: Snapshot | None = None
    begun: list[int] = field(default_factory=list)
    left_to_others: bool = False
    polled: bool = False
    distances: list[float | None] = field(default_factory=list)
    moved: int = 0
    row: int = 0
    runs_out: bool = False
    left: float | None = None
    heads: list[tuple[int, int, Snapshot]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.mark = self.start.asked

    def is_under_way(self, meter: Meter, most: int) -> bool:
        """Whether a loop without an end has states of which not all have been passed: data that
        choose where to drive are others than before any pass, and the last one drove what none
        before it did, or did not drive. Of one that drove everything at once there are none.

        Args:
            most: how many of its statements move the robot.
        """
        heads = self.heads
        if len(heads) != self.count or not all(state.changed() for *_, state in heads):
            return False
        moves, driven, _ = heads[-1]
        if meter.moves == moves:
            return self.count <= _IDLE or heads[-_IDLE][0] < moves
        at_once = driven == self.start.driven and meter.driven >= driven + most
        return driven < meter.driven and not at_once

    def last_round(self) -> int | None:
        """The first pass of the last round of a loop: from where the data that choose where to
        drive were as they are now; None where they never were."""
        states = (state for *_, state in self.heads)
        return next((k for k, state in enumerate(states) if not state.changed()), None)
