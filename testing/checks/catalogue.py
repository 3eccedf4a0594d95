"""Checks of a vendor's robots: limits, kinematics, configuration labels."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ...core.arrays import FloatArray
from ...core.robot.model import Robot
from ..strategies import configurations, regular_configurations, robots
from .subject import EXAMPLES, Subject

POSE_TOLERANCE = 1e-7
"""m and dimensionless: how near a solution of the inverse must come to its pose."""
SAME_JOINTS = 1e-5
"""rad within which a configuration counts as found again."""


class CatalogueChecks(Subject):
    """Every robot loads, and kinematics, limits and labels are sound."""

    def test_the_robots_load_under_their_names(self) -> None:
        assert self.vendor.robots
        for name in self.vendor.robots:
            assert self.vendor.robot(name).name == f"{self.name}/{name}"

    def test_a_robot_is_loaded_once(self) -> None:
        for name in self.vendor.robots:
            assert self.vendor.robot(name) is self.vendor.robot(f"{self.name}/{name}")

    def test_limits_are_ordered(self) -> None:
        for name in self.vendor.robots:
            limits = self.vendor.robot(name).limits
            assert np.isfinite([limits.lower, limits.upper, limits.velocity]).all(), name
            assert (limits.lower < limits.upper).all(), name
            assert (limits.velocity > 0).all(), name
            assert (limits.acceleration > 0).all() and np.isfinite(limits.acceleration).all(), name
            assert (limits.effort > 0).all(), name

    def test_figures_state_their_origins(self) -> None:
        for name in self.vendor.robots:
            origins = self.vendor.robot(name).origins
            assert {"geometry", "range", "velocity", "acceleration"} <= set(origins), name

    @EXAMPLES
    @given(data=st.data())
    def test_forward_kinematics_are_rigid(self, data: st.DataObject) -> None:
        robot = data.draw(robots(self.vendor))
        q = data.draw(configurations(robot, margin=0.0))
        rotation, position = robot.forward(q)
        assert np.isfinite(position).all()
        assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(rotation) > 0

    @EXAMPLES
    @given(data=st.data())
    def test_the_inverse_leads_back(self, data: st.DataObject) -> None:
        robot = data.draw(robots(self.vendor))
        q = data.draw(regular_configurations(robot))
        solutions = inverse(robot, q)
        for solution in solutions:
            found = robot.forward(np.concatenate([solution, q[robot.arm_size :]]))
            for part, expected in zip(found, robot.forward(q), strict=True):
                assert np.allclose(part, expected, atol=POSE_TOLERANCE)
        if robot.recognised is not None:
            apart = [turned_apart(solution, q[: robot.arm_size]) for solution in solutions]
            assert min(apart) < SAME_JOINTS, "the configuration itself is not among the solutions"

    @EXAMPLES
    @given(data=st.data())
    def test_a_label_matches_itself(self, data: st.DataObject) -> None:
        robot = data.draw(robots(self.vendor))
        q = data.draw(configurations(robot))
        label = self.vendor.label(robot, q)
        if label is not None:
            assert label.mismatch(label) == 0

    @EXAMPLES
    @given(data=st.data())
    def test_a_label_names_one_solution(self, data: st.DataObject) -> None:
        robot = data.draw(robots(self.vendor))
        q = data.draw(regular_configurations(robot))
        label = self.vendor.label(robot, q)
        if label is None or label.hint or robot.recognised is None:
            return
        arm, external = q[: robot.arm_size], q[robot.arm_size :]
        # On the edge of a quadrant both sides fit, and so may two turns.
        inside = np.abs(np.sin(2.0 * arm)) > SAME_JOINTS
        for solution in inverse(robot, q):
            for turned in robot.turns(solution):
                other = self.vendor.label(robot, np.concatenate([turned, external]))
                assert other is not None
                if label.mismatch(other) == 0:
                    assert np.abs(turned - arm)[inside].max(initial=0.0) < SAME_JOINTS


def inverse(robot: Robot, q: FloatArray) -> list[FloatArray]:
    """All solutions (n,) for the flange's pose at ``q`` (N,)."""
    external = [float(value) for value in q[robot.arm_size :]]
    return [solution.q for solution in robot.inverse(robot.flange_pose(q), external)]


def turned_apart(first: FloatArray, second: FloatArray) -> float:
    """Largest angle between joint values, whole turns aside."""
    return float(np.abs(np.angle(np.exp(1j * (first - second)))).max())
