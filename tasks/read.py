"""Programs from files, folders and texts."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.door import spelt
from ..core.errors import FlybyError, InputError, Note, OptionError, ParseError
from ..core.program.entry_point import ALL
from ..core.source.text.files import refuse_no_text
from .backup.finding import find_backup, no_backup
from .backup.opening import begins, read_task, setup_in, task_of, told_of_setup
from .backup.surrounding import backup_round, surrounding_note
from .catalogue import registry
from .fitting import arms_that_fit
from .options.entries import TaskOptions, count, value
from .options.keywords import by_keywords
from .options.texts import joint_target
from .setup import RobotOptions, check_language, configurations, setup_of

if TYPE_CHECKING:
    from ..core.backup.backup import Backup, BackupRobot
    from ..core.cell.cell import Cell
    from ..core.program.program import Program
    from ..core.program.target import JointTarget
    from ..core.robot.model import Robot
    from ..core.source.execution.answers import Answers
    from ..core.vendor import Vendor


@dataclass(frozen=True, kw_only=True)
class TextOptions(TaskOptions):
    """How a program is read."""

    entry: str | None = value(
        None, "Routine to run, with arguments as Pick(1,p10); all: each of them."
    )
    answers: str | Path | Answers | None = value(
        None,
        "Answers to what the program asks of signals and operators (TOML).",
        kind=Path,
    )
    cycles: int = count(1, "Passes of a production loop, one that nothing known ends.", least=1)
    others: Sequence[str | Path] = value(
        (),
        "A further file of the program; may be given several times.",
        kind=Path,
        several=True,
    )
    start: str | Sequence[float] | JointTarget | None = value(
        None,
        "Axis values before the first move, degrees and mm: 0,0,0,0,30,0. "
        "Without it the robot stands at the first target.",
        numbers="rad and m",
    )
    configuration: str | None = configurations()
    task: str | None = value(None, "Task of a backup, where several move a robot.")

    def for_robot(self, robot: str | None, cell: Path | None) -> SourceOptions:
        """The same for a robot."""
        return SourceOptions(
            robot=robot,
            cell=cell,
            entry=self.entry,
            answers=self.answers,
            cycles=self.cycles,
            others=self.others,
            start=self.start,
            configuration=self.configuration,
            task=self.task,
            report=self.report,
        )


@dataclass(frozen=True, kw_only=True)
class SourceOptions(RobotOptions, TextOptions):
    """How a program is read, and for which robot."""


def read_with(source: str | Path, options: SourceOptions) -> Program:
    """The program of a file, of a folder, of a backup or of a text, for a robot.

    Args:
        source: a file, a folder that holds one program, a backup of a station (folder, archive or
            file), or a text of several lines.

    Returns:
        The program; it knows which robot it is for.

    Raises:
        InputError: no robot is named, or there is no such file, or it is no program of its vendor.
        SourceError: the text cannot be read; file, line and column are named.
        MotionError: a move that no robot can drive.
    """
    backup = backup_in(source, options)
    if backup is not None:
        return _read_backup(backup, options)
    if options.task is not None:
        raise OptionError(f"{spelt('task')} {options.task}: {source} is no backup with tasks")
    note = surrounding(source)
    try:
        setup = setup_of(options)
    except InputError as error:
        if options.robot is not None or options.cell is not None:
            raise
        _check_it_is_a_program(source)
        told = [str(error), *(_fitting(source, options) if note is None else [str(note)])]
        raise type(error)("; ".join(told)) from None
    from ..core.driving.unknown_start import from_ready_posture

    vendor, robot = setup.vendor, setup.robot
    start = joint_target(options.start, spelt("start"), robot)
    if isinstance(source, str) and "\n" in source:
        name = f"program{vendor.suffixes[0] if vendor.suffixes else ''}"
        answers = answers_of(options)
        program = from_ready_posture(
            lambda at: vendor.read(source, name, options.entry, robot, answers, at), start, robot
        )
    else:
        if not str(source):
            raise OptionError("source is empty: name a file or a folder, or give a program's text")
        file = Path(source)
        if file.is_dir():
            file = _program_in(file, vendor, robot, options)
        check_language(vendor, file)
        answers = answers_of(options)
        program = from_ready_posture(
            lambda at: vendor.read_file(file, options.entry, robot, answers, options.others, at),
            start,
            robot,
        )
    notes = program.notes if note is None else (note, *program.notes)
    return replace(program, setup=setup, notes=notes)


def read_undriven(source: str | Path, options: SourceOptions) -> Program:
    """What the text of a program says by itself: its moves, for no robot.

    Args:
        source: a file, a folder that holds one program, or a backup of a station.

    Raises:
        InputError: there is no such file, or nothing says whose language it is.
        SourceError: it cannot be read, or needs a robot to be read at all.
    """
    path = Path(source)
    backup = backup_in(source, options)
    if backup is not None:
        task, answers = task_of(backup, options.task, options.entry), answers_of(options)
        return read_task(backup, task, None, options.entry, answers, options.others, None)
    _check_it_is_a_program(source)
    vendor = _vendor_in(path) if path.is_dir() else registry().reader_of(path)
    file = _program_in(path, vendor, None, options) if path.is_dir() else path
    return vendor.read_file(file, options.entry, None, answers_of(options), options.others)


def vendor_of(source: str | Path, options: SourceOptions) -> Vendor:
    """Whose program a file, a folder or a backup is.

    Raises:
        InputError: nothing tells.
    """
    backup, path = backup_in(source, options), Path(source)
    if backup is not None:
        return registry().find_vendor(backup.vendor)
    return _vendor_in(path) if path.is_dir() else registry().reader_of(path)


def _vendor_in(folder: Path) -> Vendor:
    """Whose programs lie in a folder.

    Raises:
        InputError: none do, or those of several vendors.
    """
    files = [file for file in folder.iterdir() if file.is_file()]
    suffixes = {file.suffix.lower() for file in files}
    own = [v for v in registry().vendors.values() if suffixes & set(v.suffixes)]
    found = [v for v in own if suffixes & (set(v.suffixes) - _BESIDE_PROGRAMS)] or own
    if len(found) > 1:  # files of several end alike
        read = [file for file in files if any(file.suffix.lower() in v.suffixes for v in found)]
        owners = [registry().readers_of(file) for file in read]
        found = [v for v in found if any(v in each for each in owners)]
    if len(found) == 1:
        return found[0]
    if not found:
        raise InputError(f"{folder} is a folder without a program")
    names = " and ".join(vendor.name for vendor in found)
    raise InputError(f"{folder} is a folder with programs of {names}: name a program file in it")


def _fitting(source: str | Path, options: SourceOptions) -> list[str]:
    """What a program says by itself of the robot that nobody names."""
    if isinstance(source, str) and "\n" in source:
        return []
    try:
        program = read_undriven(source, options)
        vendor = registry().reader_of(Path(program.reading.main)) if program.reading else None
    except FlybyError:
        return []
    said = "" if vendor is None else arms_that_fit(program, vendor)
    return [said] if said else []


def surrounding(source: str | Path) -> Note | None:
    """What to do with a program, or a folder with programs, that lies in a backup."""
    if (isinstance(source, str) and "\n" in source) or not Path(source).exists():
        return None
    return surrounding_note(Path(source), registry())


def robot_around(source: str | Path) -> BackupRobot | None:
    """The robot of the backup that a program, or a folder with programs, lies in: that of its task,
    else the only one; None where none or several may be it."""
    if (isinstance(source, str) and "\n" in source) or not Path(source).exists():
        return None
    found = backup_round(Path(source), registry())
    if found is None:
        return None
    with suppress(FlybyError, OSError):
        backup = find_backup(found[1], registry())
        if backup is not None:
            place = Path(os.path.abspath(source))
            own = {
                task.robot
                for task in backup.tasks
                if any((found[1] / name).is_relative_to(place) for name in task.files)
            }
            index = own.pop() if len(own) == 1 else 0 if len(backup.robots) == 1 else None
            return None if index is None else backup.robots[index]
    return None


def _check_it_is_a_program(source: str | Path) -> None:
    """Refuse what no robot could make a program, before one is asked for."""
    if isinstance(source, str) and ("\n" in source or not source):
        return
    path = Path(source)
    if not path.exists():
        raise InputError(f"{path}: there is no such file or folder")
    if path.is_file():
        registry().readers_of(path)
        refuse_no_text(path)
    elif not _programs_of(path):
        raise no_backup(path, registry())


def backup_in(source: str | Path, options: SourceOptions) -> Backup | None:
    """The backup that a source is; None if it is a program.

    Beside a robot that is named, a program file is read by itself, and so is a folder with programs
    in it that is no backup itself, unless one of several has the entry or is the only one that a
    controller would start; if none is, the backup may say which. A cell says what stands around:
    the arm itself is the backup's.
    """
    if isinstance(source, str) and ("\n" in source or not source):
        return None
    path = Path(source)
    if not path.exists():
        return None
    named = options.robot is not None or options.cell is not None
    if not named or options.task is not None or not _holds_program(path):
        return find_backup(path, registry())
    if path.is_file():
        return None if options.robot is not None else find_backup(path, registry())
    found = find_backup(path, registry(), marked=True)
    if found is None and options.entry != ALL and len(_programs_of(path)) > 1:
        several = find_backup(path, registry())
        if several is not None and begins(several, options.entry):
            found = several if _all_parsed(path, several.vendor, options) else None
    return found if found is not None and found.root == path else None


def _holds_program(path: Path) -> bool:
    """Whether a path is a program file, or a folder with one in it."""
    return bool(_programs_of(path))


def _programs_of(path: Path) -> list[Path]:
    """A program file, or those in a folder."""
    files = path.iterdir() if path.is_dir() else [path]
    suffixes = {suffix for vendor in registry().vendors.values() for suffix in vendor.suffixes}
    return [file for file in files if file.suffix.lower() in suffixes and file.is_file()]


def _read_backup(backup: Backup, options: SourceOptions) -> Program:
    from ..core.driving.unknown_start import from_ready_posture

    task = task_of(backup, options.task, options.entry)
    setup = setup_in(backup, task, options)
    start = joint_target(options.start, spelt("start"), setup.robot)
    answers = answers_of(options)
    program = from_ready_posture(
        lambda at: read_task(backup, task, setup, options.entry, answers, options.others, at),
        start,
        setup.robot,
    )
    setup = replace(setup, backup=backup, cell=_with_tools(setup.cell, program))
    notes = (*backup.notes, *told_of_setup(backup, task, setup), *program.notes)
    return replace(program, setup=setup, notes=notes)


def _with_tools(cell: Cell | None, program: Program) -> Cell | None:
    """A cell beside a backup, with the backup's tools where it says nothing of them but a shape."""
    if cell is None:
        return None
    from ..core.program.tool import Tool

    used = {move.tool.name: move.tool for move in program.moves}
    said = {name for name, tool in cell.tools.items() if tool != Tool(name)}
    return replace(cell, tools={**cell.tools, **{n: t for n, t in used.items() if n not in said}})


