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

from ..arrays import FloatArray
from .options import start_point
from .problem.arrays import numbers, whole_number
from .problem.errors import NlpError
from .problem.nlp import NLP
from .result import Result
from .solver import solve


@dataclass(frozen=True, slots=True)
class MultiStart:
    """Solutions from several starts.

    Args:
        results: in the order of the starts.
        accepted: whether each is a success that the caller's certificate, if there is one, lets
            pass.
        best: index of the lowest accepted one. Where none is accepted: the least violated failure,
            or None if there is a certificate.
    """

    results: tuple[Result, ...]
    accepted: tuple[bool, ...]
    best: int | None

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
    **options: Any,
) -> MultiStart:
    """Solve a problem from every start.

    Args:
        nlp: the problem.
        starts: each (n,).
        workers: processes; more than one needs an operating system that can fork, as the problem's
            callables go to the workers by inheritance.
        accept: whether a success may be the best: a certificate of the caller's, say. Failures are
            not shown to it.
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
    results = (
        [_bare(solve(nlp, point, **options)) for point in points]
        if workers == 1
        else _in_processes(nlp, points, workers, options)
    )
    accepted = tuple(r.success and (accept is None or bool(accept(r))) for r in results)
    return MultiStart(tuple(results), accepted, _best(results, accepted, accept is not None))


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
