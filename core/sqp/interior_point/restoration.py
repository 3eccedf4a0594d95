"""Restoration of feasibility by an interior point of its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ..algebra.linear import SaddlePatterns
from ..algebra.matrices import SparseMatrix, identity
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.scaled import ScaledProblem
from .barrier import Barrier
from .elastic import ElasticFunctions
from .functions import ConstraintHessian
from .method import InteriorPoint

_ENOUGH = 0.9
_LEAST_MU = 1e-9


def restored(
    outer: InteriorPoint,
    curvature: ConstraintHessian,
    patterns: SaddlePatterns,
    moved: Callable[[Point, float], None],
) -> tuple[Point, FloatArray] | None:
    """A point with derivatives, and slacks (m,), from which an interior point that is stuck can go
    on; None where the violation cannot be lowered that far.

    Args:
        outer: the interior point.
        curvature: of the constraints.
        patterns: keeps symbolic factorisations.
        moved: called after each iteration with the point and the share of the step that led there;
            may end the solution by an exception.

    Raises:
        CallableError: a Hessian has no value.
    """
    place, functions = outer.place, outer.functions
    n, mu = len(place.point.x), outer.barrier.mu
    first_theta, first_phi = outer.search.measures(place.at.v, place.point, mu)
    first_mu = max(mu, float(np.abs(place.rest).max()))
    elastic = ElasticFunctions(functions, curvature, place.point, np.sqrt(mu))
    outer.search.filter.add(first_theta, first_phi)
    found: list[tuple[Point, FloatArray]] = []

    def seen(inner: InteriorPoint, length: float, kind: str) -> bool:
        if not kind:
            return False
        point = functions.point(elastic.inner(inner.place.point))
        v = inner.place.at.v
        v = np.concatenate([point.x, v[len(v) - len(point.c) :]])
        theta, phi = outer.search.measures(v, point, mu)
        functions.differentiate(point)
        moved(point, length)
        if theta <= _ENOUGH * first_theta and outer.search.filter.admits(theta, phi):
            found.append((point, v[n:]))
            return True
        return False

    barrier = Barrier(_LEAST_MU, first_mu)
    inner = InteriorPoint(elastic, patterns, outer.tolerance, barrier, seen)
    try:
        inner.start(elastic.begin(place.point, place.at.v[n:], first_mu), first_theta)
        inner.run()
    except CallableError:
        return None
    return found[0] if found else None


def curvature_of(problem: ScaledProblem) -> ConstraintHessian:
    """The constraints' curvature where the problem gives Hessians; else none, which makes the
    restoration one of Gauss and Newton."""
    if problem.nlp.hessian is not None:
        return problem.evaluation.constraint_hessian
    none = SparseMatrix(identity(problem.nlp.n), np.zeros(problem.nlp.n))
    return lambda x, multipliers: none
