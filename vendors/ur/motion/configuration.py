"""Universal Robots' way to name an inverse-kinematics solution: joint values nearby."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError
from ....core.program.target import Configuration
from ....core.robot.model import Robot


@dataclass(frozen=True, slots=True)
class UrConfiguration:
    """The ``qnear`` of ``get_inverse_kin``: the solution nearest to it is taken.

    URScript numbers no solutions. A solution's own label is its joint values.

    Args:
        joints: of the arm, rad; joints turn through ±360°, so whole turns count.
    """

    joints: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.joints or not all(map(math.isfinite, self.joints)):
            raise InputError(f"qnear needs finite joint values, not {list(self.joints)}")

    def __str__(self) -> str:
        """The joint values in degrees."""
        return f"[{', '.join(f'{math.degrees(value):.2f}°' for value in self.joints)}]"

    @property
    def hint(self) -> bool:
        """True: the nearest solution is taken, however far."""
        return True

    def admits(self, label: Configuration) -> bool:
        """True: any will do."""
        return True

    def mismatch(self, label: Configuration) -> float:
        """Distance of the joint values, rad (Euclidean).

        Raises:
            InputError: the label is another vendor's, or has another number of joints.
        """
        if not isinstance(label, UrConfiguration):
            raise InputError(f"a configuration of Universal Robots cannot be compared with {label}")
        if len(label.joints) != len(self.joints):
            raise InputError(
                f"qnear has {len(self.joints)} joint values, but the arm has {len(label.joints)}"
            )
        return math.dist(self.joints, label.joints)


def label(robot: Robot, q: NDArray[np.float64]) -> UrConfiguration:
    """The label of joint values (N,) rad."""
    return UrConfiguration(tuple(float(value) for value in q[: robot.arm_size]))
