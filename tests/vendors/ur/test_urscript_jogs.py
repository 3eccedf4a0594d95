"""``speedj`` and ``speedl`` with a known speed and time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor

HOME = "movej([0, -1.57, 1.57, -1.57, -1.57, 0])\n"


def read(body: str) -> Program:
    return find_vendor("ur").read(HOME + body, "a.script", robot=find_robot("ur/ur5e"))


def said(program: Program) -> str:
    return " ".join(note.message for note in program.notes)


def test_a_joint_speed_leads_over_speed_times_time() -> None:
    first, jog = read("speedj([0.5, 0, 0, 0, -0.25, 0], a=0.5, t=3)").moves
    assert isinstance(jog, MoveJ)
    away = np.subtract(jog.target.joints, first.target.joints)
    assert away == pytest.approx([1.5, 0, 0, 0, -0.75, 0])
    assert (jog.speed.joint, jog.speed.joint_acceleration) == (0.5, 0.5)


def test_a_line_turns_and_moves_in_the_base() -> None:
    program = read("speedl([0, 0, 0.1, 0, 0, 0.2], 0.5, 2)\nspeedl([0.1, 0, 0, 0, 0, 0], 0.5, 1)")
    _, jog, other = program.moves
    assert isinstance(jog, MoveL) and isinstance(other, MoveL)
    assert jog.speed.tcp == pytest.approx(0.1) and jog.speed.reorientation == pytest.approx(0.2)
    step = np.subtract(other.target.pose.position, jog.target.pose.position)
    assert step == pytest.approx([0.1, 0, 0])
    assert other.target.pose.quaternion == pytest.approx(jog.target.pose.quaternion)
    assert "speedl with a known speed and time is driven from rest to rest" in said(program)


@settings(max_examples=10, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(0.05, 0.1), st.floats(0.0, 0.05), st.floats(0.7, 1.0)),
        min_size=2,
        max_size=3,
    )
)
def test_a_line_goes_over_to_the_next_speed_without_a_stop(jogs) -> None:
    """After the times of all calls it slows down from the last speed; where it is follows from
    the speeds, which change with the acceleration."""
    calls = [f"speedl([{x!r}, {y!r}, 0, 0, 0, 0], 0.5, {t!r})\n" for x, y, t in jogs]
    program = read("sleep(1)\n" + "".join(calls))
    if len({jog[:2] for jog in jogs}) != len(jogs):
        return  # calls that go on are one move
    first, *moves = program.moves
    assert [move.zone == FINE for move in moves] == [False] * (len(jogs) - 1) + [True]
    speeds = [np.zeros(2), *(np.array(jog[:2]) for jog in jogs), np.zeros(2)]
    times = [*(jog[2] for jog in jogs), float(np.linalg.norm(speeds[-2])) / 0.5]
    ramps = [float(np.linalg.norm(w - v)) / 0.5 for v, w in pairwise(speeds)]
    away = sum(
        (v + w) / 2 * ramp + w * (time - ramp)
        for v, w, ramp, time in zip(speeds, speeds[1:], ramps, times, strict=False)
    )
    controller = Controller(find_vendor("ur"), find_robot("ur/ur5e"))
    start = controller.robot.flange_pose(np.array(first.target.joints)).position
    assert np.subtract(moves[-1].target.pose.position, start)[:2] == pytest.approx(away, abs=1e-9)
    stops = sum(t + float(np.hypot(x, y)) / 0.5 for x, y, t in jogs)
    assert 0.99 * sum(times) <= controller.run(program).duration - 1.0 < stops


@pytest.mark.parametrize(
    "second", ["[-0.1, 0, 0, 0, 0, 0], 0.5, 1", "[0, 0.1, 0, 0, 0, 0], 0.5, 0.1"]
)
def test_a_line_that_turns_back_or_has_no_time_stops(second) -> None:
    _, jog, _ = read(f"speedl([0.1, 0, 0, 0, 0, 0], 0.5, 1)\nspeedl({second})").moves
    assert jog.zone == FINE


def test_a_speed_that_is_not_reached_counts_as_far_as_it_is() -> None:
    _, jog = read("speedj([2, 0, 0, 0, 0, 0], 1, 0.5)").moves
    assert jog.target.joints[0] == pytest.approx(0.25)  # up to 0.5 rad/s, and down again
    assert jog.speed.joint == pytest.approx(0.5)


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 12), st.floats(0.02, 0.2))
def test_steps_of_one_speed_are_one_move(count: int, seconds: float) -> None:
    steps = (
        f"i = 0\nwhile i < {count}:\nspeedj([0, 0.3, 0, 0, 0, 0], 2, {seconds!r})\ni = i + 1\nend"
    )
    *_, jog = stepped = read(steps).moves
    *_, once = read(f"speedj([0, 0.3, 0, 0, 0, 0], 2, {count * seconds!r})").moves
    assert len(stepped) == 2
    assert jog.target.joints == pytest.approx(once.target.joints)


def test_where_the_robot_stands_is_known_between_steps_and_behind_them() -> None:
    body = (
        "z = get_actual_joint_positions()\nwhile z[0] < 0.5:\n"
        "speedj([0.2, 0, 0, 0, 0, 0], 1, 0.25)\nz = get_actual_joint_positions()\nend\nstopj(1)\n"
        "speedj([0.2, 0, 0, 0, 0, 0], 1, 0.25)"
    )
    _, jog, again = read(body).moves
    assert jog.target.joints[0] == pytest.approx(0.5)
    assert again.target.joints[0] == pytest.approx(0.55)


@pytest.mark.parametrize(
    "call",
    [
        "speedl(v, 0.5, 1)",
        "speedl([0.1, 0, 0, 0, 0, 0], 0.5)",
        "speedj([0, 0, 0, 0, 0, 0], 0.5, 1)",
        "speedj([1, 0, 0, 0, 0, 0], 0.5, read_input_float_register(3))",
    ],
)
def test_what_is_not_known_of_a_jog_leaves_it_out(call: str) -> None:
    program = read(f"v = socket_read_ascii_float(6)\n{call}\nmovej([0, -1.5, 1.5, -1.5, -1.5, 0])")
    assert len(program.moves) == 2
    assert "it is taken to stay where it is" in said(program)


def test_a_jog_alone_asks_where_the_robot_stands() -> None:
    with pytest.raises(SourceError, match="speedj drives the robot in steps"):
        find_vendor("ur").read("speedj([0, 0, 0, 0, 0, 1], 3, 1)", "a.script")
