"""Corners of joint moves that are blended in time: quintics that meet both legs' motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.corners import POSITION
from flyby.core.motion.gradients.derivatives import Derivatives, ProgramGradient
from flyby.core.motion.model.blend import PARABOLA, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import Overlap
from flyby.core.motion.timing.timed_zones import TIMED
from flyby.core.motion.timing.timing import Timing
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor

UR10E = find_robot("ur/ur10e")
MODEL = MotionModel(joint=Blend(kind="quintic"), overlap=Overlap.SKIP, blend_acceleration=1.2)
LOGGED = {
    1.8142: (
        (-0.577682, -1.788884, -1.837172, -1.078907, 1.605443, 0.992353),
        (-0.976317, -1.46528, -1.34181, -1.03005, -0.605199, 2.95469),
        (-1.68171, -1.65149, -1.76995, -1.31836, 1.59297, -0.112136),
    ),
    1.0227: (
        (-0.589523, -1.692079, -1.801576, -1.217846, 1.588042, 0.980191),
        (-0.361443, -1.17712, -1.408, -0.337754, 1.62611, 1.42053),
        (-1.88511, -1.6447, -1.89619, -1.18775, 1.57623, -0.315355),
    ),
    1.02505: (
        (-2.007661, -1.821519, -1.19587, -1.728311, 1.583009, -0.437827),
        (-2.47588, -1.67892, -0.772261, -1.84744, 1.52851, 0.293012),
        (-0.577737, -1.78896, -1.83717, -1.07883, 1.60542, 0.992438),
    ),
}
"""Joints of corners of a UR10e in URSim by the time that their blends take, s (see the vendor's
motion.toml). The first gave the rule, the others had no part in it."""
INSIDE = {
    1.8142: (),
    1.0227: (
        (-0.375723516, -1.20671706, -1.430735427, -0.388380615, 1.62391226, 1.394035853),
        (-0.374368569, -1.198882303, -1.424957575, -0.375072311, 1.624466892, 1.398588929),
    ),
    1.02505: (
        (-2.453296264, -1.684580311, -0.790999332, -1.840949172, 1.530768667, 0.267265702),
        (-2.454633963, -1.682308295, -0.787190195, -1.840151490, 1.530039276, 0.283942753),
    ),
}
"""Logged joints near the corners' middles."""


def controller(model: MotionModel = MODEL) -> Controller:
    return Controller(find_vendor("ur"), UR10E, model)


def corner(joints, radius=0.1, speeds=(0.5, 0.5), accelerations=(0.5, 0.5)) -> Program:
    start, *targets = (JointTarget(tuple(map(float, row))) for row in joints)
    said = [
        Speed(joint=v, joint_acceleration=a) for v, a in zip(speeds, accelerations, strict=True)
    ]
    moves = (MoveJ(targets[0], said[0], Radius(radius)), MoveJ(targets[1], said[1], FINE))
    return Program(moves, start=start)


def stamped(program: Program) -> Timing:
    return controller().stamp(program, controller().plan(program))


@pytest.mark.parametrize("duration", LOGGED)
def test_what_logs_of_a_ur10e_showed(duration: float) -> None:
    run = controller().run(corner(LOGGED[duration]))
    timed = run.path.corners.timed[0]
    assert timed.duration.value == pytest.approx(duration, abs=1e-4)
    q = run.timing.states_at(np.linspace(0.0, run.timing.duration, 40_000))[0]
    for inside in INSIDE[duration]:
        assert np.abs(q - inside).max(axis=1).min() < 5e-5


joints = st.lists(
    st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6), min_size=3, max_size=3
).map(lambda rows: np.array(rows) + np.array(LOGGED[1.8142][0]))


