"""Where a robot stands best for a program."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import MotionError, Note, OptionError
from ..options import texts
from ..options.entries import DISTANCE, NOT_NEGATIVE, number, value
from ..options.keywords import by_keywords
from ..setup import CellOptions, start_of, with_setup

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...core.spatial.pose import Pose
    from .placed import PlacedRobot

_ROOM = "500,500,0,45"
_LARGEST = 10.0
"""m."""


@dataclass(frozen=True, kw_only=True)
class PlaceOptions(CellOptions):
    """Where a base is looked for."""

    room: str | Sequence[float] = value(
        _ROOM,
        "How far the base may be from where it is, each way: X,Y in mm, X,Y,Z or X,Y,Z,DEGREES "
        "about the vertical.",
        numbers="m and rad",
    )
    clearance: float | None = number(
        None, "Clearance to keep, {unit}; the cell's own if unset.", DISTANCE, NOT_NEGATIVE
    )


def place_with(program: Program, options: PlaceOptions) -> PlacedRobot:
    """Find the base from which a program is driven fastest, all targets in reach, and prove it.

    Targets stay where they are in the world; those by joint values move with the base. Labels of
    configurations that other bases contradict are given up there, with a note.

    Args:
        program: as `flyby.read` gives it.

    Returns:
        The base, cycle times and clearances there and now.

    Raises:
        InputError: naming the option, or the robot stands on external axes.
    """
    from ...core.motion.emulator.controller import Controller
    from ...problems.placement.place import PlacementTask, place
    from .placed import PlacedRobot

    program, setup = with_setup(program, options)
    cell = setup.surroundings(program, no_floor=options.no_floor)
    vendor = replace(setup.vendor, nearest=True)
    task = PlacementTask(
        _room(options.room),
        clearance=cell.clearance if options.clearance is None else options.clearance,
        start=start_of(program),
    )
    found = place(lambda robot: Controller(vendor, robot), program, cell, task, options.say)

    def refused_from(base: Pose) -> MotionError | None:
        """Why the program cannot be driven from a base as its configurations say."""
        try:
            Controller(setup.vendor, cell.robot.with_base(base)).run(program, task.start)
        except MotionError as error:
            return error
        return None

    notes = []
    if setup.vendor.speaks is not None and not setup.vendor.speaks.work_objects:
        notes.append(
            Note(
                "the program states its targets in the robot's base: with another base they have "
                "to be stated anew"
            )
        )
    for which, placed in (("as it is", found.before), ("the best", found.best)):
        refused = None if placed is None else refused_from(placed.base)
        if refused is not None:
            notes.append(
                Note(
                    f"{which}: its time and clearance are with targets in the solutions nearest to "
                    "where the robot comes from, as the configurations that the program states "
                    f"cannot be driven from there ({refused}): state them anew for that base"
                )
            )
    return PlacedRobot(program, cell, task.clearance, found, tuple(notes))


place = by_keywords(place_with, PlaceOptions)


def _room(given: str | Sequence[float]) -> tuple[float, float, float, float]:
    """m along x, y and z, and rad about z."""
    name = spelt("room")
    if isinstance(given, str):
        typed = texts.numbers(given, name)
        found = [1e-3 * length for length in typed[:3]]
        found += [math.radians(angle) for angle in typed[3:]]
    else:
        found = [float(each) for each in given]
    if not 2 <= len(found) <= 4 or min(found) < 0.0:
        raise OptionError(f"{name} {given}: X,Y or X,Y,Z or X,Y,Z,DEGREES, each zero or more")
    x, y, z, turn = [*found, 0.0, 0.0][:4]
    if max(x, y, z) > _LARGEST or turn > math.pi:
        raise OptionError(f"{name} {given}: at most {_LARGEST:g} m each way, and half a turn")
    return x, y, z, turn
