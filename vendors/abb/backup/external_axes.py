"""Tracks, tables and the like: the mechanical units of MOC.cfg beside the arms.

A unit has a SINGLE, which has a JOINT; ARM, ACC_DATA, TRANSMISSION and STRESS_DUTY_CYCLE of the
axis carry the joint's name, or one that the joint uses. A track moves along x of its base frame,
a rotating axis turns about z ("Technical reference manual, System parameters", topic Motion, types
Single and Single Type).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from ....core.cell.positioner import positioner
from ....core.errors import InputError
from ....core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from ....core.robot.model import Robot
from ....core.robot.seven_axes.arm_angle import AXES
from ....core.spatial.pose import IDENTITY, Pose, Vector3
from ..values.records import EXTERNAL_AXES, unit_quaternion
from .cfg import Parameters, Record

X: Vector3 = (1.0, 0.0, 0.0)
Z: Vector3 = (0.0, 0.0, 1.0)

_FIRST_AXIS = 7
"""Logical axis that robtargets call eax_a."""
_LINEAR = ("track", "ex_lin", "free_lin", "lin")
_CONVEYOR = "cnv"
_ASSUMED = {
    JointKind.PRISMATIC: (-10.0, 10.0, 1.0, 2.0),
    JointKind.REVOLUTE: (-2 * math.pi, 2 * math.pi, math.pi / 2, math.pi),
}
"""Range, speed and acceleration of an axis of which the file states none."""


@dataclass(frozen=True)
class Unit:
    """A mechanical unit beside the arms.

    Args:
        name: as work objects and programs call it.
        axis: None if it cannot be made; then ``lacks`` says why.
        number: of the axis in robtargets, 0 for eax_a.
        single: the record of its axis.
        lacks: what its file does not state.
    """

    name: str
    axis: ExternalAxis | None
    number: int
    single: Record
    lacks: tuple[str, ...] = ()


def units_of(moc: Parameters, carrying: Collection[str]) -> list[Unit]:
    """The units of one axis each, in the file's order.

    Args:
        moc: MOC.cfg.
        carrying: names of units or singles, in lower case, that an arm stands on.
    """
    singles = [pair for pair in _singles(moc) if not pair[0].casefold().startswith(_CONVEYOR)]
    called: dict[str, str] = {}
    for name, single in singles:
        called |= {single.name.casefold(): name, name.casefold(): name}
    below = {
        one: on.casefold()
        for name, single in singles
        if (on := _below(single))
        for one in (name.casefold(), single.name.casefold())
    }
    tracks = set(carrying)
    while more := {below[one] for one in tracks if one in below} - tracks:
        tracks |= more
    return [_unit(moc, name, single, tracks, called) for name, single in singles]


def _below(single: Record) -> str:
    """The unit or single that one stands on; ``""`` for the floor."""
    return single.text("base_frame_coordinated") or ""


def conveyors(moc: Parameters) -> list[str]:
    """Units that move by themselves, and that the controller only follows."""
    return [name for name, _ in _singles(moc) if name.casefold().startswith(_CONVEYOR)]


def _singles(moc: Parameters) -> list[tuple[str, Record]]:
    """Singles with the names of their units; the last one of a unit is called as the unit."""
    found: dict[str, tuple[str, Record]] = {}
    for unit in moc.section("MECHANICAL_UNIT"):
        used = [moc.named("SINGLE", name) for name in unit.numbered("use_single_")]
        singles = [single for single in used if single is not None]
        for single in singles:
            name = unit.name if single is singles[-1] else single.name
            found.setdefault(single.name, (name or single.name, single))
    for single in moc.section("SINGLE"):
        found.setdefault(single.name, (single.name, single))
    return list(found.values())


def _unit(
    moc: Parameters,
    name: str,
    single: Record,
    carrying: Collection[str],
    called: Mapping[str, str],
) -> Unit:
    joint = moc.named("JOINT", single.text("use_joint"), single.name)
    try:
        number = -1 if joint is None else int(joint.number("logical_axis") or 0) - _FIRST_AXIS
        if joint is None or not 0 <= number < EXTERNAL_AXES:
            lack = f"the axis of unit {name} is not known (MOC.cfg JOINT): it is left out"
            return Unit(name, None, number, single, (lack,))
        carries = {name.casefold(), single.name.casefold()} & set(carrying)
        unit = _axis(moc, name, single, joint, number, bool(carries))
        on = _below(single)
        if unit.axis is None or not on:
            return unit
        if called.get(on.casefold(), name) == name:
            lack = f"unit {name} stands on {on}, which is not known: it is taken to stand still"
            return replace(unit, lacks=(*unit.lacks, lack))
        return replace(unit, axis=replace(unit.axis, carried_by=called[on.casefold()]))
    except InputError as error:
        return Unit(name, None, -1, single, (f"unit {name} is left out: {error}",))


def _axis(
    moc: Parameters, name: str, single: Record, joint: Record, number: int, carries: bool
) -> Unit:
    names = [joint.name, *(v for k, v in joint.values.items() if k.startswith("use_"))]
    arm, gear, top, acceleration = (
        moc.named(section, *names)
        for section in ("ARM", "TRANSMISSION", "STRESS_DUTY_CYCLE", "ACC_DATA")
    )
    single_type = moc.named("SINGLE_TYPE", single.text("use_single_type"))
    mechanics = (single_type.text("mechanics") if single_type is not None else None) or ""
    linear = carries if gear is None else not gear.flag("rotating_move")
    if mechanics:
        linear = mechanics.lower() in _LINEAR
    kind = JointKind.PRISMATIC if linear else JointKind.REVOLUTE
    lower, upper, speed, most = _ASSUMED[kind]
    missing = []
    bounds = [arm.number(f"{end}_joint_bound") if arm else None for end in ("lower", "upper")]
    if bounds[0] is None and bounds[1] is None:
        missing.append("range")
    else:
        lower, upper = (0.0 if bound is None else bound for bound in bounds)
    ratio = gear.number("transm_joint") if gear else None
    motor = top.number("speed_absolute_max") if top else None
    if ratio and motor:
        speed = abs(motor / ratio)
    else:
        missing.append("speed")
    nominal = [acceleration.number(key) if acceleration else None for key in ("wc_acc", "wc_dec")]
    stated = [abs(one) for one in nominal if one]
    if stated:
        most = min(stated)
    else:
        missing.append("acceleration")
    axis = ExternalAxis(
        Joint(name, base_frame(single), X if linear else Z, lower, upper, speed, most, kind=kind),
        ExternalRole.TRACK if carries else ExternalRole.TABLE,
    )
    lacks = _assumed(axis.joint, missing)
    if mechanics.lower() == "track" and not carries:
        lacks = (*lacks, f"no arm is said to stand on the track {name} (base_frame_coordinated)")
    return Unit(name, axis, number, single, lacks)


def _assumed(joint: Joint, missing: list[str]) -> tuple[str, ...]:
    if not missing:
        return ()
    unit = "m" if joint.kind is JointKind.PRISMATIC else "°"
    scale = 1.0 if joint.kind is JointKind.PRISMATIC else 180 / math.pi
    figures = {
        "range": f"{joint.lower * scale:g} to {joint.upper * scale:g} {unit}",
        "speed": f"{joint.velocity * scale:g} {unit}/s",
        "acceleration": f"{joint.acceleration * scale:g} {unit}/s²",
    }
    said = ", ".join(f"{name} {figures[name]}" for name in missing)
    return (f"MOC.cfg does not state of unit {joint.name}: {said} assumed",)


def base_frame(record: Record) -> Pose:
    """Where a ROBOT or SINGLE stands: ``base_frame_pos_x…``, ``base_frame_orient_u0…``.

    Raises:
        InputError: a number is none, or the quaternion is not of unit length.
    """
    x, y, z = (record.number(f"base_frame_pos_{axis}") or 0.0 for axis in "xyz")
    parts = [record.number(f"base_frame_orient_u{k}") for k in range(4)]
    if all(part is None for part in parts):
        return Pose((x, y, z))
    # Defaults are left out: of the identity's, u0 is 1.
    u0 = parts[0] if parts[0] is not None else _rest([part or 0.0 for part in parts[1:]])
    try:
        turn = unit_quaternion((u0, *(part or 0.0 for part in parts[1:])))
    except InputError as error:
        raise InputError(f"{record.file}:{record.line}: {record.place}: {error}") from None
    return Pose((x, y, z), turn) if turn != IDENTITY.quaternion else Pose((x, y, z))


def _rest(others: list[float]) -> float:
    """u0 where it is left out: its default is 1, of a half turn it is 0."""
    length = math.sqrt(sum(part * part for part in others))
    return 1.0 if length < 1e-9 else math.sqrt(max(0.0, 1.0 - length * length))


def units_named(units: Iterable[Unit], members: Iterable[str]) -> list[Unit]:
    """Those of these names, or whose singles have them."""
    names = {name.casefold() for name in members}
    return [unit for unit in units if {unit.name.casefold(), unit.single.name.casefold()} & names]


def with_units(robot: Robot, units: Sequence[Unit]) -> tuple[Robot, list[str]]:
    """The robot with its external axes in the order of robtargets."""
    lacks = [lack for unit in units for lack in unit.lacks]
    made = sorted((unit for unit in units if unit.axis is not None), key=lambda unit: unit.number)
    axes: list[ExternalAxis] = []
    behind = int(robot.arm_size == AXES)  # whose eax_a is the arm's own
    for unit in made:
        if unit.number < behind:
            lacks.append(
                f"unit {unit.name} is eax_{'abcdef'[unit.number]} of robtargets, and so is another "
                "one: it is left out"
            )
            continue
        assert unit.axis is not None
        skips = unit.number > behind  # of places that are no axis of this robot
        axes.append(replace(unit.axis, number=unit.number + 1) if skips else unit.axis)
        behind = unit.number + 1
    names = {axis.name for axis in axes}
    for place, axis in enumerate(axes):
        if axis.carried_by is not None and axis.carried_by not in names:
            lacks.append(f"unit {axis.name} stands on {axis.carried_by}, which is taken to stand")
            axes[place] = replace(axis, carried_by=None)
    if not axes:
        return robot, lacks
    singles = [unit.single for unit in made if unit.name in names]
    assumed = "; ".join(lack for unit in made for lack in unit.lacks)
    origin = f"{origin_of(singles)}{assumed and f'; {assumed}'}"
    origins = {**robot.origins, "external axes": origin}
    try:
        return replace(robot, external_axes=tuple(axes), origins=origins), lacks
    except InputError as error:
        return robot, [*lacks, f"external axes are left out: {error}"]


def positioner_of(units: Sequence[Unit]) -> tuple[Robot, tuple[str, ...]]:
    """Units that a task of their own turns, and what is not known of them."""
    robot, lacks = with_units(positioner("abb", ()), units)
    return robot, tuple(lacks)


def origin_of(records: Sequence[Record]) -> str:
    """What figures rest on that records of one section state."""
    names = [record.name for record in records]
    said = names[0] if len(names) == 1 else f"{names[0]} to {names[-1]}"
    return f"published: {records[0].section} {said} of the controller's own MOC.cfg"
