"""A robot as a page has it: frames on frames, with tracks, tables and what follows other joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.driving.driven_program import DrivenProgram
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import WorkObject
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.assembly import assemble
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Follower, Joint, JointKind
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.drawing.page.arm_content import (
    PageRole,
)
from flyby.drawing.page.arms import Nodes, page_arm
from flyby.drawing.page.tracks import page_lines, page_waypoints

ARM = find_robot("abb/irb6640-180-255")
TRACK = ExternalAxis(
    Joint("E1", Pose((0, -1, 0)), (0.0, 1.0, 0.0), -3, 3, 1, 2, kind=JointKind.PRISMATIC),
    ExternalRole.TRACK,
)
TABLE = ExternalAxis(
    Joint("T", Pose((1.6, 0.0, 0.6)), (0.0, 0.0, 1.0), -6, 6, 2, 4), ExternalRole.TABLE
)
TILTED = ExternalAxis(
    Joint("T2", Pose((0.1, 0.0, 0.2)), (1.0, 0.0, 0.0), -2, 2, 2, 4), ExternalRole.TABLE, "T"
)
ROBOT = ARM.with_external_axes([TILTED, TRACK, TABLE])
VALUES = st.lists(st.floats(-1.5, 1.5), min_size=9, max_size=9)


def placed(nodes: Nodes, q: np.ndarray) -> list[np.ndarray]:
    """World poses (4, 4) of all frames, as the page computes them."""
    found: list[np.ndarray] = []
    for node in nodes.made:
        at = node.place if node.parent < 0 else found[node.parent] @ node.place
        if node.value >= 0:
            moved = np.eye(4)
            if node.slides:
                moved[:3, 3] = q[node.value] * np.array(node.axis)
            else:
                moved[:3, :3] = matrix_from_rotation_vector(q[node.value] * np.array(node.axis))
            at = at @ moved
        found.append(at)
    return found


@given(VALUES)
def test_the_flange_is_where_the_robot_has_it(values: list[float]) -> None:
    q = np.array(values)
    nodes = Nodes.of(ROBOT)
    at = placed(nodes, q)[nodes.flange]
    np.testing.assert_allclose(at, ROBOT.flange_pose(q).matrix(), atol=1e-12)
    assert all(node.parent < k for k, node in enumerate(nodes.made)), "carriers come first"


@given(VALUES)
def test_followers_turn_with_their_drivers(values: list[float]) -> None:
    joints = list(ARM.joints)
    joints[2] = replace(joints[2], followers=(Follower(joints[1].name, (0.0, -1.0, 0.0)),))
    rods = replace(ARM, joints=tuple(joints))
    q, nodes = np.array(values[:6]), Nodes.of(rods)
    at = placed(nodes, q)[nodes.flange]
    np.testing.assert_allclose(at, rods.flange_pose(q).matrix(), atol=1e-12)


@pytest.mark.parametrize("shapes", [True, False])
@pytest.mark.parametrize(
    "name", ["abb/irb660-180-315", "kuka/kr140-r3200-2-pa", "abb/irb910sc-3-065", "ur/ur5e"]
)
def test_every_arm_of_the_catalogue_is_drawn_where_it_stands(name: str, shapes: bool) -> None:
    """Palletisers and SCARAs too, of which one counts A4 behind A5."""
    robot = find_robot(name)
    robot = robot if shapes else replace(robot, shapes=())
    q = np.array([0.3, 0.2, 0.1, 0.0, 0.4, 0.6])
    nodes = Nodes.of(robot)
    frames = placed(nodes, q)
    np.testing.assert_allclose(frames[nodes.flange], robot.flange_pose(q).matrix(), atol=1e-12)
    for link in range(robot.arm_size + 1):
        R, p = poses(assemble([*robot.base_stages(), *robot.link_stages(link)]), q[None])
        np.testing.assert_allclose(frames[nodes.link(link)][:3, :3], R[0], atol=1e-12)
        np.testing.assert_allclose(frames[nodes.link(link)][:3, 3], p[0], atol=1e-12)
    assert page_arm(robot).bodies


def test_the_programmed_path_stands_on_its_table() -> None:
    """Lines and waypoints are those of the work object, wherever the table has turned it."""
    robot = ARM.with_external_axes([TABLE])
    work = WorkObject("part", user=Pose((0.1, 0.05, 0.3)), moved_by="T")
    home = np.radians([0.0, 20.0, 10.0, 0.0, 60.0, 0.0])
    nodes = Nodes.of(robot)
    start = JointTarget(tuple(home), (0.0,))
    begin = placed(nodes, np.array([*home, 0.0]))[nodes.flange]
    held = np.linalg.inv(TABLE.joint.placement.matrix() @ work.pose.matrix()) @ begin
    pose = Pose.from_matrix(held)
    ends = [
        Pose((pose.position[0] + dx, pose.position[1] + dy, pose.position[2]), pose.quaternion)
        for dx, dy in ((0.1, 0.0), (0.1, 0.1))
    ]
    speed = Speed(tcp=0.2, reorientation=3.0, external_angular=0.5)
    moves = tuple(
        MoveL(PoseTarget(end, external=(turn,)), speed, work_object=work)
        for end, turn in zip(ends, (0.3, 0.6), strict=True)
    )
    controller = Controller(find_vendor("abb"), robot)
    run = controller.run(Program(moves, start=start))
    driven = DrivenProgram.faultless(run)
    lines = page_lines(driven, nodes)
    assert {line.node for line in lines} == {nodes.axes["T"]}
    # Each sample of the driven path lies on the lines, seen from the table.
    ends_of = [line.points.values for line in lines]
    for q in run.trajectory.q[::40]:
        frames = placed(nodes, q)
        tip = np.linalg.inv(frames[nodes.axes["T"]]) @ frames[nodes.flange][:, 3]
        off = min(_off(tip[:3], points[0], points[-1]) for points in ends_of)
        assert off < 1e-4
    points = page_waypoints(driven, nodes)
    last = placed(nodes, run.trajectory.q[-1])
    at = last[int(points.nodes.values[-1])] @ np.append(points.points.values[-1], 1.0)
    np.testing.assert_allclose(at[:3], last[nodes.flange][:3, 3], atol=1e-4)
    assert points.moves.values.tolist() == [-1, 0, 1]


def _off(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    share = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return float(np.linalg.norm(p - a - share * (b - a)))


def test_an_arm_without_shapes_is_drawn_as_bars() -> None:
    arm = page_arm(replace(ARM, shapes=()))
    links = [body for body in arm.bodies if body.role is PageRole.LINK]
    assert len(links) >= 4
    assert {body.shape.kind for body in links} == {"capsule"}  # type: ignore[union-attr]


@pytest.mark.parametrize("robot", [ARM, ROBOT])
def test_axes_have_their_limits(robot) -> None:
    arm = page_arm(robot)
    assert [axis.name for axis in arm.axes] == list(robot.axis_names)
    assert [axis.upper for axis in arm.axes] == robot.limits.upper.tolist()
