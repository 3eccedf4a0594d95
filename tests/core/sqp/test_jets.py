"""Jets against closed forms and differences; expressions against jets."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.validation.trajectories import expressions
from flyby.validation.trajectories.expressions import Expression, Graph, slopes
from flyby.validation.trajectories.tape import Tape

from . import jets
from .jets import Jet, variables

FORMULAS: dict[str, Callable] = {
    "sums": lambda m, x, y: 3 + x - y - (2 - x) + (+y),
    "products": lambda m, x, y: 2 * x * y * (x + 1) * 0.5,
    "quotients": lambda m, x, y: x / y + 1 / (x * y) - y / 3,
    "whole powers": lambda m, x, y: x**3 - y**2 + (x * y) ** -2 + x**1,
    "real powers": lambda m, x, y: x**1.7 * y**-0.6,
    "powers of both": lambda m, x, y: x**y + 2.0 ** (x - y),
    "exp": lambda m, x, y: m.exp(x - y**2),
    "log": lambda m, x, y: m.log(x + 2 * y) * x,
    "sqrt": lambda m, x, y: m.sqrt(x * y + 1),
    "sin": lambda m, x, y: m.sin(x * y),
    "cos": lambda m, x, y: m.cos(x / y),
    "tan": lambda m, x, y: m.tan(0.3 * x * y),
    "tanh": lambda m, x, y: m.tanh(x - y),
    "arctan": lambda m, x, y: m.arctan(x / y),
    "erf": lambda m, x, y: m.erf(x - y**2),
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
    formula, at = partial(FORMULAS[name], jets), np.array([x, y])
    found = formula(*variables(at))
    gradient, hessian = _derivatives(formula, at)
    assert found.value == pytest.approx(formula(*at), rel=1e-13, abs=1e-13)
    scale = max(1.0, np.abs(hessian).max())
    np.testing.assert_allclose(found.gradient, gradient, atol=2e-6 * scale)
    np.testing.assert_allclose(found.hessian, hessian, atol=2e-4 * scale)
    np.testing.assert_array_equal(found.hessian, found.hessian.T)


@pytest.mark.parametrize("name", FORMULAS)
@settings(max_examples=10)
@given(places=st.lists(st.tuples(positive, positive), min_size=1, max_size=70))
def test_expressions_agree_with_jets(name: str, places: list[tuple[float, float]]) -> None:
    formula = FORMULAS[name]
    graph = Graph(2)
    value = formula(expressions, *graph.variables)
    first = slopes(value, graph.variables)
    second = [entry for slope in first for entry in slopes(slope, graph.variables)]
    found = Tape(graph, [value, *first, *second]).values(np.array(places).T)
    for column, at in zip(found.T, places, strict=True):
        jet = formula(jets, *variables(at))
        wanted = [jet.value, *jet.gradient, *jet.hessian.ravel()]
        np.testing.assert_allclose(column, wanted, rtol=1e-11, atol=1e-11)


def test_expressions_write_nothing_down_that_is_zero_or_known() -> None:
    graph = Graph(2)
    x, y = graph.variables
    value = 3.0 * x + (x * y + y * x) ** 2
    assert [slope.number for slope in slopes(3.0 * x + 2.0, [x, y])] == [3.0, 0.0]
    assert (x * y).node == (y * x).node
    assert isinstance(value - value * 1.0 + 0.0, Expression)


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
