"""Derivatives by targets that state an arm angle equal difference quotients of the emulator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

ROBOT = find_robot("yumi right")
VENDOR = find_vendor("abb")
START = np.radians([35, -95, 40, 80, 50, 20, -70])
STEP = 2e-6


def target(*degrees: float) -> PoseTarget:
    q = START + np.radians(degrees)
    return PoseTarget(ROBOT.flange_pose(q), arm_angle=ROBOT.arm_angle(q))


PROGRAM = Program(
    (
        MoveL(target(4, 3, -2, 3, 4, 2, 5), Speed(tcp=0.2), Radius(0.01)),
        MoveJ(target(12, -4, 6, -5, 8, 9, -4), Speed(tcp=0.5), Radius(0.02)),
        MoveL(target(6, 5, 2, 4, -3, 5, 7), Speed(tcp=0.3), Radius(0.01)),
        MoveL(target(2, 1, 4, 8, 3, -5, 3), Speed(tcp=0.25), FINE),
    ),
    start=JointTarget(tuple(map(float, START))),
)


def timing_of(program: Program):
    controller = Controller(VENDOR, ROBOT, VENDOR.motion_of(ROBOT))
    return controller.stamp(program, controller.plan(program))


@pytest.mark.parametrize("index", range(4))
def test_the_arm_angle_stays_as_the_pose_moves(index) -> None:
    timing = timing_of(PROGRAM)
    sample, weights = 2 * len(timing.path.sigma) // 3, np.linspace(-0.5, 1.0, 7)
    made = Derivatives(PROGRAM, timing)
    gradients = [made.duration(), made.configuration(sample, weights)]

    def values(axis: int, h: float) -> np.ndarray:
        moves = list(PROGRAM.moves)
        pose = moves[index].target.pose
        x, y, z = np.array(pose.position) + h * np.eye(3)[axis]
        moved = replace(moves[index].target, pose=Pose((x, y, z), pose.quaternion))
        moves[index] = replace(moves[index], target=moved)
        found = timing_of(PROGRAM.with_moves(tuple(moves)))
        return np.array([found.duration, found.path.q[sample] @ weights])

    for axis in (0, 2):
        quotient = (values(axis, STEP) - values(axis, -STEP)) / (2 * STEP)
        exact = [gradient.position[index, axis] for gradient in gradients]
        np.testing.assert_allclose(exact, quotient, rtol=2e-5, atol=2e-5)
