"""Distances to polylines with long and short pieces, against all pieces one by one."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flyby.identification.tcp_path import distance_to_polyline


def by_all_pieces(point: np.ndarray, line: np.ndarray) -> float:
    best = np.inf
    for a, b in itertools.pairwise(line):
        share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        best = min(best, float(np.linalg.norm(point - a - share * (b - a))))
    return best


@given(seed=st.integers(0, 10_000), vertices=st.integers(2, 30), spread=st.floats(0.0, 3.0))
def test_the_distance_is_exact_however_sparse_the_line(seed, vertices, spread) -> None:
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(vertices, 3)) * 10 ** rng.uniform(-spread, 0, (vertices, 1))
    line = np.cumsum(steps, axis=0)
    points = line[rng.integers(vertices, size=15)] + rng.normal(size=(15, 3)) * 0.3
    wanted = [by_all_pieces(point, line) for point in points]
    np.testing.assert_allclose(distance_to_polyline(points, line), wanted, atol=1e-12)


def test_the_nearest_vertex_may_belong_to_another_part() -> None:
    line = np.array([[-1.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0.1, 0]])
    assert distance_to_polyline(np.array([[0.0, 0.04, 0.0]]), line)[0] == 0.04


def test_a_line_of_one_point() -> None:
    line = np.zeros((3, 3))
    np.testing.assert_allclose(distance_to_polyline(np.array([[3.0, 4.0, 0.0]]), line), 5.0)


def test_standing_still_adds_nothing() -> None:
    rng = np.random.default_rng(0)
    line = np.cumsum(rng.normal(size=(10, 3)), axis=0)
    points = rng.normal(size=(15, 3))
    held = distance_to_polyline(points, np.repeat(line, 3, axis=0))
    np.testing.assert_array_equal(held, distance_to_polyline(points, line))
