"""The kernel of moving averages, and places that averages keep to."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from flyby.core.collision.deviation.averaging import Averages
from flyby.core.collision.deviation.averaging_kernels import tail
from flyby.core.collision.deviation.earliest_times import EarliestTimes
from flyby.core.collision.deviation.speed_bounds import Allowed, greatest
from flyby.core.motion.command.ramp import ramped
from flyby.core.motion.command.smoothing import Smoothing, even_times
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.timing.timing import Timing
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


def driven_program(arm, zone, tcp: float) -> Program:
    places = ([0.4, 0.2, -0.3, 0.3, 0.2, 0.5], [0.1, -0.2, 0.3, 0.0, 0.4, 0.2])
    speed = Speed(tcp=tcp, reorientation=50.0)
    first, last = (arm.joints(place[: arm.robot.arm_size]) for place in places)
    moves = (MoveJ(first, speed, zone), MoveJ(last, speed, FINE))
    return Program(moves, start=arm.start)


def timing_of(arm, zone, model: MotionModel, tcp: float = 50.0) -> Timing:
    driven = driven_program(arm, zone, tcp)
    controller = arm.controller(model)
    return controller.stamp(driven, controller.plan(driven))


def course_of(timing: Timing, model: MotionModel) -> tuple[EarliestTimes, Averages]:
    reach = Smoothing(model.smoothing).window + timing.ramp
    course = EarliestTimes.of(
        timing, Allowed.of(timing, greatest(timing)), timing.rests.length, reach / 40, reach
    )
    return course, Averages(course, Smoothing(model.smoothing), timing.ramp)


def test_nothing_is_faster_than_the_course(abb) -> None:
    model = MotionModel(smoothing=(0.05,))
    course, _ = course_of(timing_of(abb, Radius(0.1), model), model)
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
    course, averages = course_of(timing_of(abb, zone, model), model)
    found = averages.offsets()
    most = np.abs(found.axis) * np.abs(found.along).max(axis=1, keepdims=True) + found.aside
    return most[course.moves]


@settings(max_examples=6, deadline=None)
@given(
    ramp=st.sampled_from([0.03, 0.08]),
    zone=st.sampled_from([Radius(0.1), Radius(0.02)]),
    tcp=st.sampled_from([50.0, 0.5]),
)
def test_means_over_a_ramp_are_as_near_the_mean_place_as_bounded(abb, ramp, zone, tcp) -> None:
    """How far they are off, from one instant to another nearby, is what `ramped` is made of."""
    model = MotionModel(smoothing=(0.04, 0.03), ramp=ramp)
    timing = timing_of(abb, zone, model, tcp)
    course, averages = course_of(timing, model)
    off = averages.over_ramp()
    stamped = timing.intervals, timing.along.states, timing.start, ramp
    t = even_times(0.0, timing.duration, 1e-3)
    q, _ = ramped(*stamped, t)
    made = means(timing, ramp, t) - q
    cell = cells_at(timing, course, q)
    nearby = int(averages.reach / np.diff(t).max())
    for first in range(0, len(made) - nearby, nearby // 4):
        some = slice(first, first + nearby)
        assert (np.ptp(made[some], axis=0) <= off[cell[some]].max(axis=0) + 1e-9).all()
    assert (np.abs(made).max(axis=0) > off.max(axis=0) / 8.0).all()


def means(timing: Timing, window: float, t: np.ndarray) -> np.ndarray:
    """Means (T, N) of the stamped joints over the last ``window`` s; they rest before and after."""
    fine = np.arange(-window - 0.001, t[-1] + 0.001, 1e-4)
    q = timing.driven_at(np.clip(fine, 0.0, timing.duration))[0]
    area = np.cumsum(q, axis=0) * 1e-4

    def until(at: np.ndarray) -> np.ndarray:
        return np.stack([np.interp(at, fine + 0.5e-4, column) for column in area.T], -1)

    return np.asarray((until(t) - until(t - window)) / window)


def cells_at(timing: Timing, course: EarliestTimes, q: np.ndarray) -> np.ndarray:
    """(T,), cells of a course in which configurations (T, N) on its path are."""
    t = np.linspace(0.0, timing.duration, 4_000)
    sigma = timing.place_at(t)
    _, nearest = cKDTree(timing.driven_at(t)[0]).query(q)
    return np.clip(
        np.searchsorted(course.sigma, sigma[nearest], "right") - 1, 0, len(course.moves) - 1
    )
