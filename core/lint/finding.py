"""What a check has to say, and how a rule says it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Generic, TypeVar

from ..errors import Span
from ..program.program import Program

if TYPE_CHECKING:
    from ..dialect import Wording
    from ..motion.emulator.run import Run
    from ..robot.model import Robot

Subject = TypeVar("Subject")


class Severity(StrEnum):
    """How much a finding matters, the worst first."""

    ERROR = "error"
    """The robot stops with a fault, or leaves out what is programmed."""
    WARNING = "warning"
    """The robot does something else than the program seems to want."""
    INFO = "info"
    """Worth knowing."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that a rule found.

    Args:
        rule: its id.
        severity: how much it matters.
        message: what is so.
        fix: what to do about it.
        move: index of the move concerned, from 0; None if it is no move.
        span: where in the source; None if the program was built in Python.
        size: how bad it is, of what a line in a loop shows every time in another size; None if
            every message counts.
    """

    rule: str
    severity: Severity
    message: str
    fix: str
    move: int | None = None
    span: Span | None = None
    size: float | None = None


@dataclass(frozen=True, slots=True)
class ProgramSubject:
    """What rules on the text look at.

    Args:
        program: the program.
        robot: whose.
        wording: how the language's text is searched; None if it is not.
    """

    program: Program
    robot: Robot
    wording: Wording | None = None


@dataclass(frozen=True, slots=True)
class RunSubject:
    """What rules on the emulated motion look at; moves are those of ``run.program``.

    Args:
        run: the emulated program.
        robot: whose.
    """

    run: Run
    robot: Robot

    @property
    def program(self) -> Program:
        """The program that was run."""
        return self.run.program


@dataclass(frozen=True, slots=True)
class Hit:
    """A place where a rule applies: move, or span of what is no move; see `Finding`."""

    message: str
    fix: str
    move: int | None = None
    span: Span | None = None
    size: float | None = None


@dataclass(frozen=True, slots=True)
class Rule(Generic[Subject]):
    """One rule.

    Args:
        id: its name in reports.
        severity: of all its findings.
        summary: what it looks for, in one line.
        hits: finds the places.
    """

    id: str
    severity: Severity
    summary: str
    hits: Callable[[Subject], Iterator[Hit]]

    def findings(self, subject: Subject, program: Program) -> Iterator[Finding]:
        """The findings in a program."""
        for hit in self.hits(subject):
            span = hit.span
            if span is None and hit.move is not None:
                origin = program.moves[hit.move].origin
                span = None if origin is None else origin.statement
            yield Finding(self.id, self.severity, hit.message, hit.fix, hit.move, span, hit.size)
