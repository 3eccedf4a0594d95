"""`solve`, with every claim of its result held against the callables."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from flyby.core.sqp import NLP, Result, Status, solve
from flyby.core.sqp.nlp import FloatArray


def solved(nlp: NLP, x0, *, tolerance: float = 1e-6, **options) -> Result:
    """The result of `solve`, which does not lie."""
    result = solve(nlp, x0, tolerance=tolerance, **options)
    assert_honest(nlp, result, tolerance)
    return result


def assert_honest(nlp: NLP, result: Result, tolerance: float = 1e-6) -> None:
    """Residuals, objective and status are what the callables say."""
    kkt, violation = recomputed(nlp, result)
    assert result.constraint_violation == pytest.approx(violation, rel=1e-9, abs=1e-14)
    assert result.kkt_residual == pytest.approx(kkt, rel=1e-6, abs=1e-9)
    assert result.success == (result.status in (Status.OPTIMAL, Status.ACCEPTABLE))
    if result.status is Status.OPTIMAL:
        assert max(kkt, violation) <= tolerance
    if result.status is Status.ACCEPTABLE:
        assert violation <= tolerance
    if result.status is Status.INFEASIBLE:
        assert violation > tolerance
    assert result.message


def recomputed(nlp: NLP, result: Result) -> tuple[float, float]:
    """KKT residual and violation at a result's point, as `Result` defines them."""
    x, multipliers, nu = result.x, result.multipliers, result.bound_multipliers
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    if nlp.residuals is not None and nlp.residual_jacobian is not None:
        r = nlp.residuals(x)
        slope, objective = _dense(nlp.residual_jacobian(x)).T @ r, 0.5 * float(r @ r)
    elif nlp.objective is not None and nlp.gradient is not None:
        slope = np.asarray(nlp.gradient(x), dtype=float).reshape(nlp.n)
        objective = float(np.asarray(nlp.objective(x)).reshape(()))
    else:
        slope, objective = np.zeros(nlp.n), 0.0
    assert result.objective == pytest.approx(objective, rel=1e-12, abs=1e-300)
    c = np.zeros(0)
    if nlp.constraints is not None and nlp.jacobian is not None:
        c = np.asarray(nlp.constraints(x), dtype=float).reshape(nlp.m)
        slope = slope + _dense(nlp.jacobian(x)).T @ multipliers
    parts = [
        np.abs(slope + nu),
        _complementarity(multipliers, c, c_lower, c_upper),
        _complementarity(nu, x, x_lower, x_upper),
    ]
    kkt = max(float(part.max(initial=0.0)) for part in parts)
    return kkt, max(_excess(c, c_lower, c_upper), _excess(x, x_lower, x_upper))


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
