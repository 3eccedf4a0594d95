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

from ...core.door import called, spelt
from ...core.errors import FlybyError, OptionError
from ...core.program.entry_point import ALL
from ..backup.opening import read_task, setup_in
from ..backup.surrounding import surrounding_note
from ..catalogue import registry
from ..emulate import EmulateOptions, emulate_with
from ..read import SourceOptions, answers_of, backup_in, read_undriven, read_with
from ..setup import Setup, setup_of

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
        run: the same driven; None if it cannot be, or no robot is known.
        error: why it cannot be; empty if it can.
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
        undriven: why nothing of it is driven; empty if it is.
    """

    path: Path
    routines: Mapping[str, Routine]
    backup: Backup | None = None
    texts: Mapping[str, str] = field(default_factory=dict, repr=False)
    undriven: str = ""

    @property
    def programs(self) -> dict[str, Program]:
        """Of the routines that can be read."""
        found = {name: routine.program for name, routine in self.routines.items()}
        return {name: program for name, program in found.items() if program is not None}

    def read_alone(self) -> StationState:
        """The same with nothing driven, to be compared with one of which nobody knows the robot."""
        read = {
            name: routine if routine.program is None else Routine(routine.program)
            for name, routine in self.routines.items()
        }
        return replace(self, routines=read)


def state_of(path: Path, options: SourceOptions) -> StationState:
    """Read and drive a state.

    Every routine that needs no arguments and moves the robot is driven by itself, unless one is
    named; what cannot be read or driven says why in its place. Where nobody says which robot, what
    needs none is read.

    Raises:
        FlybyError: the path is neither a program nor a backup, or nobody says which robot options
            are for.
    """
    backup = backup_in(path, options)
    if backup is None:
        return _of_program(path, options)
    return _of_backup(path, backup, options)


def program_of(path: Path, options: SourceOptions) -> Program:
    """The program that options name; what its text says by itself where nobody says which robot.

    Raises:
        FlybyError: it cannot be read.
    """
    if backup_in(path, options) is None and _undriven(path, options):
        return read_undriven(path, options)
    return read_with(path, options)


def _of_program(path: Path, options: SourceOptions) -> StationState:
    undriven = _undriven(path, options)
    read = read_undriven if undriven else read_with
    names = [options.entry] if options.entry else _entries(partial(read, path), options)
    routines = {}
    for name in names:
        entry = None if name == MAIN else name
        by_name = partial(read, path, replace(options, entry=entry))
        routines[name] = _read(by_name) if undriven else _driven(by_name)
    texts = {path.name: text_of(path)} if path.is_file() else {}
    for routine in routines.values():
        if path.is_file():
            texts |= _texts(routine.program, path.parent)
        else:
            texts |= _texts(routine.program, path, beside=True)
    return StationState(path, routines, texts=texts, undriven=undriven)


def _undriven(path: Path, options: SourceOptions) -> str:
    """Why a program is not driven: nobody says which robot; empty if somebody does.

    Raises:
        FlybyError: the robot cannot be used, or options need one.
    """
    of_a_robot = options.motion, options.machine_data, options.vendor, options.start
    if options.robot is None and options.cell is None and not any(of_a_robot):
        note = surrounding_note(path, registry()) if path.is_file() else None
        return (
            f"{path} does not say which robot drives it; {spelt('robot')} names one "
            f"({called('robots')} lists them), or {spelt('cell')}" + (f"; {note}" if note else "")
        )
    setup_of(options)
    return ""


def _entries(read: Callable[[SourceOptions], Program], options: SourceOptions) -> list[str]:
    """The routines of a program that move the robot; its main one where it lists none."""
    try:
        found = read(replace(options, entry=ALL)).entries
    except FlybyError:
        return [MAIN]
    return [e.name for e in found if e.moves and not e.parameters] or [MAIN]


def _of_backup(path: Path, backup: Backup, options: SourceOptions) -> StationState:
    routines: dict[str, Routine] = {}
    texts: dict[str, str] = {}
    moving = [task for task in backup.tasks if task.robot is not None]
    if options.task is not None:
        moving = [task for task in moving if task.name.casefold() == options.task.casefold()]
    undriven = ""
    for task in moving:
        for file in task.files:
            texts[file] = text_of(backup.root / file)
        try:
            setup = setup_in(backup, task, options)
        except OptionError as error:
            setup, undriven = None, str(error)
        for name in _names(task, options):
            of_task = partial(_of_task, backup, task, setup, options, name)
            routine = _read(of_task) if setup is None else _driven(of_task)
            routines[f"{task.name}/{name}"] = routine
            texts |= _texts(routine.program, backup.root)
    return StationState(path, routines, backup, texts, undriven)


def _names(task: Task, options: SourceOptions) -> list[str]:
    """The routines of a task that are driven; its main one where it lists none."""
    if options.entry is not None:
        return [options.entry]
    if not task.entries:
        return [] if task.main is None else [MAIN]
    return [e.name for e in task.entries if e.moves != 0 and not e.parameters]


def _of_task(
    backup: Backup, task: Task, setup: Setup | None, options: SourceOptions, name: str
) -> Program:
    entry = None if name == MAIN else name
    found = read_task(backup, task, setup, entry, answers_of(options), (), None)
    return replace(found, setup=setup)


def _read(read: Callable[[], Program]) -> Routine:
    """A routine that no known robot drives, read if it can be."""
    try:
        return Routine(read())
    except FlybyError as error:
        return Routine(error=str(error))


def _driven(read: Callable[[], Program]) -> Routine:
    """A routine read and driven, as far as it can be."""
    routine = _read(read)
    if routine.program is None:
        return routine
    try:
        return replace(routine, run=emulate_with(routine.program, EmulateOptions()))
    except FlybyError as error:
        return replace(routine, error=str(error))


def _texts(program: Program | None, folder: Path, beside: bool = False) -> dict[str, str]:
    """The source files of a program by their names below a folder.

    They are its own and those with moves that are driven: what else stands beside a program is
    read by its reader, and may be another program's.

    Args:
        beside: whether what stands beside it counts, as the user has named the whole folder.
    """
    from ...core.source.reading import Reading

    reading = None if program is None else program.reading
    if program is None or not isinstance(reading, Reading):
        return {}
    driven = {move.statement.file for move in program.moves if move.statement is not None}
    found = {}
    for name, file in reading.files.items():
        path = Path(name)
        below = path.is_relative_to(folder)
        if name not in driven | {reading.main} and not (beside and below):
            continue
        found[path.relative_to(folder).as_posix() if below else path.name] = file.text
    return found


def text_of(path: Path) -> str:
    """The text of a file, unpacked if it is packed; empty if it is none."""
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
