"""Jets against closed forms and against differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.validation.trajectories import jets
from flyby.validation.trajectories.jets import (
    Jet,
    arctan,
    cos,
    erf,
    exp,
    log,
    sin,
    sqrt,
    tan,
    tanh,
    variables,
)

FORMULAS: dict[str, Callable] = {
    "sums": lambda x, y: 3 + x - y - (2 - x) + (+y),
    "products": lambda x, y: 2 * x * y * (x + 1) * 0.5,
    "quotients": lambda x, y: x / y + 1 / (x * y) - y / 3,
    "whole powers": lambda x, y: x**3 - y**2 + (x * y) ** -2 + x**1,
    "real powers": lambda x, y: x**1.7 * y**-0.6,
    "powers of both": lambda x, y: x**y + 2.0 ** (x - y),
    "exp": lambda x, y: exp(x - y**2),
    "log": lambda x, y: log(x + 2 * y) * x,
    "sqrt": lambda x, y: sqrt(x * y + 1),
    "sin": lambda x, y: sin(x * y),
    "cos": lambda x, y: cos(x / y),
    "tan": lambda x, y: tan(0.3 * x * y),
    "tanh": lambda x, y: tanh(x - y),
    "arctan": lambda x, y: arctan(x / y),
    "erf": lambda x, y: erf(x - y**2),
}
positive = st.floats(0.5, 2.0)


def _derivatives(formula: Callable, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    step = 1e-4
    n = len(x)
    gradient, hessian = np.zeros(n), np.zeros((n, n))
    unit = np.eye(n) * step
    for i in range(n):
        gradient[i] = (formula(*(x + unit[i])) - formula(*(x - unit[i]))) / (2 * step)
        for j in range(n):
            corners = [
                a * b * formula(*(x + a * unit[i] + b * unit[j])) for a in (1, -1) for b in (1, -1)
            ]
            hessian[i, j] = sum(corners) / (4 * step**2)
    return gradient, hessian


@pytest.mark.parametrize("name", FORMULAS)
@settings(max_examples=30)
@given(x=positive, y=positive)
def test_jets_agree_with_differences(name: str, x: float, y: float) -> None:
    formula, at = FORMULAS[name], np.array([x, y])
    found = formula(*variables(at))
    gradient, hessian = _derivatives(formula, at)
    assert found.value == pytest.approx(formula(*at), rel=1e-13, abs=1e-13)
    scale = max(1.0, np.abs(hessian).max())
    np.testing.assert_allclose(found.gradient, gradient, atol=2e-6 * scale)
    np.testing.assert_allclose(found.hessian, hessian, atol=2e-4 * scale)
    np.testing.assert_array_equal(found.hessian, found.hessian.T)


def test_powers_at_zero_have_the_polynomials_derivatives() -> None:
    x = variables([0.0])[0]
    for power, second in ((1, 0.0), (2, 2.0), (3, 0.0), (4, 0.0)):
        found = x**power
        assert (found.value, found.gradient[0]) == (0.0, 1.0 if power == 1 else 0.0)
        assert found.hessian[0, 0] == second


def test_numpy_numbers_on_the_left_give_jets() -> None:
    x = variables([2.0])[0]
    for found in (np.float64(3) + x, np.float64(3) * x, np.float64(3) - x, np.float64(3) / x):
        assert isinstance(found, Jet)


def test_plain_numbers_stay_plain() -> None:
    for name in ("exp", "log", "sqrt", "sin", "cos", "tan", "tanh", "arctan"):
        assert getattr(jets, name)(0.7) == getattr(np, name)(0.7)
