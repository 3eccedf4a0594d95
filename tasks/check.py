"""What is odd about a program, with line, rule and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.errors import FlybyError, MotionError, SourceError, Span
from .options.keywords import by_keywords
from .results.cell_course import CellCourse
from .setup import RobotOptions, Setup, start_of, with_setup

if TYPE_CHECKING:
    from ..core.collision.clearance import Approach
    from ..core.driving.driven_program import DrivenPart
    from ..core.lint.finding import Finding
    from ..core.program.program import Program
    from .results.findings import Findings


@dataclass(frozen=True, kw_only=True)
class CheckOptions(RobotOptions):
    """How a program is checked."""


def check_with(program: Program, options: CheckOptions) -> Findings:
    """Look for what goes wrong, or other than it seems: zones, limits, configurations, speeds.

    Args:
        program: as `flyby.read` gives it.

    Raises:
        InputError: nobody says which robot, or a statement both takes a part of the cell and lets
            go of it.
    """
    from ..core.lint.check import OtherRules
    from ..core.lint.check import check as look
    from .catalogue import registry
    from .results.findings import Findings

    program, setup = with_setup(program, options)
    course = CellCourse.of(program, setup)

    def around(parts: Sequence[DrivenPart]) -> list[Finding]:
        return [*_part_findings(course), *clearance_findings(course, setup, parts)]

    start = start_of(program)
    offers = registry().offers
    others = OtherRules(tuple(offers.program_rules.values()), tuple(offers.run_rules.values()))
    return Findings(look(course.program, setup.vendor, setup.robot, start, around, others))


check = by_keywords(check_with, CheckOptions)


def _part_findings(course: CellCourse) -> list[Finding]:
    from ..core.lint.check import PART

    fix = "correct the part in the cell file (attach, release, near_mm, pose), or the program"
    return [
        _finding(course, PART, note.message, fix, note.move, note.span) for note in course.notes
    ]


def clearance_findings(
    course: CellCourse, setup: Setup, parts: Sequence[DrivenPart]
) -> list[Finding]:
    """Moves that come too near, and where all of them come nearest."""
    found, notes = course.clearances(setup, parts)
    if setup.cell is None or not (found or notes):
        return []
    from ..core.collision.clearance import nearest_of
    from ..core.collision.scene.allowed_pairs import robot_notes
    from ..core.lint.check import CLEARANCE, COLLISION, NEAREST

    allow = "or let them touch: [allow] pairs in the cell file"
    worst: dict[tuple[object, ...], Approach] = {}
    for move in found:
        for side in (move.cell, move.own):
            if side is not None and (side.overlaps or side.distance < setup.cell.clearance):
                # Of a line in a loop the worst pass counts.
                place = course.program.moves[side.move].statement or side.move
                key = side is move.own, side.overlaps, place
                worst[key] = min(worst.get(key, side), side, key=lambda met: met.distance)
    told = []
    for met in worst.values():
        if met.overlaps:
            message = str(met).removeprefix("none, ")
            fix = f"move the targets, the obstacle or the part, {allow}"
            told.append(_finding(course, COLLISION, message, fix, met.move))
        else:
            message = (
                f"{' and '.join(met.pair)} come within {1e3 * met.distance:.1f} mm, "
                f"{1e3 * setup.cell.clearance:g} mm are to be kept"
            )
            fix = f"move the targets, ask for less (clearance_mm), {allow}"
            told.append(_finding(course, CLEARANCE, message, fix, met.move))
    sides = zip(("to the cell", "between the arm's own parts"), nearest_of(found), strict=True)
    for what, least in sides:
        if least is not None:
            message = f"clearance {what}: {least}"
            told.append(
                _finding(course, NEAREST, message, "nothing, if that is enough", least.move)
            )
    allowed = {note.message for note in robot_notes(setup.robot)}
    for note in notes:
        fix = (
            "nothing, if that file is right"
            if note.message in allowed
            else "complete the cell file"
        )
        told.append(_finding(course, NEAREST, note.message, fix, note.move, note.span))
    return told


def _finding(
    course: CellCourse,
    rule: str,
    message: str,
    fix: str,
    move: int | None,
    span: Span | None = None,
) -> Finding:
    from ..core.lint.check import rules
    from ..core.lint.finding import Finding

    if span is None and move is not None:
        span = course.program.moves[move].statement
    return Finding(rule, rules()[rule][0], message, fix, move, span)


def unread(error: FlybyError) -> Findings:
    """The finding of a program that cannot be read.

    Raises:
        FlybyError: the error itself, where it names no place in a text: a wrong file or option is
            no finding in a program.
    """
    from ..core.lint.check import unreadable
    from .results.findings import Findings

    if not isinstance(error, SourceError | MotionError) or error.span is None:
        raise error
    return Findings((unreadable(error),))
