"""What a program asks of the world that no file says, all at once."""

from __future__ import annotations

import shlex
from contextlib import suppress
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.door import spelt
from ..core.errors import EntryError, FlybyError, InputError
from ..core.program.entry_point import ALL
from .options.guessed_robot import with_robot
from .options.keywords import by_keywords
from .read import SourceOptions, read_with
from .setup import setup_of_program, start_of

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.program.question import Question
    from .results.questions import Questions


def next_command(questions: Questions, program: Path, out: Path, options: SourceOptions) -> str:
    """The command that drives a program with the file of what it asks, as it is typed.

    Args:
        questions: of the program.
        out: the file.
        options: with which it was asked.
    """
    words = ["flyby", "emulate", str(program)]
    if options.cell is not None:
        words += ["--cell", str(options.cell)]
    elif questions.robot and options.task is None:
        words += ["--robot", questions.robot]
    for name in ("vendor", "motion", "machine_data", "configuration", "entry", "task", "start"):
        value = getattr(options, name)
        words += [] if value is None else [spelt(name), str(value)]
    if options.cycles != 1:
        words += [spelt("cycles"), str(options.cycles)]
    for other in options.others:
        words += ["--with", str(other)]
    return shlex.join([*words, "--io", str(out)])


def ask_with(source: str | Path, options: SourceOptions) -> Questions:
    """What a program asks that no file says: signals, dialogs, data, routines, loops, branches.

    It is read with everything unknown at its default; of one that begins nowhere in particular,
    and of the entry ``all``, each routine that moves the robot.

    Args:
        source: a file, a folder that holds one program, or a text of several lines.

    Returns:
        One entry for each thing, and all of them as a file of answers: ``questions.toml``.

    Raises:
        InputError: no robot is named, or the file is no program of its vendor.
        SourceError: the text cannot be read; file, line and column are named.
    """
    from ..core.source.reading import Reading
    from .results.questions import Questions

    programs = _read(source, options)
    first, reading = programs[0], programs[0].reading
    name = Path(reading.main).name if isinstance(reading, Reading) else first.name
    named = "" if first.setup is None or _in_backup(first) else first.setup.robot.name
    asked: dict[tuple[str, str], Question] = {}
    for question in chain.from_iterable(map(_with_examples, programs)):
        asked.setdefault((question.table, question.key), question)
    return Questions.of(tuple(asked.values()), name, named)


def _read(source: str | Path, options: SourceOptions) -> list[Program]:
    """A program; where it begins nowhere in particular, or that is asked for, each of its routines
    that moves the robot and can be read.

    Raises:
        FlybyError: it cannot be read, or none of them can.
    """
    options, _ = with_robot(source, options)
    if options.entry != ALL:
        with suppress(EntryError):
            return [read_with(source, options)]
    entries = read_with(source, replace(options, entry=ALL)).entries
    moving = [replace(options, entry=entry.name) for entry in entries if entry.moves]
    found: list[Program] = []
    for one in moving:
        try:
            found.append(read_with(source, one))
        except FlybyError:
            if one is moving[-1] and not found:
                raise
    if not found:
        raise InputError(f"{source}: no routine in it moves the robot: there is nothing to ask")
    return found


def _in_backup(program: Program) -> bool:
    """Whether a program's robot is that of its backup, which needs no name."""
    return setup_of_program(program).backup is not None


def _with_examples(program: Program) -> tuple[Question, ...]:
    """What a program asks, with examples that it is driven with."""
    from ..core.driving.fitting_answers import answers_that_fit

    asked = _with_places(program)
    open_ = [q for q in asked if q.table == "values" and not q.answered and q.taken is None]
    fitting = answers_that_fit(program, open_)
    return tuple(replace(q, example=fitting.get(q.key, q.example)) for q in asked)


def _with_places(program: Program) -> tuple[Question, ...]:
    """What a program asks; unknown tools and frames that keep it from being driven are taken for
    what lets it be driven."""
    from ..core.driving.fitting_frames import frames_that_fit
    from ..core.language import FrameAnswers
    from ..core.motion.emulator.controller import Controller
    from ..core.source.execution.answers_text import FOUND

    setup = setup_of_program(program)
    says = setup.vendor.reader
    if not isinstance(says, FrameAnswers):
        return program.questions
    found = frames_that_fit(Controller(setup.vendor, setup.robot), program, start_of(program))
    asked: list[Question] = []
    for question in program.questions:
        pose = found.get(question.key)
        if pose is not None and question.table == "values" and question.example is not None:
            example = says.frame_answer(question.example, pose)
            if example is not None:
                said = f"{FOUND}: with it {setup.robot.name} drives more of the moves"
                question = replace(question, taken=example, example=example, meanwhile=said)
        asked.append(question)
    return tuple(asked)


ask = by_keywords(ask_with, SourceOptions)
