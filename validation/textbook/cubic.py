"""Two variables and two cubic constraints (thesis, equation 2.4).

    minimise   x₁² + x₁x₂ + x₂² − 3x₁ − 3x₂
    subject to (x₁/2 − 2)³ − x₂ + 4 ≤ 0
               x₁³ + x₂ − 4 ≥ 0

The thesis prints the second constraint as ≤ 0; its figures, whose shaded area lies below both
curves, and the start (5, 5), which it calls feasible, need ≥ 0. The optimum lies where the curves
cross: there x₁³ = −(x₁/2 − 2)³, so x₁ = 2 − x₁/2 = 4/3, and x₂ = 4 − x₁³ = 44/27.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.sqp import NLP, solve

CUBIC_START = np.array([5.0, 5.0])
CUBIC_OPTIMUM = np.array([4.0 / 3.0, 44.0 / 27.0])


def cubic() -> NLP:
    """The problem; constraints in the order and the signs given above."""
    return NLP(
        n=2,
        m=2,
        objective=objective,
        gradient=gradient,
        constraints=constraints,
        jacobian=jacobian,
        hessian=hessian,
        c_lower=[-np.inf, 0.0],
        c_upper=[0.0, np.inf],
    )


def objective(x: FloatArray) -> float:
    """f at x (2,)."""
    a, b = x
    return float(a * a + a * b + b * b - 3.0 * a - 3.0 * b)


def gradient(x: FloatArray) -> FloatArray:
    """∇f (2,)."""
    a, b = x
    return np.array([2.0 * a + b - 3.0, a + 2.0 * b - 3.0])


def constraints(x: FloatArray) -> FloatArray:
    """c (2,)."""
    a, b = x
    return np.array([(a / 2.0 - 2.0) ** 3 - b + 4.0, a**3 + b - 4.0])


def jacobian(x: FloatArray) -> FloatArray:
    """∂c/∂x (2, 2)."""
    a = x[0]
    return np.array([[1.5 * (a / 2.0 - 2.0) ** 2, -1.0], [3.0 * a * a, 1.0]])


def hessian(x: FloatArray, factor: float, multipliers: FloatArray) -> FloatArray:
    """∇²(factor f + multipliers·c) (2, 2)."""
    a = x[0]
    bend = multipliers[0] * 1.5 * (a / 2.0 - 2.0) + multipliers[1] * 6.0 * a
    return np.array([[2.0 * factor + bend, factor], [factor, 2.0 * factor]])


# ------------------------------------------------------------------------------ log barrier


def barrier(x: FloatArray, weight: float) -> float:
    """f − weight Σ log(−hᵢ) with hᵢ ≤ 0 the constraints (2.5, 2.6); infinite outside of them."""
    slack = _slack(x)
    if np.any(slack <= 0.0):
        return np.inf
    return objective(x) - weight * float(np.log(slack).sum())


def barrier_path(weights: Iterable[float], x0: FloatArray = CUBIC_START) -> list[FloatArray]:
    """Minimisers (2,) of the barrier function, each from the one before (figure 2.4).

    Raises:
        InputError: a weight is not above zero.
        ArithmeticError: a minimiser was not reached.
    """
    path = [np.array(x0, dtype=np.float64)]
    for weight in weights:
        if not weight > 0:
            raise InputError(f"weights are numbers above zero, not {weight!r}")
        path.append(_barrier_minimum(path[-1], weight))
    return path[1:]


def _barrier_minimum(x0: FloatArray, weight: float) -> FloatArray:
    """Newton's method on the barrier function, by the SQP solver without constraints."""
    unconstrained = NLP(
        n=2,
        objective=lambda x: barrier(x, weight),
        gradient=lambda x: _barrier_gradient(x, weight),
        hessian=lambda x, factor, _: factor * _barrier_hessian(x, weight),
    )
    found = solve(unconstrained, x0)
    if not found.success:
        raise ArithmeticError(f"barrier weight {weight:g}: {found.message}")
    return found.x


def _slack(x: FloatArray) -> FloatArray:
    return np.array([-1.0, 1.0]) * constraints(x)


def _barrier_gradient(x: FloatArray, weight: float) -> FloatArray:
    slopes = np.array([[-1.0], [1.0]]) * jacobian(x)
    return np.asarray(gradient(x) - weight * slopes.T @ (1.0 / _slack(x)))


def _barrier_hessian(x: FloatArray, weight: float) -> FloatArray:
    slack = _slack(x)
    slopes = np.array([[-1.0], [1.0]]) * jacobian(x) / slack[:, None]
    bent = hessian(x, 1.0, -weight * np.array([-1.0, 1.0]) / slack)
    return bent + weight * slopes.T @ slopes
