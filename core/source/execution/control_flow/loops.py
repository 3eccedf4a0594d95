"""A loop of a program, and one execution of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Generic

from ....errors import Span
from ..host import Snapshot
from .steps import NOTHING, Block

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
        place: where the robot stood.
    """

    skips: int
    asked: int
    moves: int
    statements: int
    driven: int = 0
    place: object = None


@dataclass(slots=True)
class Head:
    """Where a pass of a loop began.

    Args:
        moves: that had been read.
        driven: see `Meter.driven`.
        place: where the robot stood.
        state: the data that choose the way of a pass; None if there are none, or are too many.
    """

    moves: int
    driven: int
    place: object
    state: Snapshot | None = None


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
        left_to_others: whether outputs that its condition reads have just been left to others: it
            is to be asked again.
        distances: how far its condition was from ending it half way to `FORESEEN` passes, half way
            from there, and then.
        moved, row: how many moves had been read half way, and statements in a row without one.
        runs_out: whether it is foreseen that it counts to its end.
        left: passes that it has left, as was foreseen, where these are too many to be read; None
            if that was not foreseen.
        polled: whether what its motion depends on has been left to others.
        supposed: what the number of its passes depends on, where a way is chosen by rule; empty if
            on nothing.
        unseen: passes of which nobody saw how they began: the first one of a loop that a jump
            closes, which shows itself at its end.
        heads: where the others began.
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
    left_to_others: bool = False
    polled: bool = False
    distances: list[float | None] = field(default_factory=list)
    moved: int = 0
    row: int = 0
    runs_out: bool = False
    left: float | None = None
    heads: list[Head] = field(default_factory=list)
    supposed: str = ""
    unseen: int = 0

    def __post_init__(self) -> None:
        self.mark = self.start.asked

    def suppose(self, reason: str) -> None:
        """The number of its passes depends on something; nothing if ``reason`` is empty."""
        self.supposed = self.supposed or reason

    def states(self) -> list[Snapshot]:
        """The state before each pass; none if one of them is not known."""
        found = [head.state for head in self.heads if head.state is not None]
        return found if len(found) == len(self.heads) else []

    def last_round(self) -> int | None:
        """The first pass of the last round of a loop: from where its state was as it is now; None
        where it never was."""
        states = self.states()
        back = range(len(states) - 1, -1, -1)
        return next((k for k in back if not states[k].changed()), None)
