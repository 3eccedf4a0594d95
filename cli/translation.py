"""Programs carried to another robot: what ``translate`` and ``optimize --vendor`` share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.errors import InputError
from .installed import registry, vendor_of

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.spatial.pose import Pose
    from ..core.translation.translate import Translation
    from ..core.vendor import Vendor

    Party = tuple[Vendor, Robot]


def party_of(robot: str) -> Party:
    """The robot called ``vendor/robot``, for which programs can be written.

    Raises:
        InputError: there is none, or it can be emulated only.
    """
    vendor, arm = vendor_of(robot), registry().find_robot(robot)
    vendor.check_written(arm)
    return vendor, arm


def party_for(name: str, option: str) -> Party:
    """As `party_of`; of a vendor with one robot its own name will do.

    Raises:
        InputError: as there, or the vendor has several robots.
    """
    if "/" in name or name not in registry().vendors:
        return party_of(name)
    robots = [robot for robot in registry().robot_names if robot.startswith(f"{name}/")]
    if len(robots) != 1:
        raise InputError(
            f"{option} {name}: which of its robots? {', '.join(robots) or 'It has none'}"
        )
    return party_of(robots[0])


def carried(program: Program, before: Party, after: Party, base: Pose | None = None) -> Translation:
    """The program for another robot.

    Args:
        program: for the robot that there is.
        before, after: vendor and robot of either side.
        base: the new robot's world in the old one's; None if it stands where the old one does.

    Raises:
        MotionError: the translation must refuse; the message names move and line.
    """
    from ..core.translation.translate import TranslationOptions, translate

    place = before[1].base if base is None else base
    return translate(program, before, after, TranslationOptions(place))
