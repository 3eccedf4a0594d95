"""The best of several solutions from different starts.

Nonconvex problems have optima that differ more than solvers do: among obstacles by a factor of two.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .options import start_point
from .problem.arrays import numbers, whole_number
from .problem.errors import NlpError
from .problem.nlp import NLP
from .result import Result
from .solver import solve

_SAME_OBJECTIVE, _SAME_PLACE = 1e-4, 1e-2
"""Shares of objective and of a variable's size up to which solutions are one optimum."""


@dataclass(frozen=True, slots=True)
class MultiStart:
    """Solutions from several starts.

    Args:
        results: in the order of the starts.
        accepted: whether each is a success that the caller's certificate, if there is one, lets
            pass.
        best: index of the lowest accepted one. Where none is accepted: the least violated failure,
            or None if there is a certificate.
        distinct: indices of the accepted ones that are different optima, the lowest first; of those
            alike the lowest.
    """

    results: tuple[Result, ...]
    accepted: tuple[bool, ...]
    best: int | None
    distinct: tuple[int, ...] = ()

    @property
    def result(self) -> Result | None:
        """The best result; None where a certificate lets none pass."""
        return None if self.best is None else self.results[self.best]


def solve_from(
    nlp: NLP,
    starts: Iterable[ArrayLike],
    *,
    workers: int = 1,
    accept: Callable[[Result], bool] | None = None,
    patience: int | None = None,
    **options: Any,
) -> MultiStart:
    """Solve a problem from every start; in one process, all share what follows from its sparsity.

    Args:
        nlp: the problem.
        starts: each (n,).
        workers: processes; more than one needs an operating system that can fork, as the problem's
            callables go to the workers by inheritance.
        accept: whether a success may be the best: a certificate of the caller's, say. Failures are
            not shown to it.
        patience: stop when as many starts in a row have found no optimum that is new; None for all
            starts. With more workers than one it counts whole batches of them.
        options: of `solve`.

    Raises:
        NlpError: there is no start or no worker, or a start is no point.
    """
    try:
        points = [start_point("starts", nlp, start) for start in starts]
    except TypeError:
        raise NlpError(f"starts are points, one after the other, not {starts!r}") from None
    if not points:
        raise NlpError("starts is empty")
    whole_number("workers", workers, 1)
    if patience is not None:
        whole_number("patience", patience, 1)
    results: list[Result] = []
    accepted: list[bool] = []
    distinct: tuple[int, ...] = ()
    idle = 0
    for found in _batches(nlp, points, workers, options, patience is not None):
        results += found
        accepted += [r.success and (accept is None or bool(accept(r))) for r in found]
        before, distinct = distinct, _distinct(results, accepted)
        idle = 0 if len(distinct) > len(before) else idle + len(found)
        if patience is not None and idle >= patience:
            break
    best = _best(results, accepted, accept is not None)
    return MultiStart(tuple(results), tuple(accepted), best, distinct)


def _batches(
    nlp: NLP, points: list[FloatArray], workers: int, options: dict[str, Any], small: bool
) -> Iterator[list[Result]]:
    """Results, some at a time: one, or as many as there are workers where batches are small."""
    if workers > 1:
        size = workers if small else len(points)
        for k in range(0, len(points), size):
            yield _in_processes(nlp, points[k : k + size], workers, options)
        return
    before: Result | None = None
    for point in points:
        shared = options if before is None else {"structure_of": before, **options}
        before = solve(nlp, point, **shared)
        yield [_bare(before)]


def _distinct(results: Sequence[Result], accepted: Sequence[bool]) -> tuple[int, ...]:
    """See `MultiStart`."""
    kept: list[int] = []
    successes = [i for i, good in enumerate(accepted) if good]
    for i in sorted(successes, key=lambda k: results[k].objective):
        if not any(_alike(results[i], results[k]) for k in kept):
            kept.append(i)
    return tuple(kept)


def _alike(one: Result, other: Result) -> bool:
    """Whether two solutions are the same optimum."""
    apart = abs(one.objective - other.objective)
    if apart > _SAME_OBJECTIVE * max(1.0, abs(one.objective)):
        return False
    size = np.maximum(1.0, np.abs(one.x))
    return bool((np.abs(one.x - other.x) <= _SAME_PLACE * size).all())


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
        NlpError: an argument is wrong; the message names it.
    """
    centre, widths = start_point("x0", nlp, x0), numbers("spread", spread)
    if widths.shape not in ((), (nlp.n,)):
        raise NlpError(f"spread has shape {widths.shape}, expected a number or ({nlp.n},)")
    if not (np.isfinite(widths).all() and (widths >= 0).all()):
        raise NlpError(f"spread is zero or more, not {spread!r}")
    whole_number("count", count, 1)
    whole_number("seed", seed, 0)
    lower, upper, *_ = nlp.bounds
    random = np.random.default_rng(seed)
    noise = random.standard_normal((count - 1, nlp.n)) * widths
    return [np.clip(centre, lower, upper), *(np.clip(centre + row, lower, upper) for row in noise)]


def _best(results: Sequence[Result], accepted: Sequence[bool], certified: bool) -> int | None:
    indices = range(len(results))
    if any(accepted):
        return min((i for i in indices if accepted[i]), key=lambda i: results[i].objective)
    if certified:
        return None
    return min(indices, key=lambda i: (results[i].constraint_violation, results[i].objective))


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
