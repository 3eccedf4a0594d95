"""A robot as its controller's data lists describe it, alone or on top of a listed arm."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ....core.errors import FlybyError, InputError
from ....core.robot.hulls import ORIGIN, hulls, reach_of
from ....core.robot.joint import Joint
from ....core.robot.model import Robot
from ....core.robot.shape import LinkShape
from ....core.spatial.pose import IDENTITY, Pose
from ..data_list import DataList
from .assumed import SPREAD, starting_times
from .axis_limits import (
    RULE_SPREAD,
    AxisLimits,
    acceleration_rule,
    axis_limits,
    axis_name,
)
from .external_axes import external_axes
from .filters import filters
from .geometry import AXES, ArmGeometry, frame, geometry
from .named_arms import APART, FindRobot, apart, called, listed_arm, name_alone, payload_of_name

_MODEL, _ARM, _DECLARED = "$robcor.dat", "$machine.dat", "$MACHINE"


def with_machine_data(robot: Robot, file: Path) -> Robot:
    """The robot with the ranges, speeds and accelerations that its controller's file states.

    Args:
        robot: of this type.
        file: ``$machine.dat``.

    Raises:
        InputError: the file cannot be read, lacks what is read of it, or is another arm's.
    """
    data = _read(file)
    if robot.arm_size != AXES:
        raise InputError(f"{file}: machine data of six axes; {robot.name} has {robot.arm_size}")
    if _holds_level(robot, data):
        return _palletiser(robot, data)
    own = geometry(data)
    off = apart(robot, _arm(robot.name, robot.joints, own))
    if off > APART:
        raise InputError(
            f"{file}: the flange of its arm is up to {1e3 * off:.1f} mm from that of a "
            f"{robot.name}: name the robot that the file is of"
        )
    limits = [axis_limits(data, i) for i in range(1, AXES + 1)]
    joints = tuple(map(_limited, robot.joints, limits))
    return _said(replace(robot, joints=joints), data, limits)


def stated_in(file: Path) -> dict[str, tuple[Any, str]]:
    """What a ``$machine.dat`` says of how its controller drives; see `filters`.

    Raises:
        InputError: the file cannot be read.
    """
    return filters(_read(file))


def robot_of(file: Path) -> Robot:
    """The robot that a file alone describes.

    Args:
        file: ``$machine.dat``; a ``$robcor.dat`` in the same folder says the rated load.

    Raises:
        InputError: the file cannot be read, lacks what is read of it, or is of an arm that is not
            modelled.
    """
    from ....core.registry import find_robot

    data = _read(file)
    model = None
    try:
        beside = [one for one in file.parent.iterdir() if one.name.lower() == _MODEL]
        model = DataList.read(beside[0]) if beside else None
    except (FlybyError, OSError):  # it says little, and nothing that cannot be done without
        pass
    return described(data, model, (data.text("$TRAFONAME"),), {}, find_robot)


def described(
    data: DataList,
    model: DataList | None,
    names: Sequence[str],
    roots: Mapping[str, Pose],
    find_robot: FindRobot,
) -> Robot:
    """The robot that a controller's data lists describe.

    Args:
        data: of ``$machine.dat``.
        model: of ``$robcor.dat``; None if there is none.
        names: that the controller has for the arm, the most trusted first.
        roots: of tables in the world, by their type (``#EASYS``).
        find_robot: loads a listed arm.

    Raises:
        InputError: what is needed is missing, or the arm is not modelled.
    """
    if data.flag("$DEF_A4FIX"):
        named = name_alone(names, find_robot)
        if named is not None and _holds_level(named, data):
            return _placed(_palletiser(named, data), data, roots)
    own = geometry(data)
    limits = [axis_limits(data, i) for i in range(1, AXES + 1)]
    payload = rated_load(data, model)
    bare = _arm("kuka/bare", _joints(own, limits), own)
    known, doubts = listed_arm(bare, names, payload, find_robot)
    if known is None:
        made = _alone(own, limits, names, payload)
    else:
        made = _as_listed(own, limits, known, payload)
    made = replace(
        made,
        origins={**made.origins, "geometry": _published(data)},
        doubts=(*doubts, *made.doubts),
    )
    return _said(_placed(made, data, roots), data, limits)


def _placed(robot: Robot, data: DataList, roots: Mapping[str, Pose]) -> Robot:
    """The arm where the file has it, with the file's external axes."""
    external = external_axes(data, roots)
    base = frame(data, "$ROBROOT") if data.has("$ROBROOT") else IDENTITY
    return replace(
        robot,
        base=base if external.base is None else external.base,
        external_axes=external.axes,
        doubts=(*robot.doubts, *external.doubts),
    )


def _holds_level(robot: Robot, data: DataList) -> bool:
    """Whether a listed arm is a palletiser, as the file says."""
    return data.flag("$DEF_A4FIX") and robot.arm_size == AXES and robot.joints[3].held


def _palletiser(robot: Robot, data: DataList) -> Robot:
    """A palletiser with the limits of a file, whose lengths hold for a level flange alone."""
    limits = {i: axis_limits(data, i) for i in range(1, AXES + 1) if not robot.joints[i - 1].held}
    joints = tuple(_limited(joint, limits.get(i)) for i, joint in enumerate(robot.joints, 1))
    doubt = "lengths are those of its type: those of a palletiser's $machine.dat are not read"
    said = _said(replace(robot, joints=joints), data, list(limits.values()))
    return replace(said, doubts=(*robot.doubts, doubt))


def _limited(joint: Joint, limit: AxisLimits | None) -> Joint:
    """A joint with the limits of a file; as it is without."""
    if limit is None:
        return joint
    return replace(
        joint,
        lower=limit.lower,
        upper=limit.upper,
        velocity=limit.velocity,
        acceleration=limit.acceleration or joint.acceleration,
    )


def rated_load(data: DataList, model: DataList | None) -> float | None:
    """kg that the arm is built for, as the controller has it; None if it does not say."""
    for source in (model, data):
        for name in ("DEF_L_M", "$DEF_L_M"):
            if source is not None and source.has(name):
                mass = source.number(name)
                if 0.0 < mass < math.inf:
                    return mass
    return None


def _alone(
    own: ArmGeometry, limits: Sequence[AxisLimits], names: Sequence[str], rated: float | None
) -> Robot:
    """An arm that is not listed."""
    doubts = ["it is not in the catalogue: masses, inertias and efforts are not known"]
    payload = rated
    if payload is None:
        payload = payload_of_name(names)
        doubts.append(
            "no rated load is stated, and no shapes are drawn without one"
            if payload is None
            else f"its rated load is taken from its name: {payload:g} kg"
        )
    joints = _joints(own, limits)
    reach = reach_of(joints)
    if any(limit.acceleration is None for limit in limits):
        times = starting_times(payload or 10.0, reach)
        joints = tuple(
            replace(joint, acceleration=limit.acceleration or joint.velocity / seconds)
            for joint, limit, seconds in zip(joints, limits, times, strict=True)
        )
    robot = _arm(called(names), joints, own)
    shapes: tuple[LinkShape, ...] = ()
    if payload is not None:
        shapes = hulls(robot.joints, robot.flange, payload, max(reach, 0.1))
    origins = {"shape": ORIGIN} if shapes else {}
    return replace(robot, payload=payload, shapes=shapes, origins=origins, doubts=tuple(doubts))


def _as_listed(
    own: ArmGeometry, limits: Sequence[AxisLimits], known: Robot, rated: float | None
) -> Robot:
    """A listed arm with the lengths and limits of a file."""
    joints = tuple(
        replace(joint, effort=listed.effort, acceleration=limit.acceleration or listed.acceleration)
        for joint, listed, limit in zip(_joints(own, limits), known.joints, limits, strict=True)
    )
    made = _arm(known.name, joints, own)
    moved = [IDENTITY, *_from_listed(own, known)]
    shapes = tuple(
        replace(shape, placement=moved[shape.link] @ shape.placement) for shape in known.shapes
    )
    links = tuple(body.placed(at) for body, at in zip(known.links, moved[1:], strict=False))
    return replace(
        made,
        links=links,
        shapes=shapes,
        payload=rated or known.payload,
        origins=known.origins,
        spread=known.spread,
    )


def _from_listed(own: ArmGeometry, known: Robot) -> list[Pose]:
    """Each joint frame of the listed arm in the same one here, all axes at zero."""
    frames, at = [], IDENTITY
    for joint, origin in zip(known.joints, own.origins, strict=True):
        at = at @ joint.placement
        frames.append(Pose(origin).inverse() @ at)
    return frames


def _arm(name: str, joints: Sequence[Joint], own: ArmGeometry) -> Robot:
    placed = tuple(
        replace(joint, placement=placement, axis=axis)
        for joint, placement, axis in zip(joints, own.placements(), own.axes, strict=True)
    )
    return Robot(name=name, joints=placed, flange=own.flange_placement())


def _joints(own: ArmGeometry, limits: Sequence[AxisLimits]) -> tuple[Joint, ...]:
    """The joints; an acceleration that is not stated is the velocity over a second."""
    return tuple(
        Joint(
            name=axis_name(i),
            placement=placement,
            axis=axis,
            lower=limit.lower,
            upper=limit.upper,
            velocity=limit.velocity,
            acceleration=limit.acceleration or limit.velocity,
        )
        for i, (placement, axis, limit) in enumerate(
            zip(own.placements(), own.axes, limits, strict=True), start=1
        )
    )


def _said(robot: Robot, data: DataList, limits: Sequence[AxisLimits]) -> Robot:
    """The robot with what its limits rest on."""
    said = _published(data)
    origins = {**robot.origins, "range": said, "velocity": said}
    spread = {group: factor for group, factor in robot.spread.items() if group != "velocity"}
    if all(limit.acceleration is not None for limit in limits):
        rule = acceleration_rule(data)
        origins["acceleration"] = f"computed: {Path(data.name).name} of its controller ({rule})"
        spread["acceleration"] = RULE_SPREAD[rule]
    elif "acceleration" not in origins:
        origins["acceleration"] = (
            "assumed: times to top speed of 39 arms of the maker, by payload and reach "
            f"(docs/reference/robots.md), within a factor {SPREAD:g}"
        )
        spread["acceleration"] = SPREAD
    return replace(robot, origins=origins, spread=spread)


def _published(data: DataList) -> str:
    return f"published: {Path(data.name).name} of its controller"


def _read(file: Path) -> DataList:
    """The data of a file.

    Raises:
        InputError: it cannot be read, or assigns nothing.
    """
    try:
        data = DataList.read(file)
    except InputError:
        raise
    except FlybyError as error:
        raise InputError(str(error)) from None
    if not data.data:
        raise InputError(f"{file}: no {_ARM}: it assigns nothing")
    if data.declared and data.declared.upper() != _DECLARED:
        raise InputError(
            f"{file}: is the data list {data.declared}: the arm is described by {_ARM}, in R1/Mada "
            "of the controller"
        )
    return data
