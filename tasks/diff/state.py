"""One of the states that are compared: its routines, read and driven."""

from __future__ import annotations

import gzip
import io
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.errors import FlybyError
from ...core.program.entry_point import ALL
from ..backup.finding import find_backup
from ..backup.opening import read_task, setup_in
from ..catalogue import registry
from ..emulate import EmulateOptions, emulate_with
from ..read import SourceOptions, answers_of, read_with
from ..setup import setup_of

if TYPE_CHECKING:
    from ...core.backup.backup import Backup, Task
    from ...core.program.program import Program
    from ..results.runs import Run

_GZIP = b"\x1f\x8b"
MAIN = "main routine"
"""What a routine is called that nobody names."""


@dataclass(frozen=True)
class Routine:
    """A routine that a state can be driven by.

    Args:
        program: what it drives; None if it cannot be read.
        run: the same driven; None if it cannot be.
        error: why; empty if it can.
    """

    program: Program | None = None
    run: Run | None = None
    error: str = ""


@dataclass(frozen=True)
class StationState:
    """A state of a program or a station.

    Args:
        path: as the user named it.
        routines: by name; of a backup as ``task/routine``.
        backup: if it is one.
        texts: of its source files, by name below its folder.
    """

    path: Path
    routines: Mapping[str, Routine]
    backup: Backup | None = None
    texts: Mapping[str, str] = field(default_factory=dict, repr=False)

    @property
    def programs(self) -> dict[str, Program]:
        """Of the routines that can be read."""
        found = {name: routine.program for name, routine in self.routines.items()}
        return {name: program for name, program in found.items() if program is not None}


def state_of(path: Path, options: SourceOptions) -> StationState:
    """Read and drive a state.

    Every routine that needs no arguments and moves the robot is driven by itself, unless one is
    named; what cannot be read or driven says why in its place.

    Raises:
        FlybyError: the path is neither a program nor a backup, or nobody says which robot.
    """
    named = options.robot is not None or options.cell is not None
    backup = None if named and path.is_file() else find_backup(path, registry())
    if backup is None:
        return _of_program(path, options)
    return _of_backup(path, backup, options)


def _of_program(path: Path, options: SourceOptions) -> StationState:
    setup_of(options)  # asks for the robot
    names = _entries(path, options) if options.entry is None else [options.entry]
    routines = {}
    for name in names:
        entry = None if name == MAIN else name
        routines[name] = _driven(partial(read_with, path, replace(options, entry=entry)))
    texts: dict[str, str] = {}
    for routine in routines.values():
        texts |= _texts(routine.program, path.parent if path.is_file() else path)
    return StationState(path, routines, texts=texts)


def _entries(path: Path, options: SourceOptions) -> list[str]:
    """The routines of a program that move the robot; its main one where it lists none."""
    try:
        found = read_with(path, replace(options, entry=ALL)).entries
    except FlybyError:
        return [MAIN]
    return [e.name for e in found if e.moves and not e.parameters] or [MAIN]


def _of_backup(path: Path, backup: Backup, options: SourceOptions) -> StationState:
    routines: dict[str, Routine] = {}
    texts: dict[str, str] = {}
    moving = [task for task in backup.tasks if task.robot is not None]
    if options.task is not None:
        moving = [task for task in moving if task.name.casefold() == options.task.casefold()]
    for task in moving:
        for file in task.files:
            texts[file] = _text(backup.root / file)
        for name in _names(task, options):
            routine = _driven(partial(_read, backup, task, options, name))
            routines[f"{task.name}/{name}"] = routine
            texts |= _texts(routine.program, backup.root)
    return StationState(path, routines, backup, texts)


def _names(task: Task, options: SourceOptions) -> list[str]:
    """The routines of a task that are driven; its main one where it lists none."""
    if options.entry is not None:
        return [options.entry]
    if not task.entries:
        return [] if task.main is None else [MAIN]
    return [e.name for e in task.entries if e.moves != 0 and not e.parameters]


def _read(backup: Backup, task: Task, options: SourceOptions, name: str) -> Program:
    setup = setup_in(backup, task, options)
    entry = None if name == MAIN else name
    found = read_task(backup, task, setup, entry, answers_of(options), (), None)
    return replace(found, setup=setup)


def _driven(read: Callable[[], Program]) -> Routine:
    """A routine read and driven, as far as it can be."""
    try:
        program = read()
    except FlybyError as error:
        return Routine(error=str(error))
    try:
        return Routine(program, emulate_with(program, EmulateOptions()))
    except FlybyError as error:
        return Routine(program, error=str(error))


def _texts(program: Program | None, folder: Path) -> dict[str, str]:
    """The source files of a program by their names below a folder.

    They are its own and those with moves that are driven: what else stands beside a program is
    read by its reader, and may be another program's.
    """
    from ...core.source.reading import Reading

    reading = None if program is None else program.reading
    if program is None or not isinstance(reading, Reading):
        return {}
    driven = {move.statement.file for move in program.moves if move.statement is not None}
    found = {}
    for name, file in reading.files.items():
        if name not in driven | {reading.main}:
            continue
        path = Path(name)
        below = path.is_relative_to(folder)
        found[path.relative_to(folder).as_posix() if below else path.name] = file.text
    return found


def _text(path: Path) -> str:
    from ...core.files.reading import read_bytes
    from ...core.source.text.files import LARGEST_FILE, source_of

    try:
        data = read_bytes(path, LARGEST_FILE)
        if data.startswith(_GZIP):
            with gzip.open(io.BytesIO(data)) as file:
                data = file.read(LARGEST_FILE)
        return source_of(data, str(path)).text
    except (FlybyError, OSError, EOFError, zlib.error):
        return ""
