"""The arms of MOC.cfg: the type of each, with this arm's ranges, base, gravity and external axes.

A ROBOT names its type (`arms`), and stands in the world, or on the unit that carries it, by its
base frame; JOINT and ARM records, ``rob1_1`` to ``rob1_6`` of ``ROB_1``, have the ranges. Lengths,
speeds and accelerations of arms are in no backup.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ....core.arrays import FloatArray
from ....core.backup.backup import BackupRobot
from ....core.backup.contents import BackupNotes, listed
from ....core.door import called
from ....core.errors import InputError
from ....core.robot.joint import CoupledRange, Joint
from ....core.robot.model import STANDARD_GRAVITY, Robot
from ....core.robot.seven_axes.arm_angle import AXES
from ....core.spatial.pose import IDENTITY, Pose
from ....core.spatial.rotation import matrix_from_quaternion, matrix_from_rotation_vector
from .arms import FindRobot, agreeing, find_arm
from .cfg import Parameters, Record, folded
from .external_axes import (
    Unit,
    base_frame,
    conveyors,
    origin_of,
    positioner_of,
    units_named,
    units_of,
    with_units,
)
from .planner import stated_speeds

_SAME = 1e-3
"""rad, m/s² by which numbers may differ that are rounded in a file."""
_COUPLED = "lower_joint_coupl_bound", "upper_joint_coupl_bound"
_BETWEEN_ARMS = "the angle between upper arm and forearm"
"""What bounds of neighbouring axes limit; the type's doubt about it begins so."""
_TWO_ARMED = "14000"
_SIDES = {"r": "right", "l": "left"}
"""By the ends of its arms' names."""
_POSITIONER = "positioner"
"""The type of units that a task of their own turns."""
_LONGEST = 1e3
"""rad or m: a range beyond it is none."""


@dataclass(frozen=True)
class Mechanics:
    """The arms of a controller and the units that none of them moves.

    Args:
        robots: in the file's order.
        alone: names of the units that belong to no arm.
    """

    robots: tuple[BackupRobot, ...]
    alone: tuple[str, ...] = ()


