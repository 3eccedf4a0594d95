"""Programs driven as the robot's controller would."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..core.display import counted
from ..core.door import spelt
from ..core.errors import FaultCause, MotionError, Note
from .fitting import arms_that_fit
from .options.entries import TIME, Extent, number, switch
from .options.keywords import by_keywords
from .results.cell_course import CellCourse
from .setup import RobotOptions, Setup, start_of, with_setup

if TYPE_CHECKING:
    from ..core.driving.driven_program import DrivenProgram
    from ..core.motion.emulator.controller import Controller
    from ..core.program.program import Program
    from .results.runs import Run

PERIODS = Extent(1e-5, 1.0)
"""s. At the least a cycle of a minute makes six million samples; beyond 1 it was meant in ms."""


@dataclass(frozen=True, kw_only=True)
class EmulateOptions(RobotOptions):
    """How a program is emulated."""

    strict: bool = switch("Stop at the first move that cannot be driven.")
    period: float | None = number(
        None,
        "Seconds between samples; the controller's own if unset.",
        TIME,
        PERIODS,
    )


def emulate_with(program: Program, options: EmulateOptions) -> Run:
    """Drive a program as the robot's controller would: cycle time, path, what limits each move.

    A move that cannot be driven is a fault of the result; the robot goes on behind it.

    Args:
        program: as `flyby.read` gives it, or built of moves.

    Raises:
        MotionError: no move can be driven, or with ``strict`` any cannot; the message names it.
        InputError: nobody says which robot, or a statement both takes a part of the cell and lets
            go of it.
    """
    from ..core.driving.assumed_figures import duration_range
    from ..core.driving.driven_program import refusal
    from ..core.motion.emulator.controller import Controller
    from ..core.motion.emulator.move_figures import load_notes, range_notes
    from .results.runs import Run

    program, setup = with_setup(program, options)
    options.say(f"emulating {counted(program.moves, 'move')}")
    controller = Controller(setup.vendor, setup.robot)
    program, course, driven = _driven(program, setup, controller, options)
    if options.strict and driven.faults:
        raise refusal(driven.faults)
    noted = tuple(
        replace(part, run=replace(part.run, notes=(*part.run.notes, *more)))
        for part in driven.parts
        for more in [
            range_notes(part.run, controller.model) + load_notes(part.run, controller.model)
        ]
    )
    options.say("measuring clearances")
    clearances, odd = course.clearances(setup, noted)
    misfit = _misfit(program, setup) if driven.faults else ()
    own = replace(program, notes=(*program.notes, *course.notes, *odd, *misfit))
    ranges = [duration_range(controller, part.run) for part in driven.parts]
    known = [found for found in ranges if found is not None]
    between = (sum(least for least, _ in known), sum(most for _, most in known)) if known else None
    whole = replace(driven, program=own, parts=noted)
    return Run.of(whole, setup.robot, clearances, between)


def _driven(
    program: Program, setup: Setup, controller: Controller, options: EmulateOptions
) -> tuple[Program, CellCourse, DrivenProgram]:
    """A program as it is driven, its course among the cell's parts, and what can be driven."""
    from ..core.driving.past_faults import drive

    course = CellCourse.of(program, setup)
    failed: MotionError | None = None
    try:
        driven = drive(controller, course.program, start_of(program), options.period)
        if not driven.faults or options.strict:
            return program, course, driven
    except MotionError as error:
        failed = error
    if not options.strict and not program.placed:
        put = _with_places(program, setup, controller)
        if put.placed:
            return _driven(put, setup, controller, options)
    if failed is not None:
        raise _with_others(failed, program, setup) from failed
    return program, course, driven


def _with_places(program: Program, setup: Setup, controller: Controller) -> Program:
    """A program whose unknown tools and work objects are put to where the robot drives it, if it
    does not drive it with the controller's own; and that they are."""
    from ..core.driving.fitting_frames import frames_that_fit, placed
    from ..core.language import FrameAnswers
    from ..core.program.assumed_places import assumed_places
    from ..core.source.execution.answers_text import answer_text

    says = setup.vendor.reader
    if not isinstance(says, FrameAnswers) or not assumed_places(program):
        return program
    found = frames_that_fit(controller, program, start_of(program))
    notes: list[Note] = []
    for question in program.questions:
        pose = found.get(question.key)
        if pose is None or question.example is None:
            continue
        answer = says.frame_answer(question.example, pose)
        notes.append(
            Note(
                f"{question.key} is not known, and the robot does not drive the program with the "
                f"controller's own: {answer_text(answer)} is taken, an example with which it "
                f"drives more of it; say what it is in a file ({spelt('answers')})",
                span=question.span,
            )
        )
    if not notes:
        return program
    return replace(placed(program, found), notes=(*program.notes, *notes))


def _misfit(program: Program, setup: Setup) -> tuple[Note, ...]:
    """That the robot that is named may not be the program's: others can take all its places."""
    if setup.cell is not None or setup.backup is not None:
        return ()
    said = arms_that_fit(program, setup.vendor, setup.robot)
    stands = f"is it the right one, and does it stand in the world's origin ({spelt('cell')})?"
    return (Note(f"{said}: {stands}"),) if said else ()


def _with_others(error: MotionError, program: Program, setup: Setup) -> MotionError:
    """The same error, with what is to be said of the robot."""
    if error.cause not in (FaultCause.REACH, FaultCause.LIMIT):
        return error
    notes = (str(note) for note in _misfit(program, setup))
    message = "; ".join((error.message, *notes))
    return type(error)(message, error.move, error.span, error.cause)


emulate = by_keywords(emulate_with, EmulateOptions)
