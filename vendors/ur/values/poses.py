"""URScript's poses: six numbers, the last three a rotation vector, and what is done with them.

Source: "The URScript Programming Language", module urmath.
"""

from __future__ import annotations

import math

from ....core.spatial.pose import Pose, Quaternion, Vector3
from .values import UrPose, Value, ValueFault, describe, numbers

_FULL_TURN = 2 * math.pi


def pose_of(value: Value, what: str) -> Pose:
    """The pose of six known numbers.

    Args:
        value: ``p[x, y, z, rx, ry, rz]``, or a list of six that is meant as one.
        what: for the message.

    Raises:
        ValueFault: it is something else.
    """
    found = numbers(value, 6)
    if found is None:
        raise ValueFault(f"{what} is a pose p[x, y, z, rx, ry, rz], not {describe(value)}")
    x, y, z, rx, ry, rz = found
    return Pose((x, y, z), quaternion_of(rx, ry, rz))


def value_of(pose: Pose) -> UrPose:
    """The six numbers of a pose; the rotation by half a turn at most."""
    return UrPose(*pose.position, *rotation_vector_of(pose.quaternion))


def quaternion_of(rx: float, ry: float, rz: float) -> Quaternion:
    """The unit quaternion, w >= 0, of a rotation vector in rad."""
    angle = math.sqrt(rx * rx + ry * ry + rz * rz)
    if not angle < math.inf:
        raise ValueFault("the rotation vector is too long for a number")
    half = 0.5 * math.fmod(angle, 2 * _FULL_TURN)
    scale = math.sin(half) / angle if angle > 0 else 0.5
    w = math.cos(half)
    if w < 0:
        w, scale = -w, -scale
    return w, scale * rx, scale * ry, scale * rz


def rotation_vector_of(quaternion: Quaternion) -> Vector3:
    """The rotation vector in rad, half a turn long at most, of a unit quaternion."""
    w, x, y, z = quaternion
    if w < 0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2 * math.atan2(sine, w) / sine if sine > 0 else 2.0
    return scale * x, scale * y, scale * z


def pose_trans(p_from: Value, p_from_to: Value) -> Value:
    """``p_from_to`` seen from the frame in which ``p_from`` is given."""
    return value_of(pose_of(p_from, "p_from") @ pose_of(p_from_to, "p_from_to"))


def pose_inv(p_from: Value) -> Value:
    """The inverse of a pose."""
    return value_of(pose_of(p_from, "p_from").inverse())


def pose_add(p_1: Value, p_2: Value) -> Value:
    """Positions added, rotations chained: P = P1 + P2, R = R1 R2."""
    one, two = pose_of(p_1, "p_1"), pose_of(p_2, "p_2")
    x, y, z = (a + b for a, b in zip(one.position, two.position, strict=True))
    return value_of(Pose((x, y, z), _chained(one.quaternion, two.quaternion)))


def pose_sub(p_to: Value, p_from: Value) -> Value:
    """Positions subtracted, rotations too: P = P1 − P2, R = R1 R2⁻¹."""
    one, two = pose_of(p_to, "p_to"), pose_of(p_from, "p_from")
    x, y, z = (a - b for a, b in zip(one.position, two.position, strict=True))
    back = two.inverse().quaternion
    return value_of(Pose((x, y, z), _chained(one.quaternion, back)))


def point_dist(p_from: Value, p_to: Value) -> Value:
    """Distance of two positions, m."""
    return math.dist(pose_of(p_from, "p_from").position, pose_of(p_to, "p_to").position)


def interpolate_pose(p_from: Value, p_to: Value, alpha: Value) -> Value:
    """Between two poses: the position on the line, the rotation on the shortest arc."""
    one, two = pose_of(p_from, "p_from"), pose_of(p_to, "p_to")
    if not isinstance(alpha, int | float):
        raise ValueFault(f"alpha is a number, not {describe(alpha)}")
    x, y, z = (a + alpha * (b - a) for a, b in zip(one.position, two.position, strict=True))
    way = (one.inverse() @ two).quaternion
    rx, ry, rz = (alpha * component for component in rotation_vector_of(way))
    turned = _chained(one.quaternion, quaternion_of(rx, ry, rz))
    return value_of(Pose((x, y, z), turned))


def rpy2rotvec(rpy: Value) -> Value:
    """Roll, pitch, yaw about the fixed x, y, z axes → rotation vector."""
    roll, pitch, yaw = _three(rpy, "roll, pitch and yaw")
    turn = (
        Pose(quaternion=quaternion_of(0.0, 0.0, yaw))
        @ Pose(quaternion=quaternion_of(0.0, pitch, 0.0))
        @ Pose(quaternion=quaternion_of(roll, 0.0, 0.0))
    )
    return rotation_vector_of(turn.quaternion)


def rotvec2rpy(rotation_vector: Value) -> Value:
    """The inverse of `rpy2rotvec`."""
    matrix = Pose(quaternion=quaternion_of(*_three(rotation_vector, "a rotation vector"))).matrix()
    pitch = math.atan2(-matrix[2, 0], math.hypot(matrix[0, 0], matrix[1, 0]))
    if math.hypot(matrix[0, 0], matrix[1, 0]) < 1e-9:  # roll and yaw turn about one axis
        return math.atan2(-matrix[1, 2], matrix[1, 1]), pitch, 0.0
    roll = math.atan2(matrix[2, 1], matrix[2, 2])
    return roll, pitch, math.atan2(matrix[1, 0], matrix[0, 0])


def _chained(one: Quaternion, two: Quaternion) -> Quaternion:
    return (Pose(quaternion=one) @ Pose(quaternion=two)).quaternion


def _three(value: Value, what: str) -> tuple[float, float, float]:
    found = numbers(value, 3)
    if found is None:
        raise ValueFault(f"{what} are a list of three numbers, not {describe(value)}")
    x, y, z = found
    return x, y, z
