"""The folders round a file, as far as they may be looked at."""

from __future__ import annotations

import os
from collections.abc import Container, Iterable
from itertools import islice, takewhile
from operator import attrgetter
from pathlib import Path

_MOST_ENTRIES = 2000
"""Of a folder that are looked at."""
_MOST_FOLDERS = 500
"""Of a tree, likewise."""


def entries(folder: Path) -> list[os.DirEntry[str]]:
    """What is in a folder, by name; nothing if it may not be looked at."""
    try:
        with os.scandir(folder) as found:
            return sorted(islice(found, _MOST_ENTRIES), key=attrgetter("name"))
    except OSError:
        return []


def subfolders(root: Path, called: Container[str] | None = None) -> list[Path]:
    """The folders in one that are not hidden; of those ``called`` so alone, if that is said."""
    return [
        Path(entry.path)
        for entry in entries(root)
        if not entry.name.startswith(".")
        and (called is None or entry.name.lower() in called)
        and (Path(entry.path) if entry.is_symlink() else entry).is_dir()  # links may go in circles
    ]


def inside(folder: Path, deep: int) -> list[Path]:
    """A folder and those in it, as many inside each other as ``deep`` says, the outer ones first;
    of a huge tree those that come first."""
    found, level = [folder], [folder]
    for _ in range(deep):
        room = max(0, _MOST_FOLDERS - len(found))
        level = [*islice((inner for one in level for inner in subfolders(one)), room)]
        found += level
    return found


def nearest_first(own: Path, folders: Iterable[Path]) -> list[Path]:
    """Folders without one, in the order in which they are away from it in the tree."""
    others = [folder for folder in dict.fromkeys(folders) if folder != own]
    others.sort(key=lambda folder: len(own.parts) - _shared(own, folder))
    return others


def _shared(one: Path, other: Path) -> int:
    """How many folders two paths have in common."""
    pairs = zip(one.parts, other.parts, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
