"""The Hock–Schittkowski problems, crossed with the back ends and the kinds of Hessian."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatch
from itertools import product

import numpy as np
import pytest

from flyby.core.sqp import BackendKind, HessianKind, Result, Status, check_derivatives

from . import hock_schittkowski, hock_schittkowski_large, hock_schittkowski_medium
from .honesty import solved
from .problem import Problem

PROBLEMS = {
    value.name: value
    for module in (hock_schittkowski, hock_schittkowski_medium, hock_schittkowski_large)
    for value in vars(module).values()
    if isinstance(value, Problem)
}
# Exact and quasi-Newton Hessians with both back ends that every installation has; what else there
# is with one of the others each.
WAYS = (
    *product((BackendKind.CLARABEL, BackendKind.OSQP), (HessianKind.EXACT, HessianKind.BFGS)),
    (BackendKind.CLARABEL, HessianKind.DIFFERENCES),
    (BackendKind.INTERIOR_POINT, HessianKind.EXACT),
)
CASES = [f"{name} {backend} {kind}" for name, (backend, kind) in product(PROBLEMS, WAYS)]

# Cases (problem, back end, kind of Hessian) that end in another local optimum, and its value.
ELSEWHERE = {
    "hs16 * *": 3.98206045,
    "hs20 * *": 40.19873,
    "hs33 * *": -4.0,
    "hs55 * *": 20 / 3,
    "hs97 * bfgs": 4.07124636,
    "hs98 * bfgs": 4.07124636,
}

# Cases that do not reach the optimum to the tolerance in 100 iterations, and why.
UNSOLVED = {
    "hs13 * *": "a cusp: no multipliers exist at the solution",
    "hs54 * bfgs": "gradients are below the tolerance far from the optimum: x is of size 1e8",
    "hs54 * differences": "as by bfgs",
    "hs75 osqp *": "first-order subproblems leave violations of 1e-5: multipliers of 3e3",
    "hs69 interior_point *": "rounding decides without a fallback; with one it ends well",
    "hs101 osqp *": "first-order subproblems are not exact enough for exponents of -3 to 3",
    "hs101 clarabel bfgs": "dense updates do not follow exponents of -3 to 3: restoration wanders",
    "hs101 clarabel differences": "as by bfgs",
    "hs102 osqp *": "as hs101",
    "hs103 osqp *": "as hs101",
    "hs116 * *": "degenerate: rows depend on each other to 1e-4 along the way",
}


def _listed(case: str, table: dict) -> list:
    return [value for pattern, value in table.items() if fnmatch(case, pattern)]


ORDINARY = [c for c in CASES if not _listed(c, ELSEWHERE) and not _listed(c, UNSOLVED)]


def _close(value: float, to: float) -> bool:
    return abs(value - to) <= 1e-6 * max(1.0, abs(to))


def _from_the_published_start(case: str, max_iterations: int) -> tuple[Problem, Result]:
    name, backend, kind = case.split()
    stated = PROBLEMS[name]
    result = solved(
        stated.nlp(),
        stated.start,
        qp=backend,
        hessian_kind=kind,
        fallback=False,
        max_iterations=max_iterations,
    )
    return stated, result


def test_the_table_is_large_and_its_exceptions_are_few() -> None:
    assert len(PROBLEMS) >= 90
    assert len(ORDINARY) >= 0.85 * len(CASES)
    exact = [c for c in CASES if fnmatch(c, "* clarabel exact")]
    assert len(set(exact) & set(ORDINARY)) >= 0.9 * len(exact)
    for pattern in (*ELSEWHERE, *UNSOLVED):
        assert any(fnmatch(case, pattern) for case in CASES), pattern


@pytest.mark.parametrize("name", PROBLEMS)
def test_statements_have_right_derivatives(name: str) -> None:
    stated = PROBLEMS[name]
    nlp = stated.nlp()
    lower, upper, *_ = nlp.bounds
    inside = np.clip(stated.start, lower + 1e-3, upper - 1e-3)  # differences stay within
    found = check_derivatives(nlp, inside + 1e-3 * np.cos(np.arange(nlp.n)), tolerance=1e-4)
    assert found.passed, str(found)


@pytest.mark.parametrize("case", ORDINARY)
def test_the_optimum_is_reached(case: str) -> None:
    stated, result = _from_the_published_start(case, 100)
    assert result.status is Status.OPTIMAL
    assert _close(result.objective, stated.optimum)


@pytest.mark.parametrize("case", [c for c in CASES if _listed(c, ELSEWHERE)])
def test_another_local_optimum_is_reached(case: str) -> None:
    stated, result = _from_the_published_start(case, 100)
    (value,) = _listed(case, ELSEWHERE)
    assert result.status is Status.OPTIMAL
    assert _close(result.objective, value)
    assert not _close(value, stated.optimum)


@pytest.mark.parametrize("case", [c for c in CASES if _listed(c, UNSOLVED)])
def test_the_listed_exceptions_claim_nothing_false(case: str) -> None:
    """Rounding, and with it the machine, decides whether one of them converges; `solved` sees to it
    that residuals are true, and none may call a problem with a solution infeasible or unbounded."""
    _, result = _from_the_published_start(case, 25)
    assert result.status not in (Status.INFEASIBLE, Status.UNBOUNDED)


# By limited memory: other local optima, and those that are not reached.
LIMITED = {
    "hs16": 3.98206045,
    "hs20": 40.19873,
    "hs55": 20 / 3,
    "hs97": 4.07124636,
    "hs108": -0.674981429,
    "hs47": -0.026714182,
    "hs13": None,
    "hs101": None,
}


@pytest.mark.parametrize("name", PROBLEMS)
def test_first_derivatives_and_the_last_steps_lead_to_the_optimum(name: str) -> None:
    stated = PROBLEMS[name]
    nlp = replace(stated.nlp(), hessian=None)
    value = LIMITED.get(name, stated.optimum)
    most = 25 if value is None else 150
    result = solved(nlp, stated.start, hessian_kind="lbfgs", max_iterations=most)
    assert result.method.startswith("interior_point")
    if value is None:
        assert result.status not in (Status.INFEASIBLE, Status.UNBOUNDED)
    else:
        assert result.status is Status.OPTIMAL
        assert _close(result.objective, value)


NEARBY = {
    "hs16": (0.5, 0.3),
    "hs20": (0.4, 0.9),
    "hs33": (0.1, 1.4, 1.4),
    "hs55": (0.1, 1.3, 1.6, 0.9, 0.7, 0.4),
    "hs59": (13.5, 51.6),
    "hs97": (0.268, 0, 0, 0, 0.028, 0.0134),
    "hs98": (0.268, 0, 0, 0, 0.028, 0.0134),
}


@pytest.mark.parametrize("name", NEARBY)
def test_the_published_optimum_is_reached_from_nearby(name: str) -> None:
    stated = PROBLEMS[name]
    result = solved(stated.nlp(), NEARBY[name])
    assert result.status is Status.OPTIMAL
    assert _close(result.objective, stated.optimum)
