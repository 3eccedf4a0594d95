"""Closed-form inverse kinematics of six-axis arms whose axes 2, 3 and 4 are parallel.

These are the arms of Universal Robots and their likes: axis 5 is normal to axis 4 and meets axis 6
at a right angle. Signs of axes and zero positions are free.
"""

from __future__ import annotations

import math

from ...arrays import FloatArray
from .arm_geometry import ArmGeometry
from .closed_form import (
    ALIGNED,
    X,
    Y,
    Z,
    about,
    outer_angle,
    row,
    solve_elbow,
    solve_shoulder,
    target_rotation,
    transposed,
    wrapped,
    wrist_target,
)
from .lean import inner, lean
from .vectors import Rotation, Vector, add, compose, cross, dot, load, rotation_about, turn


@lean
def solve_parallel_axes(
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
        for flip in range(2):
            fifth, sixth, sine = _solve_wrist(arm, turned, flip == 1)
            back = _step_to_fourth(arm, turned, fifth, sixth)
            if abs(sine) <= ALIGNED:
                sixth = _reaching_roll(arm, turned, x, centre[2], back)
                back = _step_to_fourth(arm, turned, fifth, sixth)
            # Angle about y that joints 2, 3 and 4 make together.
            pointing = about(row(arm.axes, 2), -sixth, about(row(arm.axes, 1), -fifth, X))
            pointing = turn(turned, pointing)
            total = math.atan2(-dot(Z, pointing), dot(X, pointing))
            fourth = add((x, arm.lateral, centre[2]), back)
            for elbow in range(2):
                second, third, bend, beyond = solve_elbow(arm, fourth[0], fourth[2], elbow == 1)
                n = 4 * shoulder + 2 * elbow + flip
                q[n, 0], q[n, 1], q[n, 2] = first, second, arm.signs[2] * third
                q[n, 3] = wrapped(arm.signs[3] * (total - second - third))
                q[n, 4], q[n, 5] = fifth, sixth
                measures[n, 0], measures[n, 1], measures[n, 2] = x, bend, sine
                measures[n, 3] = max(aside, beyond)


@inner
def _solve_wrist(arm: ArmGeometry, target: Rotation, flipped: bool) -> tuple[float, float, float]:
    """Angles of joints 5 and 6, and the sine between axes 4 and 6."""
    fifth, sixth = row(arm.axes, 1), row(arm.axes, 2)
    across = cross(fifth, Y)
    offset = math.atan2(dot(sixth, across), dot(sixth, Y))
    pointing = turn(target, sixth)
    sine = math.hypot(dot(pointing, X), dot(pointing, Z))
    aligned = sine < ALIGNED
    if flipped:
        sine = -sine
    bend = wrapped(math.atan2(sine, dot(pointing, Y)) - offset)
    if aligned:
        return bend, 0.0, sine
    end = about(fifth, -bend, Y)
    return bend, outer_angle(sixth, turn(transposed(target), Y), end), sine


@inner
def _step_to_fourth(arm: ArmGeometry, target: Rotation, fifth: float, sixth: float) -> Vector:
    """From the wrist's centre to axis 4, for a rotation that all joints but the first make."""
    back = about(row(arm.axes, 1), -fifth, load(arm.centre_to_fourth))
    step: Vector = turn(target, about(row(arm.axes, 2), -sixth, back))
    return step


@inner
def _reaching_roll(arm: ArmGeometry, target: Rotation, x: float, z: float, back: Vector) -> float:
    """Joint 6 for an aligned wrist, where it turns axis 4 about the centre: 0 if that reaches.

    Otherwise the angle that puts axis 4 in the middle of the distances from axis 2 that both the
    arm and the wrist allow.

    Args:
        arm: the arm's numbers.
        target: rotation that all joints but the first make.
        x, z: the wrist's centre in the arm's plane.
        back: step from it to axis 4 with joint 6 at 0.
    """
    x, z = x - arm.shoulder[0], z - arm.shoulder[1]
    upper = math.hypot(arm.elbow[0] - arm.shoulder[0], arm.elbow[1] - arm.shoulder[1])
    fore = math.hypot(arm.wrist[0] - arm.elbow[0], arm.wrist[1] - arm.elbow[1])
    centre, radius = math.hypot(x, z), math.hypot(back[0], back[2])
    shortest, longest = abs(upper - fore), upper + fore
    if shortest <= math.hypot(x + back[0], z + back[2]) <= longest or centre * radius == 0.0:
        return 0.0
    distance = 0.5 * (max(shortest, abs(centre - radius)) + min(longest, centre + radius))
    cosine = (distance**2 - centre**2 - radius**2) / (2.0 * centre * radius)
    wanted = math.atan2(x, z) + math.acos(min(1.0, max(-1.0, cosine)))
    # Angles count about +y; joint 6 takes the step back about its own axis, along or against y.
    sense = dot(turn(target, row(arm.axes, 2)), Y)
    angle = math.atan2(back[0], back[2]) - wanted
    roll: float = wrapped(angle * math.copysign(1.0, sense))
    return roll
