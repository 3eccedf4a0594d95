"""The two-variable linear program of the stamp against scipy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from flyby.core.motion.timing.stamping_polygon import greatest_sum

BOX = np.array([[1.0, 0.0, 3.0], [0.0, 1.0, 2.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    """The first call compiles, which no single test should be timed for."""
    greatest_sum(BOX, 0, 1)


def polygon(seed: int, count: int) -> np.ndarray:
    """Half-planes that hold the origin, in a box; some repeat or nearly repeat."""
    rng = np.random.default_rng(seed)
    planes = np.column_stack([rng.normal(size=(count, 2)), rng.uniform(0.0, 2.0, count)])
    copies = planes[rng.integers(0, count, count // 2)]
    copies = copies * (1.0 + rng.choice([0.0, 1e-13, 1e-6], copies.shape))
    return np.vstack([BOX, planes, copies])


@given(st.integers(0, 2**32 - 1), st.integers(1, 20))
def test_sum_is_the_optimum_and_the_point_is_inside(seed, count):
    planes = polygon(seed, count)
    y, z, i, j = greatest_sum(planes, 0, 1)
    expected = linprog([-1.0, -1.0], A_ub=planes[:, :2], b_ub=planes[:, 2])
    assert y + z == pytest.approx(-expected.fun, rel=1e-6, abs=1e-6)
    size = np.abs(planes[:, :2]) @ [y, z] + planes[:, 2]
    assert np.all(planes[:, :2] @ [y, z] <= planes[:, 2] + 1e-12 * size)
    for edge in planes[[i, j]]:
        assert edge[:2] @ [y, z] == pytest.approx(edge[2], abs=1e-7)


@given(st.integers(0, 2**32 - 1), st.integers(1, 20), st.floats(-9.0, 9.0))
def test_units_do_not_matter(seed, count, exponent):
    planes = polygon(seed, count)
    scaled = planes * [10.0**exponent, 10.0**exponent, 1.0]
    y, z, _, _ = greatest_sum(planes, 0, 1)
    y_scaled, z_scaled, _, _ = greatest_sum(scaled, 0, 1)
    assert (y_scaled + z_scaled) * 10.0**exponent == pytest.approx(y + z, rel=1e-9, abs=1e-12)
