"""Loops that a state drives: each pass goes the way that data choose which the one before has set.

They are read until the state comes back: that is their cycle.
"""

from __future__ import annotations

from typing import Generic

from ....display import counted
from ....door import given, spelt
from ....program.cycle import Cycle
from ..host import Host
from .analysis import Analysis
from .loops import Head, Loop, Passes, Start
from .steps import NOTHING, Block

FOLLOWED = 100
"""Passes of a loop without a condition that gets on and moves the robot, after which a way out is
taken that nobody can decide, and no more states are followed."""
_IDLE = 10
"""Passes in a row without a move after which no more is read."""


class LoopStates(Generic[Block]):
    """Follows the states of the loops of one run.

    Args:
        analysis: of the program's statements.
        host: the run.
    """

    def __init__(self, analysis: Analysis[Block], host: Host) -> None:
        self._analysis = analysis
        self._host = host

    def _names(self, loop: Loop[Block]) -> frozenset[str]:
        """Of the data by which a pass chooses its way, and that passes write."""
        return self._analysis.choosing(loop.body) & self._analysis.written(loop.body)

    def look(self, passes: Passes[Block]) -> None:
        """A pass has begun: remember what decides which of its ways the robot is driven."""
        if passes.loop.counts or passes.count >= FOLLOWED:
            return
        names = self._names(passes.loop)
        if names:
            asked = (passes.watched or NOTHING) - self._analysis.set_first(passes.loop.body)
            names |= asked & passes.written
            passes.heads[-1].state = self._host.snapshot(names, passes.written)

    def come_round(self, passes: Passes[Block]) -> bool:
        """Whether all that decides about the passes of a loop is as it was before one of them."""
        return passes.watched is not None and passes.last_round() is not None

    def are_under_way(self, passes: Passes[Block]) -> bool:
        """Whether not all states of a loop without an end have been passed: the data are others
        than before any pass, and the last one drove what none before it did, or did not drive. Of
        one that drove everything at once there are none."""
        loop, heads, meter = passes.loop, passes.heads, self._host.meter
        if not self._names(loop) or len(passes.states()) < passes.count - passes.unseen:
            return False
        if passes.last_round() is not None:
            return False
        last = heads[-1] if heads else passes.start
        if meter.moves == last.moves:
            return len(heads) <= _IDLE or heads[-_IDLE].moves < last.moves
        every = last.driven + self._analysis.way_count(loop.body)
        at_once = last.driven == passes.start.driven and meter.driven >= every
        return last.driven < meter.driven and not at_once

    def _cycle(self, passes: Passes[Block]) -> tuple[Head | Start, int]:
        """Where the last cycle began, and how many passes it has: those since the state was what it
        is, or the last one."""
        count, first = len(passes.heads), passes.last_round()
        last = max(count - 1, 0) if first is None else first
        return passes.heads[last] if passes.heads else passes.start, max(count - last, 1)

    def closes(self, passes: Passes[Block]) -> bool:
        """Whether the last cycle began where later ones do: in one before it, or at its own end."""
        begun, _ = self._cycle(passes)
        return begun.moves > passes.start.moves or begun.place == self._host.place

    def tell_cycle(self, passes: Passes[Block]) -> None:
        """What a cycle of a loop is that production runs in."""
        host, (begun, length) = self._host, self._cycle(passes)
        end = host.meter.moves
        if end > begun.moves:
            host.course.cycle = Cycle(begun.moves, end, passes.count, passes.loop.span, length)
            if not self.closes(passes):
                self._say_place(passes, begun.place is None)

    def _say_place(self, passes: Passes[Block], unknown: bool) -> None:
        """Say that the cycle that was read does not begin where later ones do."""
        span = passes.loop.span
        where = "where nobody knows" if unknown else "where the robot stood before the loop"
        more = given("cycles", str(passes.count + 1))
        self._host.note_once(
            f"closes {span.file}:{span.start}",
            f"the first cycle of the loop ({passes.loop.words}) begins {where}, and the next one "
            f"where this one ends: its time may be another ({more} reads it)",
            span,
        )

    def say(self, passes: Passes[Block], words: str) -> None:
        """Say where the state has not come back.

        Args:
            words: what messages call the loop.
        """
        span = passes.loop.span
        if not passes.states() or passes.last_round() is not None:
            return
        self._host.note_once(
            f"state {span.file}:{span.start}",
            f"what a pass of the loop {words} does depends on {named(self._names(passes.loop))}, "
            "whose value has not come back: the next pass may go another way, and no cycle is "
            f"known; more are read with {spelt('cycles')}",
            span,
        )


def named(names: frozenset[str]) -> str:
    """Some data, shortly."""
    first, *more = sorted(names)
    return first if not more else f"{first} and {counted(more, 'other datum', 'other data')}"