def mechanics_of(
    moc: Parameters,
    products: Sequence[str],
    groups: Mapping[str, Sequence[str]],
    find_robot: FindRobot,
    notes: BackupNotes,
    positioners: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> Mechanics:
    """The arms, and positioners that tasks of their own turn.

    Args:
        moc: MOC.cfg, empty if there is none.
        products: arms among the controller's products.
        groups: in lower case, the names of the units that belong to each robot of a MultiMove.
        positioners: names of the units of groups without an arm, by the group.
        find_robot: see `BackupOpener.open`.
        notes: where is said what the file should not hold.
    """
    arms = [record for record in moc.section("ROBOT") if _is_arm(record)]
    if not arms:
        return Mechanics(_of_products(products, find_robot))
    for record in moc.section("ROBOT"):
        if record not in arms:
            notes.add(
                f"unit {record.name} ({record.text('use_robot_type')}) is no arm but a positioner "
                "of several axes, which is left out",
                record.file,
                record.line,
            )
    if conveyors(moc):
        notes.add(
            f"conveyors are not driven: {listed(conveyors(moc))}; what lies on one is taken to "
            "stand still"
        )
    own = {f"{folded(arm.name)}{AXES}" for arm in arms}
    carrying = {(arm.text("base_frame_coordinated") or "").casefold() for arm in arms} - {""}
    units = [unit for unit in units_of(moc, carrying) if folded(unit.single.name) not in own]
    turned = {group: units_named(units, names) for group, names in positioners.items()}
    alone = {unit.name for own in turned.values() for unit in own}
    others = [unit for unit in units if unit.name not in alone]
    owned = {arm.name: _own(arm, others, groups, len(arms) == 1) for arm in arms}
    robots = tuple(_robot(moc, arm, products, owned[arm.name], find_robot, notes) for arm in arms)
    robots += tuple(
        BackupRobot(group, _POSITIONER, *positioner_of(own)) for group, own in turned.items() if own
    )
    taken = alone | {unit.name for own in owned.values() for unit in own}
    return Mechanics(robots, tuple(unit.name for unit in units if unit.name not in taken))


def _is_arm(record: Record) -> bool:
    """Positioners of two axes and more are ROBOT records too, of other types."""
    kind = record.text("use_robot_type") or ""
    return kind.upper().startswith("ROB") or not kind


def _of_products(products: Sequence[str], find_robot: FindRobot) -> tuple[BackupRobot, ...]:
    """Arms by the controller's products alone."""
    robots = []
    named = [one for product in products or [""] for one in _arms_of(product, len(products))]
    for number, (name, product) in enumerate(named, 1):
        found = find_arm("", [product] if product else [], find_robot)
        lacks = [found.lack] if found.lack else []
        lacks.append(
            "MOC.cfg, which has ranges, base and external axes, is missing or damaged: those of "
            "the type are taken, in the world's origin"
        )
        robots.append(BackupRobot(name or f"ROB_{number}", product, found.robot, tuple(lacks)))
    return tuple(robots)


def _arms_of(product: str, count: int) -> list[tuple[str, str]]:
    """The arms of a product, each with its name (``""`` for a number) and what to look for."""
    if _TWO_ARMED not in product or count > 1:
        return [("", product)]
    return [(f"ROB_{key.upper()}", f"{product} {side}") for key, side in _SIDES.items()]


def _own(
    arm: Record, units: Iterable[Unit], groups: Mapping[str, Sequence[str]], single: bool
) -> list[Unit]:
    """The units that a robot moves: those of its group, and what it stands on; of one robot all."""
    if single:
        return list(units)
    members = {*groups.get(arm.name.casefold(), ()), arm.text("base_frame_coordinated") or ""}
    return units_named(units, members)


def _robot(
    moc: Parameters,
    arm: Record,
    products: Sequence[str],
    units: Sequence[Unit],
    find_robot: FindRobot,
    notes: BackupNotes,
) -> BackupRobot:
    written = arm.text("use_robot_type") or ""
    found = find_arm(written, agreeing(written, products) or products, find_robot)
    side = _SIDES.get(arm.name.rpartition("_")[2].casefold())
    if found.robot is None and side is not None and _TWO_ARMED in written:
        found = find_arm("", [f"IRB {_TWO_ARMED} {side}"], find_robot)
    if found.robot is None:
        return BackupRobot(arm.name, written, None, (found.lack,))
    robot, lacks = found.robot, list(_assumed(found.robot))
    robot, said = _with_ranges(robot, moc, arm, notes)
    lacks += said
    robot, said = with_units(robot, units)
    lacks += said
    robot = _placed(robot, arm, units, notes)
    lacks += _arm_loads(moc, arm)
    if robot.arm_angle_reference is not None:
        lacks += _reference(arm)
    stated = stated_speeds(moc, arm.name)
    return BackupRobot(arm.name, written, _calibrated(robot, arm), tuple(lacks), stated)


def _assumed(robot: Robot) -> list[str]:
    """What no backup states and the type's description assumes."""
    factors = [f"{group} within a factor {robot.spread[group]:g}" for group in robot.spread]
    if not factors:
        return []
    figures = ", ".join(factors)
    return [
        f"no backup states how fast the arm is; assumed are {figures}: logged runs make them known "
        f"({called('identify')})"
    ]


# ranges


def _with_ranges(
    robot: Robot, moc: Parameters, arm: Record, notes: BackupNotes
) -> tuple[Robot, list[str]]:
    """The robot with the ranges of its ARM records."""
    joints, records = [], []
    ranges: list[CoupledRange] = []
    unknown: list[str] = []
    for index, joint in enumerate(robot.joints):
        record = _arm_record(moc, arm, index)
        if record is not None:
            ranged = _ranged(joint, record, notes)
            records += [record] if ranged is not joint else []
            if any(record.text(bound) for bound in _COUPLED):
                coupled = _coupled(joint, record)
                unknown += [] if coupled is not None else [joint.name]
                ranges += [] if coupled is None else [coupled]
            joint = ranged
        joints.append(joint)
    if not records:
        return robot, ["MOC.cfg states no ranges of this arm: those of its type are taken"]
    origins = {**robot.origins, "range": origin_of(records)}
    doubts = robot.doubts
    if unknown:
        said = "the range of a joint depends on its neighbour's (coupl_bound), which is not checked"
        doubts = (*doubts, f"{', '.join(unknown)}: {said}")
    if ranges:
        doubts = tuple(doubt for doubt in doubts if not doubt.startswith(_BETWEEN_ARMS))
    motors = sum(not joint.held for joint in robot.joints)
    lacks = [] if len(records) >= motors else [_partly(len(records), motors)]
    robot = replace(
        robot,
        joints=tuple(joints),
        origins=origins,
        doubts=doubts,
        coupled_ranges=(*robot.coupled_ranges, *ranges),
    )
    return robot, lacks


def _coupled(joint: Joint, record: Record) -> CoupledRange | None:
    """The range of the angle between upper arm and forearm, where a rod holds the forearm.

    Returns:
        None where the joint counts from its neighbour anyway, or not both bounds are stated.
    """
    try:
        lower, upper = (record.number(bound) for bound in _COUPLED)
    except InputError:
        return None
    drivers = [one.driver for one in joint.followers]
    if (
        len(drivers) != 1
        or lower is None
        or upper is None
        or not -math.pi < lower < upper < math.pi
    ):
        return None
    reason = f"{_BETWEEN_ARMS}, by coupl_bound of MOC.cfg"
    return CoupledRange(((joint.name, 1.0), (drivers[0], -1.0)), lower, upper, reason)


def _partly(stated: int, joints: int) -> str:
    return (
        f"MOC.cfg states the ranges of {stated} of {joints} joints: of the others those of the "
        "type are taken"
    )


def _arm_record(moc: Parameters, arm: Record, index: int) -> Record | None:
    """The ARM of a joint, counted from zero: by the robot's joints, or by its name."""
    used = arm.numbered("use_joint_")
    by_name = f"{folded(arm.name)}{index + 1}"
    name = used[index] if index < len(used) else None
    joint = moc.named("JOINT", name) or _alike(moc, "JOINT", by_name)
    found = None
    if joint is not None:
        found = moc.named("ARM", joint.text("use_arm"), joint.name)
    return found or moc.named("ARM", name) or _alike(moc, "ARM", by_name)


def _alike(moc: Parameters, section: str, name: str) -> Record | None:
    return next((one for one in moc.section(section) if folded(one.name) == name), None)


def _ranged(joint: Joint, record: Record, notes: BackupNotes) -> Joint:
    """A joint with the range of its record; of its type where the record has none."""
    try:
        lower, upper = (record.number(f"{end}_joint_bound") for end in ("lower", "upper"))
        ends = [joint.lower if lower is None else lower, joint.upper if upper is None else upper]
        if not -_LONGEST < ends[0] < ends[1] < _LONGEST:
            message = f"the range of {record.name} makes no sense, so that of its type is taken"
            raise InputError(f"{message}: {ends[0]:g} to {ends[1]:g} rad")
    except InputError as error:
        notes.add(str(error), record.file, record.line)
        return joint
    if lower is None and upper is None:
        return joint
    return replace(joint, lower=ends[0], upper=ends[1])


# base, gravity, external axes


def _placed(robot: Robot, arm: Record, units: Sequence[Unit], notes: BackupNotes) -> Robot:
    """The robot where it stands, and hanging as it does."""
    try:
        base = base_frame(arm)
    except InputError as error:
        notes.add(f"the base frame of {arm.name} is not taken: {error}")
        return robot
    on = arm.text("base_frame_coordinated") or ""
    carrier = next(
        (u for u in units if on and on.casefold() in (u.name.casefold(), u.single.name.casefold())),
        None,
    )
    frame = base
    if carrier is not None and carrier.axis is not None:
        frame = _standing(robot, carrier.name) @ base
        if base != IDENTITY and carrier.axis.joint.placement != IDENTITY:
            notes.add(
                f"{arm.name} stands on {carrier.name}, and both have a base frame: that of "
                f"{arm.name} is taken to be in the frame of {carrier.name}",
                arm.file,
                arm.line,
            )
    elif on:
        message = f"{arm.name} stands on {on}, which is not known: it is taken to stand still"
        notes.add(message, arm.file, arm.line)
    gravity = _gravity(robot, arm, frame, notes)
    origins = {**robot.origins, "base": origin_of([arm])}
    return replace(robot, base=base, gravity=gravity, origins=origins)


def _standing(robot: Robot, unit: str) -> Pose:
    """The frame of a unit in the world, all axes at zero."""
    axes = {axis.name: axis for axis in robot.external_axes}
    frame, axis = IDENTITY, axes.get(unit)
    while axis is not None:
        frame, axis = axis.joint.placement @ frame, axes.get(axis.carried_by or "")
    return frame


def _gravity(
    robot: Robot, arm: Record, frame: Pose, notes: BackupNotes
) -> tuple[float, float, float]:
    """m/s² in the world.

    The controller has it by ``gravity_alpha`` and ``gravity_beta``, the turns about x and y by
    which the base is off a level floor, whatever the base frame says ("Technical reference manual,
    System parameters", Gravity Beta: positive about y, π suspended).
    """
    try:
        alpha, beta = (arm.number(f"gravity_{turn}") or 0.0 for turn in ("alpha", "beta"))
        gamma = arm.number("gamma_rotation") or 0.0
    except InputError as error:
        notes.add(f"gravity is taken as on a level floor: {error}")
        return robot.gravity
    turned, stands = _about(0, alpha) @ _about(1, beta), np.eye(3)
    if robot.arm_size == AXES:  # two arms stand on one body, and count from its frame
        turned = turned @ _about(2, gamma)
        stands = robot.joints[0].placement.matrix()[:3, :3]
    in_base = turned.T @ np.array(STANDARD_GRAVITY)
    world = matrix_from_quaternion(np.array(frame.quaternion)) @ stands @ in_base
    if float(np.abs(world - np.array(STANDARD_GRAVITY)).max()) < 10 * _SAME:
        return STANDARD_GRAVITY
    tilt = math.degrees(math.acos(float(np.clip(turned[2, 2], -1.0, 1.0))))
    notes.add(
        f"gravity_alpha and gravity_beta of {arm.name} say {tilt:.0f}° off a level floor, and its "
        "base frame says otherwise: gravity is taken from the former, the place from the latter",
        arm.file,
        arm.line,
    )
    x, y, z = (round(float(part), 12) for part in world)
    return (x, y, z)


def _about(axis: int, angle: float) -> FloatArray:
    return np.asarray(matrix_from_rotation_vector(angle * np.eye(3)[axis]))


# what else is said of an arm


def _arm_loads(moc: Parameters, arm: Record) -> list[str]:
    """Loads that the arm carries besides its tool: accelerations do not know of them."""
    said = []
    number = "".join(filter(str.isdigit, arm.name))
    for record in moc.section("ARM_LOAD"):
        try:
            mass = record.number("mass") or 0.0
        except InputError:
            continue
        if mass > 0.0 and record.name.casefold().startswith(f"r{number}_"):
            said.append(f"{record.name} {mass:g} kg")
    if not said:
        return []
    return [
        f"the arm carries {', '.join(said)} (MOC.cfg ARM_LOAD), of which its accelerations do "
        "not know"
    ]


def _reference(arm: Record) -> list[str]:
    """What the file says of the direction that arm angles count from, in words nobody knows."""
    said = [f"{key} {value}" for key, value in arm.values.items() if "arm_angle" in key]
    if not said:
        return []
    return [
        f"{arm.name} states {listed(said)}, which is not understood: arm angles are taken to count "
        "from the usual direction of its type"
    ]


def _calibrated(robot: Robot, arm: Record) -> Robot:
    """A doubt where the controller makes up for the errors of this arm's own geometry."""
    names = [
        value for key, value in arm.values.items() if key.startswith("use_") and "calib" in key
    ]
    if not any(name.lower().endswith("_calib") for name in names):
        return robot
    said = "calibrated (absolute accuracy): its joints are off the nominal ones by some hundredths"
    return replace(robot, doubts=(*robot.doubts, f"{said} to tenths of a degree"))
