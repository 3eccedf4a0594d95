"""What limits allow, against motions driven at many speeds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.deviation.speed_bounds import Allowed, greatest
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius


def driven(arm, turn: float, share: float) -> Program:
    speed = Speed(tcp=2.0 * share, reorientation=10.0 * share, joint_fraction=share)
    moves = (
        MoveL(arm.target((1, 0, 0)), speed, Radius(0.2 * arm.leg)),
        MoveL(arm.target((1, 1, 0)), speed, Radius(0.1 * arm.leg)),
        MoveJ(arm.target((0, 1, turn)), speed, FINE),
    )
    return Program(moves, start=arm.start)


def timing_of(arm, turn: float, share: float, model: MotionModel):
    controller = arm.controller(model)
    program = driven(arm, turn, share)
    return controller.stamp(program, controller.plan(program))


def of_whole(timing) -> Allowed:
    return Allowed.of(timing, greatest(timing))


@settings(max_examples=5, deadline=None)
@given(share=st.floats(0.1, 1.0))
def test_no_motion_at_any_speed_passes_what_is_allowed(arm, share) -> None:
    allowed = of_whole(timing_of(arm, 0.3, 1.0, MotionModel()))
    slower = timing_of(arm, 0.3, share, MotionModel())
    assert (slower.stamp.x <= allowed.most * (1 + 1e-6) + 1e-12).all()
    assert np.isfinite(allowed.most).all()


def test_what_is_allowed_is_reached(arm) -> None:
    timing = timing_of(arm, 0.3, 1.0, MotionModel())
    share = timing.stamp.x[1:-1] / greatest(timing)[1:-1]
    assert share.max() == pytest.approx(1.0, abs=1e-6)


def test_some_intervals_allow_what_they_allow_among_all(arm) -> None:
    timing = timing_of(arm, 0.3, 1.0, MotionModel())
    whole, some = of_whole(timing), Allowed.of(timing, greatest(timing), 5, 17)
    np.testing.assert_array_equal(some.slope, whole.slope[:, 5:17])
    np.testing.assert_array_equal(some.bend, whole.bend[:, 5:17])
    np.testing.assert_array_equal(some.most, whole.most[5:18])
    assert some.first == 5


@pytest.mark.parametrize("turn", [0.3, -0.2])
def test_coefficients_hold_slopes_and_bends(arm, turn) -> None:
    """As `states_at` drives them, at the stamp's own pace."""
    timing = timing_of(arm, turn, 1.0, MotionModel())
    allowed, x = of_whole(timing), timing.stamp.x
    for z in (0.05, 0.5, 0.9):
        t = timing.begin + z * (timing.end - timing.begin)
        _, dq, ddq = timing.states_at(t)
        pace, push = np.sqrt(x[:-1]) + z * np.diff(np.sqrt(x)), timing.stamp.u
        slope = dq / pace[:, None]
        low, high = allowed.slope.min(axis=0), allowed.slope.max(axis=0)
        assert (slope >= low - 1e-6).all() and (slope <= high + 1e-6).all()
        bend = (ddq - slope * push[:, None]) / pace[:, None] ** 2
        size = 1e-6 + 1e-9 / pace[:, None] ** 2
        assert (bend >= allowed.bend.min(axis=0) - size).all()
        assert (bend <= allowed.bend.max(axis=0) + size).all()