read = by_keywords(read_with, SourceOptions)


def answers_of(options: SourceOptions) -> Answers:
    """The answers that options give, or none.

    Raises:
        InputError: their file cannot be used.
    """
    from ..core.source.execution.answers import Answers
    from ..core.source.execution.answers_file import load_answers

    given = options.answers
    answers = load_answers(given) if isinstance(given, str | Path) else given or Answers()
    return replace(answers, cycles=options.cycles, closes=True, goes_on=True, mends=True)


_BESIDE_PROGRAMS = frozenset({".sub", ".txt", ".urp", ".urpx"})
"""Suffixes of files that are a folder's program where no other file is."""


def _program_in(folder: Path, vendor: Vendor, robot: Robot | None, options: SourceOptions) -> Path:
    """The one file in a folder that can be run by itself.

    Where another cannot be parsed, it may be the program itself: then the one must hold the entry
    that is named, or a routine ``main``.

    Raises:
        InputError: there is none, there are several, or the program's file cannot be parsed.
    """
    files = sorted(f for f in folder.iterdir() if f.suffix.lower() in vendor.suffixes)
    files = [f for f in files if f.suffix.lower() not in _BESIDE_PROGRAMS] or files
    if len(files) == 1:
        return files[0]
    if not files:
        known = ", ".join(vendor.suffixes)
        raise InputError(f"{folder} is a folder without a program of {vendor.name} ({known})")
    errors = {file: _error(file, vendor, robot, options, options.entry) for file in files}
    found = [file for file, error in errors.items() if error is None]
    broken = [(f, e) for f, e in errors.items() if isinstance(e, ParseError) and _of(e, f)]
    if len(found) == 1:
        entry = options.entry or "main"
        if not broken or _error(found[0], vendor, robot, options, entry) is None:
            return found[0]
    names = "".join(f", {file.name}" for file in found or files).replace(",", ":", 1)
    why = "".join(f"; not read: {error}" for _, error in broken)
    raise InputError(f"{folder} is a folder; name a program file in it{names}{why}")


def _all_parsed(folder: Path, vendor: str, options: SourceOptions) -> bool:
    """Whether none of a folder's programs is damaged: that might be the one that is meant."""
    own = registry().find_vendor(vendor)
    errors = {
        file: _error(file, own, None, options, options.entry)
        for file in _programs_of(folder)
        if file.suffix.lower() in own.suffixes
    }
    return not any(isinstance(e, ParseError) and _of(e, f) for f, e in errors.items())


def _error(
    file: Path, vendor: Vendor, robot: Robot | None, options: SourceOptions, entry: str | None
) -> FlybyError | None:
    """Why a file does not run by itself; None if it does."""
    try:
        answers = replace(answers_of(options), mends=False)
        vendor.read_file(file, entry, robot, answers, options.others)
    except FlybyError as error:
        return error
    return None


def _of(error: ParseError, file: Path) -> bool:
    return error.span is not None and error.span.file == str(file)
