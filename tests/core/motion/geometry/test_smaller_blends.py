"""Blends that are made smaller: corners too sharp for the speed, and legs too short for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.corners import POSITION
from flyby.core.motion.geometry.smaller_blends import SHARP, SHORT
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.motion.model.blend import TANGENT_ARC
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import DurationRule, Overlap, Pace
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

K, RADIUS, LEG = 1.2, 0.05, 0.25
MODEL = MotionModel(pace=Pace.SUPERPOSED, overlap=Overlap.SKIP, tcp=TANGENT_ARC, centripetal=K)


def corner(
    arm, deflection: float, speed: float, acceleration: float, radius=RADIUS, first=LEG
) -> Program:
    said = Speed(tcp=speed, tcp_acceleration=acceleration)
    later = replace(said, tcp=1.1 * speed, tcp_acceleration=1.1 * acceleration)
    start, share = np.array([first, 0.0, 0.0]) / arm.leg, LEG / arm.leg
    end = start + share * np.array([np.cos(deflection), np.sin(deflection), 0.0])
    moves = (
        MoveL(arm.target(tuple(start)), said, Radius(radius)),
        MoveL(arm.target(tuple(end)), later, FINE),
    )
    return Program(moves, start=arm.start)


@settings(max_examples=15, deadline=None)
@given(deflection=st.floats(0.1, 3.0), speed=st.floats(0.1, 1.0), acceleration=st.floats(0.3, 3.0))
def test_braking_from_the_zones_edge_meets_the_speed_of_the_arc(
    abb, deflection, speed, acceleration
) -> None:
    path = abb.controller(MODEL).plan(corner(abb, deflection, speed, acceleration))
    radius = path.corners.reach[0, POSITION] * path.segments.length
    np.testing.assert_allclose(radius[0], radius[1], rtol=1e-9)
    square = min(speed**2, 2 * acceleration * RADIUS)
    most = K * acceleration
    on_arc = most * radius[0] / np.tan(0.5 * deflection)
    if square <= most * RADIUS / np.tan(0.5 * deflection):
        assert radius[0] == pytest.approx(RADIUS, rel=1e-9)
        assert not path.notes
    else:
        left = square - 2 * most * (RADIUS - radius[0])
        assert left == pytest.approx(on_arc, rel=1e-9)
        assert radius[0] < RADIUS
        assert "too sharp" in path.notes[0].message


def test_what_a_log_of_a_ur10e_showed(abb) -> None:
    """A corner of 151.49° with a blend of 100 mm at 0.5 m/s²: 19.085 mm, and 0.0541 m/s on it."""
    program = corner(abb, np.radians(151.492), 1.0, 0.5, radius=0.1)
    run = abb.controller(MODEL).run(program)
    reach = run.path.corners.reach[0, POSITION, 0] * run.path.segments.length[0]
    assert reach == pytest.approx(0.019085, abs=1e-5)
    place, t = run.trajectory.position, run.trajectory.t
    speed = np.linalg.norm(np.gradient(place, t, axis=0), axis=1)
    middle = (t > 0.4 * t[-1]) & (t < 0.6 * t[-1])
    assert speed[middle].min() == pytest.approx(0.0541, rel=1e-2)


@settings(max_examples=10, deadline=None)
@given(time=st.floats(0.3, 4.0), stated=st.booleans(), ramp=st.sampled_from(["thirds", "halves"]))
def test_a_time_stands_for_the_speed_and_acceleration_that_it_is_driven_with(
    abb, time, stated, ramp
) -> None:
    rule = DurationRule(ramp)
    program = corner(abb, 2.1, 0.4, 1.0)
    first, last = program.moves
    timed = Speed(tcp=0.01 if stated else None, duration=time)
    speed = LEG / ((1 - rule.ramp) * time)
    driven = Speed(tcp=speed, tcp_acceleration=speed / (rule.ramp * time))
    model = replace(MODEL, duration=rule)
    for swap in (False, True):
        reaches = []
        for said in (timed, driven):
            moves = (first, replace(last, speed=said))
            if swap:
                moves = (replace(first, speed=said), last)
            path = abb.controller(model).plan(Program(moves, start=abb.start))
            reaches.append(path.corners.reach[0, POSITION])
        np.testing.assert_allclose(reaches[0], reaches[1], rtol=1e-9)


@pytest.mark.parametrize(("speed", "acceleration"), [(0.3, 2.0), (2.0, 0.5)])
def test_derivatives_are_those_of_difference_quotients(abb, speed, acceleration) -> None:
    """Where the programmed speed bounds the entry, and where the acceleration does."""
    controller, numbers = abb.controller(MODEL), np.array([2.1, speed, acceleration, RADIUS])

    def duration(values) -> float:
        program = corner(abb, *values)
        return controller.stamp(program, controller.plan(program)).stamp.duration

    program = corner(abb, *numbers)
    path = controller.plan(program)
    assert path.notes
    made = Derivatives(program, controller.stamp(program, path)).duration()
    turned = LEG * np.array([-np.sin(2.1), np.cos(2.1), 0.0])
    by_number = [
        made.position[1] @ turned,
        made.speed.tcp @ [1.0, 1.1],
        made.speed.tcp_acceleration @ [1.0, 1.1],
        made.zone.sum(),
    ]
    for k, slope in enumerate(by_number):
        h = 1e-6 * np.eye(4)[k]
        wanted = (duration(numbers + h) - duration(numbers - h)) / 2e-6
        assert slope == pytest.approx(wanted, rel=2e-4, abs=1e-6), k


@settings(max_examples=15, deadline=None)
@given(
    deflection=st.floats(0.1, 3.0),
    speed=st.floats(0.1, 1.0),
    acceleration=st.floats(0.3, 3.0),
    share=st.floats(1.02, 2.5),
)
def test_a_short_first_leg_changes_speed_from_the_zones_edge_on(
    abb, deflection, speed, acceleration, share
) -> None:
    """It arrives there at what it comes to from rest, and the arc begins at the arc's speed."""
    program = corner(abb, deflection, speed, acceleration, first=share * RADIUS)
    path = abb.controller(MODEL).plan(program)
    radius = path.corners.reach[0, POSITION] * path.segments.length
    np.testing.assert_allclose(radius[0], radius[1], rtol=1e-9)
    most, planned = K * acceleration, min(speed**2, 2 * acceleration * RADIUS)
    arriving = min(planned, 2 * acceleration * (share - 1) * RADIUS)
    on_arc = min(planned, most * radius[0] / np.tan(0.5 * deflection))
    changed = 2 * most * (RADIUS - radius[0])
    assert abs(arriving - on_arc) == pytest.approx(changed, rel=1e-6, abs=1e-12)
    assert path.corners.kept.keys() == ({0} if changed > 0 else set())
    assert [note.message.split(": ")[1] for note in path.notes] == [
        SHORT if arriving < on_arc else SHARP for _ in path.corners.kept
    ]


