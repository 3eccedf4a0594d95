"""Closed-form inverse kinematics of six-axis arms whose last three axes meet in a point.

Signs of axes, zero positions, an elbow offset and a lateral offset are free. Position and
orientation part as in Pieper, "The kinematics of manipulators under computer control", 1968.
"""

from __future__ import annotations

import math

from ...arrays import FloatArray
from .arm_geometry import ArmGeometry
from .closed_form import (
    ALIGNED,
    Y,
    Z,
    about,
    outer_angle,
    row,
    solve_elbow,
    solve_shoulder,
    target_rotation,
    wrapped,
    wrist_target,
)
from .lean import inner, lean
from .vectors import Rotation, compose, cross, dot, rotation_about, turn


@lean
def solve_spherical_wrist(
    arm: ArmGeometry, R: FloatArray, p: FloatArray, q: FloatArray, measures: FloatArray
) -> None:
    """All solutions for flange poses in the base's frame, out of reach those nearest to them.

    Args:
        arm: the arm's numbers.
        R, p: (M, 3, 3), (M, 3) m, the flange's poses.
        q: (M, 8, 6) rad, written; row number = 4 shoulder + 2 elbow + wrist.
        measures: (M, 8, 4), written: x of the wrist's centre in the arm's plane (m), sine at the
            elbow, sine between axes 4 and 6, and the distance (m) by which it is out of reach.
    """
    for m in range(p.shape[0]):
        _solve(arm, R[m], p[m], q[m], measures[m])


@inner
def _solve(
    arm: ArmGeometry, R: FloatArray, p: FloatArray, q: FloatArray, measures: FloatArray
) -> None:
    centre = wrist_target(arm, R, p)
    rotation = target_rotation(arm, R)
    for shoulder in range(2):
        first, x, aside = solve_shoulder(arm.lateral, centre, shoulder == 1)
        turned = compose(rotation_about(Z, -first), rotation)
        for elbow in range(2):
            second, third, bend, beyond = solve_elbow(arm, x, centre[2], elbow == 1)
            wrist = compose(rotation_about(Y, -(second + third)), turned)
            n = 4 * shoulder + 2 * elbow
            sine = solve_wrist(arm, wrist, q[n], q[n + 1])
            missing = max(aside, beyond)
            for flip in range(2):
                q[n + flip, 0], q[n + flip, 1] = first, second
                q[n + flip, 2] = arm.signs[2] * third
                measures[n + flip, 0], measures[n + flip, 1] = x, bend
                measures[n + flip, 2] = -sine if flip == 1 else sine
                measures[n + flip, 3] = missing


@inner
def solve_wrist(
    arm: ArmGeometry, target: Rotation, plain: FloatArray, flipped: FloatArray
) -> float:
    """Write joints 4 to 6 of both ways to make a wrist rotation.

    Args:
        arm: the arm's numbers.
        target: rotation that the wrist makes.
        plain, flipped: (6,), written from 3 on.

    Returns:
        The sine between axes 4 and 6, not negative: that of the plain way.
    """
    fourth, fifth, sixth = row(arm.axes, 0), row(arm.axes, 1), row(arm.axes, 2)
    across = cross(fifth, fourth)
    offset = math.atan2(dot(sixth, across), dot(sixth, fourth))
    pointing = turn(target, sixth)
    a, b = dot(pointing, across), dot(pointing, cross(fourth, across))
    sine = math.hypot(a, b)
    roll = math.atan2(b, a) if sine > ALIGNED else 0.0
    bend = math.atan2(sine, dot(pointing, fourth))
    last = about(fifth, offset - bend, about(fourth, -roll, turn(target, fifth)))
    twist = outer_angle(sixth, fifth, last)
    plain[3], plain[4], plain[5] = roll, wrapped(bend - offset), twist
    # Half turns of axes 4 and 6 undo the mirrored bend.
    flipped[3], flipped[4] = wrapped(roll + math.pi), wrapped(-bend - offset)
    flipped[5] = wrapped(twist + math.pi)
    return sine
