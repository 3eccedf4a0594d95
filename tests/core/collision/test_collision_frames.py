"""Frames that bodies ride on, and gradients of distances: against the robot's own kinematics."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.arrays import FloatArray
from flyby.core.collision.scene.frames import (
    WORLD,
    base_place,
    distance_gradients,
    frame_of_axis,
    frame_tree,
    place_bodies,
)
from flyby.core.robot.joint import ExternalAxis, ExternalRole
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose

from .conftest import arm, configurations, table, track, with_rods

TURNED = Pose((0.3, -0.2, 0.1), (0.8, 0.0, 0.6, 0.0))
ROBOTS = {
    "alone": arm(base=TURNED),
    "track": arm([track()], base=TURNED),
    "table": arm(table(), base=TURNED),
    "both": arm([*table(), track()]),
    "rods": with_rods(arm([track()], base=TURNED)),
}


def placed(robot: Robot, frame: int, pose: Pose, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    matrix = pose.matrix()[None]
    R, p = place_bodies(
        frame_tree(robot), np.array([frame]), matrix[:, :3, :3].copy(), matrix[:, :3, 3].copy(), q
    )
    return R[:, 0], p[:, 0]


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_the_last_frame_carries_the_flange(robot: Robot) -> None:
    q = configurations(robot, 20)
    R, p = placed(robot, robot.arm_size, robot.flange, q)
    expected_R, expected_p = robot.forward(q)
    np.testing.assert_allclose(R, expected_R, atol=1e-12)
    np.testing.assert_allclose(p, expected_p, atol=1e-12)


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=ROBOTS)
def test_gradients_of_points_are_those_of_the_jacobian(robot: Robot) -> None:
    q = configurations(robot, 20)
    p = robot.forward(q)[1]
    normal = np.tile([0.6, 0.0, 0.8], (20, 1))
    last, world = np.full(20, robot.arm_size), np.full(20, WORLD)
    gradient = distance_gradients(frame_tree(robot), q, last, world, p, p, normal)
    expected = np.einsum("mi,min->mn", normal, robot.jacobian(q)[:, :3])
    np.testing.assert_allclose(gradient, expected, atol=1e-12)
    swapped = distance_gradients(frame_tree(robot), q, world, last, p, p, normal)
    np.testing.assert_allclose(swapped, -gradient, atol=1e-15)


def test_a_table_on_a_tilting_axis_moves_with_both() -> None:
    robot = ROBOTS["table"]
    frames = frame_tree(robot)
    turning, tilting = frame_of_axis(robot, "table"), frame_of_axis(robot, "tilt")
    assert frames.parent[turning] == tilting
    assert np.flatnonzero(frames.rides[turning]).tolist() == [WORLD, turning, tilting]
    assert np.flatnonzero(frames.rides[tilting]).tolist() == [WORLD, tilting]
    q = np.array([[0.0, 0.0, 0.0, 0.5, 0.3]])
    R, p = placed(robot, turning, Pose((0.2, 0.0, 0.0)), q)
    cosine, sine = np.cos(0.3), np.sin(0.3)
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    spun = np.array([0.2 * np.cos(0.5), 0.2 * np.sin(0.5), 0.1])
    np.testing.assert_allclose(p[0], np.array([1.3, 0.0, 0.2]) + tilt @ spun, atol=1e-12)
    np.testing.assert_allclose(R[0][:, 2], tilt[:, 2], atol=1e-12)


def test_the_base_rides_on_the_track() -> None:
    assert base_place(ROBOTS["alone"]) == (WORLD, TURNED)
    frame, placement = base_place(ROBOTS["both"])
    assert frame == frame_of_axis(ROBOTS["both"], "track")
    assert placement == Pose()
    rides = frame_tree(ROBOTS["both"]).rides
    assert np.flatnonzero(rides[1]).tolist() == [WORLD, 1, frame]


def test_a_gantry_of_two_tracks_is_walked_in_order() -> None:
    lower, upper = track(), track()
    joint = upper.joint
    short = ExternalAxis(
        type(joint)(
            "bridge", Pose((0.0, 0.0, 2.0)), (1.0, 0.0, 0.0), -1.0, 1.0, 1.0, 2.0, kind=joint.kind
        ),
        ExternalRole.TRACK,
        carried_by="track",
    )
    robot = arm([short, lower])
    q = configurations(robot, 5)
    R, p = placed(robot, robot.arm_size, robot.flange, q)
    np.testing.assert_allclose(p, robot.forward(q)[1], atol=1e-12)
    np.testing.assert_allclose(R, robot.forward(q)[0], atol=1e-12)
