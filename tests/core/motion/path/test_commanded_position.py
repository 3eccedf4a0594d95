"""Where the robot stands after moves that were not planned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError, MotionError, Span
from flyby.core.motion.path.commanded_position import Standing
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, WORLD, Tool, WorkObject
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.testing.strategies import (
    Parts,
    joint_targets,
    poses,
    programs,
    regular_configurations,
    tools,
    work_objects,
)

ROBOT = find_robot("abb/irb1600-6-145")
LABEL = find_vendor("abb").label
CALM = settings(
    max_examples=30,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
PARTS = Parts(
    lambda _: st.just(FINE),
    lambda _: st.just(Speed(0.1)),
    aim=st.sampled_from([JointTarget, PoseTarget]),
    tool=tools(),
    work_object=work_objects(),
)


def after(program: Program, start: JointTarget | None = None) -> Standing:
    standing = Standing(ROBOT, LABEL, start)
    for move in program.moves:
        standing.moved(move)
    return standing


@CALM
@given(programs(ROBOT, LABEL, PARTS))
def test_the_robot_stands_at_the_last_target(program: Program) -> None:
    standing, move = after(program), program.moves[-1]
    try:
        q = standing.joints()
    except MotionError:
        assume(False)
    if isinstance(move.target, JointTarget):
        assert np.allclose(q, move.target.joints, atol=1e-12)
    else:
        found = standing.pose(move.tool, move.work_object).matrix()
        assert np.abs(found - move.target.pose.matrix()).max() < 1e-7
        assert move.target.configuration.mismatch(LABEL(ROBOT, q)) == 0


@CALM
@given(regular_configurations(ROBOT), tools(), work_objects())
def test_the_pose_is_that_of_the_tool_in_the_work_object(
    q: np.ndarray, tool: Tool, frame: WorkObject
) -> None:
    standing = Standing(ROBOT, LABEL, JointTarget(tuple(map(float, q))))
    found = frame.pose @ standing.pose(tool, frame)
    expected = ROBOT.flange_pose(q) @ tool.tcp
    assert np.abs(found.matrix() - expected.matrix()).max() < 1e-9


@CALM
@given(joint_targets(ROBOT), st.data())
def test_asking_changes_nothing(start: JointTarget, data: st.DataObject) -> None:
    program = data.draw(programs(ROBOT, LABEL, PARTS, max_moves=3))
    curious, quiet = Standing(ROBOT, LABEL, start), after(program, start)
    try:
        for move in program.moves:
            curious.moved(move)
            curious.joints()[:] = 9.0
        assert np.allclose(curious.joints(), quiet.joints(), atol=1e-9)
    except MotionError:
        assume(False)


@CALM
@given(regular_configurations(ROBOT), poses(0.2))
def test_a_solution_is_the_one_nearest_to_what_is_named(q: np.ndarray, tcp: Pose) -> None:
    tool = Tool("gun", tcp)
    target = PoseTarget(ROBOT.flange_pose(q) @ tcp)
    standing = Standing(ROBOT, LABEL)
    found = standing.solve(MoveJ(target, Speed(0.1), tool=tool), near=q)
    assert np.abs(found - q).max() < 1e-6
    assert not standing.known, "asking for a solution moves nothing"


def test_before_the_first_move_nobody_knows() -> None:
    standing = Standing(ROBOT, LABEL)
    assert not standing.known
    with pytest.raises(InputError, match="not known before the first move"):
        standing.joints()
    with pytest.raises(InputError, match="not known before the first move"):
        standing.pose(FLANGE, WORLD)
    standing.moved(MoveJ(JointTarget((0.1, 0.2, 0.3, 0.4, 0.5, 0.6)), Speed(0.1)))
    assert standing.known
    assert standing.joints() == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])


def test_what_cannot_be_reached_is_an_error_of_its_move() -> None:
    standing = Standing(ROBOT, LABEL, JointTarget((0.0,) * 6))
    standing.moved(MoveJ(JointTarget((0.1,) * 6), Speed(0.1)))
    away = MoveL(PoseTarget(Pose((50.0, 0.0, 0.0))), Speed(0.1))
    standing.moved(away)
    with pytest.raises(MotionError, match="move 2"):
        standing.joints()


def test_the_error_stands_at_the_statement_of_its_move() -> None:
    statement = Span("a.txt", 3, 1, 20, 30)
    standing = Standing(ROBOT, LABEL, JointTarget((0.0,) * 6))
    standing.moved(MoveL(PoseTarget(Pose((50.0, 0.0, 0.0))), Speed(0.1)), statement)
    with pytest.raises(
        MotionError, match=r"^a\.txt:3:1: move 1: target cannot be reached"
    ) as caught:
        standing.joints()
    assert caught.value.span == statement


def test_joint_values_make_earlier_targets_unimportant() -> None:
    standing = Standing(ROBOT, LABEL)
    standing.moved(MoveL(PoseTarget(Pose((50.0, 0.0, 0.0))), Speed(0.1)))
    standing.moved(MoveJ(JointTarget((0.1,) * 6), Speed(0.1)))
    assert standing.joints() == pytest.approx([0.1] * 6)
    assert replace(FLANGE) == FLANGE
