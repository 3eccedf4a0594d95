"""Every error that a user can cause, and the warnings that travel with a result.

An error says what is wrong, where (file, line and column; move; joint) and what to do.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class FlybyError(Exception):
    """Base of every error that input from outside can cause."""


class InputError(FlybyError):
    """A value, file or option from outside cannot be used."""


class OptionError(InputError):
    """An option or an argument that is wrong by itself, whatever the files hold."""


_OFFERED = 20
"""Names that a message lists at most."""


class UnknownNameError(InputError):
    """A name that nothing answers to; the message offers the nearest known ones.

    Args:
        kind: what was looked up, e.g. ``"robot"``.
        name: the name asked for.
        known: the names that exist.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        known = sorted(known)
        folded = {other.casefold(): other for other in known}
        matches = difflib.get_close_matches(name.casefold(), folded, n=3, cutoff=0.4)
        near = [folded[match] for match in matches]
        if near:
            offer = f"did you mean {' or '.join(repr(n) for n in near)}?"
        elif known:
            more = f" and {len(known) - _OFFERED} more" if len(known) > _OFFERED else ""
            offer = f"known: {', '.join(known[:_OFFERED])}{more}"
        else:
            offer = "none is known"
        super().__init__(f"unknown {kind} {name!r}: {offer}")
        self.kind = kind
        self.name = name


class Span(NamedTuple):
    """A stretch of a source file; lines and columns count from 1, offsets (characters) from 0.

    A tuple, since reading makes one for every number of a program.
    """

    file: str
    line: int
    column: int
    start: int
    end: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class SourceError(FlybyError):
    """A program text cannot be read, understood or written; ``span`` says where."""

    def __init__(self, message: str, span: Span | None = None) -> None:
        super().__init__(f"{span}: {message}" if span is not None else message)
        self.message = message
        self.span = span


class PluginFault(SourceError):
    """A plugin fails at a place of a program; what it raised is the cause."""

    @classmethod
    def of(cls, what: str, error: Exception, span: Span | None = None) -> PluginFault:
        """What failed, with the exception and where it was raised."""
        if isinstance(error.__cause__, StopIteration):  # a generator says it in words of its own
            error = error.__cause__
        last = error.__traceback__
        while last is not None and last.tb_next is not None:
            last = last.tb_next
        code = None if last is None else last.tb_frame.f_code
        at = "" if code is None or last is None else f", {code.co_filename}:{last.tb_lineno}"
        hint = "; what a text does wrong is an InputError" if isinstance(error, ValueError) else ""
        return cls(f"{what} fails: {type(error).__name__}: {error}{at}{hint}", span)


class EntryError(SourceError):
    """Nobody says with which routine a program begins, and none is clearly the first."""


class LeftOpenError(SourceError):
    """What a statement does depends on what only the running controller knows."""


class LostError(LeftOpenError):
    """What a statement does depends on what a damaged line would have said."""


class StopError(SourceError):
    """What the running controller ends a program with: no item has an index, nothing is divided by
    zero."""


class ParseError(SourceError):
    """A text is not written in its language: it is wrong or cut off at a place."""


class FaultCause(StrEnum):
    """Why a robot cannot drive a move, in one word."""

    REACH = "reach"
    """The target, or a place on the way, is out of reach."""
    LIMIT = "joint limit"
    """A joint would pass its limit."""
    SINGULARITY = "singularity"
    """The path passes a singular configuration, or too near to one."""
    CONFIGURATION = "configuration"
    """The programmed configuration contradicts the pose, or the path."""
    NOWHERE = "no motion"
    """Every move ends where the robot stands."""
    OPEN = "not known"
    """Nobody knows where it goes: a datum that nothing sets, a message of a sensor."""
    ERROR = "program error"
    """The program makes an error there, at which the controller stops it."""
    OTHER = "refused"
    """Points that make no arc, values that no robot has, zones that contradict each other."""


class MotionError(FlybyError):
    """A program that reads well but that the robot cannot drive.

    Args:
        message: what is wrong and what to do.
        move: index of the move in ``Program.moves`` (from 0); messages count from 1.
        span: where the move stands in its source, if known.
        cause: in one word.
    """

    def __init__(
        self,
        message: str,
        move: int | None = None,
        span: Span | None = None,
        cause: FaultCause = FaultCause.OTHER,
    ) -> None:
        where = "" if span is None else f"{span}: "
        if move is not None:
            where += f"move {move + 1}: "
        super().__init__(where + message)
        self.message = message
        self.move = move
        self.span = span
        self.cause = cause


@dataclass(frozen=True, slots=True)
class Note:
    """Something a user should know that is no error: a zone cut short, a statement stepped over.

    Args:
        message: one sentence.
        move: index of the move concerned, from 0.
        span: where in the source.
        asked: whether it is about something that the program asks, and that is listed among its
            questions.
        damage: whether it is about text that no controller takes, and that was stepped over.
    """

    message: str
    move: int | None = None
    span: Span | None = None
    asked: bool = False
    damage: bool = False

    def __str__(self) -> str:
        where = "" if self.span is None else f"{self.span}: "
        if self.move is not None:
            where += f"move {self.move + 1}: "
        return where + self.message
