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

from ..errors import InputError
from .kinematics.arm_geometry import Family
from .model import Robot

_UPRIGHT = 0.25
"""Share of its length up to which an arm leans to neither side."""


class Posture(NamedTuple):
    """Signed quantities that vanish where two solutions meet.

    Args:
        shoulder: m, how far the wrist's centre is in front of axis 1 (see `posture`).
        elbow: m, how far the wrist's centre is in front of the line through axes 2 and 3; with
            that line upright above the base, "front" is the same side as for the shoulder.
        wrist: rad in [-π, π], axis 5.
    """

    shoulder: float
    elbow: float
    wrist: float


def posture(robot: Robot, q: ArrayLike, front: ArrayLike | None = None) -> Posture | None:
    """The posture of a robot at a configuration (N,); None of an arm with six motors whose last
    three axes do not meet.

    Args:
        robot: the robot.
        q: (N,) rad and m.
        front: (3,), what points to the front with joint 1 at zero, in the robot's base; None for
            the side on which the wrist's centre lies with all joints at zero, or of an arm that
            stands upright there, within the ranges of its axes 2 and 3 on average.

    Raises:
        InputError: axis 2 turns the arm across ``front``.
    """
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
    if front is not None:
        ahead = _ahead(robot, arm.frame[0], front)
    elif abs(wrist.real) > _UPRIGHT * (abs(lower) + abs(fore)):
        ahead = math.copysign(1.0, wrist.real)
    else:
        lowest, highest = (known.angles(q[:6]) for q in (robot.limits.lower, robot.limits.upper))
        turns = (_mean_turn(lowest[k], highest[k]) for k in (1, 2))
        second, third = next(turns), next(turns)
        third = third if arm.signs[2] > 0 else third.conjugate()
        usual = shoulder + second * (elbow - shoulder + third * (wrist - elbow))
        ahead = math.copysign(1.0, usual.real)
    up = math.copysign(1.0, arm.frame[2, 2])
    return Posture(
        shoulder=ahead * (shoulder + lower + fore + hand).real,
        elbow=-ahead * up * (lower.conjugate() * fore).imag / abs(lower),
        wrist=math.remainder(float(own[4]), math.tau),
    )


def elbow_height(robot: Robot, q: ArrayLike) -> float | None:
    """m by which axis 3 is above the line from axis 2 to the wrist, at a configuration (N,), seen
    along these axes; None of an arm that is built otherwise."""
    known = robot.recognised
    if known is None or known.family is Family.SCARA:
        return None
    arm = known.geometry
    _, q2, q3 = (float(value) for value in known.angles(np.asarray(q, dtype=float)[:6])[:3])
    shoulder, elbow, wrist = (complex(x, z) for x, z in (arm.shoulder, arm.elbow, arm.wrist))
    lower = (elbow - shoulder) * cmath.exp(-1j * q2)
    line = lower + (wrist - elbow) * cmath.exp(-1j * (q2 + arm.signs[2] * q3))
    share = (lower * line.conjugate()).real / abs(line) ** 2 if line else 0.0
    return math.copysign(1.0, arm.frame[2, 2]) * (lower - share * line).imag


def _mean_turn(lower: float, upper: float) -> complex:
    """What turns by all angles between two come to on average."""
    if lower == upper:
        return cmath.exp(-1j * lower)
    return (cmath.exp(-1j * lower) - cmath.exp(-1j * upper)) / (1j * (upper - lower))


def _ahead(robot: Robot, forward: np.ndarray, front: ArrayLike) -> float:
    along = float(forward @ np.asarray(front, dtype=float))
    if abs(along) < 0.5:
        found = ", ".join(f"{value:+.2g}" for value in forward)
        raise InputError(
            f"{robot.name}: with joint 1 at zero axis 2 swings the arm along ({found}), not along "
            "the front that is stated: state which of the two directions is the front"
        )
    return math.copysign(1.0, along)
