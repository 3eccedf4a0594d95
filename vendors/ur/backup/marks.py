"""Where programs of UR controllers begin among files: by what the files end with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from ..urp.file_names import INSTALLATION, POLYSCOPE_X, PROGRAM

MARKS = (PROGRAM, INSTALLATION, POLYSCOPE_X)


def root_in(names: Sequence[str]) -> str | None:
    """The outermost folder with a program or an installation; a script alone marks nothing."""
    marking = [
        PurePosixPath(name) for name in names if PurePosixPath(name).suffix.casefold() in MARKS
    ]
    if not marking:
        return None
    folders = [path.parent for path in marking]
    folder = min(folders, key=lambda one: len(one.parts))
    return "" if folder == PurePosixPath(".") else folder.as_posix()
