"""Turns of lines by a swivel of the tool's x axis and a rotation about it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.swivel import pull_swivel, pull_turn_shares, swivel, turn_shares
from flyby.core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

SEEDS = st.integers(0, 10_000)
X = np.array([1.0, 0.0, 0.0])


def some_turn(rng: np.random.Generator) -> np.ndarray:
    vector = rng.normal(size=3)
    size = rng.choice([1e-7, 1e-3, 1.0]) * rng.uniform(0.01, 2.9)
    return matrix_from_rotation_vector(vector / np.linalg.norm(vector) * size)


def apart(R: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """a and b of a turn."""
    a = swivel(R[None, :, 0])[0]
    return a, rotation_vector(matrix_from_rotation_vector(-a) @ R)


def on_the_way(R: np.ndarray, share: float) -> np.ndarray:
    a, b = apart(R)
    return matrix_from_rotation_vector(share * a) @ matrix_from_rotation_vector(share * b)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS, share=st.floats(0, 1))
def test_x_goes_the_shortest_way_and_the_rest_is_about_it(seed, share) -> None:
    R = some_turn(np.random.default_rng(seed))
    a, b = apart(R)
    np.testing.assert_allclose(b[1:], 0.0, atol=1e-9)
    assert abs(a[0]) == 0.0
    np.testing.assert_allclose(on_the_way(R, 1.0), R, atol=1e-12)
    angle = np.arctan2(np.linalg.norm(np.cross(X, R[:, 0])), R[0, 0])
    x = on_the_way(R, share)[:, 0]
    # Between both ends at an even rate: what is left of the way adds to what is done.
    done, left = (np.arctan2(np.linalg.norm(np.cross(x, u)), x @ u) for u in (X, R[:, 0]))
    assert done == pytest.approx(share * angle, abs=1e-9)
    assert left == pytest.approx((1 - share) * angle, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS, share=st.floats(0, 1))
def test_the_way_back_is_the_same(seed, share) -> None:
    R = some_turn(np.random.default_rng(seed))
    back = R @ on_the_way(R.T, 1.0 - share)
    np.testing.assert_allclose(back, on_the_way(R, share), atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_reverses_are_gradients(seed) -> None:
    rng = np.random.default_rng(seed)
    R, way, weight, h = some_turn(rng), rng.normal(size=3), rng.normal(size=(1, 3)), 1e-6
    above, below = (
        swivel((matrix_from_rotation_vector(s * h * way) @ R)[None, :, 0]) for s in (1, -1)
    )
    slope = float(np.sum(weight * (above - below))) / (2 * h)
    made = float(pull_swivel(R[None, :, 0], weight)[0] @ way)
    assert made == pytest.approx(slope, rel=1e-5, abs=1e-6)
    a, b = rng.normal(size=(2, 1, 3))
    da, db = rng.normal(size=(2, 1, 3))
    if abs(np.linalg.norm(a) - np.linalg.norm(b)) > 1e-3:
        ahead, behind = (turn_shares(a + s * h * da, b + s * h * db)[0] for s in (1, -1))
        by_a, by_b = pull_turn_shares(a, b, np.ones(1))
        made = float(np.sum(by_a * da + by_b * db))
        assert made == pytest.approx((ahead - behind) / (2 * h), rel=1e-5, abs=1e-6)


def test_turns_that_are_none_or_of_one_part_count_whole() -> None:
    none, some = np.zeros((1, 3)), np.array([[0.4, 0.0, 0.0]])
    for a, b in ((none, none), (some, none), (none, some)):
        np.testing.assert_allclose(turn_shares(a, b), 1.0)
        assert np.isfinite(pull_turn_shares(a, b, np.ones(1))).all()
    assert turn_shares(some, some)[0] == pytest.approx(np.sqrt(0.5))
    away = swivel(np.array([[-1.0, 0.0, 0.0]]))
    np.testing.assert_array_equal(away, 0.0)
    assert np.isfinite(pull_swivel(np.array([[-1.0, 0.0, 0.0]]), np.ones((1, 3)))).all()
