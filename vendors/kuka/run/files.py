"""Which files on disk belong to a program.

The program's own ``.dat``, ``$CONFIG.DAT``, and of the files around it those that its text calls by
name or that declare something ``GLOBAL``; from there on, what these call. Around it is the tree of
the controller that its folder stands in (``KRC``, ``R1``, ``Program``, ``System``, …), with the
trees beside that; of a folder that stands in none, the folders in it, the one that it stands in,
and such a tree beside it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import islice
from pathlib import Path

from ....core.errors import FlybyError
from ....core.files.tree import entries, inside, nearest_first, subfolders
from ....core.source.text.files import SourceFile, read_source
from ....core.source.text.lexer import words
from ..values.library import CONFIG, stem_of, suffix_of

SUFFIXES = (".src", ".sub", ".dat")
_TREE = ("krc", "r1", "program", "system", "tp", "folgen", "up", "makros", "mada", "steu")
"""Folders of a controller's tree."""
_DEEPEST = 6
"""Folders of a tree inside each other."""
_MOST_FILES = 2000
_LARGEST_SCAN = 400
_TYPES = words(
    """int real bool char frame pos e6pos axis e6axis load def deffct signal struc enum const decl
    fdat pdat ldat in out"""
)
_WORD = re.compile(r"[A-Za-z_$][\w$]*")
_GLOBAL = re.compile(r"(?im)^[ \t]*(?:decl[ \t]+)?(?:const[ \t]+)?global[ \t]+(?!interrupt)")


def collect(
    path: Path, others: Iterable[Path], beside: Iterable[Path] | None = None
) -> dict[str, SourceFile]:
    """The source files of a program, the main one first.

    Args:
        path: of the ``.src``.
        others: files, or folders of files, that the user names.
        beside: those around it; None to look for them.

    Raises:
        InputError: a named file cannot be read.
    """
    files = {str(path): read_source(path)}
    for other in others:
        for named in _named(other):
            files.setdefault(str(named), read_source(named))
    near = _near(path) if beside is None else _by_stem(path, beside)
    seen = _words(files.values())
    for stem in (stem_of(path.name), CONFIG):
        _take(files, near.pop(stem, []), seen)
    scanned = list(near) if beside is not None else list(near)[:_LARGEST_SCAN]
    shared = {stem: _shared_names(near[stem]) for stem in scanned}
    while found := [s for s in near if s in seen or not seen.isdisjoint(shared.get(s, ()))]:
        for stem in found:
            _take(files, near.pop(stem), seen)
    return files


def _named(other: Path) -> list[Path]:
    if other.is_dir():
        return sorted(p for p in other.iterdir() if p.suffix.lower() in SUFFIXES)
    return [other]


def _near(path: Path) -> dict[str, list[Path]]:
    """Files around the program by lower-case stem, nearest folder first."""
    around = (entry for folder in _folders(path) for entry in entries(folder))
    ends = (*SUFFIXES, ".txt") if path.suffix.lower() == ".txt" else SUFFIXES
    named = (e.path for e in islice(around, _MOST_FILES) if e.name.lower().endswith(ends))
    return _by_stem(path, map(Path, named))


def _by_stem(path: Path, around: Iterable[Path]) -> dict[str, list[Path]]:
    """Those of files that are a program's, by lower-case stem."""
    near: dict[str, list[Path]] = {}
    own = path.resolve()
    for entry in around:
        if suffix_of(entry.name) in SUFFIXES and entry.resolve() != own:
            near.setdefault(stem_of(entry.name), []).append(entry)
    return near


def _folders(path: Path) -> list[Path]:
    """The program's own folder, then those around it."""
    own = path.resolve().parent
    tree = [folder for folder in (own, *own.parents[:_DEEPEST]) if folder.name.lower() in _TREE]
    if tree:
        # What they stand in may be called otherwise: the folder of a copy, of a repository.
        beside = [f for f in subfolders(tree[-1].parent, _TREE) if f != tree[-1]]
        around = [f for root in (tree[-1], *beside) for f in inside(root, _DEEPEST)]
    else:
        beside = subfolders(own.parent, _TREE)
        around = [*inside(own, _DEEPEST), own.parent, *beside]
    return [path.parent, *nearest_first(own, around)]


def _words(files: Iterable[SourceFile]) -> set[str]:
    return {word.lower() for file in files for word in _WORD.findall(file.text)}


def _take(files: dict[str, SourceFile], paths: list[Path], seen: set[str]) -> None:
    """Take a module's files; one that cannot be read is as good as not there."""
    for path in paths:
        try:
            file = read_source(path)
        except FlybyError:
            continue
        files.setdefault(str(path), file)
        seen |= _words([file])


def _shared_names(paths: list[Path]) -> set[str]:
    """What a module declares for everybody."""
    found: set[str] = set()
    for path in paths:
        try:
            found |= _names(read_source(path).text) - _TYPES
        except FlybyError:
            continue
    return found


def _names(text: str) -> set[str]:
    """Words of the lines that declare something GLOBAL."""
    found: set[str] = set()
    if "global" not in text.lower():  # far quicker than the pattern
        return found
    for match in _GLOBAL.finditer(text):
        end = text.find("\n", match.start())
        line = text[match.end() : end if end >= 0 else len(text)]
        found |= {word.lower() for word in _WORD.findall(line.partition("=")[0])}
    return found
