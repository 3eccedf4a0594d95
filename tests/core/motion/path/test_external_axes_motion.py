"""Tracks, tables and stationary tools: relative to the work object the TCP keeps to its program."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool, WorkObject
from flyby.core.program.zone import FINE, Radius
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose

SPEED = Speed(tcp=0.2, reorientation=3.0, external_linear=0.3, external_angular=0.5)
TRACK = ExternalAxis(
    Joint("E1", Pose((0, -1, 0)), (0.0, 1.0, 0.0), -3, 3, 1, 2, kind=JointKind.PRISMATIC),
    ExternalRole.TRACK,
)
TABLE = ExternalAxis(
    Joint("T", Pose((1.6, 0.0, 0.6)), (0.0, 0.0, 1.0), -6, 6, 2, 4), ExternalRole.TABLE
)


def away_from_line(p, a, b) -> np.ndarray:
    unit = (b - a) / np.linalg.norm(b - a)
    rest = (p - a) - ((p - a) @ unit)[:, None] * unit
    return np.linalg.norm(rest, axis=1)


@settings(max_examples=5, deadline=None)
@given(slide=st.floats(-0.5, 0.5))
def test_the_tcp_keeps_to_its_line_while_the_track_moves(abb, slide) -> None:
    robot = abb.robot.with_external_axes([TRACK])
    begin = robot.flange_pose(np.array([*abb.home, 0.2])).position
    end = np.array(begin) + np.array([0.2, 0.1, 0.0])
    pose = Pose(tuple(end), robot.flange_pose(np.array([*abb.home, 0.2])).quaternion)
    moves = (MoveL(PoseTarget(pose, external=(0.2 + slide,)), SPEED),)
    start = JointTarget(tuple(abb.home), (0.2,))
    run = abb.controller(robot=robot).run(Program(moves, start=start))
    assert away_from_line(run.trajectory.position, np.array(begin), end).max() < 1e-6
    np.testing.assert_allclose(run.trajectory.position[-1], end, atol=1e-8)
    assert run.trajectory.q[-1, 6] == pytest.approx(0.2 + slide)
    assert np.abs(run.trajectory.dq[:, 6]).max() <= 0.3 * (1 + 1e-6)
    # The axis moves in proportion to the path.
    share = np.linalg.norm(run.path.states.v[:, :3], axis=1)
    np.testing.assert_allclose(share, share[0], rtol=1e-6)
    np.testing.assert_allclose(run.path.states.dq[:, 6], run.path.states.dq[0, 6], atol=1e-9)


def table_program(abb, turn, zone=FINE):
    robot = abb.robot.with_external_axes([TABLE])
    work = WorkObject("part", user=Pose((0.1, 0.05, 0.3)), moved_by="T")
    chain = work_chain(robot, Tool(), work)
    q = np.array([*abb.home, 0.0])
    (R,), (p,) = poses(chain, q[None])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R, p
    at = Pose.from_matrix(matrix)
    first, second = p + np.array([0.2, 0, 0]), p + np.array([0.2, 0.2, 0])
    moves = (
        MoveL(
            PoseTarget(Pose(tuple(first), at.quaternion), external=(turn,)),
            SPEED,
            zone,
            work_object=work,
        ),
        MoveL(
            PoseTarget(Pose(tuple(second), at.quaternion), external=(0.5 * turn,)),
            SPEED,
            work_object=work,
        ),
    )
    program = Program(moves, start=JointTarget(tuple(abb.home), (0.0,)))
    return robot, chain, program, (p, first, second)


@settings(max_examples=5, deadline=None)
@given(turn=st.floats(-0.4, 0.4))
def test_the_tcp_keeps_to_its_line_on_a_turning_table(abb, turn) -> None:
    robot, chain, program, corners = table_program(abb, turn)
    run = abb.controller(robot=robot).run(program)
    _, p = poses(chain, np.ascontiguousarray(run.trajectory.q))
    for k in (0, 1):
        leg = p[run.trajectory.move == k]
        assert away_from_line(leg, corners[k], corners[k + 1]).max() < 1e-6
    np.testing.assert_allclose(p[-1], corners[2], atol=1e-8)
    assert run.trajectory.q[-1, 6] == pytest.approx(0.5 * turn)


def test_a_zone_on_a_turning_table_is_cut_in_the_work_object(abb) -> None:
    robot, chain, program, corners = table_program(abb, 0.4, Radius(0.05, 0.05, 0.05))
    path = abb.controller(robot=robot).plan(program)
    _, p = poses(chain, np.ascontiguousarray(path.q))
    off = np.minimum(
        away_from_line(p, corners[0], corners[1]), away_from_line(p, corners[1], corners[2])
    )
    from_corner = np.linalg.norm(p - corners[1], axis=1)
    assert (from_corner[off > 1e-8] < 0.05).all()
    assert off.max() > 1e-3
    left, right = path.pieces.first_sample[1:-1] - 1, path.pieces.first_sample[1:-1]
    np.testing.assert_allclose(path.states.dq[left], path.states.dq[right], atol=1e-8)


def test_a_stationary_tool_draws_the_programmed_line_on_the_held_part(abb) -> None:
    gun = Tool("gun", Pose((1.9, 0.3, 1.2), (0.8, 0.0, 0.6, 0.0)), robot_held=False)
    held = WorkObject("part", frame=Pose((0.0, 0.0, 0.1)), robot_held=True)
    chain = work_chain(abb.robot, gun, held)
    (R,), (p,) = poses(chain, abb.home[None])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R, p
    at = Pose.from_matrix(matrix)
    corners = [p, p + np.array([0.1, 0, 0]), p + np.array([0.1, 0.1, 0])]
    moves = (
        MoveL(PoseTarget(Pose(tuple(corners[1]), at.quaternion)), SPEED, Radius(0.02), gun, held),
        MoveL(PoseTarget(Pose(tuple(corners[2]), at.quaternion)), SPEED, FINE, gun, held),
    )
    run = abb.controller().run(Program(moves, start=abb.start))
    p = run.trajectory.position
    off = np.minimum(away_from_line(p, *corners[:2]), away_from_line(p, *corners[1:]))
    from_corner = np.linalg.norm(p - corners[1], axis=1)
    assert (from_corner[off > 1e-7] < 0.02 + 1e-7).all()
    np.testing.assert_allclose(p[-1], corners[2], atol=1e-7)
    speed = np.linalg.norm(np.diff(p, axis=0), axis=1) / np.diff(run.trajectory.t)
    assert speed.max() <= 0.2 * (1 + 1e-3)
    # A joint move to the same place arrives at the same configuration.
    jump = (MoveJ(moves[1].target, SPEED, FINE, gun, held),)
    there = abb.controller().run(Program(jump, start=abb.start)).trajectory.q[-1]
    np.testing.assert_allclose(there, run.trajectory.q[-1], atol=1e-7)


def test_a_move_of_an_external_axis_alone_takes_its_time(abb) -> None:
    """The table turns under a TCP that stays on the part: joints follow."""
    robot, chain, program, corners = table_program(abb, 0.0)
    first = program.moves[0]
    at = Pose(tuple(corners[0]), first.target.pose.quaternion)
    target = PoseTarget(at, external=(0.3,))
    moves = (MoveL(target, SPEED, work_object=first.work_object),)
    run = abb.controller(MotionModel(), robot).run(Program(moves, start=program.start))
    _, p = poses(chain, np.ascontiguousarray(run.trajectory.q))
    np.testing.assert_allclose(p, np.broadcast_to(corners[0], p.shape), atol=1e-6)
    assert run.duration >= 0.3 / 0.5
