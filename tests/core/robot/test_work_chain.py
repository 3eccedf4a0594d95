"""Chains from work object to TCP against explicit products of matrices."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError, UnknownNameError
from flyby.core.program.tool import FLANGE, WORLD, Tool, WorkObject
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.kinematics.chain_kernels import jacobians, poses
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

SETTINGS = settings(max_examples=30, deadline=None)
TCP = Pose((0.1, -0.05, 0.3), (0.8, 0.0, 0.6, 0.0))
USER = Pose((1.0, 0.4, 0.2), (0.6, 0.0, 0.0, 0.8))
FRAME = Pose((0.05, -0.3, 0.1), (0.8, 0.6, 0.0, 0.0))
TRACK = Pose((-1.0, 0.2, 0.1), (0.0, 0.6, 0.8, 0.0))
TILT, TURN = Pose((2.0, 0.0, 0.5), (0.6, 0.8, 0.0, 0.0)), Pose((0.1, 0.0, 0.2))
Q = st.lists(st.floats(-2.0, 2.0), min_size=9, max_size=9).map(np.array)


@pytest.fixture(scope="module")
def cell(arms):
    """An arm on a track before a two-axis table: values J1 … J6, TILT, TURN, E1."""
    axes = [
        ExternalAxis(Joint("TILT", TILT, (1.0, 0.0, 0.0), -2, 2, 1, 1), ExternalRole.TABLE),
        ExternalAxis(Joint("TURN", TURN, (0.0, 0.0, 1.0), -6, 6, 1, 1), ExternalRole.TABLE, "TILT"),
        ExternalAxis(
            Joint("E1", TRACK, (0.0, 1.0, 0.0), -3, 3, 1, 1, kind=JointKind.PRISMATIC),
            ExternalRole.TRACK,
        ),
    ]
    return arms["KR 16"].with_external_axes(axes).with_base(Pose((0.2, 0.0, 0.4)))


def turned(axis, angle):
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(angle * np.array(axis, dtype=float))
    return matrix


def flange(cell, q):
    """The flange in the world, joint by joint."""
    slid = np.eye(4)
    slid[1, 3] = q[8]
    T = TRACK.matrix() @ slid @ cell.base.matrix()
    for joint, value in zip(cell.joints, q, strict=False):
        T = T @ joint.placement.matrix() @ turned(joint.axis, value)
    return T @ cell.flange.matrix()


def table(q):
    """The turntable in the world."""
    tilted = TILT.matrix() @ turned((1, 0, 0), q[6])
    return tilted @ TURN.matrix() @ turned((0, 0, 1), q[7])


def check(cell, tool, work_object, q, expected) -> None:
    chain = work_chain(cell, tool, work_object)
    (R,), (p,) = poses(chain, q[None])
    np.testing.assert_allclose(R, expected(q)[:3, :3], atol=1e-12)
    np.testing.assert_allclose(p, expected(q)[:3, 3], atol=1e-12)
    J, h = jacobians(chain, q[None])[0], 1e-6
    for k in range(q.size):
        step = h * np.eye(q.size)[k]
        slope = (expected(q + step) - expected(q - step)) / (2 * h)
        np.testing.assert_allclose(J[:3, k], slope[:3, 3], atol=1e-8)
        spin = slope[:3, :3] @ R.T
        np.testing.assert_allclose(J[3:, k], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)


@SETTINGS
@given(q=Q)
def test_the_bare_flange_in_the_world(cell, q) -> None:
    check(cell, FLANGE, WORLD, q, lambda x: flange(cell, x))


@SETTINGS
@given(q=Q)
def test_a_tool_at_a_fixed_work_object(cell, q) -> None:
    work = WorkObject("part", USER, FRAME)
    inverse = np.linalg.inv(USER.matrix() @ FRAME.matrix())
    check(cell, Tool("gun", TCP), work, q, lambda x: inverse @ flange(cell, x) @ TCP.matrix())


@SETTINGS
@given(q=Q)
def test_a_work_object_on_a_two_axis_table(cell, q) -> None:
    work = WorkObject("part", USER, FRAME, moved_by="TURN")

    def expected(x):
        at = table(x) @ USER.matrix() @ FRAME.matrix()
        return np.linalg.inv(at) @ flange(cell, x) @ TCP.matrix()

    check(cell, Tool("gun", TCP), work, q, expected)


@SETTINGS
@given(q=Q)
def test_a_part_held_by_the_robot_at_a_stationary_tool(cell, q) -> None:
    work = WorkObject("part", USER, FRAME, robot_held=True)

    def expected(x):
        at = flange(cell, x) @ USER.matrix() @ FRAME.matrix()
        return np.linalg.inv(at) @ TCP.matrix()

    check(cell, Tool("nozzle", TCP, robot_held=False), work, q, expected)


def test_only_one_of_tool_and_work_object_can_be_held(cell) -> None:
    held, standing = WorkObject("part", robot_held=True), Tool("nozzle", robot_held=False)
    with pytest.raises(InputError, match="both tool 'tool0' and work object 'part'"):
        work_chain(cell, FLANGE, held)
    with pytest.raises(InputError, match="neither tool 'nozzle' nor work object 'wobj0'"):
        work_chain(cell, standing, WORLD)
    both = WorkObject("part", robot_held=True, moved_by="TURN")
    with pytest.raises(InputError, match="held by the robot and moved by 'TURN'"):
        work_chain(cell, standing, both)


def test_only_a_table_moves_a_work_object(cell) -> None:
    with pytest.raises(InputError, match="'E1', which is a track, not a table"):
        work_chain(cell, FLANGE, WorkObject("part", moved_by="E1"))
    with pytest.raises(UnknownNameError, match="'TURM': did you mean"):
        work_chain(cell, FLANGE, WorkObject("part", moved_by="TURM"))