@settings(max_examples=8, deadline=None)
@given(joints=joints, v=st.floats(0.3, 1.5), A=st.floats(0.3, 1.5), radius=st.floats(0.03, 0.15))
def test_both_legs_are_met_at_their_speed(joints, v, A, radius) -> None:
    steps = np.diff(joints, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    leads = np.abs(steps).max(axis=1)
    assume(leads.min() > 0.4 and steps[0] @ steps[1] > -0.95 * lengths[0] * lengths[1])
    try:
        timing = stamped(corner(joints, radius, (v, v), (A, A)))
    except MotionError:  # the blend reaches beyond a leg
        assume(False)
    path = timing.path
    assume(0 in path.corners.timed and path.corners.reach[0, POSITION].max() < 0.5)
    inside = np.flatnonzero(timing.path_limits.timed.timed[path.pieces.interval_pieces])
    knots = np.append(inside, inside[-1] + 1)
    # No other limit, as where a quintic overshoots the programmed speed.
    assume((timing.path_limits.binding[knots, 1] == TIMED).all())
    begin, end = timing.begin[inside[0]], timing.end[inside[-1]]
    assert end - begin == pytest.approx(path.corners.timed[0].duration.value, rel=0.02)
    for at, leg in ((begin, 0), (end, 1)):
        expected = min(v, np.sqrt(2 * A * path.corners.reach[0, POSITION, leg] * leads[leg]))
        before, after = timing.states_at(np.array([at - 1e-7, at + 1e-7]))[1]
        np.testing.assert_allclose(before, after, atol=1e-3 * expected)
        assert np.abs(before).max() == pytest.approx(expected, rel=0.01)


@settings(max_examples=20, deadline=None)
@given(joints=joints, speed=st.floats(0.3, 1.0), radius=st.floats(0.02, 0.1))
def test_a_point_on_the_way_is_passed_at_speed(joints, speed, radius) -> None:
    """Where both legs have one direction and full speed, the blend is the line at that speed."""
    start, step = joints[0], joints[1] - joints[0]
    assume(np.abs(step).max() > 0.8)
    on_the_way = np.stack([start, start + step, start + 2 * step])
    run = controller().run(corner(on_the_way, radius, (speed, speed), (2.0, 2.0)))
    blend = run.path.corners.timed.get(0)
    reach = run.path.corners.reach[0, POSITION] * np.abs(step).max()
    assume(blend is not None and reach.min() > 0.25 * speed**2 and reach.max() < 0.4)
    assert blend is not None
    assert blend.duration.value == pytest.approx(reach.sum() / speed, rel=1e-9)
    rate = np.abs(run.timing.states_at(np.linspace(1.2, 1.4, 9))[1]).max(axis=1)
    np.testing.assert_allclose(rate, speed, rtol=1e-3)


def test_without_programmed_speeds_it_is_the_parabola() -> None:
    joints = [JointTarget(row) for row in LOGGED[1.0227]]
    moves = (
        MoveJ(joints[1], Speed(joint_fraction=0.3), Radius(0.1)),
        MoveJ(joints[2], Speed(joint_fraction=0.3), FINE),
    )
    driven = Program(moves, start=joints[0])
    timed = controller().plan(driven)
    plain = controller(replace(MODEL, joint=PARABOLA)).plan(driven)
    assert not timed.corners.timed
    np.testing.assert_allclose(timed.q, plain.q, atol=1e-12)


def test_the_parabola_is_all_that_a_quintic_has_beside_it() -> None:
    with pytest.raises(InputError, match="quintic"):
        Blend(kind="quintic", beta=(0.1,))


@pytest.mark.parametrize("duration", LOGGED)
@pytest.mark.parametrize(
    ("speeds", "accelerations"), [((0.5, 0.5), (0.5, 0.5)), ((0.9, 0.7), (0.4, 0.6))]
)
def test_derivatives(duration: float, speeds, accelerations) -> None:
    """Of the cycle time and of a configuration in the zone, against difference quotients."""
    rows = np.array(LOGGED[duration])

    def quantities(joints, radius, speeds, accelerations) -> tuple[float, float]:
        timing = stamped(corner(joints, radius, speeds, accelerations))
        return timing.duration, float(timing.path.q[middle] @ weights)

    weights = np.array([0.3, -0.5, 0.2, 0.7, -0.1, 0.4])
    made = corner(rows, 0.1, speeds, accelerations)
    timing = stamped(made)
    zoned = np.flatnonzero(timing.path_limits.timed.timed[timing.path.pieces.sample_pieces])
    middle = int(zoned[len(zoned) // 3])
    found = Derivatives(made, timing)
    gradients = found.duration(), found.configuration(middle, weights)

    def check(vary, of, h: float) -> None:
        upper, lower = quantities(*vary(h)), quantities(*vary(-h))
        for gradient, a, b in zip(gradients, upper, lower, strict=True):
            exact = of(gradient)
            assert exact == pytest.approx((a - b) / (2 * h), rel=2e-4, abs=2e-5)

    for row, axis in ((0, 5), (1, 3), (1, 4), (2, 0), (2, 5)):

        def moved(h: float, row=row, axis=axis):
            joints = rows.copy()
            joints[row, axis] += h
            return joints, 0.1, speeds, accelerations

        def of_joint(g: ProgramGradient, row=row, axis=axis) -> float:
            return float(g.start[axis] if row == 0 else g.joints[row - 1, axis])

        check(moved, of_joint, 1e-6)
    check(lambda h: (rows, 0.1 + h, speeds, accelerations), lambda g: float(g.zone[0]), 1e-6)
    if speeds[0] == speeds[1]:  # at a tie derivatives are one-sided
        return
    for k in range(2):
        step = np.eye(2)[k]
        check(
            lambda h, step=step: (rows, 0.1, tuple(speeds + h * step), accelerations),
            lambda g, k=k: float(g.speed.joint[k]),
            1e-6,
        )
        check(
            lambda h, step=step: (rows, 0.1, speeds, tuple(accelerations + h * step)),
            lambda g, k=k: float(g.speed.joint_acceleration[k]),
            1e-6,
        )
