"""A status is claimed where it is true, and nowhere else."""

from __future__ import annotations

import copy
import pickle
import threading

import numpy as np
import pytest

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP, Iteration, Status, solve
from flyby.core.sqp.problem.optimality import OptimalityResiduals
from flyby.core.sqp.verdict import Ending, Evidence, verdict

from .honesty import assert_honest, solved
from .jets import cos, sin
from .problem import at_least, at_most, equal, nlp_from

NAN = float("nan")


def square() -> dict:
    """|x|² and its gradient."""
    return {"objective": lambda x: x @ x, "gradient": lambda x: 2 * x}


def on_a_line(**changes) -> NLP:
    """Minimise |x|² on x + y = 1."""
    parts = {
        "n": 2,
        "m": 1,
        **square(),
        "constraints": lambda x: np.array([x[0] + x[1]]),
        "jacobian": lambda x: np.ones((1, 2)),
        "c_lower": 1,
        "c_upper": 1,
    }
    return NLP(**{**parts, **changes})


# ------------------------------------------------------------------------------- acceptable


def test_a_large_multiplier_excuses_no_other_variable() -> None:
    """A strictly convex problem in variables of size 4e3 and 1.6e-6; the optimum is a corner."""
    u, Q, q = np.array([4e3, 1.6e-6]), np.array([[1, 0.5], [0.5, 1]]), np.array([3.0, 3.0])
    nlp = NLP(
        n=2,
        objective=lambda x: 0.5 * (x / u) @ Q @ (x / u) + q @ (x / u),
        gradient=lambda x: (Q @ (x / u) + q) / u,
        x_lower=-2 * u,
        x_upper=2 * u,
    )
    result = solved(nlp, 1.9 * u)
    if result.success:
        assert result.objective == pytest.approx(-6, abs=1e-2)


def test_acceptable_needs_small_residuals_beside_their_own_terms() -> None:
    """An evidence that was once taken for a solution: slope 1e-3 beside a multiplier of 1e7."""
    at = OptimalityResiduals(1e-3, 0.0, 0.0, 1e-3, False, np.array([0.0, 1e7]))
    known = Evidence(at, 1e-6, 1.6, 1.6, 1.0, 1.0, True, 0.0, "", False, 10)
    assert verdict(Ending.NO_STEP, known)[0] is Status.ITERATION_LIMIT
    rounded = OptimalityResiduals(1e-3, 0.0, 0.0, 1e-7, False, np.array([0.0, 1e7]))
    promising = Evidence(rounded, 1e-6, 1.6, 1.6, 1.0, 1.0, True, 0.5, "", False, 10)
    assert verdict(Ending.NO_STEP, promising)[0] is Status.ITERATION_LIMIT
    done = Evidence(rounded, 1e-6, 1.6, 1.6, 1.0, 1.0, True, 1e-9, "", False, 10)
    assert verdict(Ending.NO_STEP, done)[0] is Status.ACCEPTABLE


def test_violations_that_are_rounding_are_acceptable_but_not_optimal() -> None:
    at = OptimalityResiduals(0.0, 0.0, 1e-3, 0.0, True, np.zeros(1))
    known = Evidence(at, 1e-6, 1.0, 1.0, 1.0, 1.0, True, 0.0, "", False, 10)
    for ending in (Ending.NO_STEP, Ending.STATIONARY_VIOLATION):
        status, message = verdict(ending, known)
        assert status is Status.ACCEPTABLE
        assert "rounding" in message


# ------------------------------------------------------------------------------- infeasible


@pytest.mark.parametrize("s", [1e3, 1e4, 1e5])
@pytest.mark.parametrize("with_objective", [True, False])
def test_a_linear_system_in_far_apart_units_is_solved(s: float, with_objective: bool) -> None:
    of_size_one = {
        "objective": lambda x: (x[0] / s) ** 2 + (s * x[1]) ** 2,
        "gradient": lambda x: np.array([2 * x[0] / s**2, 2 * s * s * x[1]]),
    }
    nlp = NLP(
        n=2,
        m=2,
        **(of_size_one if with_objective else {}),
        constraints=lambda x: np.array([x[0] / s + s * x[1], x[0] / s - s * x[1]]),
        jacobian=lambda x: np.array([[1 / s, s], [1 / s, -s]]),
        c_lower=[1, 0.5],
        c_upper=[1, 0.5],
    )
    result = solved(nlp, [0.0, 0.0])
    assert result.success
    np.testing.assert_allclose(result.x / [s, 1 / s], [0.75, 0.25], atol=1e-4)


def test_wrong_derivatives_are_no_proof_of_infeasibility() -> None:
    result = solved(on_a_line(jacobian=lambda x: -np.ones((1, 2))), [3.0, 1.0])
    assert result.status is Status.ITERATION_LIMIT
    assert "derivatives" in result.message


def test_a_box_that_never_opens_is_no_proof_of_infeasibility() -> None:
    result = solved(on_a_line(), [3.0, 1.0], step_box=lambda number, x: (0, 0))
    assert result.status is Status.ITERATION_LIMIT
    assert "step_box" in result.message


def test_a_box_may_open_late() -> None:
    box = lambda number, x: (0, 0) if number < 5 else (-1, 1)  # noqa: E731
    assert solved(on_a_line(), [3.0, 1.0], step_box=box).status is Status.OPTIMAL


