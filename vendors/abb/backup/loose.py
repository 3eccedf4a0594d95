"""Modules in folders that are no task's, as repositories and a controller's HOME keep them.

A controller loads what a program's list (``.pgf``) names, or what an operator picks. Here each list
is a task, and so is each PROC main: with its own modules and with those that lie with no other
program's. Where there is neither, all modules are one task.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from ....core.errors import FlybyError
from ..run.files import MODULES, PROGRAM, is_system, listed
from .backinfo import ListedModule, ListedTask
from .contents import Contents
from .modules import ModuleFile, ModuleFiles

_MAIN = "main"


@dataclass(frozen=True)
class _Program:
    """What an operator would pick.

    Args:
        file: its list, or the module with its PROC main.
        modules: that the list names, as they are called below the root, or that one.
    """

    file: PurePosixPath
    modules: tuple[str, ...]

    @property
    def has_list(self) -> bool:
        return self.file.suffix.casefold() == PROGRAM

    @property
    def folder(self) -> PurePosixPath:
        return self.file.parent


def loose_tasks(contents: Contents, names: Sequence[str], modules: ModuleFiles) -> list[ListedTask]:
    """The tasks that lie in folders of any name.

    Args:
        names: of the files that may hold one, below the root.
    """
    files = [name for name in names if name.lower().endswith(MODULES)]
    if not files:
        return []
    programs = [*_lists(contents, names)]
    named = {name for one in programs for name in one.modules}
    others = [file for file in modules.read(files) if file.name not in named]
    mains = {file.name for file in others if _holds_main(file)}
    programs += [_Program(PurePosixPath(name), (name,)) for name in sorted(mains)]
    if not programs:
        return [_task(contents.root.name, files)]
    free = [file.name for file in others if file.name not in mains]
    called = _names(programs, contents.root.name)
    return [
        _task(name, [*one.modules, *_beside(one, programs, free)])
        for name, one in zip(called, programs, strict=True)
    ]


def _task(name: str, files: Iterable[str]) -> ListedTask:
    return ListedTask("", name, "", tuple(ListedModule(file, 1) for file in files), 1)


def _lists(contents: Contents, names: Iterable[str]) -> Iterable[_Program]:
    for name in names:
        if not name.lower().endswith(PROGRAM):
            continue
        path = PurePosixPath(name)
        try:
            members = listed(contents.source(name))
        except FlybyError as error:
            contents.notes.add(f"passed over: {error}")
            continue
        places = [(path.parent / member).as_posix() for member in members]
        if places:
            yield _Program(path, tuple(contents.find(place) or place for place in places))


def _holds_main(file: ModuleFile) -> bool:
    return any(one.kind == "proc" and not one.local and one.name == _MAIN for one in file.routines)


def _beside(program: _Program, programs: Sequence[_Program], free: Sequence[str]) -> list[str]:
    """Modules that lie with a program or with none, nearest first; of those that lie with a list
    the system's alone."""
    folders = {one.folder for one in programs}
    found = []
    for name in free:
        path = PurePosixPath(name)
        zone = next((above for above in path.parents if above in folders), None)
        own = zone == program.folder and (not program.has_list or is_system(name))
        if zone is None or own:
            found.append((_steps(program.folder, path.parent), name))
    return [name for _, name in sorted(found)]


def _steps(one: PurePosixPath, other: PurePosixPath) -> int:
    """From folder to folder."""
    shared = sum(1 for a, b in zip(one.parts, other.parts, strict=False) if a == b)
    return len(one.parts) + len(other.parts) - 2 * shared


def _names(programs: Sequence[_Program], root: str) -> list[str]:
    """By their folders, their files or their places, whichever tells all of them apart."""
    folders = [one.folder.name or root for one in programs]
    stems = [one.file.stem for one in programs]
    apart = (way for way in (folders, stems) if len({*map(str.casefold, way)}) == len(way))
    return next(apart, [one.file.as_posix() for one in programs])
