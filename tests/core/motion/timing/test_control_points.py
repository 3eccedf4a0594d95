"""Bounds between samples hold at every place, and are not much more than what is there."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.motion.path.between_states import joint_at
from flyby.core.motion.path.tcp_samples import States
from flyby.core.motion.timing.control_points import (
    most_acceleration,
    most_speed,
    most_tool_speed,
    slope_points,
)

VALUE = st.floats(-5.0, 5.0)
SQUARE = st.floats(0.0, 4.0)
PLACES = np.linspace(0.0, 1.0, 201)


@given(ends=st.tuples(*[VALUE] * 5), h=st.floats(0.01, 2.0), x0=SQUARE, x1=SQUARE)
def test_no_joint_is_faster(ends, h, x0, x1) -> None:
    states = States.zeros(2, 1)
    states.q[1, 0], states.dq[0, 0], states.dq[1, 0], states.ddq[0, 0], states.ddq[1, 0] = ends
    c = slope_points(states, 0, 0, states.q[1, 0], h)
    x, u = x0 + PLACES * (x1 - x0), 0.5 * (x1 - x0) / h
    slope, bend = np.array([joint_at(states, 0, 0, h, z)[1:] for z in PLACES]).T
    speed, rise = slope**2 * x, np.abs(slope * u + bend * x)
    size = 1.0 + max(map(abs, c)) ** 2
    assert speed.max() <= most_speed(c, x0, x1) + 1e-12 * size
    assert rise.max() <= most_acceleration(c, x0, x1, h) + 1e-9 * size / h


@given(v=st.lists(VALUE, min_size=12, max_size=12), h=st.floats(0.01, 2.0), x0=SQUARE, x1=SQUARE)
def test_the_tool_is_not_faster(v, h, x0, x1) -> None:
    states = States.zeros(2, 1)
    states.v[:, 3:], states.a[:, 3:] = np.reshape(v, (2, 2, 3))
    z = PLACES[:, None]
    twist = (1 - z) ** 2 * ((1 + 2 * z) * states.v[0, 3:] + h * z * states.a[0, 3:])
    twist += z**2 * ((3 - 2 * z) * states.v[1, 3:] - h * (1 - z) * states.a[1, 3:])
    driven = (twist**2).sum(axis=1) * (x0 + PLACES * (x1 - x0))
    assert driven.max() <= most_tool_speed(states, 0, 1, h, x0, x1) * (1 + 1e-12) + 1e-12
    assert most_tool_speed(states, 0, 0, h, x0, x1) == 0.0


@pytest.mark.parametrize("h", [0.1, 0.01])
def test_what_short_intervals_reach_is_told_to_the_square_of_their_length(h) -> None:
    t = np.array([0.0, h])
    states = States.zeros(2, 1)
    q, states.dq[:, 0], states.ddq[:, 0] = np.sin(t), np.cos(t), -np.sin(t)
    c = slope_points(states, 0, 0, q[1] - q[0], h)
    assert most_speed(c, 1.0, 1.0) == pytest.approx(1.0, abs=h**2)
    assert most_acceleration(c, 1.0, 1.0, h) == pytest.approx(np.sin(h), abs=h**2)
