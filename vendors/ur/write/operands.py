"""What stands in a move: targets in the robot's base, speeds, blend radii.

What URScript cannot say is an `InputError`; the writer adds which move it was.
"""

from __future__ import annotations

from ....core.errors import InputError
from ....core.program.move import Move, MoveJ
from ....core.program.speed import Speed
from ....core.program.target import Configuration, JointTarget, PoseTarget
from ....core.program.tool import WorkObject
from ....core.program.zone import Fine, Radius, Zone, zone_word
from ....core.robot.model import Robot
from ....core.spatial.pose import Pose
from ..motion.configuration import UrConfiguration
from .declarations import Declarations, Operand
from .formatting import listing, number, pose_literal

ARM_AXES = 6


def check_robot(robot: Robot) -> None:
    """Refuse robots that URScript does not drive.

    Raises:
        InputError: another number of joints than six, or external axes.
    """
    if robot.arm_size != ARM_AXES or robot.external_axes:
        raise InputError(
            f"URScript drives arms of six joints without external axes; {robot.name} has "
            f"{robot.arm_size} joints and {len(robot.external_axes)} external axes"
        )


class Operands:
    """The operands of one script's moves.

    Args:
        robot: in whose base poses are given.
    """

    def __init__(self, robot: Robot) -> None:
        check_robot(robot)
        self._base = robot.base
        self.declarations = Declarations()

    def pose(self, target: PoseTarget, work_object: WorkObject) -> Operand:
        """``p[x, y, z, rx, ry, rz]``: the TCP in the robot's base."""
        if target.external:
            raise InputError("URScript has no external axes: take them out of the target")
        frame = frame_in_base(work_object, self._base)
        if frame is None:
            return self.declarations.add(pose_literal(target.pose), target.name)
        # Other numbers than those that the name stood for get no name.
        return pose_literal(frame @ target.pose)

    def joints(self, target: JointTarget) -> Operand:
        """``[q1, …, q6]`` in rad."""
        if target.external:
            raise InputError("URScript has no external axes: take them out of the target")
        if len(target.joints) != ARM_AXES:
            raise InputError(
                f"URScript gives {ARM_AXES} joint values, but the target has {len(target.joints)}"
            )
        return self.declarations.add(listing(target.joints), target.name)


def frame_in_base(work_object: WorkObject, base: Pose) -> Pose | None:
    """A work object seen from the robot's base; None if it is the base.

    Args:
        work_object: that stands still.
        base: of the robot, in the world.

    Raises:
        InputError: the work object moves.
    """
    if work_object.robot_held or work_object.moved_by is not None:
        raise InputError(
            f"work object {work_object.name} moves, but URScript's targets are in the robot's base"
        )
    if work_object.pose == base:
        return None
    return base.inverse() @ work_object.pose


def qnear(configuration: Configuration) -> str:
    """``qnear=[q1, …, q6]``, in rad."""
    if not isinstance(configuration, UrConfiguration):
        raise InputError(
            f"{configuration} is no qnear: label the target's solution for this robot, or take "
            "the configuration away"
        )
    if len(configuration.joints) != ARM_AXES:
        raise InputError(f"qnear has {ARM_AXES} joint values, not {len(configuration.joints)}")
    return f"qnear={listing(configuration.joints)}"


def blend(zone: Zone) -> str:
    """``r=`` in m; nothing for a stop point.

    The radius is the only zone that URScript knows: orientation and position share it.
    """
    if isinstance(zone, Fine):
        return ""
    if not isinstance(zone, Radius):
        raise InputError(
            f"URScript has no zone by {zone_word(zone)}: give it a radius (TCP distance)"
        )
    if zone.tcp == 0:
        raise InputError("a blend radius of 0 is a stop point in URScript: make the zone fine")
    try:
        zone.with_one_distance()
    except InputError as error:
        raise InputError(f"URScript has one radius for all: {error}") from None
    for what in ("angle", "external_linear", "external_angular"):
        if getattr(zone, what) > 0:
            raise InputError(f"URScript's blend has no Radius.{what}: set it to 0")
    return f"r={number(zone.tcp)}"


_NOWHERE = {
    "reorientation": "a speed of reorientation",
    "reorientation_acceleration": "an acceleration of reorientation",
}
_SHARES = {
    "joint_fraction": "a share of the joints' speed",
    "joint_acceleration_fraction": "a share of the joints' acceleration",
}


def check_speed(speed: Speed) -> None:
    """Refuse what no move of URScript can say.

    Limits of external axes say nothing about arms that have none.

    Raises:
        InputError: naming the field.
    """
    for name, what in _NOWHERE.items():
        if getattr(speed, name) is not None:
            raise InputError(f"URScript has no words for {what} (Speed.{name}): take it away")
    if speed.acceleration_override != 1.0:
        raise InputError(
            "URScript has no words for an override of all accelerations "
            "(Speed.acceleration_override): state the accelerations"
        )
    if speed.jerk_fraction != 1.0:
        raise InputError("URScript has no words for a share of the jerk (Speed.jerk_fraction)")


def speed_arguments(move: Move) -> str:
    """``a=, v=`` or ``t=`` in s: of the leading joint in rad, or of the TCP in m.

    Raises:
        InputError: the move has another speed than its call can give.
    """
    speed = move.speed
    check_speed(speed)
    if isinstance(move, MoveJ) and speed.tcp is not None:
        raise InputError(
            "URScript's movej has no limit on the speed of the TCP (Speed.tcp): give the move a "
            "joint speed or a duration"
        )
    for name, what in _SHARES.items():
        if getattr(speed, name) != 1.0:
            raise InputError(
                f"there is no argument for {what} (Speed.{name}): give a speed and an acceleration "
                "that stay within it, or write optimove with the option shares=optimove"
            )
    paced = "joint" if isinstance(move, MoveJ) else "tcp"
    fields = {"a": f"{paced}_acceleration", "v": paced, "t": "duration"}
    given = {argument: getattr(speed, field) for argument, field in fields.items()}
    for argument in ("a", "v"):
        if given["t"] is None and given[argument] is None:
            raise InputError(
                f"URScript needs Speed.{fields[argument]}: without it the controller takes a "
                "default of its own"
            )
    return ", ".join(f"{k}={number(v)}" for k, v in given.items() if v is not None)


def gives_shares(speed: Speed) -> bool:
    """Whether a speed is a share of what the robot can do and nothing else."""
    absolute = (speed.joint, speed.joint_acceleration, speed.tcp, speed.tcp_acceleration)
    return absolute == (None,) * 4 and speed.duration is None


def shares(move: Move) -> str:
    """``a=, v=`` of ``optimovej`` and ``optimovel``: shares of what the robot can do.

    Raises:
        InputError: the move's speed is no share.
    """
    speed = move.speed
    check_speed(speed)
    if not gives_shares(speed):
        raise InputError("optimove takes shares of the robot's speed and acceleration alone")
    a, v = speed.joint_acceleration_fraction, speed.joint_fraction
    return f"a={number(a)}, v={number(v)}"
