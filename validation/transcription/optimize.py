"""Solve a transcription, and solve it again until it keeps its clearance between nodes too."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

import numpy as np

from ...core.arrays import FloatArray
from ...core.program.program import Program
from ...core.sqp import NLP, BackendKind, solve
from .guess import initial_guess
from .layout import Grid
from .motion import Check, carried_over, check, program, sampled
from .task import TranscriptionTask
from .transcription import Transcription

NEAR = 0.25
"""m; pairs farther apart than this all along the motion get no rows."""
TOO_MUCH = 5e-4
"""m by which the clearance may be exceeded."""
AIM = 1e-4
"""m beyond it that is aimed at between nodes, where it may not be missed."""


class Answer(Protocol):
    """What a solver gives: the point, and whether it is a solution."""

    @property
    def x(self) -> FloatArray:
        """(n,)."""
        ...

    @property
    def success(self) -> bool:
        """Whether x is a solution."""
        ...

    @property
    def iterations(self) -> int:
        """Number of them."""
        ...


Solver = Callable[[NLP, FloatArray], Answer]
"""A problem and a start → its solution: ours or a peer's."""


@dataclass(frozen=True)
class Optimum:
    """What came of it.

    Args:
        problem: the last one that was solved.
        x: its variables.
        success: whether the last solution is one.
        iterations: of all solutions together.
        rounds: how many problems were solved.
        check: limits and clearance between nodes.
    """

    problem: Transcription
    x: FloatArray
    success: bool
    iterations: int
    rounds: int
    check: Check

    @property
    def time(self) -> float:
        """The duration, s."""
        return self.problem.objective(self.x)

    @property
    def missing(self) -> float:
        """Clearance that is missing, m; negative where there is more than enough."""
        return self.problem.task.cell.clearance - self.check.clearance

    @property
    def program(self) -> Program:
        """The same via points and radii as joint moves."""
        return program(self.problem, self.x)


def optimize(
    task: TranscriptionTask,
    grid: Grid | None = None,
    freedom: float = np.inf,
    share: float = 0.5,
    rounds: int = 5,
    solver: Solver | None = None,
) -> Optimum:
    """The fastest motion near the task's waypoints.

    Where the motion comes nearer to something between nodes than it may, or stays farther away than
    it needs to, the clearance asked for at nodes is changed by what is missing, and the problem
    solved again from there.

    Args:
        task: what moves where.
        grid: intervals of time.
        freedom: rad (m) by which each joint of a via point may differ from the task's.
        share: radius of each zone at the start, as a share of the largest that neighbours leave.
        rounds: most problems that are solved.
        solver: None for ours, with its own interior point for the subproblems.

    Returns:
        The fastest that keeps the clearance, or the last one if none does.
    """
    ours = partial(solve, method="sqp", qp=BackendKind.INTERIOR_POINT)  # the guess is a good one
    answers = ours if solver is None else solver
    problem = Transcription(task, grid, freedom, pairs=())
    x = initial_guess(problem, share)
    pairs, margin, iterations = _near(problem, x), 0.0, 0
    best: Optimum | None = None
    for number in range(1, rounds + 1):
        before, problem = problem, Transcription(task, grid, freedom, margin, pairs)
        found = answers(problem.nlp(), carried_over(before, x, problem))
        x, iterations = found.x, iterations + found.iterations
        last = Optimum(problem, x, found.success, iterations, number, check(problem, x))
        best = last if best is None else _better(best, last)
        if -TOO_MUCH <= last.missing <= 0.0:
            break
        margin = max(0.0, margin + last.missing + AIM)
        pairs = tuple(sorted({*pairs, *_near(problem, x)}))
    assert best is not None
    return replace(best, iterations=iterations, rounds=number)


def _better(one: Optimum, other: Optimum) -> Optimum:
    """The faster of two that are free, else the freer."""
    free = [o for o in (one, other) if o.missing <= 0.0 and o.success]
    if free:
        return min(free, key=lambda o: o.time)
    return min((one, other), key=lambda o: o.missing)


def _near(problem: Transcription, x: FloatArray) -> tuple[int, ...]:
    """Pairs that come near to each other somewhere."""
    distances = problem.task.clearances.values(sampled(problem, x, 20).q)
    least = distances.min(axis=0, initial=np.inf)
    return tuple(int(k) for k in np.flatnonzero(least < problem.task.cell.clearance + NEAR))
