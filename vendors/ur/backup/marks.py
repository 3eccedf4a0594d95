"""Where programs of UR controllers begin among files: by what the files end with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from ..urp.file_names import INSTALLATION, POLYSCOPE_X, PROGRAM, SCRIPT

MARKS = (PROGRAM, INSTALLATION, POLYSCOPE_X)


def root_in(names: Sequence[str]) -> str | None:
    """The outermost folder with a program or an installation; a script alone marks nothing."""
    return _outermost(names, MARKS)


def scripts_in(names: Sequence[str]) -> str | None:
    """The outermost folder with a script."""
    return _outermost(names, (SCRIPT,))


def _outermost(names: Sequence[str], suffixes: Sequence[str]) -> str | None:
    folders = [path.parent for path in map(PurePosixPath, names) if has_suffix(path, suffixes)]
    if not folders:
        return None
    folder = min(folders, key=lambda one: len(one.parts))
    return "" if folder == PurePosixPath(".") else folder.as_posix()


def has_suffix(path: PurePosixPath, suffixes: Sequence[str]) -> bool:
    """Whether a file's name ends so, in whatever case."""
    return path.suffix.casefold() in suffixes
