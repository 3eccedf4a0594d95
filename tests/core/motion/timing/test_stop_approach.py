"""Stops that are closed in on ever more slowly."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.binding_limits import limit_shares
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.timing.stop_approach import APPROACH, NEAR
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

FAST = Speed(tcp=1.0, reorientation=1e3, tcp_acceleration=4.0)


def there_and_on(arm, zone=FINE) -> Program:
    """Two lines of 0.2 m."""
    places = ((0.2, 0.0, 0.0), (0.2, 0.2, 0.0))
    first, last = (arm.target(place) for place in places)
    return Program((MoveL(first, FAST, zone), MoveL(last, FAST, FINE)), start=arm.start)


def timing(arm, program: Program, approach: float, sampling: Sampling | None = None):
    controller = arm.controller(replace(MotionModel(), approach=approach))
    if sampling is not None:
        controller.sampling = sampling
    return controller.stamp(program, controller.plan(program))


@settings(max_examples=10, deadline=None)
@given(approach=st.floats(0.01, 0.2), stops=st.booleans())
def test_the_way_left_bounds_the_speed(abb, approach, stops) -> None:
    program = there_and_on(abb, FINE if stops else Radius(0.02))
    made, plain = timing(abb, program, approach), timing(abb, program, 0.0)
    covered = np.concatenate([[0.0], np.cumsum(made.along.spacing)])
    knots = made.path_limits.approach.stop
    assert len(knots) == 2 + stops
    for begin, end in pairwise(knots):
        left = covered[end] - covered[begin:end]
        assert (made.stamp.x[begin:end] <= left * (left + NEAR) / approach**2 * (1 + 1e-12)).all()
    assert made.duration > plain.duration
    assert (made.path_limits.binding[:, 1] == APPROACH).any()


def test_a_start_is_as_before(abb) -> None:
    made, plain = (timing(abb, there_and_on(abb), one) for one in (0.01, 0.0))
    quick = slice(0, int(np.argmax(plain.stamp.x)))
    assert made.stamp.x[quick] == pytest.approx(plain.stamp.x[quick], rel=1e-9)


def test_how_long_it_takes_is_no_matter_of_the_samples(abb) -> None:
    times = [
        timing(abb, there_and_on(abb), 0.01, Sampling(step=step, approach=6)).duration
        for step in (0.02, 0.01, 0.0025)
    ]
    assert np.ptp(times) < 0.004


def test_what_binds_is_called_the_stop(abb) -> None:
    controller = abb.controller(replace(MotionModel(), approach=0.05))
    run = controller.run(there_and_on(abb))
    shares = limit_shares(run, abb.robot.axis_names)
    assert all("stop" in {one.name for one in move} for move in shares)
