"""The kernel of moving averages, and places that averages keep to."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.allowed import Allowed
from flyby.core.motion.averaging import Averages
from flyby.core.motion.averaging_kernels import tail
from flyby.core.motion.course import Course
from flyby.core.motion.model import MotionModel
from flyby.core.motion.smoothing import Smoothing
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius


@given(
    widths=st.lists(st.floats(0.01, 0.2), min_size=1, max_size=4),
    share=st.floats(-1.2, 1.2),
)
def test_tails_are_those_of_sums_of_even_distributions(widths, share) -> None:
    """κ' = −S, by difference quotients; κ at the far end is the distance, at the near end none."""
    widths = np.array(widths)
    half, c = 0.5 * widths.sum(), 0.5 * share * widths.sum()
    assert tail(widths, 1, -half - 0.1) == pytest.approx(half + 0.1)
    assert tail(widths, 1, half + 0.1) == 0.0 and tail(widths, 0, 0.0) == pytest.approx(0.5)
    h = 1e-6
    slope = (tail(widths, 1, c + h) - tail(widths, 1, c - h)) / (2 * h)
    assert slope == pytest.approx(-tail(widths, 0, c), abs=1e-4)
    # Its area is half the variance.
    x = np.linspace(0.0, half, 2001)
    area = np.trapezoid([tail(widths, 1, v) for v in x[::20]], x[::20])
    assert area == pytest.approx(np.sum(widths**2) / 48.0, rel=1e-2)


def course_of(arm, zone, model: MotionModel) -> tuple[Course, Averages]:
    places = ([0.4, 0.2, -0.3, 0.3, 0.2, 0.5], [0.1, -0.2, 0.3, 0.0, 0.4, 0.2])
    speed = Speed(tcp=50.0, reorientation=50.0)
    first, last = (arm.joints(place[: arm.robot.arm_size]) for place in places)
    moves = (MoveJ(first, speed, zone), MoveJ(last, speed, FINE))
    driven = Program(moves, start=arm.start)
    controller = arm.controller(model)
    timing = controller.stamp(driven, controller.plan(driven))
    reach = Smoothing(model.smoothing).window + timing.ramp
    course = Course.of(timing, Allowed.of(timing), reach / 40, reach)
    return course, Averages(course, Smoothing(model.smoothing), timing.ramp)


def test_nothing_is_faster_than_the_course(abb) -> None:
    course, _ = course_of(abb, Radius(0.1), MotionModel(smoothing=(0.05,)))
    assert (np.diff(course.theta) >= 0.0).all() and (np.diff(course.place) >= 0.0).all()
    way = np.diff(course.place) <= course.speed * np.diff(course.theta) * (1 + 1e-9)
    assert way.all()


@settings(max_examples=4, deadline=None)
@given(ramp=st.sampled_from([0.0, 0.03]))
def test_straight_moves_are_not_left_and_corners_are(abb, ramp) -> None:
    """With stops that are waited for, averages do not reach over them."""
    model = MotionModel(smoothing=(0.04, 0.04), ramp=ramp)
    assert offsets_of(abb, FINE, model).max() < 1e-6
    assert offsets_of(abb, Radius(0.1), model).max() > 1e-3


def offsets_of(abb, zone, model: MotionModel) -> np.ndarray:
    course, averages = course_of(abb, zone, model)
    found = averages.offsets()
    most = np.abs(found.axis) * np.abs(found.along).max(axis=1, keepdims=True) + found.aside
    return most[course.moves]
