"""Angles about z, the new y and the new z."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.spatial.rotation import euler_zyz, matrix_from_euler_zyz

TURNS = st.floats(-3.1, 3.1, allow_subnormal=False)
EDGES = st.sampled_from([0.0, math.pi])
MIDDLES = st.floats(0.0, math.pi) | EDGES | st.builds(abs, st.floats(-1e-6, 1e-6))


@given(TURNS, MIDDLES | MIDDLES.map(lambda b: math.pi - b), TURNS)
def test_the_angles_give_the_rotation_again(a: float, b: float, c: float) -> None:
    matrix = matrix_from_euler_zyz(a, b, c)
    assert np.abs(matrix_from_euler_zyz(*euler_zyz(matrix)) - matrix).max() < 3e-12


@given(TURNS, EDGES, TURNS)
def test_where_both_axes_are_one_the_last_angle_is_zero(a: float, b: float, c: float) -> None:
    first, middle, last = euler_zyz(matrix_from_euler_zyz(a, b, c))
    assert (middle, last) == (pytest.approx(b, abs=1e-9), 0.0)
    turned = a + c if b == 0.0 else a - c
    assert math.cos(first - turned) == pytest.approx(1.0, abs=1e-9)
