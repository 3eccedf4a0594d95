"""The number of via points: idle ones are left out, others come where they save enough.

It is done stretch by stretch, from stop to stop, while all others stay. A via point goes if a short
search from there ends no higher without it. Then every one is cut in two (`doubling`) and searched
from there, briefly; the best of these is searched longer, or the second best, and stays if it is
better by enough. What short searches come to is neither refined nor proven, so that only what may
stay is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ....core.collision.proof.verdict import Certificate
from ....core.motion.emulator.run import Run
from ....core.program.move import Opaque, Wait
from ....core.program.program import Program
from .blocks import stretches
from .changeable import Selection
from .doubling import doubled, without
from .options import Effort, WaypointTask
from .point_limits import Free

_SERVES_NOTHING = 1e-4
"""Share of the stretch's cost that a via point must save to stay."""
_PAYS = 2e-3
"""Share of the stretch's cost that one more must save."""
_MOST = 4
"""Via points more in a stretch."""
_BRIEF = 30
"""Iterations of a search that only compares."""
_ROUGH = 0.02
"""Share of the stretch's cost by which more searching may better what a short search comes to."""
_SECOND = 0.005
"""The same of the second best of several, which is searched longer where the best is given up."""


@dataclass(frozen=True)
class Counted:
    """A proven program.

    Args:
        run: the program, driven.
        certificate: of the run.
        cost: its objective.
        task: with the indices of its moves.
    """

    run: Run
    certificate: Certificate
    cost: float
    task: WaypointTask


@dataclass(frozen=True)
class Rough:
    """What a short search comes to; nothing of it is proven.

    Args:
        program: with what was found.
        cost: its objective.
    """

    program: Program
    cost: float


@dataclass(frozen=True)
class Searches:
    """What the count of via points asks for; each gives None where it cannot, or where the user has
    ended the work.

    Args:
        roughly: searches a program.
        improved: optimises one.
        selected: what may change in a program.
    """

    roughly: Callable[[Program, WaypointTask, Effort], Rough | None]
    improved: Callable[[Program, WaypointTask, Effort], Counted | None]
    selected: Callable[[Counted], Selection]


Renumbering = Callable[[int], int | None]


def idle_points(
    best: Counted,
    selection: Selection,
    judged: Callable[[Program, WaypointTask], float | None],
) -> Iterator[int]:
    """Via points (indices of moves) without which, all else as it is, nothing is lost.

    Args:
        best: the program.
        selection: what may change in it.
        judged: a program's cost, with its task; None if it does not keep its clearance.
    """
    for i in _countable(best, selection):
        fewer = without(best.run.program, i)
        cost = judged(fewer, best.task.renumbered(_gone(i), len(fewer.moves)))
        if cost is not None and cost <= best.cost * (1.0 + 1e-9):
            yield i


def change_count(best: Counted, searches: Searches, effort: Effort, arm_size: int) -> Counted:
    """The program with as many via points as it is best with.

    Args:
        best: as it is.
        searches: that find others.
        effort: of the searches so far; these are shorter, as they begin near an optimum.
        arm_size: number of the arm's own joints.
    """
    for number in range(len(_stretches(best))):
        turn = _Turn(number, searches, effort, arm_size)
        best = turn.with_more(turn.with_fewer(best))
    return best


