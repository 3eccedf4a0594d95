"""Programs carried to another vendor's robot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..core.display import counted
from ..core.door import given
from ..core.errors import InputError
from .options.entries import REQUIRED, TaskOptions, value
from .options.keywords import by_keywords
from .options.texts import pose
from .setup import RobotOptions, Setup, controller_of, with_setup, writable_robot

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.spatial.pose import Pose
    from ..core.translation.translate import Translation


@dataclass(frozen=True, kw_only=True)
class TranslateOptions(TaskOptions):
    """Where a program is carried."""

    robot: str = value(REQUIRED, "The new robot, such as kuka/kr30-3 (`robots`).")
    to: str | None = value(None, "The new robot's vendor, such as kuka.")
    base: str | Pose | None = value(
        None,
        "The new robot's base in the old one's world: x,y,z,rx,ry,rz in mm and degrees. "
        "Without it both stand at the same place.",
        pose,
    )


def target_of(options: TranslateOptions) -> Setup:
    """The new robot.

    Raises:
        InputError: there is none, it can be emulated only, or it is another vendor's.
    """
    named = options.robot
    made = writable_robot(named if options.to is None or "/" in named else f"{options.to}/{named}")
    if options.to is not None and options.to != made.vendor.name:
        raise InputError(f"{given('to', options.to)}: {named} is a robot of {made.vendor.name}")
    return made


def translate_with(program: Program, options: TranslateOptions) -> Translation:
    """Carry a program to another robot: targets, zones and speeds in its vendor's terms.

    Args:
        program: as `flyby.read` gives it; corners and times are taken from its robot's motion.

    Raises:
        InputError: the new robot is unknown or can be emulated only.
        MotionError: the translation must refuse; the message names move and line.
    """
    program, before = with_setup(program, RobotOptions())
    after = target_of(options)
    controller_of(program, before)  # refuses faults
    options.say(f"translating {counted(program.moves, 'move')}")
    return carried(program, before, after, options.base)


translate = by_keywords(translate_with, TranslateOptions)


def carried(
    program: Program, before: Setup, after: Setup, base: str | Pose | None = None
) -> Translation:
    """The program for another robot.

    Args:
        program: for the robot that there is.
        before, after: the robots.
        base: the new robot's world in the old one's; None if it stands where the old one does.

    Raises:
        MotionError: the translation must refuse; the message names move and line.
    """
    from ..core.translation.translate import translate

    place = before.robot.base if base is None else pose(base, "base")
    made = translate(
        program,
        (before.vendor, before.robot),
        (after.vendor, after.robot),
        place,
    )
    return replace(made, program=replace(made.program, setup=after))
