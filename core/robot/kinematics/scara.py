"""Compiled closed-form inverse kinematics of SCARAs: two turns, a slide and a wrist about it.

Axes 1, 2 and 4 and the slide are parallel; axes 5 and 6, which have no motors, meet axis 4 in a
point. In the arm's frame z is along axis 1 and x leads to axis 2 at zero; `ArmGeometry` holds x and
y of axes 2 and 4 as ``elbow`` and ``wrist``, and z of the wrist's centre as ``lateral``.
"""

from __future__ import annotations

import math

import numpy as np

from ...arrays import FloatArray
from .arm_geometry import ArmGeometry
from .closed_form import Z, target_rotation, wrapped, wrist_target
from .lean import inner, lean
from .spherical_wrist import solve_wrist
from .vectors import compose, rotation_about


@lean
def solve_scara(
    arm: ArmGeometry, R: FloatArray, p: FloatArray, q: FloatArray, measures: FloatArray
) -> None:
    """All solutions for flange poses in the base's frame, out of reach those nearest to them.

    Args:
        arm: the arm's numbers.
        R, p: (M, 3, 3), (M, 3) m, the flange's poses.
        q: (M, 8, 6) rad, m at the slide, written; row number = 2 elbow + wrist, the others are
            none.
        measures: (M, 8, 4), written: 1, sine at the elbow, sine between axes 4 and 6, and the
            distance (m) by which the wrist's centre is out of reach.
    """
    for m in range(p.shape[0]):
        _solve(arm, R[m], p[m], q[m], measures[m])


@inner
def _solve(
    arm: ArmGeometry, R: FloatArray, p: FloatArray, q: FloatArray, measures: FloatArray
) -> None:
    x, y, z = wrist_target(arm, R, p)
    rotation = target_rotation(arm, R)
    upper = math.hypot(arm.elbow[0], arm.elbow[1])
    fore_x, fore_y = arm.wrist[0] - arm.elbow[0], arm.wrist[1] - arm.elbow[1]
    fore = math.hypot(fore_x, fore_y)
    reach = math.hypot(x, y)
    missing = max(0.0, reach - upper - fore, abs(upper - fore) - reach)
    cosine = (reach * reach - upper * upper - fore * fore) / (2.0 * upper * fore)
    area = (upper + fore - reach) * (upper + fore + reach)
    area *= (reach + fore - upper) * (reach + upper - fore)
    sine = math.sqrt(max(0.0, area)) / (2.0 * upper * fore)
    at_zero = math.atan2(fore_y, fore_x) - math.atan2(arm.elbow[1], arm.elbow[0])
    for elbow in range(2):
        side = -sine if elbow == 1 else sine
        bend = math.atan2(side, cosine)
        inner = math.atan2(fore * math.sin(bend), upper + fore * math.cos(bend))
        first = math.atan2(y, x) - inner - math.atan2(arm.elbow[1], arm.elbow[0])
        second = bend - at_zero
        turned = compose(rotation_about(Z, -(first + second)), rotation)
        n = 2 * elbow
        apart = solve_wrist(arm, turned, q[n], q[n + 1])
        for flip in range(2):
            q[n + flip, 0] = wrapped(first)
            q[n + flip, 1] = arm.signs[1] * wrapped(second)
            q[n + flip, 2] = arm.signs[2] * (z - arm.lateral)
            measures[n + flip, 0], measures[n + flip, 1] = 1.0, side
            measures[n + flip, 2] = -apart if flip == 1 else apart
            measures[n + flip, 3] = missing
    for n in range(4, 8):
        q[n, :] = 0.0
        measures[n, :] = np.inf
