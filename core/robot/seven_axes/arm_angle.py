"""The arm angle: by how much an arm of seven axes is turned about the line from shoulder to wrist.

With s from the shoulder to the wrist, e the direction of the fourth axis and r a reference
direction, ψ = atan2(−r·ŝ×(ŝ×e), r·(ŝ×e)). The shoulder is where axis 1 is nearest to axis 2, the
wrist where axis 7 is nearest to axis 6 (A. J. Elias and J. T. Wen, "Redundancy parameterization of
the ABB YuMi robot arm", arXiv 2505.23111, 2025).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...spatial.pose import Pose, Vector3
from ..joint import Joint
from ..kinematics.chain import Chain
from ..kinematics.chain_kernels import jacobian
from ..kinematics.linear import solve_in_place
from ..kinematics.tracking import LONGEST_STEP, pose_error

AXES = 7
FOURTH = 3
"""Of the axes from base to flange."""
TOLERANCE = 1e-11
"""m and rad of error at which Newton's method has converged."""
ITERATIONS = 40
SMALLEST_PIVOT = 1e-9
_PARALLEL = 1e-9


class ArmAngle(NamedTuple):
    """What the arm angle is measured by.

    Args:
        shoulder: (3,) m, in the base's frame.
        wrist: (3,) m, in the flange's frame.
        reference: (3,) of unit length, in the base's frame.
        fourth: index of the fourth axis among the arm's joints.
        before: (7,), which joints stand before it.
    """

    shoulder: FloatArray
    wrist: FloatArray
    reference: FloatArray
    fourth: int
    before: NDArray[np.bool_]


def arm_angle_of(
    joints: Sequence[Joint], along: Sequence[int], flange: Pose, reference: Vector3
) -> ArmAngle:
    """The arm angle of an arm.

    Args:
        joints: seven that turn, each placement in the frame behind the joint before along the arm.
        along: their indices from base to flange.
        flange: in the frame behind the last joint.
        reference: direction, in the base's frame.
    """
    frame, points, axes = np.eye(4), [], []
    for index in along:
        frame = frame @ joints[index].placement.matrix()
        points.append(frame[:3, 3])
        axes.append(frame[:3, :3] @ np.array(joints[index].axis))
    tip = np.linalg.inv(frame @ flange.matrix())
    shoulder = _foot(points[0], axes[0], points[1], axes[1])
    wrist = tip[:3, :3] @ _foot(points[-1], axes[-1], points[-2], axes[-2]) + tip[:3, 3]
    direction = np.array(reference) / math.hypot(*reference)
    before = np.isin(np.arange(AXES), along[:FOURTH])
    return ArmAngle(shoulder, wrist, direction, along[FOURTH], before)


def _foot(point: FloatArray, axis: FloatArray, other: FloatArray, its: FloatArray) -> FloatArray:
    """The point (3,) of an axis that is nearest to another axis."""
    axis, its = axis / np.linalg.norm(axis), its / np.linalg.norm(its)
    between, cosine = other - point, float(axis @ its)
    sine = 1.0 - cosine * cosine
    way = between @ axis if sine < _PARALLEL else (between @ axis - cosine * (between @ its)) / sine
    return np.asarray(point + way * axis)


@njit(cache=True, error_model="numpy")
def measure(
    angle: ArmAngle, R: FloatArray, p: FloatArray, J: FloatArray, slope: FloatArray
) -> float:
    """The arm angle, rad in [-π, π], of a flange pose and its Jacobian.

    Args:
        R, p, J: (3, 3), (3,) m, (6, n) of the flange in the base's frame.
        slope: (n,), written: its derivative, per rad; (0,) if it is not asked for.
    """
    at, way = np.empty(3), np.empty(3)
    for i in range(3):
        way[i] = 0.0
        for j in range(3):
            way[i] += R[i, j] * angle.wrist[j]
        at[i] = p[i] + way[i] - angle.shoulder[i]
    length = math.sqrt(at[0] ** 2 + at[1] ** 2 + at[2] ** 2)
    s, e, r = at / length, J[3:6, angle.fourth].copy(), angle.reference
    across = np.cross(s, e)
    a = r[0] * across[0] + r[1] * across[1] + r[2] * across[2]
    rs = r[0] * s[0] + r[1] * s[1] + r[2] * s[2]
    se = s[0] * e[0] + s[1] * e[1] + s[2] * e[2]
    b = r[0] * e[0] + r[1] * e[1] + r[2] * e[2] - rs * se
    size = max(a * a + b * b, 1e-300)
    for joint in range(slope.size):
        turn = J[3:6, joint].copy()
        moved = (J[0:3, joint] + np.cross(turn, way)) / length
        ds = moved - s * (s[0] * moved[0] + s[1] * moved[1] + s[2] * moved[2])
        de = np.cross(turn, e) if angle.before[joint] else np.zeros(3)
        change = np.cross(ds, e) + np.cross(s, de)
        da = r[0] * change[0] + r[1] * change[1] + r[2] * change[2]
        rds = r[0] * ds[0] + r[1] * ds[1] + r[2] * ds[2]
        dse = 0.0
        db = -rds * se
        for i in range(3):
            dse += ds[i] * e[i] + s[i] * de[i]
            db += r[i] * de[i]
        slope[joint] = (a * (db - rs * dse) - b * da) / size
    return math.atan2(b, a)


def arm_angle_at(chain: Chain, angle: ArmAngle, q: FloatArray, slope: FloatArray) -> float:
    """The arm angle, rad, of a configuration.

    Args:
        chain: from the base to the flange, over the n joints.
        angle: what it is measured by.
        q: (n,).
        slope: as in `measure`.
    """
    R, p, J = np.empty((3, 3)), np.empty(3), np.empty((6, q.size))
    jacobian(chain, np.ascontiguousarray(q), R, p, J)
    return float(measure(angle, R, p, J, slope))


@njit(cache=True, error_model="numpy")
def wrapped(angle: float) -> float:
    """An angle, rad, in [-π, π]."""
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


@njit(cache=True, error_model="numpy")
def settle(
    chain: Chain, angle: ArmAngle, R: FloatArray, p: FloatArray, wanted: float, q: FloatArray
) -> bool:
    """Move q (7,) to the flange pose R, p with the arm angle ``wanted`` (rad), by Newton's method.

    Returns:
        Whether it got there.
    """
    here_R, here_p, J = np.empty((3, 3)), np.empty(3), np.empty((6, AXES))
    slope, error, A, step = np.empty(AXES), np.empty(6), np.empty((AXES, AXES)), np.empty(AXES)
    for _ in range(ITERATIONS):
        jacobian(chain, q, here_R, here_p, J)
        size = pose_error(R, p, here_R, here_p, error)
        left = wrapped(wanted - measure(angle, here_R, here_p, J, slope))
        if size < TOLERANCE and abs(left) < TOLERANCE:
            return True
        A[:6], A[6], step[:6], step[6] = J, slope, error, left
        if not solve_in_place(A, step) > SMALLEST_PIVOT:
            return False
        longest = np.abs(step).max()
        q += step * (LONGEST_STEP / longest if longest > LONGEST_STEP else 1.0)
    return False
