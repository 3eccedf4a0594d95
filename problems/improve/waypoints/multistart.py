"""The best proven values of every block: searches from many starts, refined and certified.

1. Short searches from every start, at few places of the path. They race: in rounds, after each of
   which only the most promising ones go on.
2. Generations of variations of the best path of each block: neighbouring local optima are often
   better. A block of which a generation finds nothing better has no further ones.
3. The best of these are refined at many places.
4. They are proven between places too, the best first; a candidate that cannot be proven aims at a
   wider margin and is tried again. No others are tried once one is proven that is better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ....core.worker_pool import WorkerPool, worker_pool
from ..nonsmooth_sqp import Memory
from ..progress import Progress, Report
from .block_search import FEASIBLE, FINE_BOX, FINE_ITERATIONS, Answer, Job, JobStage, Shared, work
from .starts import starting_points, variations

_ROUNDS = ((0.5, 0.7), (0.5, 0.5), (0.5, 0.5), (1.0, 1.0), (1.0, 1.0), (1.0, 1.0))
"""Iterations of a round for each free variable, as an iteration shows one kink and where a search
leads is not seen before it knows some; and the share of its searches that go on after it if they
may win."""
_NEAR_ROUNDS = ((0.75, 0.5), (0.75, 1.0))
"""The same of variations,"""
_FINE_ROUNDS = ((0.5, 0.7), (0.5, 0.7), (1.5, 1.0))
"""and of refinements."""
_SHORTEST, _LONGEST = 5, 15
"""Iterations of a round."""
_LEAST = 3
"""Searches of a block that go on at least if they may win."""
_FALLS = 3.0
"""Falls of its last round that a search may still have before it: they mostly become smaller from
round to round, not always."""
_FINALS = 3
"""Searches of a block that are refined."""
_NEAR_ITERATIONS, _NEAR_BOX = 25, 0.6
_ALIKE, _SAME_HEIGHT = 0.5, 2e-3
"""Difference of all variables, in units of their scale, and share of the objective, up to which two
searches are at the same optimum."""
_BETTER = 1e-4
"""Share of the objective by which a generation has to be better for another one."""
_HOPELESS = 0.05
"""m of violation at which a searched candidate is not worth refining."""


def improve(shared: Shared, report: Report | None) -> tuple[list[Answer | None], bool]:
    """The best proven values of every block; None where the input is not bettered.

    Args:
        shared: the problem.
        report: called with progress. When it, or the keyboard, ends the work, what has been found
            until then is proven, and nothing more is searched.

    Returns:
        The values, and whether the user has ended the work.
    """
    jobs = _first(shared)
    with worker_pool(partial(work, shared), shared.effort.processes, len(jobs)) as pool:
        made = _Improvement(shared, pool, report)
        try:
            made.search(jobs)
            made.vary()
        except KeyboardInterrupt:
            made.over = True
        try:
            made.prove()
        except KeyboardInterrupt:
            made.over = True
    return made.best, made.over


def searched(shared: Shared, report: Report | None) -> tuple[list[Answer | None], bool]:
    """What searches from every start come to, neither refined nor proven; see `improve`."""
    jobs = _first(shared)
    with worker_pool(partial(work, shared), shared.effort.processes, len(jobs)) as pool:
        made = _Improvement(shared, pool, report)
        try:
            made.search(jobs)
        except KeyboardInterrupt:
            made.over = True
    return made.searched, made.over


class _Improvement:
    """One run.

    Args:
        shared, report: as above.
        pool: does the searches.

    Attributes:
        best: proven values of each block.
        over: whether the user has ended the work.
    """

    def __init__(
        self, shared: Shared, pool: WorkerPool[Job, Answer], report: Report | None
    ) -> None:
        self._shared = shared
        self._pool = pool
        self._report = report
        self._found: list[Answer] = []
        self.best: list[Answer | None] = [None] * len(shared.blocks)
        self.over = False

    def search(self, jobs: list[Job]) -> None:
        """From every start."""
        self._race("searching, round {}", jobs, _ROUNDS)

    @property
    def searched(self) -> list[Answer | None]:
        """The best that searches have come to in every block."""
        blocks = range(len(self._shared.blocks))
        own = [[a for a in self._found if a.block == k] for k in blocks]
        return [min(answers, key=Answer.rank, default=None) for answers in own]

    def vary(self) -> None:
        """From near the best, in generations."""
        blocks = list(range(len(self._shared.blocks)))
        for generation in range(self._shared.effort.generations):
            if self.over or not blocks:
                return
            before = self.searched
            jobs = _varied(self._shared, [before[k] for k in blocks], generation)
            self._race(f"varying, round {generation + 1}", jobs, _NEAR_ROUNDS)
            blocks = [k for k in blocks if _bettered(before[k], self.searched[k])]

    def prove(self) -> None:
        """Refine the best, and prove the best of them that can be proven."""
        searched, self._found = self._found, []
        count = 1 if self.over else _FINALS
        self._race("refining", _finals(self._shared, searched, count), _FINE_ROUNDS)
        queue = sorted(self._found, key=Answer.rank)
        while queue:
            turn = {a.block: a for a in reversed(queue) if self._may_lead(a)}
            jobs = [Job(a.block, a.memory, stage=JobStage.PROVE, refined=a) for a in turn.values()]
            self._do("proving", jobs)
            queue = [a for a in queue if a not in turn.values() and self._may_lead(a)]

    def _may_lead(self, answer: Answer) -> bool:
        best = self.best[answer.block]
        return best is None or answer.objective < best.objective

    def _race(self, stage: str, jobs: list[Job], rounds: Sequence[tuple[float, float]]) -> None:
        """Do searches in rounds, and keep what each of them comes to.

        Args:
            stage: what they are called; "{}" in it is the number of the round.
            jobs: with all the iterations that they may take, as many for each of a block.
            rounds: see `_ROUNDS`; after them comes one with the iterations that are left.
        """
        for number, (length, share) in enumerate((*rounds, (np.inf, 0.0)), start=1):
            if not jobs:
                return
            turn = [replace(job, iterations=self._turn(job, length)) for job in jobs]
            left = {
                job.block: job.iterations - t.iterations for job, t in zip(jobs, turn, strict=True)
            }
            made = self._do(stage.format(number), turn)
            if self.over:
                return
            going = _going_on(self._shared, made, self.searched, share)
            going = [answer for answer in going if left[answer.block]]
            self._found = [answer for answer in self._found if answer not in going]
            jobs = [
                replace(jobs[0], block=a.block, memory=a.memory, iterations=left[a.block])
                for a in going
            ]

    def _turn(self, job: Job, length: float) -> int:
        """Iterations of a search in one round; in one of infinite length all that are left."""
        if length == np.inf:
            return job.iterations
        wished = np.ceil(length * len(self._shared.blocks[job.block].variables.free))
        return min(int(np.clip(wished, _SHORTEST, _LONGEST)), job.iterations)

    def _do(self, stage: str, jobs: Sequence[Job]) -> list[Answer]:
        """Do jobs, and keep what comes of them."""

        def tell(done: int, answer: Answer) -> bool:
            self._found.append(answer)
            known = self.best[answer.block]
            if answer.proven and (known is None or answer.objective < known.objective):
                self.best[answer.block] = answer
            if self._report is not None:
                lowest = min((a.objective for a in self.best if a is not None), default=1.0)
                ended = self._report(Progress(stage, done, len(jobs), lowest))
                self.over = bool(ended) or self.over
            return self.over and stage not in ("refining", "proving")

        before = len(self._found)
        answers = self._pool.answers(jobs, tell) if jobs else []
        # In the order of the jobs, whichever was done first.
        made = [answer for answer in answers if answer is not None]
        self._found[before:] = made
        return made


def _first(shared: Shared) -> list[Job]:
    """A search from every start."""
    return [
        Job(k, Memory(x, 1.0), shared.effort.iterations)
        for k, block in enumerate(shared.blocks)
        for x in starting_points(block, shared.controller.plan(block.program), shared.effort)
    ]


def _going_on(
    shared: Shared, made: Sequence[Answer], best: Sequence[Answer | None], share: float
) -> list[Answer]:
    """The searches of a round of which more is to be expected.

    Args:
        shared: the problem.
        made: what the round's searches came to.
        best: of each block, of all searches.
        share: of each block's that may go on.
    """
    going: list[Answer] = []
    for k, leader in enumerate(best):
        own = sorted((a for a in made if a.block == k), key=Answer.rank)
        own = _distinct(shared, own[: max(_LEAST, round(share * len(own)))])
        going += [a for a in own if not a.finished and _may_win(a, leader)]
    return going


def _may_win(answer: Answer, leader: Answer | None) -> bool:
    """Whether a search may yet overtake the best one, by how fast it falls."""
    if leader is None or leader.violation > FEASIBLE:
        return True
    return answer.objective - _FALLS * answer.fell <= leader.objective


def _distinct(shared: Shared, answers: Sequence[Answer]) -> list[Answer]:
    """The first of those that are at the same optimum; ``answers`` are the best first."""
    chosen: list[Answer] = []
    for answer in answers:
        if not any(_alike(shared, answer, other) for other in chosen):
            chosen.append(answer)
    return chosen


def _alike(shared: Shared, answer: Answer, other: Answer) -> bool:
    if max(answer.violation, other.violation) > FEASIBLE:
        return answer.x is other.x
    scale = shared.blocks[answer.block].variables.scale
    apart = np.abs((answer.x - other.x) / scale).max(initial=0.0)
    higher = answer.objective - other.objective
    return bool(apart < _ALIKE and abs(higher) < _SAME_HEIGHT * other.objective)


def _bettered(before: Answer | None, now: Answer | None) -> bool:
    """Whether a generation has found something better."""
    if before is None or now is None:
        return now is not None
    return now.objective < (1.0 - _BETTER) * before.objective


def _varied(shared: Shared, best: Sequence[Answer | None], generation: int) -> list[Job]:
    """Searches from near the best path of some blocks."""
    return [
        Job(a.block, Memory(x, _NEAR_BOX), min(_NEAR_ITERATIONS, shared.effort.iterations))
        for a in best
        if a is not None and a.violation <= FEASIBLE
        for x in variations(shared.blocks[a.block], a.x, shared.effort, generation)
    ]


def _finals(shared: Shared, found: Sequence[Answer], count: int) -> list[Job]:
    """Refinements of the best ``count`` of each block, no two of them alike."""
    jobs: list[Job] = []
    for k in range(len(shared.blocks)):
        own = [a for a in found if a.block == k and a.violation < _HOPELESS]
        chosen = _distinct(shared, sorted(own, key=Answer.rank))[:count]
        jobs += [Job(k, Memory(a.x, FINE_BOX), FINE_ITERATIONS, JobStage.REFINE) for a in chosen]
    return jobs
