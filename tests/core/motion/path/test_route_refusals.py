"""Targets that cannot be resolved, and what is said of those that can hardly be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.errors import InputError, MotionError
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE
from flyby.core.spatial.pose import Pose

SLOW = Speed(tcp=0.2)


@pytest.mark.parametrize("start", [True, False])
@pytest.mark.parametrize("kind", [MoveJ, MoveL])
def test_a_target_beyond_all_reach_is_refused_at_once(abb, kind, start) -> None:
    far = PoseTarget(Pose((1e300, 0.0, 0.0)))
    moves = (kind(far, SLOW, FINE), MoveL(abb.target(), SLOW, FINE))
    with pytest.raises(MotionError, match=r"move 1: the target lies 1e\+300 m away"):
        abb.controller().plan(Program(moves, start=abb.start if start else None))


def test_an_auxiliary_point_beyond_all_reach_is_refused(abb) -> None:
    move = MoveC(abb.target((1, 0, 0)), SLOW, FINE, via=PoseTarget(Pose((0.0, -1e200, 0.0))))
    with pytest.raises(MotionError, match="move 1: the auxiliary point lies"):
        abb.controller().plan(Program((move,), start=abb.start))


def test_more_samples_than_memory_holds_are_refused(abb) -> None:
    moves = (MoveL(abb.target((1, 0, 0)), SLOW, FINE),)
    controller = abb.controller()
    program = Program(moves, start=abb.start)
    timing = controller.stamp(program, controller.plan(program))
    with pytest.raises(InputError, match="period of at least"):
        controller.sample(program, timing, 1e-12)


@pytest.mark.parametrize(("degrees", "noted"), [(179.0, False), (179.99, True)])
def test_half_a_turn_is_noted(abb, degrees, noted) -> None:
    move = MoveL(abb.target(turn=(0.0, 0.0, np.radians(degrees))), SLOW, FINE)
    program = Program((move,), start=abb.start)
    notes = [str(note) for note in abb.controller().plan(program).notes]
    assert any("half a turn" in note for note in notes) is noted


def test_a_first_move_without_a_start_is_told_once(abb) -> None:
    moves = (MoveJ(abb.start, SLOW, FINE), MoveL(abb.target((1, 0, 0)), SLOW, FINE))
    notes = [str(note) for note in abb.controller().plan(Program(moves)).notes]
    assert sum("no start is known" in note for note in notes) == 1
    assert not any("goes nowhere" in note for note in notes)
    notes = [str(n) for n in abb.controller().plan(Program(moves, start=abb.start)).notes]
    assert any("move 1: goes nowhere" in note for note in notes)


def test_no_derivative_at_a_singular_target(abb) -> None:
    straight = abb.home.copy()
    straight[4] = 0.0
    target = PoseTarget(abb.robot.flange_pose(straight))
    moves = (MoveJ(target, Speed(), FINE),)
    controller = abb.controller()
    program = Program(moves, start=JointTarget(tuple(map(float, abb.home))))
    timing = controller.stamp(program, controller.plan(program))
    with pytest.raises(MotionError, match="move 1: the arm is singular at the target"):
        Derivatives(program, timing).duration()


@pytest.fixture(scope="module")
def seven(abb):
    """The large arm with an elbow that turns: a third axis along the upper arm."""
    robot = abb.robot
    first, second, third, *rest = robot.joints
    along = Pose((0.0, 0.0, 0.5))
    elbow = replace(first, name="E1", placement=along)
    third = replace(third, placement=along.inverse() @ third.placement)
    return replace(
        robot, name="abb/seven", joints=(first, second, elbow, third, *rest), links=(), shapes=()
    )


def test_a_seven_axis_joint_move_keeps_the_third_axis(abb, seven) -> None:
    controller = abb.controller(robot=seven)
    home = np.insert(abb.home, 2, 0.3)
    there = home + np.array([0.5, 0.2, 0.0, -0.3, 0.2, 0.3, -0.4])
    target = PoseTarget(seven.flange_pose(there))
    program = Program((MoveJ(target, Speed(), FINE),), start=JointTarget(tuple(map(float, home))))
    path = controller.plan(program)
    arrived = path.q[-1]
    assert arrived[2] == home[2]
    reached = seven.flange_pose(arrived).matrix()
    np.testing.assert_allclose(reached, target.pose.matrix(), atol=1e-9)
    assert np.abs(arrived - home).sum() <= np.abs(there - home).sum() + 1e-9


def test_a_seven_axis_target_out_of_reach_is_told_without_a_path(abb, seven) -> None:
    controller = abb.controller(robot=seven)
    home = JointTarget(tuple(map(float, np.insert(abb.home, 2, 0.3))))
    move = MoveJ(PoseTarget(Pose((9.0, 0.0, 0.0))), Speed(), FINE)
    with pytest.raises(MotionError, match="move 1: target cannot be reached") as caught:
        controller.plan(Program((move,), start=home))
    assert "path" not in str(caught.value)
