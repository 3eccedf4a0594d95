"""What motions consume, and its derivatives through the emulator."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.motion.model.consumption import SQUARED_TORQUE, Motors, SquaredTorque
from flyby.core.motion.timing.energy import energy_by_joint
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor

ROBOT = find_robot("abb/irb6640-180-255")
CONTROLLER = Controller(find_vendor("abb"), ROBOT)
COPPER = (2e-5, 1e-5, 3e-5, 1e-4, 1e-4, 2e-4)
CONSUMPTIONS = {
    "weighted": SquaredTorque((0.5, 2.0, 1.0, 0.0, 3.0)),
    "motors": Motors(COPPER),
    "recuperating": Motors(COPPER, 0.6),
}


def program(*speeds: float, joint: float = 0.35) -> Program:
    points = ((0.3, 0.4, 0.1, 0.3, 0.6, 0.2), (0.5, joint, 0.4, 0.1, 0.4, 0.1))
    first, second = (JointTarget(point) for point in points)
    moves = (
        MoveJ(first, Speed(tcp=speeds[0], joint_acceleration_fraction=speeds[1]), Radius(0.08)),
        MoveJ(second, Speed(tcp=speeds[2], joint_acceleration_fraction=speeds[3]), FINE),
    )
    return Program(moves, start=JointTarget((0.0, 0.1, 0.1, 0.2, 0.5, 0.1)))


def consumed(consumption, made: Program) -> float:
    timing = CONTROLLER.stamp(made, CONTROLLER.plan(made))
    return CONTROLLER.energy(made, timing, consumption).value


@pytest.mark.parametrize("name", CONSUMPTIONS)
@given(
    st.tuples(st.floats(0.5, 0.9), st.floats(0.4, 0.9), st.floats(0.95, 1.2), st.floats(0.4, 0.9))
)
@settings(max_examples=5, deadline=None)
def test_derivatives_are_difference_quotients(name, speeds):
    consumption, step = CONSUMPTIONS[name], 1e-6
    made = program(*speeds)
    timing = CONTROLLER.stamp(made, CONTROLLER.plan(made))
    found = Derivatives(made, timing).energy(consumption)
    slopes = [
        found.speed.tcp[0],
        found.speed.joint_acceleration_fraction[0],
        found.speed.tcp[1],
        found.speed.joint_acceleration_fraction[1],
    ]
    for k, slope in enumerate(slopes):
        up, down = (consumed(consumption, program(*_moved(speeds, k, s * step))) for s in (1, -1))
        close = pytest.approx(slope, rel=2e-4, abs=1e-4 * (abs(up) + 1.0))
        assert (up - down) / (2 * step) == close
    up, down = (consumed(consumption, program(*speeds, joint=0.35 + s * step)) for s in (1, -1))
    close = pytest.approx(found.joints[1, 1], rel=2e-4, abs=1e-4 * (abs(up) + 1.0))
    assert (up - down) / (2 * step) == close


def _moved(values, k, by):
    return [value + by * (i == k) for i, value in enumerate(values)]


@given(st.lists(st.floats(-100.0, 100.0), min_size=6, max_size=6), st.floats(0.0, 1.0))
def test_what_is_drawn_lies_between(values, share):
    """Never less than the net power, never less than with more recuperation."""
    torque, rate = np.array(values), np.array(values[::-1]) / 50.0
    none, some, all_ = (Motors(COPPER, r) for r in (0.0, share, 1.0))
    net = float(all_.total(all_.powers(torque, rate)))
    drawn = [float(m.total(m.powers(torque, rate))) for m in (none, some)]
    assert net <= drawn[1] + 1e-9 <= drawn[0] + 2e-9
    assert drawn[0] >= 0.0
    flow = float(all_.flow(all_.powers(torque, rate)))
    assert flow == pytest.approx(abs(net))
    assert all(drawn_ <= flow + 1e-9 for drawn_ in drawn)


@given(st.floats(-1e3, 1e3), st.floats(0.0, 1.0), st.floats(0.5, 100.0))
def test_a_rounded_kink(power, share, width):
    """Never below what is consumed, and never further above it than it says."""
    motors, p = Motors(COPPER, share), np.array([power])
    rounded, sharp = motors.rounded(p, width), motors.total(p[:, None])
    slack = rounded.value - sharp
    assert -1e-9 <= slack[0] <= 0.5 * (1.0 - share) * width + 1e-9
    step = 1e-3 * width
    up, down = (motors.rounded(p + s * step, width) for s in (1, -1))
    assert rounded.slope == pytest.approx((up.value - down.value) / (2 * step), abs=1e-5)
    assert rounded.bend == pytest.approx((up.slope - down.slope) / (2 * step), abs=1e-5 / width)
    if share == 1.0:
        assert rounded.value == pytest.approx(p) and rounded.bend[0] == 0.0


@given(st.floats(-100.0, 100.0), st.floats(-3.0, 3.0), st.sampled_from([0.0, 0.4, 1.0]))
def test_slopes_of_powers(torque, rate, share):
    motors = Motors(COPPER[:3], share)
    state = np.array([torque, 5.0, -2.0]), np.array([rate, 0.3, 1.0])
    found = motors.slopes(*state)
    power = motors.powers(*state).sum()
    if abs(power) < 1e-2:  # beside the kink
        return
    step = 1e-6
    for k in range(2):
        for j in range(3):
            sides = []
            for sign in (1.0, -1.0):
                moved = [part.copy() for part in state]
                moved[k][j] += sign * step
                sides.append(float(motors.total(motors.powers(*moved))))
            quotient = (sides[0] - sides[1]) / (2 * step)
            assert found[k][j] == pytest.approx(quotient, abs=1e-5)


def test_nothing_comes_back_and_all_comes_back():
    torque, rate = np.array([10.0, -20.0]), np.array([1.0, 2.0])
    for share, drawn in ((0.0, 0.0), (0.25, -7.5), (1.0, -30.0)):
        motors = Motors((), share)
        assert float(motors.total(motors.powers(torque, rate))) == pytest.approx(drawn)
    # One drive uses what another gives back before anything is burnt.
    motors = Motors((), 0.0)
    assert float(motors.total(motors.powers(torque, -rate))) == pytest.approx(30.0)


@given(st.floats(0.1, 10.0))
def test_squared_torque_scales(factor):
    torque = np.array([1.0, -2.0, 3.0])
    plain = SQUARED_TORQUE.total(SQUARED_TORQUE.powers(torque, 0 * torque))
    scaled = SquaredTorque((factor,) * 3)
    assert float(scaled.total(scaled.powers(torque, 0 * torque))) == pytest.approx(factor * plain)
    assert plain == pytest.approx(14.0)


def test_joints_add_up():
    made = program(0.8, 0.7, 1.1, 0.9)
    timing = CONTROLLER.stamp(made, CONTROLLER.plan(made))
    energy = CONTROLLER.energy(made, timing)
    assert energy_by_joint(timing, energy).sum() == pytest.approx(energy.value)
    full = CONTROLLER.energy(made, timing, Motors(COPPER, 1.0))
    assert energy_by_joint(timing, full).sum() == pytest.approx(full.value)


def test_recuperating_everything_leaves_heat_and_height():
    """With η = 1 and no heat, what is consumed is the change of potential energy, rest to rest."""
    made = program(0.8, 0.7, 1.1, 0.9)
    dense = Controller(find_vendor("abb"), ROBOT)
    dense.sampling = replace(dense.sampling, joint=0.005, blend=64)
    timing = dense.stamp(made, dense.plan(made))
    whole = dense.energy(made, timing, Motors((), 1.0)).value
    back = program(0.8, 0.7, 1.1, 0.9)
    reverse = Program(
        (
            replace(back.moves[0], target=back.moves[0].target),
            replace(back.moves[1], target=back.start),
        ),
        start=back.moves[1].target,
    )
    returned = dense.energy(
        reverse, dense.stamp(reverse, dense.plan(reverse)), Motors((), 1.0)
    ).value
    assert whole == pytest.approx(-returned, rel=2e-2)


@pytest.mark.parametrize(
    "make",
    [
        lambda: SquaredTorque((-1.0,)),
        lambda: SquaredTorque((math.nan,)),
        lambda: Motors((1.0, math.inf)),
        lambda: Motors((1.0,), 1.5),
        lambda: Motors((1.0,), math.nan),
        lambda: Motors((1.0,), "all"),
        lambda: Motors(2e-5),
        lambda: Motors(("2e-5",)),
    ],
)
def test_what_is_no_consumption(make):
    with pytest.raises(InputError):
        make()


def test_figures_of_joints_that_there_are_not():
    for made, name in (
        (Motors((1.0, 1.0)), "Motors.copper"),
        (SquaredTorque((1.0, 1.0)), "weight"),
    ):
        with pytest.raises(InputError, match=rf"{name} has figures of 2 joints; there are 1"):
            made.squares(1)
