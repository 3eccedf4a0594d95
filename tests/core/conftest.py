"""Three arms in comfortable postures, and targets near them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

HOMES = {
    "abb/irb6640-180-255": ([0.1, 0.2, 0.3, 0.2, 0.9, 0.1], 0.25),
    "ur/ur10e": ([0.2, -1.4, -1.8, -1.4, 1.5, 0.3], 0.15),
    "kuka/kr3-r540": ([0.1, -1.3, 1.4, 0.2, 1.0, 0.1], 0.06),
}


@dataclass(frozen=True, eq=False)
class ArmAtHome:
    """An arm, where it starts, and the length in m that its tests use for a leg."""

    robot: Robot
    home: np.ndarray
    leg: float

    def _repr_pretty_(self, printer, cycle) -> None:
        printer.text(self.robot.name)  # short in Hypothesis' reports

    def controller(self, model: MotionModel | None = None, robot: Robot | None = None):
        """Its vendor's controller with a model that no fit changes."""
        vendor = find_vendor(self.robot.name.split("/")[0])
        return Controller(vendor, robot or self.robot, model or MotionModel())

    @property
    def start(self) -> JointTarget:
        return self.joints(np.zeros(len(self.home)))

    def pose(self, offset=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0)) -> Pose:
        """The flange at home, moved by ``offset`` legs and turned by ``turn`` rad (world)."""
        matrix = self.robot.flange_pose(self.home).matrix()
        matrix[:3, :3] = matrix_from_rotation_vector(np.array(turn, dtype=float)) @ matrix[:3, :3]
        matrix[:3, 3] += self.leg * np.array(offset, dtype=float)
        return Pose.from_matrix(matrix)

    def target(self, offset=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0)) -> PoseTarget:
        return PoseTarget(self.pose(offset, turn))

    def joints(self, change) -> JointTarget:
        """Home with joint values changed."""
        return JointTarget(tuple(map(float, self.home + np.asarray(change, dtype=float))))


def arm_at_home(name: str) -> ArmAtHome:
    home, leg = HOMES[name]
    return ArmAtHome(find_robot(name), np.array(home), leg)


@pytest.fixture(params=sorted(HOMES), scope="session")
def arm(request) -> ArmAtHome:
    """Each arm in turn."""
    return arm_at_home(request.param)


@pytest.fixture(scope="session")
def abb() -> ArmAtHome:
    """The large arm alone."""
    return arm_at_home("abb/irb6640-180-255")


@pytest.fixture(scope="session")
def ur() -> ArmAtHome:
    """The arm without a spherical wrist alone."""
    return arm_at_home("ur/ur10e")
