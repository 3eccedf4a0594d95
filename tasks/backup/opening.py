"""Backups of stations: opened, and the programs in them read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import InputError, Note, OptionError, UnknownNameError
from ...core.program.entry_point import ALL, EntryPoint, entry_call, listed
from ..catalogue import registry
from ..options.kinds import refuse_others
from ..setup import Setup, laid_on, setup_of
from .finding import find_backup, no_backup

if TYPE_CHECKING:
    from ...core.backup.backup import Backup, BackupEntry, Task
    from ...core.program.program import Program
    from ...core.program.target import JointTarget
    from ...core.robot.model import Robot
    from ...core.source.execution.answers import Answers
    from ..setup import RobotOptions

_APART = 1e-3
"""m, and of half the turn's sine: bases that are one place."""


def open_backup(path: str | Path) -> Backup:
    """What a backup of a station holds: robots, programs, tools, frames, signals.

    Args:
        path: a folder, a zip or a file that a controller or its tools have written.

    Raises:
        InputError: there is none, there are several, or nothing of it can be read. What single
            files lack is among its notes.
    """
    refuse_others("path", path, "str | Path")
    found = find_backup(path, registry())
    if found is None:
        raise no_backup(path, registry())
    return found


def task_of(backup: Backup, name: str | None, entry: str | None = None) -> Task:
    """The task of a name, or the only one that moves a robot, or that has a routine.

    Args:
        entry: the routine that is asked for.

    Raises:
        OptionError: none or several do.
        UnknownNameError: there is no such task.
    """
    if name is not None:
        for task in backup.tasks:
            if task.name.casefold() == name.casefold():
                return task
        raise UnknownNameError(f"task of {backup.source}", name, [t.name for t in backup.tasks])
    moving = [task for task in backup.tasks if task.robot is not None]
    having = [task for task in moving if entry not in (None, ALL) and _entry(task, entry)]
    for found in (moving, having):
        if len(found) == 1:
            return found[0]
    if not moving:
        what = "no task of it moves a robot" if backup.tasks else "it holds no program"
        raise InputError(f"{backup.source}: {what}{_noted(backup)}")
    names = ", ".join(task.name for task in moving)
    if entry not in (None, ALL) and not having:
        every = tuple(point for task in moving for point in _entry_points(task))
        raise OptionError(
            f"{backup.source}: none of {names} has a routine {entry}. Choose with "
            f"{spelt('entry')}: {listed(every)}"
        )
    raise OptionError(
        f"{backup.source}: which task? Several move a robot: {names}; choose with {spelt('task')}"
    )


def begins(backup: Backup, entry: str | None) -> bool:
    """Whether a task of a backup has a routine that is asked for, or where none is, there is but
    one that a controller would start."""
    if entry is not None:
        return any(_entry(task, entry) is not None for task in backup.tasks)
    moving = [task for task in backup.tasks if task.robot is not None]
    return len(moving) == 1 and moving[0].entry is not None


def _entry(task: Task, asked: str | None) -> BackupEntry | None:
    """The routine of a task that is asked for: by its name, maybe with arguments, or by that of its
    file, whose signs no routine's name may have.
    """
    if asked is None:
        return None
    for known in task.entries:
        if PurePath(known.file).stem.casefold() == asked.casefold() and len(task.entries) == 1:
            return known
    try:
        name, _ = entry_call(asked)
    except OptionError:
        return None
    named = (one for one in task.entries if name and one.name.casefold() == name.casefold())
    return next(named, None)


def setup_in(backup: Backup, task: Task, options: RobotOptions) -> Setup:
    """The robot that a task moves, as its backup has it; or the one that options name.

    Raises:
        InputError: the backup does not say which robot it is, or flyby does not know it.
    """
    index = 0 if task.robot is None else task.robot
    if options.robot is not None or options.cell is not None:
        arm = backup.robots[index].robot if 0 <= index < len(backup.robots) else None
        return _as_backed_up(backup, arm, setup_of(options, arm), options)
    if not 0 <= index < len(backup.robots):
        raise OptionError(
            f"{backup.source}: it does not say which robot it is of; give {spelt('robot')}"
            f"{_noted(backup)}"
        )
    known = backup.robots[index]
    if known.robot is None:
        why = "; ".join(known.lacks) or f"its robot {known.written} is not known"
        way = f"; {spelt('robot')} names one that will do"
        raise OptionError(f"{backup.source}: {why}{'' if spelt('robot') in why else way}")
    vendor = registry().find_vendor(backup.vendor).with_stated(known.robot, backup.motion)
    return laid_on(Setup(vendor, known.robot), options)