@pytest.mark.parametrize("derivatives", ["exact", "bfgs"])
def test_a_maximum_of_the_violation_is_left(derivatives: str) -> None:
    """All slopes of the constraints vanish at these starts, or leave the violation as it is."""
    kind = {"hessian_kind": derivatives}
    plain = nlp_from(lambda x: (0.0, [equal(x**2, 1)]), 1)
    assert abs(solved(plain, [0.0], **kind).x[0]) == pytest.approx(1)
    ring = nlp_from(lambda x, y: (x**2 + y**2, [at_least(x**2 + y**2, 1)]), 2)
    result = solved(ring, [0.0, 0.0], **kind)
    assert result.success
    assert result.objective == pytest.approx(1, abs=1e-5)
    arm = nlp_from(
        lambda a, b: (0.0, [equal(cos(a) + cos(a + b), 1), equal(sin(a) + sin(a + b), 0)]), 2
    )
    assert solved(arm, [0.0, 0.0], **kind).success  # stretched, and told to retract


def test_an_unreachable_target_is_infeasible_at_the_nearest_point() -> None:
    arm = nlp_from(
        lambda a, b: (0.0, [equal(cos(a) + cos(a + b), 3), equal(sin(a) + sin(a + b), 0)]), 2
    )
    result = solved(arm, [0.3, 0.2])
    assert result.status is Status.INFEASIBLE
    assert result.constraint_violation == pytest.approx(1, abs=1e-4)
    assert f"{result.constraint_violation:.3g}" in result.message


# -------------------------------------------------------------------------------- unbounded


def test_nothing_is_unbounded_in_a_box() -> None:
    nlp = NLP(
        n=1,
        objective=lambda x: 1e21 * (x[0] ** 2 - 1),
        gradient=lambda x: 2e21 * x,
        x_lower=-2,
        x_upper=2,
    )
    result = solved(nlp, [0.5])
    assert result.status is not Status.UNBOUNDED
    assert result.objective == pytest.approx(-1e21)


def test_a_far_start_is_not_unbounded() -> None:
    nlp = NLP(
        n=1,
        objective=lambda x: 1e25 * (x[0] / 1e21) ** 2,
        gradient=lambda x: 2e25 * x / 1e21**2,
    )
    assert solved(nlp, [1e21]).status is Status.OPTIMAL


def test_a_minimum_at_infinity_has_no_falling_objective() -> None:
    result = solved(nlp_from(lambda x, y: (x**2 + y, [equal(y - 1 / x, 0)]), 2, 0.5), [1.0, 1.0])
    assert result.status is not Status.UNBOUNDED


def test_large_slopes_do_not_overflow() -> None:
    nlp = NLP(n=1, objective=lambda x: np.exp(x[0]), gradient=lambda x: np.exp(x))
    result = solved(nlp, [700.0])
    assert result.status is Status.OPTIMAL


# ----------------------------------------------------------------------------- restoration


def test_restoration_keeps_to_boxes_and_is_reported() -> None:
    seen: list[Iteration] = []
    circle = nlp_from(lambda x, y: (x**2 + y**2, [equal(x**2 + y**2, 25), equal(x * y, 12)]), 2)
    nlp = NLP(
        n=2,
        m=2,
        **square(),
        constraints=circle.constraints,
        jacobian=circle.jacobian,
        c_lower=[25, 12],
        c_upper=[25, 12],
    )
    result = solved(nlp, [0.2, 0.1], step_box=lambda number, x: (-0.05, 0.05), callback=seen.append)
    assert result.success
    assert [i.number for i in seen] == list(range(len(seen)))
    steps = np.abs(np.diff(np.array([i.x for i in seen]), axis=0)).max(axis=1)
    assert "restoration" in {i.kind for i in seen}
    assert steps.max() <= 0.05 + 1e-9
    np.testing.assert_allclose([i.step for i in seen[1:]], steps, atol=1e-15)


def test_a_callback_interrupts_a_restoration() -> None:
    nlp = nlp_from(lambda x, y: (x + y, [at_most(x**2 + y**2, -1)]), 2)
    result = solve(nlp, [3, 1], callback=lambda iteration: iteration.kind == "restoration")
    assert result.status is Status.INTERRUPTED


# --------------------------------------------------------------------------------- results


def curved() -> NLP:
    return nlp_from(lambda x, y: (x**4 + y**2, [at_least(x * y, 1)]), 2, -5, 5)


def test_results_are_copied_and_pickled_without_their_workspace() -> None:
    result = solve(curved(), [3, 1])
    assert result.workspace is not None
    for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert other.workspace is None
        np.testing.assert_array_equal(other.x, result.x)
        assert other.status is result.status
    assert result == result and hash(result) == hash(result)
    assert result != solve(curved(), [3, 1])


def test_one_result_warm_starts_several_solutions_at_once() -> None:
    nlp = curved()
    before = solve(nlp, [3, 1])
    found: list[FloatArray] = []

    def again() -> None:
        for _ in range(5):
            result = solve(nlp, [2.0, 2.0], warm_start=before)
            assert_honest(nlp, result)
            found.append(result.x)

    threads = [threading.Thread(target=again) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 20
    np.testing.assert_allclose(found, np.broadcast_to(before.x, (20, 2)), atol=1e-5)


def test_a_warm_start_within_a_solution_gets_a_workspace_of_its_own() -> None:
    nlp = curved()
    before = solve(nlp, [3, 1])
    inner = []

    def callback(iteration: Iteration) -> None:
        if not inner:
            inner.append(solve(nlp, [2.0, 2.0], warm_start=before))

    outer = solve(nlp, [2.5, 1.0], warm_start=before, callback=callback)
    assert outer.success and inner[0].success
    assert outer.workspace is before.workspace is not inner[0].workspace
