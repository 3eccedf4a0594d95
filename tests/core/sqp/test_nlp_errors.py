"""Every wrong argument is refused by an error that names it."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.errors import FlybyError
from flyby.core.sqp import (
    NLP,
    NlpError,
    check_derivatives,
    scattered_starts,
    solve,
    solve_from,
)

NAN, INF = float("nan"), float("inf")


def parts(**changes) -> dict:
    plain = {
        "n": 2,
        "m": 1,
        "objective": lambda x: x @ x,
        "gradient": lambda x: 2 * x,
        "constraints": lambda x: x[:1],
        "jacobian": lambda x: np.array([[1.0, 0.0]]),
        "hessian": lambda x, factor, y: 2 * factor * np.eye(2),
    }
    return {**plain, **changes}


WRONG_PROBLEMS = [
    ({"n": 0}, "n is"),
    ({"n": 2.0}, "n is"),
    ({"n": True}, "n is"),
    ({"m": -1}, "m is"),
    ({"m": 1.5}, "m is"),
    ({"gradient": None}, "objective and gradient"),
    ({"objective": None}, "objective and gradient"),
    ({"jacobian": None}, "constraints and jacobian"),
    ({"constraints": None}, "constraints and jacobian"),
    ({"constraints": None, "jacobian": None}, "m = 1"),
    ({"m": 0}, "m = 0"),
    ({"residuals": lambda x: x}, "residuals and residual_jacobian"),
    ({"residuals": lambda x: x, "residual_jacobian": lambda x: np.eye(2)}, "residuals exclude"),
    (
        {
            "objective": None,
            "gradient": None,
            "residuals": lambda x: x,
            "residual_jacobian": lambda x: np.eye(2),
        },
        "hessian",
    ),
    ({"objective": 3}, "objective is a callable"),
    ({"gradient": 3}, "gradient is a callable"),
    ({"constraints": 3}, "constraints is a callable"),
    ({"jacobian": 3}, "jacobian is a callable"),
    ({"hessian": np.eye(2)}, "hessian is a callable"),
    ({"x_lower": [0, 0, 0]}, "x_lower has shape"),
    ({"x_upper": [[0, 0]]}, "x_upper has shape"),
    ({"c_lower": [0, 0]}, "c_lower has shape"),
    ({"c_upper": np.zeros((1, 1))}, "c_upper has shape"),
    ({"x_lower": "low"}, "x_lower"),
    ({"c_upper": [None]}, "c_upper"),
    ({"x_lower": [0, NAN]}, r"x_lower\[1\] is NaN"),
    ({"x_upper": NAN}, r"x_upper\[0\] is NaN"),
    ({"c_lower": [NAN]}, r"c_lower\[0\] is NaN"),
    ({"c_upper": [NAN]}, r"c_upper\[0\] is NaN"),
    ({"x_lower": [0, INF]}, r"x_lower\[1\] is inf"),
    ({"x_upper": [0, -INF]}, r"x_upper\[1\] is -inf"),
    ({"c_lower": INF}, r"c_lower\[0\] is inf"),
    ({"c_upper": -INF}, r"c_upper\[0\] is -inf"),
    ({"x_lower": [0, 2], "x_upper": [1, 1]}, r"x_lower\[1\] = 2 is above x_upper\[1\] = 1"),
    ({"x_lower": [0, 1.0000001], "x_upper": 1}, r"= 1.0000001 is above x_upper\[1\] = 1$"),
    ({"c_lower": 2, "c_upper": 1}, r"c_lower\[0\] = 2 is above c_upper\[0\] = 1"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG_PROBLEMS)
def test_wrong_problems(changes: dict, message: str) -> None:
    with pytest.raises(NlpError, match=message) as caught:
        NLP(**parts(**changes))
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, FlybyError)


WRONG_CALLS = [
    ({"x0": [0]}, "x0 has shape"),
    ({"x0": [[0, 0]]}, "x0 has shape"),
    ({"x0": [0, NAN]}, r"x0\[1\]"),
    ({"x0": [INF, 0]}, r"x0\[0\]"),
    ({"x0": "ab"}, "x0"),
    ({"x0": None}, "x0"),
    ({"tolerance": 0}, "tolerance"),
    ({"tolerance": -1e-6}, "tolerance"),
    ({"tolerance": NAN}, "tolerance"),
    ({"tolerance": "a"}, "tolerance"),
    ({"tolerance": None}, "tolerance"),
    ({"tolerance": [1e-6, 1]}, "tolerance"),
    ({"max_iterations": -1}, "max_iterations"),
    ({"max_iterations": "5"}, "max_iterations"),
    ({"max_iterations": None}, "max_iterations"),
    ({"max_iterations": INF}, "max_iterations"),
    ({"max_iterations": 50.0}, "max_iterations"),
    ({"warm_start": 5}, "warm_start"),
    ({"qp": "gurobi"}, "qp: one of clarabel, osqp"),
    ({"hessian_kind": "newton"}, "hessian_kind: one of exact"),
    ({"hessian_kind": "gauss_newton"}, "gauss_newton.*residuals"),
    ({"callback": 1}, "callback"),
    ({"step_box": [1, 1]}, "step_box"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG_CALLS)
def test_wrong_calls(changes: dict, message: str) -> None:
    with pytest.raises(NlpError, match=message):
        solve(**{"nlp": NLP(**parts()), "x0": [1, 1], **changes})


def test_the_exact_kind_needs_a_hessian() -> None:
    with pytest.raises(NlpError, match=r"exact.*hessian"):
        solve(NLP(**parts(hessian=None)), [1, 1], hessian_kind="exact")


@pytest.mark.parametrize(
    "box",
    [
        lambda k, x: ([0.1, -1], [1, 1]),
        lambda k, x: ([-1, -1], [1, -0.1]),
        lambda k, x: ([-1, NAN], [1, 1]),
        lambda k, x: (-np.ones(3), np.ones(3)),
        lambda k, x: None,
        lambda k, x: ("a", 1),
        lambda k, x: (None, None),
    ],
)
def test_step_boxes_are_limits_that_enclose_zero(box) -> None:
    with pytest.raises(NlpError, match="step_box"):
        solve(NLP(**parts()), [1, 1], step_box=box)


def test_wrong_multistarts_and_checks() -> None:
    nlp = NLP(**parts())
    with pytest.raises(NlpError, match="starts"):
        solve_from(nlp, [])
    with pytest.raises(NlpError, match="workers"):
        solve_from(nlp, [[0, 0]], workers=0)
    with pytest.raises(NlpError, match="starts has shape"):
        solve_from(nlp, [[0, 0, 0]])
    for starts in (5, [["a", "b"]], [[NAN, 0]]):
        with pytest.raises(NlpError, match="starts"):
            solve_from(nlp, starts)
    for workers in ("2", 1.5, True, None):
        with pytest.raises(NlpError, match="workers"):
            solve_from(nlp, [[0, 0]], workers=workers)
    with pytest.raises(NlpError, match="x has shape"):
        check_derivatives(nlp, [0, 0, 0])
    with pytest.raises(NlpError, match="gradient gave shape"):
        check_derivatives(NLP(**parts(gradient=lambda x: np.zeros(3))), [0, 0])


def test_bounds_are_copied_and_frozen() -> None:
    mine = np.zeros(2)
    nlp = NLP(**parts(x_lower=mine))
    mine[0] = 7
    np.testing.assert_array_equal(nlp.bounds[0], [0, 0])
    with pytest.raises(ValueError, match="read-only"):
        nlp.bounds[0][0] = 1


def test_scattered_starts_need_a_start_of_the_right_size() -> None:
    with pytest.raises(NlpError, match="x0"):
        scattered_starts(NLP(**parts()), [0, 0, 0], 3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"count": 2.5}, "count"),
        ({"count": 0}, "count"),
        ({"spread": "a"}, "spread"),
        ({"spread": NAN}, "spread"),
        ({"spread": -1}, "spread"),
        ({"spread": [1, 2, 3]}, "spread has shape"),
        ({"seed": -1}, "seed"),
        ({"x0": ["q", "r"]}, "x0"),
    ],
)
def test_wrong_scattered_starts(changes: dict, message: str) -> None:
    with pytest.raises(NlpError, match=message):
        scattered_starts(**{"nlp": NLP(**parts()), "x0": [0, 0], "count": 3, **changes})
