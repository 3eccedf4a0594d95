"""RAPID's record types as the core's values, and back: the one place where their units change.

A record is a nested tuple of numbers, booleans and strings, in RAPID's own shape, order and
units (mm, degrees, kilograms): ``[[x,y,z],[q1,q2,q3,q4]]`` is ``((x, y, z), (q1, q2, q3, q4))``.
The reader turns records into values, the writer values into records, and `predefined` keeps the
controller's own data in the same form.

Shapes and units: "RAPID Reference Manual", data types pose, orient, loaddata, speeddata, tooldata,
wobjdata and zonedata.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ....core.errors import InputError
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import Load, Tool, WorkObject
from ....core.program.zone import FINE, Fine, Radius, Zone
from ....core.spatial.pose import IDENTITY, Pose, Quaternion, Vector3

Record = tuple[Any, ...]
"""Numbers, booleans, strings and further records."""

PER_METRE = 1000.0
"""mm in a metre. Division gives the double next to the decimal, which a product by 0.001 does not:
410 mm are 0.41 m."""
MM = 1 / PER_METRE

UNUSED_AXIS = 9e9
"""Value of an external axis that a target does not position (``9E9``)."""

ARM_AXES = 6
"""Of a robjoint."""
EXTERNAL_AXES = 6
"""Of an extjoint."""
SEVENTH = "seventh"
"""Kind of ``eax_a`` of an arm with seven axes: of a jointtarget its own seventh axis, of a
robtarget the arm angle."""
NO_AXIS = "none"
"""Kind of an ``eax`` that stands before an axis of the robot and is none of it."""
AXIS_KINDS = ("linear", "rotating", SEVENTH, NO_AXIS)
"""Of external axes: RAPID's own text does not say which one an axis is."""

VMAX: Record = (10000.0, 500.0, 5000.0, 1000.0)
"""``vmax``. Its v_tcp belongs to the robot; this stand-in is the one of rpiRobotics
abb_motion_program_exec, beyond the TCP speed of any robot in the catalogue."""

LOAD0: Record = (0.001, (0.0, 0.0, 0.001), (1.0, 0.0, 0.0, 0.0), 0.0, 0.0, 0.0)
"""``load0``: the least load that the controller accepts; the core says None."""


def arm_axes(kinds: Sequence[str]) -> int:
    """Axes of the arm, by the kinds of external axes."""
    return ARM_AXES + (tuple(kinds[:1]) == (SEVENTH,))


def extax_values(
    target: PoseTarget | JointTarget, kinds: Sequence[str]
) -> tuple[float | None, ...]:
    """What the extjoint of a target says, rad and m, eax_a first; None for ``9E9``.

    Args:
        kinds: of external axes, as for the reader.
    """
    if arm_axes(kinds) == ARM_AXES:
        return in_places(target.external, kinds)
    own = target.arm_angle if isinstance(target, PoseTarget) else target.joints[ARM_AXES:][0]
    used = own is not None or target.external
    return in_places((own, *target.external), kinds) if used else ()


def in_places(values: Sequence[float | None], kinds: Sequence[str]) -> tuple[float | None, ...]:
    """Values of a robot's axes where an extjoint has them; None at places that are no axis.

    Args:
        kinds: of external axes, as for the reader.
    """
    placed: list[float | None] = []
    for value in values:
        while tuple(kinds[len(placed) : len(placed) + 1]) == (NO_AXIS,):
            placed.append(None)
        placed.append(value)
    return tuple(placed)


def metres(point: Sequence[float]) -> Vector3:
    """A ``pos`` (mm) in m."""
    x, y, z = point
    return (x / PER_METRE, y / PER_METRE, z / PER_METRE)


def millimetres(point: Sequence[float]) -> Record:
    """A position in m as ``pos`` (mm)."""
    return tuple(v * PER_METRE for v in point)


def unit_quaternion(orient: Sequence[float]) -> Quaternion:
    """The quaternion w, x, y, z of an ``orient``, scaled to unit length if it needs to be.

    Programs carry five to seven digits. What is of unit length within 1e-6 stays as it stands, so
    that a program that is read and written keeps its digits.

    Raises:
        InputError: the length is off by more than 1 %: that is a typing error, no rounding.
    """
    w, x, y, z = orient
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    if not abs(norm - 1.0) <= 0.01:
        raise InputError(
            f"a quaternion has length 1, but [{w:g},{x:g},{y:g},{z:g}] has {norm:.4g}; correct it"
        )
    if abs(norm - 1.0) <= 1e-6:
        return (w, x, y, z)
    return (w / norm, x / norm, y / norm, z / norm)


def pose_value(record: Record) -> Pose:
    """``[trans, rot]``."""
    trans, rot = record
    return Pose(metres(trans), unit_quaternion(rot))


def pose_record(pose: Pose) -> Record:
    """``[trans, rot]``."""
    return (millimetres(pose.position), pose.quaternion)


def speed_value(record: Record, name: str | None = None) -> Speed:
    """``[v_tcp, v_ori, v_leax, v_reax]`` in mm/s, deg/s, mm/s, deg/s."""
    tcp, reorientation, linear, angular = record
    return Speed(
        tcp=tcp / PER_METRE,
        reorientation=math.radians(reorientation),
        external_linear=linear / PER_METRE,
        external_angular=math.radians(angular),
        name=name,
    )


