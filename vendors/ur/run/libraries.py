"""Scripts beside a program that define what it calls and nobody at hand declares.

PolyScope carries out the script files that a program names before what comes after them. A program
that was written as text names none: a file that does nothing but define is taken where one of its
functions is called.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path

from ....core.errors import FlybyError
from ....core.program.program import Program
from ....core.program.question import QuestionKind
from ....core.source.text.files import SourceFile, read_source
from ..syntax.statements import parse
from ..syntax.texts import Texts
from ..syntax.tree import Assign, Define

_SUFFIXES = (".script", ".urscript")
_MOST_FILES = 400
_DEFINES = re.compile(r"^def[ \t]+(\w+)", re.M)


def libraries_of(
    program: Program, path: Path, beside: Iterable[Path] | None, taken: Collection[str]
) -> dict[str, SourceFile]:
    """The files that define functions which a program calls and nobody declares, by name.

    Args:
        program: as it is read without them.
        path: of its file.
        beside: the files that may stand beside it; None to look for them on the disk.
        taken: names of the files that it was read with.

    Returns:
        No file of a function that several define, but for the one that is called like it.
    """
    routines = (q for q in program.questions if q.kind is QuestionKind.ROUTINE and not q.answered)
    wanted = {question.key for question in routines}
    if not wanted:
        return {}
    near = path.parent.iterdir() if beside is None else beside
    own = path.resolve()
    scripts = sorted(
        one
        for one in islice(near, _MOST_FILES)
        if one.suffix.lower() in _SUFFIXES and str(one) not in taken and one.resolve() != own
    )
    defining: dict[str, list[SourceFile]] = {}
    for file in _readable(scripts):
        for name in wanted.intersection(_DEFINES.findall(file.text)):
            defining.setdefault(name, []).append(file)
    found: dict[str, SourceFile] = {}
    for name, files in defining.items():
        alike = files if len(files) == 1 else [f for f in files if Path(f.name).stem == name]
        found |= {file.name: file for file in alike[:1] if _only_defines(file)}
    return found


def _readable(paths: Iterable[Path]) -> Iterator[SourceFile]:
    for path in paths:
        with suppress(FlybyError):
            yield read_source(path)


def _only_defines(file: SourceFile) -> bool:
    """Whether a file leaves the robot alone by itself."""
    try:
        return all(isinstance(one, Define | Assign) for one in parse(Texts([file]), 0))
    except FlybyError:
        return False
