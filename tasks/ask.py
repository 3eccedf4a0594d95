"""What a program asks of the world that no file says, all at once."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.door import spelt
from .options.guessed_robot import read_or_guess
from .options.keywords import by_keywords
from .read import SourceOptions
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

    It is read with everything unknown at its default.

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

    program = read_or_guess(source, options)
    reading = program.reading
    name = Path(reading.main).name if isinstance(reading, Reading) else program.name
    named = "" if program.setup is None or _in_backup(program) else program.setup.robot.name
    return Questions.of(_with_places(program), name, named)


def _in_backup(program: Program) -> bool:
    """Whether a program's robot is that of its backup, which needs no name."""
    return setup_of_program(program).backup is not None


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
