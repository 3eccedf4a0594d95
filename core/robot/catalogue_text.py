"""Robots as catalogue files, to be read back as they were (`catalogue`)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..files.toml_text import key_text, value_text
from ..spatial.pose import IDENTITY, Pose, Vector3
from ..spatial.rotation import matrix_from_quaternion
from .inertia import Inertia
from .joint import Follower, Joint, JointKind
from .model import Robot
from .shape import Box, LinkShape, Sphere

_UNITS = {JointKind.REVOLUTE: "rad", JointKind.PRISMATIC: "m"}
_NEEDED = ("geometry", "range", "velocity", "acceleration", "effort", "inertia", "shape")
"""Groups of which a file says what they rest on."""
_UNSAID = "unknown: not stated"


def robot_text(robot: Robot) -> str:
    """An arm as the text of a catalogue file; where it stands, and external axes, are the cell's.

    Args:
        robot: the arm.

    Returns:
        TOML; every number is read back as it was to within rounding of its last digits.
    """
    head: dict[str, Any] = {"name": robot.name}
    head |= {} if robot.payload is None else {"payload_kg": robot.payload}
    head |= {"base_height_m": robot.base_height} if robot.base_height else {}
    head |= {"doubts": list(robot.doubts)} if robot.doubts else {}
    head |= {"order": list(robot.order)} if robot.order else {}
    if robot.arm_angle_reference is not None:
        head["arm_angle_reference"] = list(robot.arm_angle_reference)
    lines = list(_pairs(head))
    origins = {**dict.fromkeys(_stated(robot), _UNSAID), **robot.origins}
    lines += _table("[origin]", origins)
    if robot.spread:
        lines += _table("[spread]", dict(robot.spread))
    for joint in robot.joints:
        lines += _table("[[joint]]", _joint(joint))
        for follower in joint.followers:
            lines += _table("[[joint.follower]]", _follower(follower))
    for coupled in robot.coupled_ranges:
        names, factors = zip(*coupled.terms, strict=True)
        told: dict[str, Any] = {"joints": list(names), "factors": list(factors)}
        told |= {"lower_rad": coupled.lower, "upper_rad": coupled.upper, "reason": coupled.reason}
        lines += _table("[[coupled_range]]", told)
    if robot.flange != IDENTITY:
        lines += _table("[flange]", pose_entries(robot.flange))
    for body in robot.links:
        lines += _table("[[link]]", _link(body))
    for shape in robot.shapes:
        lines += _table("[[shape]]", _shape(shape))
    for pair in robot.may_touch:
        told = {"links": [pair.first, pair.second], "file": pair.file, "reason": pair.reason}
        lines += _table("[[may_touch]]", told)
    return "\n".join(lines) + "\n"


def pose_entries(pose: Pose) -> dict[str, Any]:
    """A pose by the keys of `pose_table`; what is zero is left out."""
    entries: dict[str, Any] = {}
    if any(pose.position):
        entries["xyz_m"] = list(pose.position)
    if pose.quaternion != IDENTITY.quaternion:
        entries["quat_wxyz"] = list(pose.quaternion)
    return entries


def _stated(robot: Robot) -> Iterator[str]:
    """Groups of numbers that a robot has."""
    yield from _NEEDED[:4]
    if any(joint.effort for joint in robot.joints):
        yield "effort"
    if robot.links:
        yield "inertia"
    if robot.shapes:
        yield "shape"
    if robot.arm_angle_reference is not None:
        yield "arm_angle"


def _table(heading: str, entries: Mapping[str, Any]) -> list[str]:
    return ["", heading, *_pairs(entries)]


def _pairs(entries: Mapping[str, Any]) -> Iterator[str]:
    for key, value in entries.items():
        yield f"{key_text(key)} = {value_text(value)}"


def _joint(joint: Joint) -> dict[str, Any]:
    unit = _UNITS[joint.kind]
    entries: dict[str, Any] = {"name": joint.name}
    if joint.kind is not JointKind.REVOLUTE:
        entries["kind"] = joint.kind.value
    entries |= pose_entries(joint.placement)
    if joint.held:
        return {**entries, "axis": list(joint.axis), "held": True}
    entries |= {
        "axis": list(joint.axis),
        f"lower_{unit}": joint.lower,
        f"upper_{unit}": joint.upper,
        f"velocity_{unit}_s": joint.velocity,
        f"acceleration_{unit}_s2": joint.acceleration,
    }
    return entries if joint.effort is None else {**entries, "effort_nm": joint.effort}


def _follower(follower: Follower) -> dict[str, Any]:
    turn = {"driver": follower.driver, "axis": list(follower.axis)}
    return turn | pose_entries(follower.placement)


def _link(body: Inertia) -> dict[str, Any]:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.tensor
    return {
        "mass_kg": body.mass,
        "centre_m": list(body.centre),
        "inertia_kgm2": [xx, yy, zz, xy, xz, yz],
    }


def _shape(placed: LinkShape) -> dict[str, Any]:
    solid = placed.shape
    entries: dict[str, Any] = {"link": placed.link, "kind": type(solid).__name__.lower()}
    if isinstance(solid, Box):
        return {**entries, "size_m": list(solid.size), **pose_entries(placed.placement)}
    entries["radius_m"] = solid.radius
    if isinstance(solid, Sphere):
        return {**entries, "centre_m": list(placed.placement.position)}
    start, end = (_along(placed.placement, side * 0.5 * solid.length) for side in (-1.0, 1.0))
    return {**entries, "from_m": list(start), "to_m": list(end)}


def _along(pose: Pose, distance: float) -> Vector3:
    """The point on a pose's z axis."""
    ahead = distance * matrix_from_quaternion(np.array(pose.quaternion))[:, 2]
    x, y, z = (float(v) for v in np.array(pose.position) + ahead)
    return x, y, z
