"""Derivatives of solutions, held against solutions of changed problems."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.sqp import NLP, NlpError, Result, sensitivities, solve
from flyby.validation.textbook import DoubleIntegrator

from .problem import at_most, equal, nlp_from

_STEP = 1e-4


def _nearest(goal: np.ndarray, radius: float, least: float) -> tuple[NLP, Result]:
    """The point of a ball, above a plane, that is nearest to a goal, with a quartic term."""

    def formula(x, y, z):
        square = (x - goal[0]) ** 2 + (y - goal[1]) ** 2 + (z - goal[2]) ** 2
        return square + 0.1 * x**4, [at_most(x**2 + y**2 + z**2, radius), equal(x + y, 0.3)]

    nlp = nlp_from(formula, 3, lower=[-9.0, -9.0, least], upper=9.0)
    return nlp, solve(nlp, [0.1, 0.1, 0.5], tolerance=1e-10)


@given(
    goal=st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    radius=st.floats(0.5, 4.0),
    least=st.floats(-0.5, 0.3),
)
@settings(max_examples=60, deadline=None)
def test_they_are_what_solutions_near_by_show(goal, radius, least) -> None:
    centre = np.array(goal)
    nlp, found = _nearest(centre, radius, least)
    assume(found.success)
    # Parameters: the goal's x, the ball's radius squared, the plane's height.
    slope = np.zeros((3, 3))
    slope[0, 0] = -2.0
    rows, bound = np.zeros((2, 3)), np.zeros((3, 3))
    rows[0, 1], bound[2, 2] = -1.0, 1.0
    held = found.bound_multipliers[2] != 0.0
    if not held:
        bound[2, 2] = 0.0
    fall = np.array([-2.0 * (found.x[0] - centre[0]), 0.0, 0.0])
    known = sensitivities(
        nlp,
        found,
        slope_change=slope,
        constraint_change=rows,
        bound_change=bound,
        objective_change=fall,
    )
    for j, (by, change) in enumerate(
        [((1, 0, 0), (0, 0)), ((0, 0, 0), (1, 0)), ((0, 0, 0), (0, 1))]
    ):
        ends = [
            _nearest(
                centre + sign * _STEP * np.array(by),
                radius + sign * _STEP * change[0],
                least + sign * _STEP * change[1],
            )[1]
            for sign in (1.0, -1.0)
        ]
        same = all(
            np.array_equal(e.multipliers != 0, found.multipliers != 0)
            and np.array_equal(e.bound_multipliers != 0, found.bound_multipliers != 0)
            for e in ends
        )
        assume(same and all(e.success for e in ends) and not known.weak)
        steep = (ends[0].x - ends[1].x) / (2 * _STEP)
        np.testing.assert_allclose(known.x[:, j], steep, atol=1e-3 * max(1, np.abs(steep).max()))
        fallen = (ends[0].objective - ends[1].objective) / (2 * _STEP)
        assert known.objective[j] == pytest.approx(fallen, abs=1e-3 * max(1.0, abs(fallen)))


def test_a_moved_start_is_predicted() -> None:
    """The double integrator's time changes with its start as the exact time does."""
    problem = DoubleIntegrator(60)
    nlp = problem.nlp()
    found = solve(nlp, problem.initial_guess(), tolerance=1e-9)
    bound = np.zeros((problem.n, 1))
    bound[1, 0] = 1.0  # the first place
    known = sensitivities(nlp, found, bound_change=bound)
    moved = DoubleIntegrator(60, start=(4.01, 1.0))
    again = solve(moved.nlp(), known.predicted([0.01]), warm_start=found, tolerance=1e-9)
    assert again.iterations <= 2
    assert found.objective + 0.01 * known.objective[0] == pytest.approx(again.objective, abs=1e-5)


def test_gauss_newton_and_differences_serve_too() -> None:
    nlp = NLP(
        n=1,
        m=1,
        objective=lambda x: float((x[0] - 2) ** 2),
        gradient=lambda x: 2 * (x - 2),
        constraints=lambda x: x**2,
        jacobian=lambda x: 2 * x[None],
        c_upper=1.0,
    )
    found = solve(nlp, [0.5], tolerance=1e-9)
    known = sensitivities(nlp, found, constraint_change=[[-1.0]])
    assert known.x[0, 0] == pytest.approx(0.5, abs=1e-5)
    assert known.objective[0] == pytest.approx(-1.0, abs=1e-5)


def test_what_has_none_is_refused() -> None:
    nlp = nlp_from(lambda x, y: ((x - 1) ** 2, [equal(x, 1)]), 2)
    found = solve(nlp, [0.0, 0.0])
    with pytest.raises(NlpError, match="not isolated"):
        sensitivities(nlp, found, slope_change=[[1.0], [1.0]])
    with pytest.raises(NlpError, match="none of the changes"):
        sensitivities(nlp, found)
    with pytest.raises(NlpError, match="slope_change"):
        sensitivities(nlp, found, slope_change=[[1.0]])
    stopped = solve(nlp, [3.0, 3.0], max_iterations=0)
    with pytest.raises(NlpError, match="iteration_limit"):
        sensitivities(nlp, stopped, slope_change=[[1.0], [1.0]])
