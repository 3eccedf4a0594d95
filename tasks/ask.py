"""What a program asks of the world that no file says, all at once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .guess import read_or_guess
from .options.keywords import by_keywords
from .read import SourceOptions

if TYPE_CHECKING:
    from .results.questions import Questions


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
    return Questions.of(program.questions, name)


ask = by_keywords(ask_with, SourceOptions)
