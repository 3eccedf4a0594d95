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
    """The posture of a robot at a configuration (N,); None of an arm with six motors whose last
    three axes do not meet."""
    known = robot.recognised
    if known is None or known.family is Family.SCARA:
        return None
    arm, own = known.geometry, np.asarray(q, dtype=float)[:6]
    _, q2, q3, q4 = (float(value) for value in known.angles(own)[:4])
    # The plane that axes 2 and 3 are normal to, x real, z imaginary; a turn about y takes z to x.
    shoulder, elbow, wrist = (complex(x, z) for x, z in (arm.shoulder, arm.elbow, arm.wrist))
    lower = (elbow - shoulder) * cmath.exp(-1j * q2)
    turned = q2 + arm.signs[2] * q3
    fore = (wrist - elbow) * cmath.exp(-1j * turned)
    hand = 0j
    if known.family is Family.PARALLEL_AXES:
        if not robot.has_held:
            return None
        # A palletiser's axis 6 stands off the joint that keeps the flange level.
        x, _, z = -arm.centre_to_fourth
        hand = complex(x, z) * cmath.exp(-1j * (turned + arm.signs[3] * q4))
    front = math.copysign(1.0, wrist.real)
    up = math.copysign(1.0, arm.frame[2, 2])
    return Posture(
        shoulder=front * (shoulder + lower + fore + hand).real,
        elbow=-front * up * (lower.conjugate() * fore).imag / abs(lower),
        wrist=math.remainder(float(own[4]), math.tau),
    )
