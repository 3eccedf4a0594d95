"""One task done for many jobs, in several processes where the system can fork."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

Job = TypeVar("Job")
Answer = TypeVar("Answer")

_task: Callable[[Any], Any] | None = None
"""What a worker does; it inherits it by forking."""


class WorkerPool(Generic[Job, Answer]):
    """Workers that all do one task.

    Args:
        task: job → answer; deterministic, so that the number of workers does not matter.
        pool: the processes; None to work here.
    """

    def __init__(self, task: Callable[[Job], Answer], pool: ProcessPoolExecutor | None) -> None:
        self._task = task
        self._pool = pool

    def answers(
        self, jobs: Sequence[Job], done: Callable[[int, Answer], bool] = lambda count, answer: False
    ) -> list[Answer | None]:
        """The answers in the order of the jobs; None for those not done any more.

        Args:
            jobs: what to do.
            done: called with the number of answers so far and the newest; True ends the work.
        """
        if self._pool is None:
            return self._here(jobs, done)
        return self._in_pool(self._pool, jobs, done)

    def _here(
        self, jobs: Sequence[Job], done: Callable[[int, Answer], bool]
    ) -> list[Answer | None]:
        found: list[Answer | None] = [None] * len(jobs)
        for k, job in enumerate(jobs):
            answer = self._task(job)
            found[k] = answer
            if done(k + 1, answer):
                break
        return found

    def _in_pool(
        self,
        pool: ProcessPoolExecutor,
        jobs: Sequence[Job],
        done: Callable[[int, Answer], bool],
    ) -> list[Answer | None]:
        found: list[Answer | None] = [None] * len(jobs)
        order: dict[Future[object], int] = {
            pool.submit(_inherited, job): k for k, job in enumerate(jobs)
        }
        waiting, count, over = set(order), 0, False
        try:
            while waiting and not over:
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in finished:
                    answer: Answer = future.result()  # type: ignore[assignment]
                    found[order[future]] = answer
                    count += 1
                    over = done(count, answer) or over
        finally:
            for future in waiting:
                future.cancel()
        return found


@contextmanager
def worker_pool(
    task: Callable[[Job], Answer], workers: int, jobs: int
) -> Iterator[WorkerPool[Job, Answer]]:
    """Workers for a task.

    Args:
        task: job → answer; answers must be picklable.
        workers: processes at most; one, or a system that cannot fork, works here.
        jobs: how many jobs there will be at most at once.
    """
    count = min(workers, jobs)
    if count < 2 or "fork" not in multiprocessing.get_all_start_methods():
        yield WorkerPool(task, None)
        return
    context = multiprocessing.get_context("fork")
    pool = ProcessPoolExecutor(count, context, initializer=_begin, initargs=(task,))
    try:
        yield WorkerPool(task, pool)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _begin(task: Callable[[Any], Any]) -> None:
    """What a worker begins with; the keyboard's interrupt is the parent's business."""
    global _task
    _task = task
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _inherited(job: object) -> object:
    assert _task is not None, "workers inherit their task"
    return _task(job)