@dataclass(frozen=True)
class _Turn:
    """The changes of one stretch.

    Args:
        number: of the stretch; it stays the same, as no stop comes or goes.
        searches, effort, arm_size: as in `change_count`.
    """

    number: int
    searches: Searches
    effort: Effort
    arm_size: int

    def with_fewer(self, best: Counted) -> Counted:
        """Without those that serve nothing."""
        while (fewer := self._without_one(best)) is not None:
            best = fewer
        return best

    def with_more(self, best: Counted) -> Counted:
        """With those that save time."""
        for _ in range(_MOST):
            more = self._with_one(best)
            if more is None:
                break
            best = more
        return best

    def _without_one(self, best: Counted) -> Counted | None:
        most = best.cost * (1.0 + _SERVES_NOTHING * self._share(best))
        for i in self._here(best, _countable(best, self.searches.selected(best))):
            rough = self._compare(best, without(best.run.program, i), _gone(i))
            if rough is None or not self._may_come_to(best, rough, most):
                continue
            found = self._search(best, rough.program, _gone(i), self._brief)
            if found is not None and found.cost <= most:
                return found
        return None

    def _with_one(self, best: Counted) -> Counted | None:
        most = best.cost * (1.0 - _PAYS * self._share(best))
        tried = [(rough, i) for i in self._divisible(best) if (rough := self._divided(best, i))]
        longer = replace(self.effort, starts=1, generations=min(1, self.effort.generations))
        best_first = sorted(tried, key=lambda pair: pair[0].cost)
        for (rough, i), share in zip(best_first, (_ROUGH, _SECOND), strict=False):
            if self._may_come_to(best, rough, most, share):
                found = self._search(best, rough.program, _later(i), longer)
                if found is not None and found.cost < most:
                    return found
        return None

    def _may_come_to(self, best: Counted, rough: Rough, cost: float, share: float = _ROUGH) -> bool:
        """Whether what a short search comes to may cost no more than that, once it is refined."""
        return rough.cost - share * self._share(best) * best.cost <= cost

    def _divisible(self, best: Counted) -> list[int]:
        """Via points that go where they like; what limits one says nothing of two."""
        task = best.task
        candidates = self._here(best, _countable(best, self.searches.selected(best)))
        return [i for i in candidates if isinstance(task.limits.get(i, task.limit), Free)]

    def _divided(self, best: Counted, i: int) -> Rough | None:
        program = doubled(best.run.program, best.run.path, i, self.arm_size)
        return None if program is None else self._compare(best, program, _later(i))

    def _compare(self, best: Counted, program: Program, new: Renumbering) -> Rough | None:
        """What a short search makes of a changed program; arguments as in `_search`."""
        task = self._confined(best).renumbered(new, len(program.moves))
        return self.searches.roughly(program, task, self._brief)

    def _search(
        self, best: Counted, program: Program, new: Renumbering, effort: Effort
    ) -> Counted | None:
        """A changed program at its best.

        Args:
            best: without the change.
            program: with it.
            new: indices of its moves.
            effort: of the search.
        """
        count = len(program.moves)
        task = self._confined(best).renumbered(new, count)
        found = self.searches.improved(program, task, effort)
        return None if found is None else replace(found, task=best.task.renumbered(new, count))

    def _confined(self, best: Counted) -> WaypointTask:
        """The task of a search that leaves all other stretches alone."""
        task = best.task
        here = self._here(best, range(len(best.run.program.moves)))
        others = set(range(len(best.run.program.moves))) - set(here)
        return replace(task.spent(), keep={*task.keep, *others})

    @property
    def _brief(self) -> Effort:
        iterations = min(_BRIEF, self.effort.iterations)
        return replace(self.effort, starts=1, generations=0, iterations=iterations)

    def _here(self, best: Counted, moves: Iterable[int]) -> list[int]:
        """Those of the moves that are in the stretch."""
        first, last = _stretches(best)[self.number]
        return [i for i in moves if first <= i <= last]

    def _share(self, best: Counted) -> float:
        """Of the motion's time that the stretch takes, and so about of its cost."""
        spent = best.run.timing.segment_durations()
        moves = list(best.run.path.route.moves)
        here = np.isin(moves, self._here(best, moves))
        return float(spent[here].sum() / spent.sum())


def _stretches(best: Counted) -> list[tuple[int, int]]:
    return stretches(best.run.path, len(best.run.program.moves))


def _countable(best: Counted, selection: Selection) -> list[int]:
    """Via points that move, share their target with no other, and at which nothing is done: what
    is switched there would be switched elsewhere. None of them ends a way on which a part comes off
    what it touches, or comes to it."""
    task, busy, moves = best.task, _busy(best.run.program), best.run.path.route.moves
    after = dict(pairwise(moves))
    alone = [group[0] for group in selection.points if len(group) == 1]
    return [
        i
        for i in alone
        if i not in busy and not any(task.given_move(k) in task.ways for k in (i, after.get(i, i)))
    ]


def _busy(program: Program) -> set[int]:
    """Moves that something else than a move comes after, such as an output."""
    found: set[int] = set()
    index = -1
    for statement in program.statements:
        if isinstance(statement, Wait | Opaque):
            found.add(index)
        else:
            index += 1
    return found


def _gone(index: int) -> Renumbering:
    """New indices of moves when one has been left out."""
    return lambda k: None if k == index else k - (k > index)


def _later(index: int) -> Renumbering:
    """New indices of moves when one has come before ``index``."""
    return lambda k: k + (k >= index)
