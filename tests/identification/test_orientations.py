"""Orientations that nobody recorded, from an emulated log whose orientations are known."""

from __future__ import annotations

import numpy as np

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector, rotation_vector
from flyby.identification.logs.orientations import orientations_at

ROBOT = find_robot("ur/ur10e")
HOME = np.array([0.2, -1.4, -1.8, -1.4, 1.5, 0.3])
STEPS = np.array([[0, 0, 0], [0.1, 0, 0], [0.2, 0.03, 0], [0.3, 0.1, 0.02], [0.31, 0.1, 0.02]])
TURNS = np.radians([[0, 0, 0], [0, 8, 0], [9, 8, 3], [9, -6, 3], [9, -6, 3]])
ZONE = 0.02


def test_legs_carry_their_turns_on_to_the_waypoints() -> None:
    rotation, position = ROBOT.forward(HOME[None])
    points = position[0] + STEPS
    wanted = np.stack([matrix_from_rotation_vector(turn) @ rotation[0] for turn in TURNS])
    moves = []
    for k in range(1, len(points)):
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = wanted[k], points[k]
        zone = FINE if k == len(points) - 1 else Radius(ZONE)
        moves.append(MoveL(PoseTarget(Pose.from_matrix(frame)), Speed(tcp=0.1), zone))
    program = Program(tuple(moves), start=JointTarget(tuple(HOME)))
    driven = Controller(find_vendor("ur"), ROBOT, MotionModel()).run(program).trajectory
    logged, place = ROBOT.forward(driven.q)
    reach = np.full(len(points), ZONE)
    found = orientations_at(points, reach, place, logged)
    off = [
        np.degrees(np.linalg.norm(rotation_vector(a.T @ b)))
        for a, b in zip(found, wanted, strict=True)
    ]
    assert max(off) < 0.01
    # At the second waypoint itself the blend is degrees away.
    nearest = logged[np.argmin(np.linalg.norm(place - points[2], axis=1))]
    assert np.degrees(np.linalg.norm(rotation_vector(nearest.T @ wanted[2]))) > 0.3