def test_what_a_log_showed_of_a_short_first_leg(abb) -> None:
    """148.1 mm before a corner of 16.87° with a blend of 100 mm, at 0.5 m/s²: 56.8 mm, and the
    whole zone at the 0.3162 m/s that stopping within 100 mm allows."""
    program = corner(abb, np.radians(16.869), 1.0, 0.5, radius=0.1, first=0.1481)
    run = abb.controller(MODEL).run(program)
    path = run.path
    length = path.segments.length
    reach = path.corners.reach[0, POSITION] * length
    np.testing.assert_allclose(reach, 0.0568, atol=1e-4)
    place, t = run.trajectory.position, run.trajectory.t
    away = np.linalg.norm(place - path.segments.ends.position[0, 1], axis=1)
    behind = np.arange(len(t)) > away.argmin()
    speed = np.linalg.norm(np.gradient(place, t, axis=0), axis=1)
    np.testing.assert_allclose(speed[behind & (away < reach[1])], 0.3162, rtol=1e-3)


@pytest.mark.parametrize(
    ("deflection", "speed", "acceleration"), [(0.3, 2.0, 0.5), (0.3, 0.2, 0.5), (1.4, 2.0, 0.5)]
)
def test_derivatives_of_short_legs_are_those_of_difference_quotients(
    abb, deflection, speed, acceleration
) -> None:
    """Where the zone bounds the arc's speed, where the program does, and where the arc itself."""
    controller = abb.controller(MODEL)
    numbers = np.array([1.3 * RADIUS, speed, acceleration, RADIUS])

    def made(values) -> Program:
        return corner(abb, deflection, *values[1:], first=values[0])

    def duration(values) -> float:
        return controller.stamp(made(values), controller.plan(made(values))).stamp.duration

    program = made(numbers)
    path = controller.plan(program)
    assert SHORT in path.notes[0].message
    found = Derivatives(program, controller.stamp(program, path)).duration()
    by_number = [
        found.position.sum(axis=0)[0],
        found.speed.tcp @ [1.0, 1.1],
        found.speed.tcp_acceleration @ [1.0, 1.1],
        found.zone.sum(),
    ]
    for k, slope in enumerate(by_number):
        h = 1e-6 * np.eye(4)[k]
        wanted = (duration(numbers + h) - duration(numbers - h)) / 2e-6
        assert slope == pytest.approx(wanted, rel=2e-4, abs=1e-6), k
