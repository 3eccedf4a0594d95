"""Where a robot stands best for a program."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import InputError, MotionError, Note, OptionError, UnknownNameError
from ..options import texts
from ..options.entries import DISTANCE, NOT_NEGATIVE, number, value
from ..options.keywords import by_keywords
from ..results.cell_course import CellCourse
from ..setup import CellOptions, start_of, with_setup
from .changing import feasibility_of
from .opening import is_station_file, open_station
from .station import StationOptions

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.program.program import Program
    from ...core.robot.model import Robot
    from ...core.spatial.pose import Pose
    from ...core.vendor import Vendor
    from ...problems.placement.place import BesideOthers, Placement, PlacementTask
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
    of: str | None = value(
        None, "Of a station file: the robot whose base is looked for, beside the others."
    )
    order: Sequence[str] = value(
        (),
        "Routine whose calls may change places with those of others named so; may be given several "
        "times.",
        several=True,
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
    if options.of is not None:
        raise OptionError(f"{spelt('of')} names a robot of a station file, and this is a program")
    return _placed(program, options, None)


place = by_keywords(place_with, PlaceOptions)


def station_place_with(source: str | Path, options: PlaceOptions) -> PlacedRobot:
    """Find the base of one robot of a station from which its program is driven fastest.

    The others stay. From the new base the station ends no later, and the robots keep clear of each
    other as well as before: whatever their clocks say, or in every order that the signals allow,
    where that was so.

    Args:
        source: a station file.

    Returns:
        The base, cycle times of the robot and clearances in its cell there and now.

    Raises:
        InputError: a file cannot be read, an option names nothing, or the robot stands on external
            axes.
        MotionError: the station never ends, or does not keep its clearances, as it is.
    """
    if not is_station_file(Path(source)):
        raise InputError(f"{source}: is no station file (.toml)")
    if options.cell is not None or options.robot is not None:
        name = "cell" if options.cell is not None else "robot"
        raise OptionError(f"{spelt(name)} does not go with a station: its file says that")
    opened = open_station(Path(source), options.say)
    members = opened.station.members
    if options.of is None:
        raise OptionError(f"{spelt('of')} names the robot to place: {', '.join(members)}")
    if options.of not in members:
        raise UnknownNameError("robot of the station", options.of, members)
    if options.order:
        raise OptionError(
            f"{spelt('order')} is found for one program by itself: beside other robots tasks stand "
            "where signals have them"
        )
    feasibility = feasibility_of(opened, StationOptions().jitter, options.say)
    beside = partial(feasibility.placed, options.of)
    made = _placed(members[options.of].program, replace(options, of=None), beside)
    return replace(made, notes=(*opened.notes, *opened.unknown, *made.notes))


station_place = by_keywords(station_place_with, PlaceOptions)


def _placed(program: Program, options: PlaceOptions, beside: BesideOthers | None) -> PlacedRobot:
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
    course = CellCourse.of(program, setup)

    def based(driven: Program, around: Cell, wanted: PlacementTask) -> Placement:
        def controller(robot: Robot) -> Controller:
            return Controller(vendor, robot)

        return place(controller, driven, around, wanted, options.say, beside)

    order: tuple[str, ...] = ()
    if options.order:
        found, driven, order = _ordered(course.program, options.order, cell, task, vendor, based)
    else:
        found, driven = based(course.program, cell, task), course.program

    def refused_from(base: Pose, made: Program) -> MotionError | None:
        """Why a program cannot be driven from a base as its configurations say."""
        try:
            Controller(setup.vendor, cell.robot.with_base(base)).run(made, task.start)
        except MotionError as error:
            return error
        return None

    notes = list(course.notes)
    if setup.vendor.speaks is not None and not setup.vendor.speaks.work_objects:
        notes.append(
            Note(
                "the program states its targets in the robot's base: with another base they have "
                "to be stated anew"
            )
        )
    for which, placed, made in (
        ("as it is", found.before, course.program),
        ("the best", found.best, driven),
    ):
        refused = None if placed is None else refused_from(placed.base, made)
        if refused is not None:
            notes.append(
                Note(
                    f"{which}: its time and clearance are with targets in the solutions nearest to "
                    "where the robot comes from, as the configurations that the program states "
                    f"cannot be driven from there ({refused}): state them anew for that base"
                )
            )
    return PlacedRobot(program, cell, task.clearance, found, tuple(notes), order)


def _ordered(
    program: Program,
    names: Sequence[str],
    cell: Cell,
    task: PlacementTask,
    vendor: Vendor,
    based: Callable[[Program, Cell, PlacementTask], Placement],
) -> tuple[Placement, Program, tuple[str, ...]]:
    """A base with an order of tasks: the quickest where the robot stands, the base for it, and the
    quickest from there, as long as that is proven, too.

    Returns:
        What was found, the program in that order, and its tasks.
    """
    from ...core.motion.emulator.controller import Controller
    from ...problems.placement.task_orders import TaskOrders, quickest_order

    orders = TaskOrders.of(program, names)

    def at(robot: Robot) -> Callable[[Program], float]:
        def seconds(made: Program) -> float:
            try:
                return Controller(vendor, robot).run(made, task.start).duration
            except MotionError:
                return math.inf

        return seconds

    here = replace(task, room=(0.0, 0.0, 0.0, 0.0))
    before = based(program, cell, here).before
    order = quickest_order(orders, at(cell.robot))
    found = based(orders.program_in(order), cell, task)
    best = found.best
    if best is not None:
        there = cell.robot.with_base(best.base)
        again = quickest_order(orders, at(there), order)
        if again != order:
            around = replace(cell, robot=there)
            other = based(orders.program_in(again), around, here).best
            if other is not None:
                order, found = again, replace(found, best=replace(other, shift=best.shift))
    made = replace(found, before=before)
    return made, orders.program_in(order), tuple(orders.named(order))


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
