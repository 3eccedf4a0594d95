"""Which of a robot's solutions stands like another robot.

Between two arms with spherical wrists the signs of `core.robot.posture` are compared: shoulder,
elbow and wrist. Between two arms of the other closed form the branches of inverse kinematics are.
Between one and the other only the elbow has a counterpart: whether it stands above or below the
line from shoulder to wrist.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from ..arrays import FloatArray
from ..errors import MotionError
from ..robot.inverse.solution import InverseSolution
from ..robot.kinematics.arm_geometry import Family
from ..robot.model import Robot
from ..robot.posture import posture

Signs = tuple[int, ...]
"""1 or -1 for each of the things that are compared, 0 where it is undecided."""

_EDGE = 1e-3
"""m or rad within which a posture is undecided."""


class Likeness:
    """Compares the stances of two robots."""

    def __init__(self, first: Robot, second: Robot) -> None:
        families = [_family(robot) for robot in (first, second)]
        self._comparable = None not in families
        self._common = families[0] if families[0] is families[1] else None

    def signs(self, robot: Robot, q: FloatArray) -> Signs:
        """How a robot stands at a configuration (N,)."""
        if not self._comparable:
            return ()
        if self._common is Family.SPHERICAL_WRIST:
            at = posture(robot, q)
            return () if at is None else tuple(map(_sign, at))
        if self._common is Family.PARALLEL_AXES:
            return _branch_signs(robot, q)
        return (_sign(_elbow_height(robot, q)),)


def differing(wanted: Signs, found: Signs) -> tuple[str, ...]:
    """In what two stances differ: of shoulder, elbow and wrist."""
    names = ("elbow",) if len(wanted) == 1 else ("shoulder", "elbow", "wrist")
    signs = zip(names, wanted, found, strict=False)
    return tuple(name for name, a, b in signs if a * b < 0)


def _family(robot: Robot) -> Family | None:
    known = robot.recognised
    return None if known is None or known.family is Family.SCARA else known.family


def _sign(value: float) -> int:
    return 0 if abs(value) < _EDGE else int(math.copysign(1, value))


def _branch_signs(robot: Robot, q: FloatArray) -> Signs:
    """The branch whose solution is the configuration, whole turns apart."""
    arm = robot.arm_size
    try:
        found = robot.inverse(robot.flange_pose(q), tuple(map(float, q[arm:])))
    except MotionError:
        return ()

    def apart(solution: InverseSolution) -> float:
        return float(np.abs(np.remainder(solution.q - q[:arm] + np.pi, 2 * np.pi) - np.pi).sum())

    branch = min(found, key=apart).branch
    if branch is None:
        return ()
    return tuple(1 if bit else -1 for bit in (branch.shoulder, branch.elbow, branch.wrist))


def _elbow_height(robot: Robot, q: FloatArray) -> float:
    """m by which axis 3 stands above the line from axis 2 to the wrist, upright from the base."""
    known = robot.recognised
    assert known is not None
    arm = known.geometry
    # The plane that axes 2 and 3 are normal to, x real, z imaginary; a turn about y takes z to x.
    shoulder, elbow, wrist = (complex(x, z) for x, z in (arm.shoulder, arm.elbow, arm.wrist))
    angles = known.angles(q[:6])
    lower = (elbow - shoulder) * cmath.exp(-1j * angles[1])
    reach = lower + (wrist - elbow) * cmath.exp(-1j * (angles[1] + arm.signs[2] * angles[2]))
    if abs(reach) < _EDGE:
        return 0.0
    along = (lower * reach.conjugate()).real / abs(reach) ** 2
    return math.copysign(1.0, arm.frame[2, 2]) * (lower - along * reach).imag
