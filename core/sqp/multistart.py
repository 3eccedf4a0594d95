"""The best of several solutions from different starts.

Nonconvex problems have optima that differ more than solvers do: among obstacles by a factor of two.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .nlp import NLP, FloatArray, NlpError
from .result import Result
from .solver import solve


@dataclass(frozen=True, slots=True)
class MultiStart:
    """Solutions from several starts.

    Args:
        results: in the order of the starts.
        best: index of the best: a success before any failure, then the lowest objective, then the
            least violation.
    """

    results: tuple[Result, ...]
    best: int

    @property
    def result(self) -> Result:
        """The best result."""
        return self.results[self.best]


def solve_from(
    nlp: NLP,
    starts: Iterable[ArrayLike],
    *,
    workers: int = 1,
    accept: Callable[[Result], bool] | None = None,
    **options: Any,
) -> MultiStart:
    """Solve a problem from every start.

    Args:
        nlp: the problem.
        starts: each (n,).
        workers: processes; more than one needs an operating system that can fork, as the problem's
            callables go to the workers by inheritance.
        accept: whether a result may be the best: a certificate of the caller's, say.
        options: of `solve`.

    Raises:
        NlpError: there is no start, or no worker.
    """
    points = [np.array(start, dtype=np.float64) for start in starts]
    if not points:
        raise NlpError("starts is empty")
    if workers < 1:
        raise NlpError(f"workers is one or more, not {workers}")
    results = (
        [_bare(solve(nlp, point, **options)) for point in points]
        if workers == 1
        else _in_processes(nlp, points, workers, options)
    )
    return MultiStart(tuple(results), _best(results, accept))


def scattered_starts(
    nlp: NLP, x0: ArrayLike, count: int, spread: ArrayLike = 1.0, seed: int = 0
) -> list[FloatArray]:
    """x0 itself, and ``count - 1`` points round it within the bounds.

    Args:
        x0: (n,).
        count: of starts.
        spread: standard deviation of each variable, (n,) or a number.
        seed: of the random numbers: the same seed gives the same starts.

    Raises:
        NlpError: x0 or spread has the wrong shape, or count is below one.
    """
    centre, widths = np.array(x0, dtype=np.float64), np.asarray(spread, dtype=np.float64)
    if centre.shape != (nlp.n,):
        raise NlpError(f"x0 has shape {centre.shape}, expected ({nlp.n},)")
    if widths.shape not in ((), (nlp.n,)):
        raise NlpError(f"spread has shape {widths.shape}, expected a number or ({nlp.n},)")
    if count < 1:
        raise NlpError(f"count is one or more, not {count}")
    lower, upper, *_ = nlp.bounds
    random = np.random.default_rng(seed)
    noise = random.standard_normal((count - 1, nlp.n)) * widths
    return [np.clip(centre, lower, upper), *(np.clip(centre + row, lower, upper) for row in noise)]


def _best(results: Sequence[Result], accept: Callable[[Result], bool] | None) -> int:
    def rank(index: int) -> tuple[bool, bool, float, float]:
        result = results[index]
        refused = accept is not None and not accept(result)
        if result.success:
            return refused, False, result.objective, result.constraint_violation
        return refused, True, result.constraint_violation, result.objective

    return min(range(len(results)), key=rank)


_inherited: tuple[NLP, dict[str, Any]] | None = None


def _in_processes(
    nlp: NLP, points: list[FloatArray], workers: int, options: dict[str, Any]
) -> list[Result]:
    global _inherited
    try:
        context = multiprocessing.get_context("fork")
    except ValueError:
        raise NlpError("workers: this system cannot fork; use workers=1") from None
    _inherited = nlp, options
    try:
        with ProcessPoolExecutor(min(workers, len(points)), mp_context=context) as pool:
            return list(pool.map(_solve_inherited, points))
    finally:
        _inherited = None


def _solve_inherited(point: FloatArray) -> Result:
    assert _inherited is not None
    nlp, options = _inherited
    return _bare(solve(nlp, point, **options))


def _bare(result: Result) -> Result:
    """Without the back ends, which cannot leave their process."""
    return replace(result, workspace=None)
