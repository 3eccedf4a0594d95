"""Paths on a part that a table turns are drawn in the part's frame."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from flyby.core.driving.driven_program import DrivenProgram
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool, WorkObject
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose
from flyby.drawing.geometry import part_geometry, path_geometry, turning_part
from flyby.drawing.run import make_figure

HOME = (0.0, 0.2, 0.2, 0.1, 1.0, 0.0)
TABLE = ExternalAxis(
    Joint("T", Pose((1.6, 0.0, 0.6)), (0.0, 0.0, 1.0), -6, 6, 2, 4), ExternalRole.TABLE
)
ROBOT = find_robot("abb/irb6640-180-255").with_external_axes([TABLE])
PART = WorkObject("part", user=Pose((0.1, 0.05, 0.3)), moved_by="T")
SPEED = Speed(tcp=0.2, reorientation=3.0, external_angular=0.5)


def run_with(turn: float) -> tuple[Run, np.ndarray]:
    """Two sides of a square on the part, while the table turns; and its corners (3, 3)."""
    (R,), (p,) = poses(work_chain(ROBOT, Tool(), PART), np.array([[*HOME, 0.0]]))
    matrix = np.eye(4)
    matrix[:3, :3] = R
    turned = Pose.from_matrix(matrix).quaternion
    corners = p + np.array([[0, 0, 0], [0.2, 0, 0], [0.2, 0.2, 0]])
    moves = tuple(
        MoveL(
            PoseTarget(Pose(tuple(map(float, at)), turned), external=(k * turn,)),
            SPEED,
            zone,
            work_object=PART,
        )
        for k, (at, zone) in enumerate(((corners[1], Radius(0.03)), (corners[2], FINE)), 1)
    )
    controller = Controller(find_vendor("abb"), ROBOT)
    return controller.run(Program(moves, start=JointTarget(HOME, (0.0,)))), corners


def test_a_line_on_a_turning_part_is_drawn_as_a_line() -> None:
    run, corners = run_with(0.4)
    assert turning_part([run]) == "part"
    geometry = part_geometry(run)
    np.testing.assert_allclose(geometry.waypoints, corners, atol=1e-8)
    for points, ends in zip(geometry.nominal, pairwise(corners), strict=True):
        np.testing.assert_allclose(points[[0, -1]], ends, atol=1e-8)
    # In the part's frame the path lies in the square's plane, and in the zone beside its sides.
    assert (
        np.abs(geometry.driven[:, 2] - corners[0, 2]).max() < 1e-4
    )  # joints are averaged over time
    off = np.minimum(
        abs(geometry.driven[:, 1] - corners[0, 1]), abs(geometry.driven[:, 0] - corners[1, 0])
    )
    assert off.max() < 0.03
    # In the world it does not: no programmed path can be drawn there.
    assert not path_geometry(run, ROBOT).nominal
    figure = make_figure(DrivenProgram.faultless(run), ROBOT)
    assert any(
        "of part" in axes.get_xlabel() for axes in figure.findobj() if hasattr(axes, "get_xlabel")
    )


def test_a_part_that_stands_still_is_drawn_in_the_world() -> None:
    run, _ = run_with(0.0)
    assert turning_part([run]) is None
    assert path_geometry(run, ROBOT).driven == pytest.approx(run.trajectory.position)
