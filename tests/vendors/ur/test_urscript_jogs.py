"""``speedj`` and ``speedl`` with a known speed and time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
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