def told_of_setup(backup: Backup, task: Task, setup: Setup) -> list[Note]:
    """What speaks against a robot that options name, by its backup."""
    stated = backup.robots[task.robot] if task.robot is not None else None
    if stated is None or (stated.robot is None and not stated.written):
        return []
    arm, driven = stated.robot, setup.robot
    if arm is None or arm.name != driven.name:
        own = stated.written if arm is None else arm.name
        return [Note(f"the backup is of {own}: {driven.name} is driven, as it was named")]
    apart = arm.base.inverse() @ driven.base
    if max(math.hypot(*apart.position), math.hypot(*apart.quaternion[1:])) <= _APART:
        return []
    places = (", ".join(f"{1e3 * x + 0.0:.1f}" for x in r.base.position) for r in (arm, driven))
    own, named = places
    return [
        Note(
            f"the backup has the robot's base at {own} mm, the cell at {named} mm (or turned "
            "otherwise): the cell's is taken"
        )
    ]


def _as_backed_up(backup: Backup, known: Robot | None, made: Setup, options: RobotOptions) -> Setup:
    """A setup that options name, with what the backup states of how that same arm is driven."""
    said = options.motion is not None or options.machine_data is not None
    said = said or (made.cell is not None and made.cell.motion is not None)
    if said or known is None or known.name != made.robot.name or backup.vendor != made.vendor.name:
        return made
    return replace(made, vendor=made.vendor.with_stated(made.robot, backup.motion))


def read_task(
    backup: Backup,
    task: Task,
    setup: Setup | None,
    entry: str | None,
    answers: Answers,
    others: Iterable[str | Path],
    start: JointTarget | None,
) -> Program:
    """The program that a routine of a task drives.

    Args:
        backup, task: where it stands.
        setup: its robot; None for what the text says by itself.
        entry: the routine, with arguments; None for the one that the controller would start; or
            all, for none but the list of them.
        answers, others, start: see `core.source.reading.ReadOptions`.

    Raises:
        OptionError: nobody says which routine.
        FlybyError: it cannot be read.
    """
    from ...core.program.program import Program

    if entry == ALL:
        return Program((), task.name, entries=_entry_points(task))
    chosen = _chosen(backup, task, entry)
    file = task.main if chosen is None else chosen.file
    if file is None:
        raise _which_routine(backup, task, entry)
    if entry is None:
        entry = task.entry if chosen is None else chosen.name
    elif chosen is not None and PurePath(chosen.file).stem.casefold() == entry.casefold():
        entry = chosen.name
    beside = [backup.root / name for name in task.files if name != file]
    vendor = registry().find_vendor(backup.vendor) if setup is None else setup.vendor
    robot = None if setup is None else setup.robot
    signals = {signal.name.lower(): signal.kind.value for signal in backup.signals}
    answers = replace(answers, stated=_stated(backup, task, robot))
    return vendor.read_file(
        backup.root / file, entry, robot, answers, others, start, beside, signals
    )


def _stated(backup: Backup, task: Task, robot: Robot | None) -> Mapping[str, float]:
    """What programs may ask of the arm of a task, unless another one is driven."""
    known = None if task.robot is None else backup.robots[task.robot]
    if known is None or (robot and known.robot and robot.name != known.robot.name):
        return {}
    return known.stated


def _which_routine(backup: Backup, task: Task, entry: str | None) -> InputError:
    """That nobody says which routine to run, or that there is none of that name."""
    if not task.entries:
        return InputError(f"{backup.source}: nothing in {task.name} can be run{_noted(backup)}")
    name, _ = entry_call(entry)
    asked = "which routine?"
    if name is not None:
        asked = f"{task.name} has no routine {name} that moves the robot, as far as is at hand."
    return InputError(
        f"{backup.source}: {asked} Choose with {spelt('entry')}: {listed(_entry_points(task))}"
    )


def _chosen(backup: Backup, task: Task, entry: str | None) -> BackupEntry | None:
    """What the backup says of an entry, or of the only one where none is asked for."""
    if entry is not None:
        return _entry(task, entry)
    wanted = task.entry if task.main is not None else None
    if wanted is None:
        return task.entries[0] if task.main is None and len(task.entries) == 1 else None
    return _entry(task, wanted)


def _entry_points(task: Task) -> tuple[EntryPoint, ...]:
    return tuple(
        EntryPoint(one.name, one.parameters, 1 if one.moves is None else one.moves)
        for one in task.entries
    )


def _noted(backup: Backup) -> str:
    """Why something may be missing, as far as the backup's notes say."""
    return "".join(f"; {note}" for note in backup.notes[:3])
