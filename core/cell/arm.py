"""What a cell says of its own arm: closer shapes of links, narrower limits of joints."""

from __future__ import annotations

from dataclasses import replace

from ..files.tables import TomlTable, per
from ..robot.catalogue import UNITS
from ..robot.joint import Joint
from ..robot.model import Robot
from ..robot.shape import LinkShape
from ..robot.shape_table import read_shapes
from ..spatial.pose import IDENTITY, Pose

BASE = "base"


def read_arm(file: TomlTable, robot: Robot) -> Robot:
    """The robot with the ``[[robot_shape]]`` and ``[joint_limit.NAME]`` of a cell file.

    Raises:
        InputError: a link or joint is unknown, or a range is wider than the robot's; the message
            names file and key.
    """
    shapes, doubts = _shapes(file, robot)
    return replace(
        robot, shapes=shapes, joints=_joints(file, robot), doubts=(*robot.doubts, *doubts)
    )


def _shapes(file: TomlTable, robot: Robot) -> tuple[tuple[LinkShape, ...], list[str]]:
    """Those of the links that the file names, and the robot's own of all others; doubts."""
    names = [BASE, *(joint.name for joint in robot.joints)]
    frames = _at_zero(robot)
    given: list[LinkShape] = []
    doubts: list[str] = []
    for row in file.listed_tables("robot_shape"):
        link = names.index(row.choice("link", names))
        made = read_shapes(row)
        row.finish()
        own = frames[link].inverse()
        given += [LinkShape(link, shape, own @ placement) for shape, placement in made.bodies]
        doubts += made.doubts
    named = {shape.link for shape in given}
    kept = (shape for shape in robot.shapes if shape.link not in named)
    return (*kept, *given), doubts


def _at_zero(robot: Robot) -> list[Pose]:
    """The frames of base and links in the base's, all joints at zero."""
    frames = [IDENTITY] * (robot.arm_size + 1)
    below = 0
    for index in robot.along:
        frames[index + 1] = frames[below] @ robot.joints[index].step
        below = index + 1
    return frames


def _joints(file: TomlTable, robot: Robot) -> tuple[Joint, ...]:
    tables = file.named_tables("joint_limit")
    known = [joint.name for joint in robot.joints]
    for name in tables:
        if name not in known:
            message = f"{robot.name} has no such joint, but {', '.join(known)}"
            raise file.table("joint_limit").error(name, message)
    return tuple(
        _limited(tables[joint.name], joint) if joint.name in tables else joint
        for joint in robot.joints
    )


def _limited(table: TomlTable, joint: Joint) -> Joint:
    units = UNITS[joint.kind]
    limited = joint
    if table.unit_key("range", units):
        limited = _narrowed(table, joint, table.quantities("range", units, 2))
    if table.unit_key("speed", per(units, "s")):
        speed = table.quantity("speed", per(units, "s"))
        if not 0.0 < speed <= joint.velocity * (1 + 1e-9):
            most = joint.shown(joint.velocity)
            raise table.error("speed", f"must be above zero, and {most}/s at most")
        limited = replace(limited, velocity=speed)
    if table.unit_key("acceleration", per(units, "s2")):
        acceleration = table.quantity("acceleration", per(units, "s2"))
        if acceleration <= 0.0:
            raise table.error("acceleration", "must be above zero")
        limited = replace(limited, acceleration=acceleration)
    table.finish()
    return limited


def _narrowed(table: TomlTable, joint: Joint, ends: tuple[float, ...]) -> Joint:
    lower, upper = ends
    if lower >= upper:
        raise table.error("range", "must rise")
    if lower < joint.lower - 1e-9 or upper > joint.upper + 1e-9:
        reach = f"{joint.shown(joint.lower)} to {joint.shown(joint.upper)}"
        raise table.error("range", f"may only be narrower than the robot's own, {reach}")
    return replace(joint, lower=max(lower, joint.lower), upper=min(upper, joint.upper))
