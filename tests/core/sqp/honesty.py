"""`solve`, with every claim of its result held against the callables."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize, sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, Result, Status, solve

METHOD = "auto"
"""The method where a test names none."""
_REACH = 0.1
"""Share of a variable's size, but at least of 1, within which a violation is stationary."""
_LEFT = 1e-2
"""Share of a violation that a step within the reach may promise to take away."""


def solved(nlp: NLP, x0, *, tolerance: float = 1e-6, **options) -> Result:
    """The result of `solve`, which does not lie."""
    result = solve(nlp, x0, tolerance=tolerance, **{"method": METHOD, **options})
    assert_honest(nlp, result, tolerance)
    return result


def assert_honest(nlp: NLP, result: Result, tolerance: float = 1e-6) -> None:
    """Residuals, objective and status are what the callables say."""
    kkt, violation = recomputed(nlp, result)
    assert result.constraint_violation == pytest.approx(violation, rel=1e-9, abs=1e-14)
    rounding = 1e-13 * float(_slopes(nlp, result)[1].max())
    assert result.kkt_residual == pytest.approx(kkt, rel=1e-6, abs=1e-9 + rounding)
    assert result.success == (result.status in (Status.OPTIMAL, Status.ACCEPTABLE))
    if result.status is Status.OPTIMAL:
        assert max(kkt, violation) <= tolerance
    if result.status is Status.ACCEPTABLE:
        assert violation <= max(tolerance, 1e-12 * _size_of_constraints(nlp, result.x))
        assert relative_residual(nlp, result) <= 1.001 * tolerance
    if result.status is Status.INFEASIBLE:
        assert violation > tolerance
        assert promised_share(nlp, result.x) <= _LEFT
    assert result.message


def recomputed(nlp: NLP, result: Result) -> tuple[float, float]:
    """KKT residual and violation at a result's point, as `Result` defines them."""
    slope, _ = _slopes(nlp, result)
    c, x = _constraints(nlp, result.x), result.x
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    parts = [
        np.abs(slope + result.bound_multipliers),
        _complementarity(result.multipliers, c, c_lower, c_upper),
        _complementarity(result.bound_multipliers, x, x_lower, x_upper),
    ]
    kkt = max(float(part.max(initial=0.0)) for part in parts)
    return kkt, max(_excess(c, c_lower, c_upper), _excess(x, x_lower, x_upper))


def relative_residual(nlp: NLP, result: Result) -> float:
    """Largest residual beside the size of what it is the difference of, but at least beside 1."""
    slope, terms = _slopes(nlp, result)
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    c, y, nu = _constraints(nlp, result.x), result.multipliers, result.bound_multipliers
    parts = [
        np.abs(slope + nu) / np.maximum(1.0, terms),
        _complementarity(y, c, c_lower, c_upper) / np.maximum(1.0, np.abs(y)),
        _complementarity(nu, result.x, x_lower, x_upper) / np.maximum(1.0, np.abs(nu)),
    ]
    return max(float(part.max(initial=0.0)) for part in parts)


def promised_share(nlp: NLP, x: FloatArray) -> float:
    """By which share linear programming lowers the linearised sum of violations within reach.

    Rows count as much as their slopes allow, as they do for the solver where slopes at the start
    are like those at x.
    """
    assert nlp.jacobian is not None
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    J, c = _dense(nlp.jacobian(x)), _constraints(nlp, x)
    m, n = J.shape
    weights = 100.0 / np.maximum(100.0, np.abs(J).max(axis=1, initial=0.0))
    rows, sides = [], []
    for sign, side in ((1.0, c_upper), (-1.0, c_lower)):
        there = np.isfinite(side)
        rows.append(np.hstack([sign * J, -np.eye(m)])[there])
        sides.append((sign * (side - c))[there])
    reach = _REACH * np.maximum(1.0, np.abs(x))
    limits = [*zip(np.maximum(-reach, x_lower - x), np.minimum(reach, x_upper - x), strict=True)]
    limits = [(min(low, 0.0), max(high, 0.0)) for low, high in limits] + [(0.0, None)] * m
    found = optimize.linprog(
        np.concatenate([np.zeros(n), weights]),
        np.vstack(rows),
        np.concatenate(sides),
        bounds=limits,
    )
    assert found.success
    now = weights @ np.maximum(np.maximum(c_lower - c, c - c_upper), 0.0)
    return float((now - found.fun) / now)


def _slopes(nlp: NLP, result: Result) -> tuple[FloatArray, FloatArray]:
    """Slope of the Lagrangian without bounds, and the size of what it is the sum of; the objective
    is checked on the way."""
    x, multipliers = result.x, result.multipliers
    if nlp.residuals is not None and nlp.residual_jacobian is not None:
        r = nlp.residuals(x)
        slope, objective = _dense(nlp.residual_jacobian(x)).T @ r, 0.5 * float(r @ r)
    elif nlp.objective is not None and nlp.gradient is not None:
        slope = np.asarray(nlp.gradient(x), dtype=float).reshape(nlp.n)
        objective = float(np.asarray(nlp.objective(x)).reshape(()))
    else:
        slope, objective = np.zeros(nlp.n), 0.0
    assert result.objective == pytest.approx(objective, rel=1e-12, abs=1e-300)
    terms = np.abs(slope)
    if nlp.jacobian is not None:
        J = _dense(nlp.jacobian(x))
        slope, terms = slope + J.T @ multipliers, terms + np.abs(J).T @ np.abs(multipliers)
    return slope, terms


def _constraints(nlp: NLP, x: FloatArray) -> FloatArray:
    if nlp.constraints is None:
        return np.zeros(0)
    return np.asarray(nlp.constraints(x), dtype=float).reshape(nlp.m)


def _size_of_constraints(nlp: NLP, x: FloatArray) -> float:
    if nlp.jacobian is None:
        return 0.0
    size = np.abs(_constraints(nlp, x)) + np.abs(_dense(nlp.jacobian(x))) @ np.abs(x)
    return float(size.max())


def _complementarity(
    multiplier: FloatArray, value: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """Multiplier times distance from the side that it pushes at; itself where that is far."""
    distance = np.where(multiplier > 0, np.abs(upper - value), np.abs(value - lower))
    return np.abs(multiplier) * np.minimum(distance, 1.0)


def _excess(value: FloatArray, lower: FloatArray, upper: FloatArray) -> float:
    return float(np.maximum(lower - value, value - upper).max(initial=0.0))


def _dense(matrix) -> FloatArray:
    return matrix.toarray() if sparse.issparse(matrix) else np.asarray(matrix, dtype=float)
