"""Changed files with all that they run with, ready to be put into a folder."""

from __future__ import annotations

from pathlib import PurePath

from ...program.program import Program
from ..reading import Files, Reading, named_apart
from .edits import PARTS, reading_of


def runnable_files(original: Program, changed: Files) -> dict[str, bytes]:
    """Contents of files by their path in a folder.

    Args:
        original: as it was read.
        changed: as a patch or a writer hands them out; none for the original itself.

    Raises:
        InputError: the original was not read from source files, or a text cannot be encoded.
    """
    reading = reading_of(original)
    changed = changed or {reading.main: reading.files[reading.main]}
    if all(file.name in reading.files for file in changed.values()):
        changed = {file.name: file for file in changed.values()}
        changed = named_apart({**_needed(original, reading, changed), **changed})
    return {name: file.data for name, file in changed.items()}


def _needed(program: Program, reading: Reading, changed: Files) -> Files:
    """The files that a program cannot run without, as they were read.

    These are the file with the entry, those whose motions are driven and whose numbers they read,
    and all that are called like one of them: a ``.dat`` belongs to its ``.src``.
    """
    needed = {reading.main, *changed}
    for move in program.moves:
        if move.origin is not None:
            parts = (getattr(move.origin, kind) for kind in PARTS)
            spans = [span for part in parts if part is not None for span in part.numbers]
            needed |= {span.file for span in (move.origin.statement, *spans) if span is not None}
    stems = set(map(_stem, needed))
    return {name: file for name, file in reading.files.items() if _stem(name) in stems}


def _stem(file: str) -> str:
    return str(PurePath(file).with_suffix("")).casefold()