def check_speed(record: Record, tcp: float | None, duration: float | None) -> None:
    """Refuse speeds that no controller takes, in RAPID's words and units.

    Args:
        record: ``[v_tcp, v_ori, v_leax, v_reax]``.
        tcp: ``\\V`` in mm/s, None if absent.
        duration: ``\\T`` in s, None if absent.

    Raises:
        InputError: naming the component and its value.
    """
    v_tcp, v_ori, v_leax, v_reax = record
    speeds = [("v_tcp", v_tcp, "mm/s") if tcp is None else ("\\V", tcp, "mm/s")]
    speeds.append(("v_ori", v_ori, "deg/s"))
    # Zero speeds of external axes are common where there are none.
    speeds += [("v_leax", v_leax, "mm/s")] if v_leax != 0 else []
    speeds += [("v_reax", v_reax, "deg/s")] if v_reax != 0 else []
    speeds += [("\\T", duration, "s")] if duration is not None else []
    for name, value, unit in speeds:
        if not (math.isfinite(value) and value > 0):
            raise InputError(f"{name} must be above zero, not {value:g} {unit}")


_OF_ZONES = ("pzone_tcp", "pzone_ori", "pzone_eax", "zone_ori", "zone_leax", "zone_reax")


def zone_value(record: Record, name: str | None = None) -> Zone:
    """``[finep, pzone_tcp, pzone_ori, pzone_eax, zone_ori, zone_leax, zone_reax]``.

    The numbers are mm, mm, mm, deg, mm, deg; they mean nothing if ``finep`` is TRUE.
    """
    finep, tcp, reorientation, external, angle, linear, angular = record
    if finep:
        return FINE
    for component, number in zip(_OF_ZONES, record[1:], strict=True):
        if number < 0:
            raise InputError(f"{component} must be zero or more, not {number:g}")
    return Radius(
        tcp=tcp / PER_METRE,
        reorientation=reorientation / PER_METRE,
        external=external / PER_METRE,
        angle=math.radians(angle),
        external_linear=linear / PER_METRE,
        external_angular=math.radians(angular),
        name=name,
    )


def speed_record(speed: Speed) -> Record:
    """As `speed_value` takes it; what is left to the robot gets a predefined value.

    Those of ``vmax`` are beyond what robots reach.
    """
    limits = (speed.tcp, speed.reorientation, speed.external_linear, speed.external_angular)
    units = (1 / MM, math.degrees(1), 1 / MM, math.degrees(1))
    return tuple(
        free if limit is None else limit * unit
        for limit, unit, free in zip(limits, units, VMAX, strict=True)
    )


def zone_record(zone: Fine | Radius) -> Record:
    """As `zone_value` takes it; the zones beside the TCP's are made at least as large as that.

    The controller does the same (zonedata, pzone_ori and pzone_eax).
    """
    if isinstance(zone, Fine):
        return (True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return (
        False,
        zone.tcp / MM,
        max(zone.tcp, zone.reorientation) / MM,
        max(zone.tcp, zone.external) / MM,
        math.degrees(zone.angle),
        zone.external_linear / MM,
        math.degrees(zone.external_angular),
    )


def load_value(record: Record, name: str | None = None) -> Load | None:
    """``[mass, cog, aom, ix, iy, iz]`` in kg, mm, kg m²; None for ``load0``, carrying nothing."""
    if record == LOAD0:
        return None
    mass, cog, aom, ix, iy, iz = record
    return Load(mass, metres(cog), (ix, iy, iz), unit_quaternion(aom), name)


def load_record(load: Load | None) -> Record:
    """As `load_value` takes it."""
    if load is None:
        return LOAD0
    return (load.mass, millimetres(load.centre), load.axes, *load.inertia)


def tool_value(record: Record, name: str) -> Tool:
    """``[robhold, tframe, tload]``."""
    robhold, tframe, tload = record
    return Tool(name, pose_value(tframe), load_value(tload), robhold)


def tool_record(tool: Tool) -> Record:
    """As `tool_value` takes it."""
    return (tool.robot_held, pose_record(tool.tcp), load_record(tool.load))


def work_object_value(record: Record, name: str) -> WorkObject:
    """``[robhold, ufprog, ufmec, uframe, oframe]``.

    ``ufmec`` names the unit that moves the user frame; it counts only where ``ufprog`` is FALSE.
    """
    robhold, ufprog, ufmec, uframe, oframe = record
    moved_by = None if ufprog else ufmec
    return WorkObject(name, pose_value(uframe), pose_value(oframe), robhold, moved_by)


def carried(work_object: WorkObject) -> WorkObject:
    """A work object as the controller takes it: it keeps the user frame of one that a unit moves,
    by the system's parameters, whatever its data say (wobjdata, ``uframe``)."""
    return work_object if work_object.moved_by is None else replace(work_object, user=IDENTITY)


def standing(work_object: WorkObject) -> WorkObject:
    """A work object that a unit moves which the robot has not, as it is declared."""
    return replace(work_object, moved_by=None, not_followed=work_object.moved_by)


def work_object_record(work_object: WorkObject) -> Record:
    """As `work_object_value` takes it."""
    moved_by = work_object.moved_by or work_object.not_followed
    user, frame = work_object.user, work_object.frame
    if work_object.moved_by is not None:  # whose user frame would not count
        user, frame = IDENTITY, frame if user == IDENTITY else work_object.pose
    frames = (pose_record(user), pose_record(frame))
    return (work_object.robot_held, moved_by is None, moved_by or "", *frames)
