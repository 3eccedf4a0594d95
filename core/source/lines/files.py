"""The files that belong to a program: those that it calls, and those that always do."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from ..reading import ReadOptions
from ..text.files import SourceFile, read_source
from .program import routine_key


def with_called(
    path: Path,
    options: ReadOptions,
    suffixes: Iterable[str],
    called: Callable[[str], Iterable[str]],
    always: Iterable[str] = (),
) -> dict[str, SourceFile]:
    """A program's file, and of those beside it the ones that it calls, and that these call.

    Args:
        path: of the program.
        options: name further files, or all that there are.
        suffixes: of programs, in lower case.
        called: names of the programs that a text calls; a file is called as its name says
            (`routine_key`).
        always: names of files, in lower case, that count wherever they stand beside the program.

    Returns:
        The files by name, the program's first.

    Raises:
        InputError: a file cannot be read.
    """
    files = {str(path): read_source(path)}
    named = [file for other in options.others for file in _within(other)]
    near = options.beside if options.beside is not None else _within(path.parent)
    around = [*named, *(file for file in near if file.resolve() != path.resolve())]
    programs: dict[str, Path] = {}
    for file in around:
        if file.suffix.lower() in suffixes:
            programs.setdefault(routine_key(file.stem), file)
        if file.name.lower() in always:
            files.setdefault(str(file), read_source(file))
    waiting = [files[str(path)].text]
    while waiting:
        for name in called(waiting.pop()):
            found = programs.pop(routine_key(name), None)
            if found is not None and str(found) not in files:
                files[str(found)] = read_source(found)
                waiting.append(files[str(found)].text)
    return files


def _within(place: Path) -> list[Path]:
    if not place.is_dir():
        return [place] if place.exists() else []
    return sorted(file for file in place.iterdir() if file.is_file())
