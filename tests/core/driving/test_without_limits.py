"""What a limit that falls away gives back, against programs that are driven without it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.driving.without_limits import seconds_without
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.binding_limits import interval_limits, limit_seconds
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import MoveJ, MoveL, Statement, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

MAKES = {
    "abb": Controller(find_vendor("abb"), find_robot("abb/irb6640-180-255")),
    "kuka": Controller(find_vendor("kuka"), find_robot("kuka/kr30-3")),
    "ur": Controller(find_vendor("ur"), find_robot("ur/ur10e")),
}
HOMES = {
    "abb": JointTarget((0.0, 0.2, 0.2, 0.1, 1.0, 0.0)),
    "kuka": JointTarget((0.0, -1.2, 1.4, 0.1, 1.0, 0.0)),
    "ur": JointTarget((0.0, -1.2, 1.8, -1.6, -1.4, 0.0)),
}
legs = st.lists(
    st.tuples(st.floats(-0.15, 0.15), st.floats(-0.1, 0.1), st.sampled_from([0.0, 0.01, 0.05])),
    min_size=2,
    max_size=4,
)


def drive(make: str, steps: list[tuple[float, float, float]], speed: Speed) -> Run:
    controller = MAKES[make]
    home = HOMES[make]
    flange = controller.robot.flange_pose(np.array(home.joints))
    at, turn = np.array(flange.position), flange.quaternion
    statements: list[Statement] = []
    for dx, dz, zone in steps:
        at = at + np.array((0.1 if dx >= 0 else -0.1, dx, dz))
        place = PoseTarget(Pose(tuple(map(float, at)), turn))
        statements.append(MoveL(place, speed, Radius(zone) if zone else FINE))
    statements += [Wait(0.2), MoveJ(home, speed)]
    return controller.run(Program(tuple(statements), start=home))


@pytest.mark.parametrize("make", MAKES)
@settings(max_examples=8, deadline=None)
@given(legs, st.floats(0.1, 1.5), st.floats(0.3, 3.0))
def test_no_limit_that_falls_away_makes_a_run_longer(
    make: str, steps: list[tuple[float, float, float]], tcp: float, acceleration: float
) -> None:
    try:
        run = drive(make, steps, Speed(tcp=tcp, tcp_acceleration=acceleration, joint_fraction=0.5))
    except MotionError:  # out of reach
        assume(False)
    names = set(interval_limits(run, MAKES[make].robot.axis_names))
    gains = {name: seconds_without(MAKES[make], run, name) for name in names}
    for name, gain in gains.items():
        assert gain is None or -1e-4 * run.duration <= gain < run.duration, name
    assert gains.get("programmed TCP speed", 1.0) != 0.0


@pytest.mark.parametrize("make, zone", [("abb", 0.02), ("ur", 0.0)])
def test_a_programmed_limit_gives_back_what_the_program_without_it_does(
    make: str, zone: float
) -> None:
    """With another speed a UR cuts its zones elsewhere; without zones there is nothing to cut."""
    steps = [(0.1, 0.05, zone), (-0.1, 0.0, zone), (0.1, -0.05, 0.0)]
    given = Speed(tcp=0.1, reorientation=5.0, tcp_acceleration=0.5, joint_acceleration_fraction=0.6)
    run = drive(make, steps, given)
    for name, speed in {
        "programmed TCP speed": replace(given, tcp=None),
        "programmed TCP acceleration": replace(given, tcp_acceleration=None),
        "programmed joint acceleration": replace(given, joint_acceleration_fraction=1.0),
    }.items():
        other = drive(make, steps, speed)
        gain = seconds_without(MAKES[make], run, name)
        assert gain == pytest.approx(run.duration - other.duration, abs=2e-3), name


def test_a_programmed_time_gives_back_what_it_takes_too_long() -> None:
    run = drive("abb", [(0.1, 0.0, 0.0)] * 2, Speed(tcp=0.5, duration=3.0))
    other = drive("abb", [(0.1, 0.0, 0.0)] * 2, Speed(tcp=0.5))
    gain = seconds_without(MAKES["abb"], run, "programmed time")
    assert gain == pytest.approx(run.duration - other.duration, abs=2e-3)


def test_what_is_no_limit_cannot_fall_away() -> None:
    run = drive("ur", [(0.1, 0.0, 0.0)] * 2, Speed(tcp=0.5))
    assert seconds_without(MAKES["ur"], run, "stop") is None
    assert seconds_without(MAKES["ur"], run, "weather") is None


def test_what_a_program_states_is_named_as_its_own() -> None:
    """A share below one of the robot's own limit is what the user can change."""
    steps = [(0.1, 0.0, 0.0)] * 2
    slow = drive("kuka", steps, Speed(joint_fraction=0.1, joint_acceleration_fraction=0.2))
    spent = limit_seconds(slow, MAKES["kuka"].robot.axis_names)[-1]
    assert set(spent) == {"programmed joint speed", "programmed joint acceleration"}
    fast = drive("kuka", steps, Speed())
    names = set(limit_seconds(fast, MAKES["kuka"].robot.axis_names)[-1])
    assert names and all(name.startswith("A") for name in names)
