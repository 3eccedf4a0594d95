"""Programs carried to another vendor's robot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..core.display import counted
from ..core.door import given
from ..core.errors import InputError
from .check import clearance_findings
from .options.entries import REQUIRED, TaskOptions, switch, value
from .options.keywords import by_keywords
from .options.texts import pose
from .results.cell_course import CellCourse
from .setup import (
    RobotOptions,
    Setup,
    controller_of,
    setup_of_program,
    start_of,
    with_setup,
    writable_robot,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..core.cell.cell import Cell
    from ..core.driving.driven_program import DrivenPart
    from ..core.language import Sources
    from ..core.lint.finding import Finding
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
    flat: bool = switch(
        "All moves one after the other, each with a speed and a zone of its own; without it loops "
        "and routines are kept whose moves differ in evenly moved or handed over targets alone."
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
    spoken = after.vendor.speaks
    keep = not options.flat and spoken is not None and spoken.structure
    program = _with_second_cycle(program) if keep else _with_first_cycle(program)
    options.say(f"translating {counted(program.moves, 'move')}")
    return carried(program, before, after, options.base, keep)


translate = by_keywords(translate_with, TranslateOptions)


def _with_first_cycle(program: Program) -> Program:
    """A program without the pass that was read to know how a cycle begins."""
    from ..core.program.folding import with_one_cycle
    from ..core.source.reading import Reading

    reading = program.reading
    asked = isinstance(reading, Reading) and reading.options.answers.cycles > 1
    return program if asked else with_one_cycle(program)


def _with_second_cycle(program: Program) -> Program:
    """A program that runs in a loop without an end, read for two passes if both are alike.

    How the robot comes from the end of a pass to its beginning is then known.
    """
    from ..core.program.folding import alike, usable
    from ..core.source.reading import Reading

    reading = program.reading
    once = any(s.endless and len(s.passes) == 1 for s in usable(program))
    if not once or not isinstance(reading, Reading) or reading.again({}) != program:
        return program
    answers = replace(reading.options.answers, cycles=2)
    twice = replace(reading, options=replace(reading.options, answers=answers)).again({})
    loops = [s for s in usable(twice) if s.endless and len(s.passes) == 2]
    if not loops or not all(alike(twice.statements, s) for s in loops):
        return program
    return replace(twice, setup=program.setup)


def written(made: Translation) -> Sources:
    """The source files of a translation, which have been read again and driven.

    Raises:
        FlybyError: the language cannot say what the program holds.
        MotionError: the new robot cannot drive what is written; the line of the old program is
            named.
    """
    from ..core.translation.hand_out import check_driven

    program, setup = made.program, setup_of_program(made.program)
    sources = setup.vendor.write(program, setup.robot, made.options)

    def around(again: Program, parts: Sequence[DrivenPart]) -> list[Finding]:
        return clearance_findings(CellCourse(again, again, setup), setup, parts)

    check_driven(made, sources, setup.vendor, setup.robot, around)
    return sources


def _cell_of(before: Setup, after: Setup, place: Pose) -> Cell | None:
    """What stands around the old robot, round the new one: what an axis moves or the robot picks
    is left out.

    Args:
        place: the new robot's world in the old one's.
    """
    from ..core.cell.cell import Cell

    cell = before.cell
    if cell is None:
        return None
    back = place.inverse()
    obstacles = (
        replace(o, geometry=replace(o.geometry, placement=back @ o.geometry.placement))
        for o in cell.obstacles
        if o.carried_by is None
    )
    return Cell(
        after.robot,
        after.vendor.name,
        tools=cell.tools,
        tool_geometries=cell.tool_geometries,
        obstacles=tuple(obstacles),
        allowed=cell.allowed,
    )


def place_of(options: TranslateOptions, before: Setup) -> Pose:
    """The new robot's world in the old one's.

    Args:
        options: that may say it.
        before: the old robot.
    """
    return _placed(options.base, before)


def _placed(base: str | Pose | None, before: Setup) -> Pose:
    return before.robot.base if base is None else pose(base, "base")


def carried(
    program: Program,
    before: Setup,
    after: Setup,
    base: str | Pose | None = None,
    keep: bool = False,
) -> Translation:
    """The program for another robot.

    Args:
        program: for the robot that there is.
        before, after: the robots.
        base: the new robot's world in the old one's; None if it stands where the old one does.
        keep: whether loops and routines are kept.

    Raises:
        MotionError: the translation must refuse; the message names move and line.
    """
    from ..core.source.reading import Reading
    from ..core.translation.signals import SignalMap
    from ..core.translation.translate import translate

    reading = program.reading
    answers = reading.options.answers.signals if isinstance(reading, Reading) else {}
    place = _placed(base, before)
    made = translate(
        program,
        (before.vendor, before.robot),
        (after.vendor, after.robot),
        place,
        keep,
        SignalMap.of(answers),
        start_of(program),
    )
    after = replace(after, cell=_cell_of(before, after, place))
    return replace(made, program=replace(made.program, setup=after))
