"""Figures of a corner, on a motion whose corner is known."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.corners import measure_corner

HOME = np.array([0.2, -1.4, -1.8, -1.4, 1.5, 0.3])
LEG, RADIUS = 0.2, 0.05


@pytest.fixture(scope="module")
def run():
    robot = find_robot("ur/ur10e")
    at = robot.flange_pose(HOME)

    def there(*offset):
        return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))

    speed = Speed(tcp=0.1)
    moves = (MoveL(there(LEG, 0, 0), speed, Radius(RADIUS)), MoveL(there(LEG, LEG, 0), speed, FINE))
    program = Program(moves, start=JointTarget(tuple(HOME)))
    return Controller(find_vendor("ur"), robot, MotionModel()).run(program)


def test_the_corner_of_a_parabola(run) -> None:
    motion = run.trajectory
    begin = motion.position[0]
    points = np.array([begin, begin + LEG * np.eye(3)[0], begin + LEG * np.array([1, 1, 0])])
    corner = measure_corner(motion.t, motion.position, points, 1.2 * RADIUS)
    apex = 0.5 * RADIUS * np.sin(np.pi / 4)
    assert corner.apex == pytest.approx(apex, abs=1e-5)
    assert 0.85 * RADIUS < corner.entry < RADIUS
    assert 0.85 * RADIUS < corner.exit < RADIUS
    # The legs outside the zone, and the parabola 1 + asinh(1)/√2 radii long.
    length = RADIUS * (2 * 0.2 + 1 + np.arcsinh(1) / np.sqrt(2))
    assert corner.duration == pytest.approx(length / 0.1, rel=0.02)
    line = np.linspace(0, 1, 201)[:, None] * np.array([1.0, 0.0, 0.0])
    plain = measure_corner(np.linspace(0, 1, 201), line, line[[0, 100, 200]], 0.1)
    assert (plain.apex, plain.entry, plain.exit) == pytest.approx((0, 0, 0), abs=1e-12)
    with pytest.raises(InputError, match="away from the waypoint"):
        measure_corner(motion.t, motion.position, points + 1.0, RADIUS)
