"""Lines that pass a wrist's singularity so near that axes turn over between two samples."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

# Name, and a posture whose wrist is straight.
ARMS = [
    ("ur/ur5e", [0.3, -1.2, 1.5, -1.0, 0.0, 0.3]),
    ("abb/irb1200-5-090", [0.3, -0.4, 0.2, 0.5, 0.0, 0.3]),
    ("kuka/kr30-3", [0.3, -1.2, 1.5, 0.5, 0.0, 0.3]),
]


def line_past(name: str, straight: list[float], turn: float) -> tuple[Controller, Program]:
    """A line of 0.2 m in the middle of which the wrist is bent by ``turn`` rad, and turns through
    that at a right angle to it."""
    robot = find_robot(name)
    q = np.array(straight)
    q[4] = turn
    middle = robot.flange_pose(q)
    # An axis across the fifth and the sixth.
    J = robot.jacobian(q)[3:]
    across = np.cross(J[:, 4], J[:, 5])
    across = -across / np.linalg.norm(across)

    def at(share: float) -> Pose:
        matrix = middle.matrix()
        matrix[:3, :3] = matrix_from_rotation_vector(0.3 * share * across) @ matrix[:3, :3]
        matrix[:3, 3] += share * 0.1 * np.array([0.0, 0.0, 1.0])
        return Pose.from_matrix(matrix)

    starts = [found.q for found in robot.inverse(at(-1.0))]
    start = min(starts, key=lambda found: float(np.abs(found - q).max()))
    move = MoveL(PoseTarget(at(1.0)), Speed(tcp=1.0), FINE, FLANGE)
    vendor = find_vendor(name.split("/")[0])
    program = Program((move,), start=JointTarget(tuple(map(float, start))))
    return Controller(vendor, robot, MotionModel()), program


@pytest.mark.parametrize(("name", "straight"), ARMS)
@pytest.mark.parametrize("turn", [0.01, 0.002])
def test_the_tool_keeps_to_its_line_while_the_wrist_turns_over(name, straight, turn) -> None:
    controller, program = line_past(name, straight, turn)
    run = controller.run(program, period=0.001)
    found = run.trajectory
    turned = np.abs(np.diff(found.q[[0, -1]], axis=0)).max()
    assert turned > 2.0
    way = found.position[-1] - found.position[0]
    way /= np.linalg.norm(way)
    off = found.position - found.position[0]
    off -= np.outer(off @ way, way)
    assert np.linalg.norm(off, axis=1).max() < 5e-5
    assert (np.abs(found.dq) / controller.robot.limits.velocity).max() < 1.3


@pytest.mark.parametrize(("name", "straight"), ARMS)
def test_what_runs_into_the_singularity_is_refused(name, straight) -> None:
    controller, program = line_past(name, straight, 1e-6)
    with pytest.raises(MotionError, match=r"singular configuration of the wrist") as caught:
        controller.run(program)
    assert caught.value.move == 0


@pytest.mark.parametrize(("arm", "axis"), list(zip(ARMS, ("wrist_3", "J4", "A6"), strict=True)))
def test_what_the_finest_samples_do_not_show_is_refused(arm, axis) -> None:
    controller, program = line_past(*arm, 5e-5)
    with pytest.raises(MotionError, match=rf"{axis} would have to turn by .* too near") as caught:
        controller.run(program)
    assert caught.value.move == 0
