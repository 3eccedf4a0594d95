"""Which of its eight solutions an arm with a spherical wrist stands in, as signed distances.

The signs of three quantities tell the solutions apart; near zero their sizes tell how near two
of them are.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .kinematics.arm_geometry import Family
from .model import Robot


class Posture(NamedTuple):
    """Signed quantities that vanish where two solutions meet.

    Args:
        shoulder: m, how far the wrist's centre is in front of axis 1; "front" is the side on
            which it lies with all joints at zero.
        elbow: m, how far the wrist's centre is in front of the line through axes 2 and 3; with
            that line upright above the base, "front" is the same side as for the shoulder.
        wrist: rad in [-π, π], axis 5.
    """

    shoulder: float
    elbow: float
    wrist: float


def posture(robot: Robot, q: ArrayLike) -> Posture | None:
    """The posture of a robot at a configuration (N,); None if its arm has no spherical wrist."""
    known = robot.recognised
    if known is None or known.family is not Family.SPHERICAL_WRIST:
        return None
    arm = known.geometry
    angles = known.angles(np.asarray(q, dtype=float)[:6])
    _, q2, q3, _, q5 = (float(value) for value in angles[:5])
    # The plane that axes 2 and 3 are normal to, x real, z imaginary; a turn about y takes z to x.
    shoulder, elbow, wrist = (complex(x, z) for x, z in (arm.shoulder, arm.elbow, arm.wrist))
    lower = (elbow - shoulder) * cmath.exp(-1j * q2)
    fore = (wrist - elbow) * cmath.exp(-1j * (q2 + arm.signs[2] * q3))
    front = math.copysign(1.0, wrist.real)
    up = math.copysign(1.0, arm.frame[2, 2])
    return Posture(
        shoulder=front * (shoulder + lower + fore).real,
        elbow=-front * up * (lower.conjugate() * fore).imag / abs(lower),
        wrist=math.remainder(q5, math.tau),
    )
