"""Changed files with all that they run with, ready to be put into a folder."""

from __future__ import annotations

from ...program.program import Program
from ..reading import Files, named_apart
from .edits import reading_of, runnable_set


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
        changed = named_apart(runnable_set(original, changed))
    return {name: file.data for name, file in changed.items()}
