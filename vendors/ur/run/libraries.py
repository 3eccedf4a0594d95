"""Scripts round a program that define what it calls and nobody at hand declares.

PolyScope carries out the script files that a program names before what comes after them. A program
that was written as text names none: a file that does nothing but define is taken where one of its
functions is called. It stands in the program's folder, else in the tree of its project: in the
folders in that, the one that it stands in, and, where a folder above is a repository's or has a
README, in all of that.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from functools import cached_property
from itertools import islice
from pathlib import Path

from ....core.backup.contents import listed
from ....core.door import spelt
from ....core.errors import FlybyError, Note
from ....core.files.tree import entries, inside, nearest_first
from ....core.program.program import Program
from ....core.program.question import QuestionKind
from ....core.source.text.files import SourceFile, read_source
from ..syntax.statements import parse
from ..syntax.texts import Texts
from ..syntax.tree import Assign, Define

_SUFFIXES = (".script", ".urscript")
_MOST_FILES = 400
_LARGEST = 1_000_000
"""Bytes of a file of functions; the largest seen have some 100 000."""
_DEEPEST = 5
"""Folders of a project inside each other."""
_REPOSITORY = (".git", ".hg", ".svn")
_PROJECT = re.compile(r"(?i)(readme|licen[cs]e|copying)(\.\w+)?|package\.xml|pyproject\.toml")
"""Files in the uppermost folder of a project."""
_DEFINES = re.compile(r"^def[ \t]+(\w+)", re.M)


class Libraries:
    """The files round a program.

    Args:
        path: of its file.
        beside: the files that may belong to it; None to look for them on the disk.
    """

    def __init__(self, path: Path, beside: Iterable[Path] | None) -> None:
        self._path = path
        self._beside = beside
        self._doubtful: dict[str, list[SourceFile]] = {}

    def of(self, program: Program, taken: Collection[str]) -> dict[str, SourceFile]:
        """The files that define functions which a program calls and nobody declares, by name.

        Args:
            program: as it is read without them.
            taken: names of the files that it was read with.

        Returns:
            No file of a function that several define, but for the one that is called like it.
        """
        routines = (q for q in program.questions if q.kind is QuestionKind.ROUTINE)
        wanted = {question.key for question in routines if not question.answered}
        found: dict[str, SourceFile] = {}
        if wanted:
            found = self._defining(wanted, self._near, taken)
        if wanted and self._beside is None:
            found |= self._defining(wanted, self._far, taken)
        return found

    def _defining(
        self, wanted: set[str], files: Iterable[SourceFile], taken: Collection[str]
    ) -> dict[str, SourceFile]:
        """Those of some files; what they define is wanted no more."""
        defining: dict[str, list[SourceFile]] = {}
        for file in files:
            for name in wanted.intersection(_DEFINES.findall(file.text)):
                if file.name not in taken and _only_defines(file):
                    defining.setdefault(name, []).append(file)
        wanted.difference_update(defining)
        found: dict[str, SourceFile] = {}
        for name, several in defining.items():
            alike = [file for file in several if Path(file.name).stem == name]
            if len(several) == 1 or len(alike) == 1:
                one = (alike or several)[0]
                found[one.name] = one
            else:
                self._doubtful[name] = several
        return found

    def taken(self, name: str) -> Note:
        """What is said of a file that is read with the program."""
        return Note(
            f"{self._shown(name)} defines functions that the program calls and does not declare: "
            "it is read as well"
        )

    def doubts(self) -> Iterator[Note]:
        """What is said of functions that several files define."""
        for name, files in self._doubtful.items():
            where = listed(self._shown(file.name) for file in files)
            yield Note(
                f"the function '{name}' is defined in {where}: nobody knows which of them the "
                f"robot has; name it ({spelt('others')})"
            )

    def _shown(self, name: str) -> str:
        """A file as it is found from the program's folder."""
        with suppress(ValueError):  # on another drive
            return Path(os.path.relpath(name, self._path.parent)).as_posix()
        return name

    @cached_property
    def _near(self) -> list[SourceFile]:
        """The files of the program's folder, or those that may belong to it."""
        return self._scripts(_files([self._path.parent]) if self._beside is None else self._beside)

    @cached_property
    def _far(self) -> list[SourceFile]:
        """The files of other folders, the nearest first."""
        own = self._path.resolve().parent
        top = _project(own)
        around = inside(own, _DEEPEST) if top is None else inside(top, _DEEPEST)
        return self._scripts(_files(nearest_first(own, [*around, own.parent])))

    def _scripts(self, paths: Iterable[Path]) -> list[SourceFile]:
        own = self._path.resolve()
        scripts = (one for one in paths if one.suffix.lower() in _SUFFIXES and one.resolve() != own)
        found: dict[str, SourceFile] = {}
        for path in sorted(islice(scripts, _MOST_FILES)):
            with suppress(FlybyError, OSError):
                if path.stat().st_size <= _LARGEST:
                    file = read_source(path)
                    found.setdefault(file.text, file)  # a copy is no other file
        return [*found.values()]


def _files(folders: Iterable[Path]) -> Iterator[Path]:
    return (Path(entry.path) for folder in folders for entry in entries(folder))


def _project(own: Path) -> Path | None:
    """The uppermost folder of the project that one stands in; None where none shows."""
    top: Path | None = None
    for folder in (own, *own.parents[:_DEEPEST]):
        if folder == Path.home():
            break
        names = [entry.name for entry in entries(folder)]
        if any(map(_PROJECT.fullmatch, names)):
            top = folder
        if not set(_REPOSITORY).isdisjoint(names):
            return folder
    return top


def _only_defines(file: SourceFile) -> bool:
    """Whether a file leaves the robot alone by itself."""
    try:
        return all(isinstance(one, Define | Assign) for one in parse(Texts([file]), 0))
    except FlybyError:
        return False
