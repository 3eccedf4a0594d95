"""When a nonlinear program is left before its last digits."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.sqp import NLP, Iteration, solve
from flyby.problems.free_motion.optimal_control.search.patience import Patience

TOLERANCE, PACE = 1e-5, 1e-3


def ended(patience: Patience, points: list[tuple[float, float]]) -> int | None:
    """The iteration, of objectives and violations, at which it ends; None if at none."""
    for k, (objective, violation) in enumerate(points):
        if patience(Iteration(k, np.zeros(1), objective, violation, 1.0)):
            return k
    return None


@pytest.mark.parametrize(
    ("points", "beat", "end"),
    [
        # Large steps go on.
        ([(1.0, 0.0), (0.9, 0.0), (0.8, 0.0), (0.7, 0.0)], None, None),
        # Two small ones in a row are enough, and one is not.
        ([(1.0, 0.0), (0.9, 0.0), (0.8999, 0.0), (0.8998, 0.0), (0.8, 0.0)], None, 3),
        ([(1.0, 0.0), (0.9, 0.0), (0.8999, 0.0), (0.8, 0.0), (0.7999, 0.0)], None, None),
        # What is not feasible yet does not count.
        ([(1.0, 0.0), (0.9, 0.1), (0.9, 0.1), (0.9, 0.1), (0.9, 0.1)], None, None),
        # Feasible, and too far from what there is already to get there in five such steps.
        ([(0.5, 0.0), (0.9, 0.1), (0.8, 0.0), (0.79, 0.0)], 0.5, 3),
        ([(0.5, 0.0), (0.9, 0.1), (0.8, 0.0), (0.7, 0.0)], 0.5, None),
        # No more than there may be.
        ([(1.0 - 0.1 * k, 0.1) for k in range(9)], None, 6),
    ],
)
def test_patience(points: list[tuple[float, float]], beat: float | None, end: int | None) -> None:
    assert ended(Patience(TOLERANCE, 6, PACE, beat), points) == end


def test_the_last_point_is_what_comes_of_it() -> None:
    """Not the start, which is less violated."""
    nlp = NLP(
        n=1,
        m=1,
        objective=lambda x: float(x[0]),
        gradient=lambda x: np.ones(1),
        constraints=lambda x: x**2,
        jacobian=lambda x: np.array([2 * x]),
        c_lower=[1.0],
    )
    patience = Patience(TOLERANCE, 1, PACE, None)
    result = solve(nlp, [4.0], tolerance=TOLERANCE, callback=patience)
    last = patience.outcome(result)
    assert patience.ended and last.objective == last.x[0] < 4.0
    assert last.constraint_violation == pytest.approx(max(0.0, 1.0 - last.x[0] ** 2))
    free = Patience(TOLERANCE, 60, 1e-12, None)
    whole = solve(nlp, [4.0], tolerance=TOLERANCE, callback=free)
    assert not free.ended and free.outcome(whole) is whole
