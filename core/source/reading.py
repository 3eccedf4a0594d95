"""How a program is read, and read again when its text has changed."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from ..display import counted, in_line
from ..door import spelt
from ..errors import FlybyError, Note, OptionError, SourceError, Span
from ..program.move import Opaque, Wait
from ..program.question import QuestionKind
from .execution.answers import Answers, stands_in
from .execution.course import AnswerError
from .execution.limits import EndlessError, Executed, ExecutionLimits
from .text.files import SourceFile, stray_return, wide_file

if TYPE_CHECKING:
    from ..program.program import Program
    from ..program.target import JointTarget
    from ..robot.model import Robot

Files = Mapping[str, SourceFile]
"""Source files by name."""

_TRIED = 12
"""Conditions, and branches of each, that are tried for one whose moves are known."""
_TRIES = 100_000
"""Lines that are read, and statements that are executed, for that."""


@dataclass(frozen=True)
class ReadOptions:
    """What a reader may want to know beside the text.

    Args:
        entry: the routine to run; None for the one that the vendor's controllers would start.
        robot: whose kinematics answer what the program asks of its own position, and whose
            external axes it moves; None if none is at hand.
        answers: to what the program asks of the world.
        limits: how much is executed.
        others: further files of the program: modules, subprograms, data lists, configuration.
            Files that stand beside the program and belong to it by their vendor's rules are found
            without being named.
        beside: the files that may stand beside the program, where a backup says so; None to look
            for them on the disk.
        executed: called with every statement that is executed.
        signals: what the controller's signals are, by their names in lower case, where a backup
            says so: ``"digital input"``.
        start: where the robot stands before the first move; None if nobody knows. What the program
            asks of its own position begins there.

    Raises:
        OptionError: the answers are none.
    """

    entry: str | None = None
    robot: Robot | None = None
    answers: Answers = field(default_factory=Answers)
    limits: ExecutionLimits = field(default_factory=ExecutionLimits)
    others: tuple[Path, ...] = ()
    beside: tuple[Path, ...] | None = None
    executed: Executed | None = field(default=None, repr=False, compare=False)
    start: JointTarget | None = None
    signals: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not isinstance(self.answers, Answers):
            raise OptionError(
                f"answers are Answers, not {type(self.answers).__name__}: values by their keys are "
                'Answers({"dostart": 1.0})'
            )


@dataclass(frozen=True)
class Reading:
    """One reading of source files: what was read, and how to do it again.

    Args:
        files: all files that were read, by the names that spans use.
        main: the one with the entry.
        options: how.
        read: reads files; a vendor's function. It opens no other file.
    """

    files: Files
    main: str
    options: ReadOptions
    read: Callable[[Files, str, ReadOptions], Program] = field(repr=False)

    def __repr__(self) -> str:
        return in_line(f"Reading of {self.main}: {counted(self.files, 'file')}")

    def again(self, changed: Files) -> Program:
        """The program in the same files, of which some have another text.

        Args:
            changed: files of the names that they were read by, under whatever keys; others are no
                part of the program.

        Raises:
            FlybyError: it cannot be read any more.
        """
        others = {file.name: file for file in changed.values() if file.name in self.files}
        reading = replace(self, files={**self.files, **others})
        program = reading.read(reading.files, reading.main, reading.options)
        return replace(program, reading=reading)


def named_apart(files: Files) -> Files:
    """Files under names that lead nowhere but into the folder they are written to.

    A file is called as it is without its folders; where two would be called alike, with the
    folders below those that all files have in common.
    """
    plain = {PurePath(file.name).name: file for file in files.values()}
    if len(plain) == len(files):
        return plain
    paths = {os.path.abspath(file.name): file for file in files.values()}
    common = os.path.commonpath([os.path.dirname(path) for path in paths])
    return {PurePath(os.path.relpath(path, common)).as_posix(): f for path, f in paths.items()}


def read_with(
    files: Files,
    main: str,
    options: ReadOptions,
    read: Callable[[Files, str, ReadOptions], Program],
) -> Program:
    """Read, and leave with the program how it was read.

    Args:
        files: source files by name.
        main: name of the one with the entry.
        options: how.
        read: a vendor's function from files to a program.
    """
    program = _to_known_places(files, main, options, read)
    told = (say(file) for file in files.values() for say in (wide_file, stray_return))
    odd = [note for note in told if note is not None]
    if any(note.span is not None and note.span.file != main for note in odd):
        own = _files_of(program, main)
        odd = [note for note in odd if note.span is None or note.span.file in own]
    reading = Reading(dict(files), main, options, read)
    return replace(program, notes=(*program.notes, *odd), reading=reading)


def _files_of(program: Program, main: str) -> frozenset[str]:
    """Names of the files whose statements or numbers are in a program; others lie beside it."""
    spans = [s.span if isinstance(s, Wait | Opaque) else s.statement for s in program.statements]
    origins = [move.origin for move in program.moves if move.origin is not None]
    for origin in origins:
        for part in (origin.target, origin.speed, origin.zone):
            spans += part.numbers
    return frozenset((main, *(span.file for span in spans if span is not None)))


def _to_known_places(
    files: Files,
    main: str,
    options: ReadOptions,
    read: Callable[[Files, str, ReadOptions], Program],
) -> Program:
    """Read; where moves to what nobody knows leave nothing to drive, or none is reached, another
    branch is taken, if one leads to what is known: of a program that a computer sends commands to,
    one that needs no numbers of it.

    Raises:
        SourceError: it cannot be read.
    """
    executed: list[Span] = []
    noted = replace(options, executed=None if options.executed is None else executed.append)
    program = _to_an_end(files, main, noted, read)
    moving = bool(program.moves) or any(entry.moves for entry in program.entries)
    if options.answers.goes_on and moving and not _is_driven(program, options.start):
        program, executed = _by_another_branch(files, main, options, read, (program, executed))
    if options.executed is not None:
        for span in executed:
            options.executed(span)
    return program


def _by_another_branch(
    files: Files,
    main: str,
    options: ReadOptions,
    read: Callable[[Files, str, ReadOptions], Program],
    first: tuple[Program, list[Span]],
) -> tuple[Program, list[Span]]:
    """The program as it goes with one branch taken otherwise that leads to moves that are known,
    and what is executed of it; what was read first if none does."""
    program, _ = first
    branches = [q for q in program.questions if q.kind is QuestionKind.BRANCH and not q.answered]
    lines, spent = sum(file.text.count("\n") for file in files.values()), 0
    for branch in reversed(branches[-_TRIED:]):
        for number in range(1, _TRIED + 1):
            if spent > _TRIES:
                return first
            executed: list[Span] = []
            answers = options.answers.with_branch(branch.key, number)
            tried = replace(options, answers=answers, executed=executed.append)
            try:
                other = _to_an_end(files, main, tried, read)
            except FlybyError:
                break  # there are no more branches, or nothing can be made of this one
            finally:
                spent += lines + len(executed)
            if number != branch.taken and _is_driven(other, options.start):
                leads = "drives to what nobody knows" if program.moves else "leads to no move"
                message = (
                    f"branch {branch.taken} {leads}: branch {number}, whose moves are known, "
                    "is taken instead"
                )
                note = Note(message, span=branch.span)
                return replace(other, notes=(note, *other.notes)), executed
    return first


def _name_answers(error: SourceError, files: Files, answers: Answers) -> None:
    """Say in an error which answers stand in its line: the program may be right, and they not."""
    span = error.span
    if span is None or span.file not in files or not answers.values:
        return
    lines = files[span.file].text.splitlines()
    line = lines[span.line - 1] if 0 < span.line <= len(lines) else ""
    told = [name for name in answers.values if stands_in(name, line)]
    if told and not isinstance(error, AnswerError):
        error.message += f" ({', '.join(told)} as answered in {answers.file or 'the answers'})"
        error.args = (f"{span}: {error.message}",)


def _is_driven(program: Program, start: JointTarget | None) -> bool:
    """Whether all moves are known, or they lead somewhere."""
    known = bool(program.moves) and not any(move.open for move in program.moves)
    return known or leads_somewhere(program, start)


def leads_somewhere(program: Program, start: JointTarget | None = None) -> bool:
    """Whether a move leads from a place that is known to another one.

    Args:
        start: where the robot stands; None for the first target, if that is known.
    """
    from ..program.move import MoveC

    at: object = start
    for number, move in enumerate(program.moves):
        target = replace(move.target, name=None)
        goes = None if move.open else (target, move.tool.tcp, move.work_object.pose)
        stays = at == goes or (at is start and target == start)
        known = goes is not None and at is not None and not (number == 0 and start is None)
        if known and (not stays or isinstance(move, MoveC)):
            return True
        at = goes
    return False


def _to_an_end(
    files: Files,
    main: str,
    options: ReadOptions,
    read: Callable[[Files, str, ReadOptions], Program],
) -> Program:
    """Read; of loops that go on for more moves than a program may have, one pass is read where
    programs go on behind what nobody knows.

    Raises:
        SourceError: it cannot be read, or goes on for ever.
    """
    while True:
        try:
            return read(files, main, options)
        except SourceError as error:
            if not isinstance(error, EndlessError):
                _name_answers(error, files, options.answers)
                raise
            answers, loop = options.answers, error.loop
            place = None if loop is None else f"{loop.file}:{loop.line}"
            if loop is None or place is None or not answers.goes_on:
                raise
            if answers.at("passes", place) is not None:
                raise
            why = _cut_short(error, answers.cycles) if error.ends else ""
            options = replace(options, answers=answers.with_cut(loop, answers.cycles, why))


def _cut_short(error: EndlessError, driven: int) -> str:
    """Why no more than some passes of a loop are driven, and what would drive more of them."""
    assert error.loop is not None
    place = f"{PurePath(error.loop.file).name}:{error.loop.line}"
    passes = "one pass is" if driven == 1 else f"{driven} passes are"
    return (
        f"the loop goes on for more moves than are read ({error.what}): {passes} driven, and no "
        f"time is claimed for the others; say in a file ({spelt('answers')}) how many are driven: "
        f'[passes] "{place}" = …'
    )
