"""Lines that begin or end where the wrist is straight."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller, Run
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.motion.path.singular_samples import ROUNDED
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

SPEED = Speed(tcp=0.25)
# Postures whose wrist is straight, and whose arm lies in a vertical plane with it.
STRAIGHT = {
    "kuka/kr30-3": [0.3, -1.57, 1.57, 0.0, 0.0, 0.2],
    "abb/irb6640-180-255": [0.3, 0.1, -0.2, 0.0, 0.0, 0.2],
    "abb/irb1200-5-090": [-0.4, 0.2, 0.1, 0.0, 0.0, -0.3],
}


def moved(robot: Robot, q, along: float, up: float, pitch: float, aside: float = 0.0) -> PoseTarget:
    """The pose at q, moved in the arm's plane and turned within it; ``aside``, out of it."""
    matrix = robot.flange_pose(np.array(q)).matrix()
    c, s = np.cos(np.arctan2(matrix[1, 3], matrix[0, 3])), 0.0
    s = np.sin(np.arctan2(matrix[1, 3], matrix[0, 3]))
    turn = matrix_from_rotation_vector(pitch * np.array([-s, c, 0.0]))
    matrix[:3, :3] = turn @ matrix[:3, :3]
    matrix[:3, 3] += [along * c - aside * s, along * s + aside * c, up]
    return PoseTarget(Pose.from_matrix(matrix))


def drive(robot: Robot, start, *targets: PoseTarget, zone=FINE) -> Run:
    vendor = find_vendor(robot.name.split("/")[0])
    moves = tuple(MoveL(target, SPEED, zone) for target in targets)
    start = JointTarget(tuple(map(float, start)))
    return Controller(vendor, robot).run(Program(moves, start=start))


def _place(pose: Pose) -> np.ndarray:
    return np.array(pose.position)


def keeps_to(run: Run, robot: Robot, start, *targets: PoseTarget) -> None:
    """The TCP is where the line is, and joints turn as their rates say."""
    corners = [_place(robot.flange_pose(np.array(start))), *(_place(t.pose) for t in targets)]
    path = run.path
    for row, q in enumerate(path.q):
        here = _place(robot.flange_pose(q))
        off = []
        for a, b in pairwise(corners):
            share = np.clip((here - a) @ (b - a) / max((b - a) @ (b - a), 1e-12), 0.0, 1.0)
            off.append(float(np.linalg.norm(here - a - share * (b - a))))
        assert min(off) < 1e-8, row
    motion = run.trajectory
    step, told = np.diff(motion.q, axis=0), 0.5 * (motion.dq[1:] + motion.dq[:-1])
    ways = np.diff(motion.t)[:, None]
    assert np.abs(step - told * ways).max() < 0.05 * np.abs(motion.dq).max() * ways.max() + ROUNDED


WAYS = st.tuples(st.floats(-0.15, 0.1), st.floats(-0.15, 0.1), st.floats(-0.3, 0.3)).filter(
    lambda way: abs(way[0]) + abs(way[1]) > 0.02
)


@settings(max_examples=20, deadline=None)
@given(name=st.sampled_from(sorted(STRAIGHT)), way=WAYS)
def test_a_line_in_the_plane_of_the_arm_leaves_and_comes_back(name, way) -> None:
    robot, q = find_robot(name), STRAIGHT[name]
    targets = moved(robot, q, *way), moved(robot, q, 0.0, 0.0, 0.0)
    try:
        run = drive(robot, q, *targets)
    except MotionError as error:
        # Where the wrist stays nearly straight, rounding decides; nothing else is in the way.
        assert "singular" in error.message
        turned = abs(way[2]) + abs(way[0]) + abs(way[1])
        assert turned < 0.5
        return
    assert np.abs(run.path.q[:, 3]).max() < ROUNDED
    np.testing.assert_allclose(run.path.q[-1], q, atol=ROUNDED)
    keeps_to(run, robot, q, *targets)


@pytest.mark.parametrize("name", sorted(STRAIGHT))
def test_a_line_out_of_the_plane_is_refused(name) -> None:
    robot, q = find_robot(name), STRAIGHT[name]
    with pytest.raises(MotionError, match="singular configuration of the wrist"):
        drive(robot, q, moved(robot, q, 0.0, 0.0, 0.0, aside=0.1))


@pytest.mark.parametrize("name", sorted(STRAIGHT))
def test_points_written_with_rounding_are_driven(name) -> None:
    robot, q = find_robot(name), STRAIGHT[name]
    exact = moved(robot, q, -0.1, -0.1, 0.3)
    matrix = exact.pose.matrix()
    matrix[:3, 3] = np.round(matrix[:3, 3], 5)
    run = drive(robot, q, PoseTarget(Pose.from_matrix(matrix)))
    assert np.abs(run.path.q[:, 3]).max() < 0.02


@pytest.mark.parametrize("name", sorted(STRAIGHT))
def test_zones_beside_a_straight_wrist(name) -> None:
    robot, q = find_robot(name), STRAIGHT[name]
    targets = moved(robot, q, -0.1, 0.0, 0.1), moved(robot, q, -0.1, -0.1, 0.3)
    run = drive(robot, q, *targets, zone=Radius(0.01, 0.01, 0.01, 0.1))
    assert np.abs(run.path.q[:, 3]).max() < ROUNDED


def test_no_derivative_where_a_line_begins_singular() -> None:
    name = "kuka/kr30-3"
    robot, q = find_robot(name), STRAIGHT[name]
    bent = JointTarget(tuple(map(float, [*q[:4], 0.3, q[5]])))
    moves = (
        MoveJ(JointTarget(tuple(map(float, q))), SPEED, FINE),
        MoveL(moved(robot, q, -0.1, -0.1, 0.3), SPEED, FINE),
    )
    controller = Controller(find_vendor("kuka"), robot)
    program = Program(moves, start=bent)
    timing = controller.stamp(program, controller.plan(program))
    with pytest.raises(MotionError, match="begins or ends where the arm is singular") as caught:
        Derivatives(program, timing).duration()
    assert caught.value.move == 1
