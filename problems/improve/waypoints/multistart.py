"""The best proven values of every block: searches from many starts, refined and certified.

1. Short searches from every start, at few places of the path; the most promising ones go on, in
   several rounds.
2. Generations of variations of the best path of each block: neighbouring local optima are often
   better.
3. The best of these are refined at many places.
4. They are proven between places too, the best first; a candidate that cannot be proven aims at a
   wider margin and is tried again. No others are tried once one is proven that is better.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from ....core.worker_pool import WorkerPool, worker_pool
from ..nonsmooth_sqp import Memory
from ..progress import Progress, Report
from .block_search import FEASIBLE, FINE_BOX, Answer, Job, JobStage, Shared, work
from .starts import starting_points, variations

ROUNDS = ((14, 0.5), (14, 0.5))
"""Iterations of a round, and the share of the searches that go on after it."""
_LEAST = 3
"""Searches of a block that go on at least, and those that are refined."""
_NEAR_ITERATIONS, _NEAR_BOX = 25, 0.6
_ALIKE = 1e-6
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
        """From every start, in rounds."""
        for number in range(len(ROUNDS) + 1):
            self._do(f"searching, round {number + 1}", jobs)
            going = [] if self.over else _going_on(self._shared, number, self._found)
            self._found = [answer for answer in self._found if answer not in going]
            iterations = _iterations(self._shared, number + 1)
            jobs = [Job(answer.block, answer.memory, iterations) for answer in going]
            if not jobs:
                return

    @property
    def searched(self) -> list[Answer | None]:
        """The best that searches have come to in every block."""
        blocks = range(len(self._shared.blocks))
        own = [[a for a in self._found if a.block == k] for k in blocks]
        return [min(answers, key=Answer.rank, default=None) for answers in own]

    def vary(self) -> None:
        """From near the best, in generations."""
        for generation in range(self._shared.effort.generations):
            if not self.over:
                jobs = _varied(self._shared, self._found, generation)
                self._do(f"varying, round {generation + 1}", jobs)

    def prove(self) -> None:
        """Refine the best, and prove the best of them that can be proven."""
        searched, self._found = self._found, []
        count = 1 if self.over else _LEAST
        self._do("refining", _finals(self._shared, searched, count))
        queue = sorted(self._found, key=Answer.rank)
        while queue:
            turn = {a.block: a for a in reversed(queue) if self._may_lead(a)}
            jobs = [Job(a.block, a.memory, stage=JobStage.PROVE, refined=a) for a in turn.values()]
            self._do("proving", jobs)
            queue = [a for a in queue if a not in turn.values() and self._may_lead(a)]

    def _may_lead(self, answer: Answer) -> bool:
        best = self.best[answer.block]
        return best is None or answer.objective < best.objective

    def _do(self, stage: str, jobs: Sequence[Job]) -> None:
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
        self._found[before:] = [answer for answer in answers if answer is not None]


def _first(shared: Shared) -> list[Job]:
    """A short search from every start."""
    return [
        Job(k, Memory(x, 1.0), _iterations(shared, 0))
        for k, block in enumerate(shared.blocks)
        for x in starting_points(block, shared.controller.plan(block.program), shared.effort)
    ]


def _iterations(shared: Shared, number: int) -> int:
    """Of round ``number``; the last one has all that are left."""
    left = shared.effort.iterations - sum(iterations for iterations, _ in ROUNDS[:number])
    return max(0, left if number >= len(ROUNDS) else min(left, ROUNDS[number][0]))


def _going_on(shared: Shared, number: int, found: Sequence[Answer]) -> list[Answer]:
    """The searches of which more is to be expected after round ``number``."""
    if number == len(ROUNDS) or not _iterations(shared, number + 1):
        return []
    going: list[Answer] = []
    for k in range(len(shared.blocks)):
        own = sorted((a for a in found if a.block == k), key=Answer.rank)
        chosen = own[: max(_LEAST, round(ROUNDS[number][1] * len(own)))]
        going += [answer for answer in chosen if not answer.finished]
    return going


def _varied(shared: Shared, found: Sequence[Answer], generation: int) -> list[Job]:
    """Searches from near the best path of each block."""
    jobs: list[Job] = []
    for k, block in enumerate(shared.blocks):
        best = min((a for a in found if a.block == k), key=Answer.rank, default=None)
        if best is None or best.violation > FEASIBLE:
            continue
        jobs += [
            Job(k, Memory(x, _NEAR_BOX), min(_NEAR_ITERATIONS, shared.effort.iterations))
            for x in variations(block, best.x, shared.effort, generation)
        ]
    return jobs


def _finals(shared: Shared, found: Sequence[Answer], count: int) -> list[Job]:
    """Refinements of the best ``count`` of each block, no two of them alike."""
    jobs: list[Job] = []
    for k in range(len(shared.blocks)):
        chosen: list[Answer] = []
        for answer in sorted((a for a in found if a.block == k), key=Answer.rank):
            alike = any(abs(a.objective - answer.objective) < _ALIKE for a in chosen)
            if answer.violation < _HOPELESS and not alike and len(chosen) < count:
                chosen.append(answer)
        jobs += [Job(k, Memory(a.x, FINE_BOX), stage=JobStage.REFINE) for a in chosen]
    return jobs
