"""Changes of a program that bring nothing are taken back: nobody wants to explain them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ...changes import Change, changes_of, with_changes
from ..gains import seconds_gained
from .via_selection import Counted

BRINGS_NOTHING = 5e-4
"""s; a waypoint's gain below which its change is tried without: of 4 ms an eighth."""
_LOST = 1e-4
"""Share of the objective that all that is taken back may cost together."""
_TRIALS = 16


def without_idle_changes(
    given: Run, found: Counted, judged: Callable[[Program], Counted | None]
) -> Counted:
    """A proven program without those of its changes that bring nothing.

    Args:
        given: the program as it was.
        found: with all changes.
        judged: a program with its proof and cost; None if it does not hold.
    """
    old, new = given.program, found.run.program
    if [move.origin for move in old.moves] != [move.origin for move in new.moves]:
        return found
    changes = changes_of(old, new)
    gained = seconds_gained(given, found.run)

    def gain(change: Change) -> float:
        return max(gained.get(i, 0.0) for i, _ in change)

    idle = sorted((c for c in changes if gain(c) < BRINGS_NOTHING), key=gain)
    return _TakingBack(old, new, changes, found, judged).without(idle)


class _TakingBack:
    """Changes taken back by halving; arguments as above."""

    def __init__(
        self,
        old: Program,
        new: Program,
        changes: Sequence[Change],
        found: Counted,
        judged: Callable[[Program], Counted | None],
    ) -> None:
        self._old, self._new, self._kept, self._judged = old, new, list(changes), judged
        self._best, self._most = found, found.cost * (1.0 + _LOST)
        self._left = _TRIALS

    def without(self, idle: Sequence[Change]) -> Counted:
        if not idle or not self._left:
            return self._best
        self._left -= 1
        kept = [change for change in self._kept if change not in idle]
        made = self._judged(with_changes(self._old, self._new, kept))
        if made is not None and made.cost <= self._most:
            self._best, self._kept = made, kept
        elif len(idle) > 1:
            half = len(idle) // 2
            self.without(idle[:half])
            self.without(idle[half:])
        return self._best
