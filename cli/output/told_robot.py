"""Programs that a command reads for a robot, and what it says of them that nobody else does: which
robot is taken, and what else."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...tasks.read import SourceOptions, read_with
from .console import warn, warn_of

if TYPE_CHECKING:
    from ...core.program.program import Program


def read_for_robot(
    program: Path, source: SourceOptions, *, writes: bool = False, told: bool = True
) -> Program:
    """A program, for the robot that is named or else for one that it may be for.

    Args:
        writes: whether a program is written; then somebody has to say which robot it is.
        told: whether it is said what is not known, as what is proven is of what that is taken for.
    """
    from ...tasks.options.guessed_robot import with_robot

    source, notes = with_robot(program, source, writes=writes)
    warn_of(notes)
    read = read_with(program, source)
    if told:
        _tell_unknown(read)
    return read


def _tell_unknown(program: Program) -> None:
    from ...core.program.question import QuestionKind
    from ...core.source.execution.answers_text import grouped

    # What takes time alone changes nothing of where the robot goes.
    asked = grouped([one for one in program.questions if one.kind is not QuestionKind.PAUSE])
    if asked:
        warn(
            f"not known: {'; '.join(asked)}: what is said here, and proven, is of the program as "
            "it is taken to run; --io says it otherwise (`flyby ask` writes a file for it)"
        )
