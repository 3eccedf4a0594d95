"""Programs that a command reads for a robot which nobody names: it says which it takes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...tasks.read import SourceOptions, read_with
from .console import warn_of

if TYPE_CHECKING:
    from ...core.program.program import Program


def read_for_robot(program: Path, source: SourceOptions, *, writes: bool = False) -> Program:
    """A program, for the robot that is named or else for one that it may be for.

    Args:
        writes: whether a program is written; then somebody has to say which robot it is.
    """
    from ...tasks.options.guessed_robot import with_robot

    source, notes = with_robot(program, source, writes=writes)
    warn_of(notes)
    return read_with(program, source)
