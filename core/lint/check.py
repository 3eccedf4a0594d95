"""Checks a program: rules on its text, then on its emulated motion."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from ..door import spelt
from ..driving.driven_program import DrivenPart
from ..driving.past_faults import drive
from ..errors import EntryError, FaultCause, FlybyError, MotionError, SourceError
from ..motion.emulator.controller import Controller
from ..program.assumed_places import assumed_places
from ..program.program import Program
from ..program.target import JointTarget
from ..robot.model import Robot
from ..vendor import Vendor
from .finding import Finding, ProgramSubject, Rule, RunSubject, Severity
from .program_rules import PROGRAM_RULES
from .run_rules import RUN_RULES

CANNOT_DRIVE = "cannot-drive"
CANNOT_READ = "cannot-read"
COLLISION, CLEARANCE, NEAREST, PART = "collision", "clearance", "nearest", "part"


@dataclass(frozen=True, slots=True)
class OtherRules:
    """Rules that plugins add to flyby's own."""

    of_program: tuple[Rule[ProgramSubject], ...] = ()
    of_run: tuple[Rule[RunSubject], ...] = ()


_NONE = OtherRules()


def rules() -> dict[str, tuple[Severity, str]]:
    """Severity and summary of every rule of flyby's own by its id."""
    known: list[Rule[ProgramSubject] | Rule[RunSubject]] = [*PROGRAM_RULES, *RUN_RULES]
    own = {
        CANNOT_READ: (Severity.ERROR, "text that cannot be read"),
        CANNOT_DRIVE: (Severity.ERROR, "moves that the robot cannot drive"),
        COLLISION: (Severity.ERROR, "bodies of a cell that overlap along a move"),
        CLEARANCE: (Severity.WARNING, "moves that come nearer than the clearance of the cell"),
        NEAREST: (Severity.INFO, "where the robot comes nearest to the cell, and to itself"),
        PART: (Severity.WARNING, "parts of a cell that are not taken or released as it says"),
    }
    return {**own, **{rule.id: (rule.severity, rule.summary) for rule in known}}


def check(
    program: Program,
    vendor: Vendor,
    robot: Robot,
    start: JointTarget | None = None,
    around: Callable[[Sequence[DrivenPart]], Iterable[Finding]] | None = None,
    others: OtherRules = _NONE,
) -> tuple[Finding, ...]:
    """All findings, in the order of the program's text.

    A move that cannot be driven is a finding, and what can be driven is checked all the same.

    Args:
        program: the program.
        vendor, robot: whose it is.
        start: where the robot stands; None for the program's own start, else its first target.
        around: finds what the parts that can be driven meet in their cell; None without one.
        others: rules beside flyby's own.
    """
    wording = None if vendor.speaks is None else vendor.speaks.wording
    subject = ProgramSubject(program, robot, wording)
    found = [
        f for rule in (*PROGRAM_RULES, *others.of_program) for f in rule.findings(subject, program)
    ]
    parts, failures = _driven(program, Controller(vendor, robot), start)
    found += failures
    for part in parts:
        subject_of_run = RunSubject(part.run, robot)
        for rule in (*RUN_RULES, *others.of_run):
            for finding in rule.findings(subject_of_run, part.run.program):
                move = None if finding.move is None else part.first + finding.move
                found.append(replace(finding, move=move))
    if around is not None:
        found += around(parts)
    return tuple(sorted(_once(found), key=_place))


def _once(found: Iterable[Finding]) -> list[Finding]:
    """What a line in a loop shows every time, where it is worst."""
    told: dict[tuple[object, ...], Finding] = {}
    for finding in found:
        what = finding.message if finding.size is None else None
        key = finding.rule, what, finding.span or finding.move
        if key not in told or (finding.size or 0.0) > (told[key].size or 0.0):
            told[key] = finding
    return list(told.values())


def unreadable(error: FlybyError) -> Finding:
    """The finding that a text cannot be read."""
    span = error.span if isinstance(error, SourceError | MotionError) else None
    message = str(error).removeprefix(f"{span}: ") if span is not None else str(error)
    to_do = f"say which ({spelt('entry')})" if isinstance(error, EntryError) else "correct the text"
    return Finding(
        CANNOT_READ,
        Severity.ERROR,
        message,
        f"{to_do}; nothing else was checked",
        None,
        span,
    )


def _driven(
    program: Program, controller: Controller, start: JointTarget | None
) -> tuple[tuple[DrivenPart, ...], list[Finding]]:
    """The parts that can be driven, and why there is not one of all moves."""
    try:
        driven = drive(controller, program, start)
    except MotionError as error:
        nowhere = error.move is None or error.cause is FaultCause.NOWHERE
        fix = _elsewhere() if nowhere else _fix_of(program, error.move)
        span = error.span
        if span is None and error.move is not None:
            span = program.moves[error.move].statement
        move = error.move
        return (), [Finding(CANNOT_DRIVE, Severity.ERROR, error.message, fix, move, span)]
    except FlybyError as error:
        return (), [Finding(CANNOT_DRIVE, Severity.ERROR, str(error), _FIX)]
    return driven.parts, [
        Finding(CANNOT_DRIVE, Severity.ERROR, f.message, _fix_of(program, f.move), f.move, f.span)
        for f in driven.faults
    ]


_FIX = "correct this move"


def _fix_of(program: Program, move: int | None) -> str:
    """What to do of a move that cannot be driven; what nobody has said of it goes first."""
    unknown = () if move is None else assumed_places(program).get(move, ())
    if move is None or not (unknown or program.moves[move].open):
        return _FIX
    what = f"what {' and '.join(unknown)} {'is' if len(unknown) == 1 else 'are'}"
    asked = f"say {what if unknown else 'where it goes'} in a file ({spelt('answers')}"
    return f"{asked}; `flyby ask` writes one), or {_FIX}"


def _elsewhere() -> str:
    return f"let the robot begin elsewhere ({spelt('start')}), or correct the program"


def _place(finding: Finding) -> tuple[str, int, int, str]:
    span, move = finding.span, -1 if finding.move is None else finding.move
    if span is None:
        return "", 0, move, finding.rule
    return span.file, span.start, move, finding.rule
