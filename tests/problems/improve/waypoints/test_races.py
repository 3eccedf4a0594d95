"""Searches that race: the best goes on to its end, none takes more than it may."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from types import SimpleNamespace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.problems.improve.nonsmooth_sqp import Memory
from flyby.problems.improve.waypoints import multistart
from flyby.problems.improve.waypoints.block_search import Answer, Job

ITERATIONS = 60


class CountingPool:
    """Answers at once: a search has the objective that is its x, and falls by as much each time."""

    def __init__(self, fell: float) -> None:
        self.fell = fell
        self.taken: Counter[float] = Counter()
        self.turns: list[Job] = []

    def answers(self, jobs: Sequence[Job], done: Callable[[int, Answer], bool]) -> list[Answer]:
        made = []
        for job in jobs:
            self.turns.append(job)
            height = float(job.memory.x[0])
            self.taken[height] += job.iterations
            made.append(
                Answer(job.block, job.memory.x, height, 0.0, False, job.memory, fell=self.fell)
            )
            done(len(made), made[-1])
        return made


@given(
    eighths=st.lists(st.integers(1, 7), min_size=1, max_size=7, unique=True),
    fell=st.floats(0.0, 0.2),
    free=st.lists(st.integers(1, 50), min_size=1, max_size=3),
)
@settings(deadline=None)
def test_the_best_goes_on_and_none_takes_more_than_it_may(
    eighths: list[int], fell: float, free: list[int]
) -> None:
    heights = [k / 8 for k in eighths]
    variables = [SimpleNamespace(free=np.arange(n), scale=np.full(1, 1e-9)) for n in free]
    shared = SimpleNamespace(blocks=[SimpleNamespace(variables=v) for v in variables])
    pool = CountingPool(fell)
    made = multistart._Improvement(shared, pool, None)  # type: ignore[arg-type]
    jobs = [
        Job(block, Memory(np.array([height + block]), 1.0), ITERATIONS)
        for block in range(len(free))
        for height in heights
    ]
    made.search(jobs)
    for block, best in enumerate(made.searched):
        assert best is not None and best.objective == min(heights) + block
        assert pool.taken[best.objective] == ITERATIONS
    assert max(pool.taken.values()) == ITERATIONS
    assert all(job.iterations > 0 for job in pool.turns)
    # One that is far behind has ended early.
    for job in jobs:
        height = float(job.memory.x[0])
        if height - 3.1 * fell > min(heights) + job.block:
            assert pool.taken[height] <= multistart._LONGEST
