"""The tasks of a backup: their modules, the arm that each moves, and what can be run of them.

``BACKINFO/backinfo.txt`` lists which modules each task had loaded; without it all modules of
``RAPID/TASKn`` are. SYS.cfg has the tasks' kinds: ``CAB_TASKS`` with MotionTask, Entry and the
group of units, ``MECHANICAL_UNIT_GROUP``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ....core.backup.backup import BackupEntry, Task
from ....core.backup.contents import BackupNotes, listed
from ....core.display import counted
from ..run.files import MODULES
from .backinfo import BackInfo, ListedTask
from .cfg import Parameters, Record
from .contents import Contents
from .loose import loose_tasks
from .modules import (
    ModuleFile,
    ModuleFiles,
    doubled,
    loaded_at_runtime,
    moving_routines,
)

_FOLDER = re.compile(r"(?:(?:rapid/)?(task\d+)/)?(?:progmod|sysmod)/[^/]+", re.IGNORECASE)
_SHARED = "TASK0"
"""Where IRC5 and OmniCore keep modules that all tasks share; S4C+ kept its only task there."""
_MAIN = "main"
_HOME = "HOME"
_FAULTS = 4
"""Files that cannot be parsed and have a note each."""


@dataclass(frozen=True)
class LoadedTask:
    """A task with the modules that can be read of it.

    Args:
        listed: as the list has it.
        files: of its modules, in the order in which they are loaded, shared ones last.
        record: of SYS.cfg; None if there is none.
        moving: of its routines that move an arm, by identity, how many statements do; see
            `moving_routines`.
    """

    listed: ListedTask
    files: tuple[ModuleFile, ...]
    record: Record | None
    moving: Mapping[int, int]

    @property
    def name(self) -> str:
        """The controller's; of its folder if the list does not say."""
        return self.listed.name or self.listed.folder


@dataclass
class _Missing:
    """What of a task is not at hand."""

    absent: list[str] = field(default_factory=list)
    encoded: list[str] = field(default_factory=list)


def loaded_tasks(
    contents: Contents, info: BackInfo, sys: Parameters, modules: ModuleFiles, notes: BackupNotes
) -> list[LoadedTask]:
    """The tasks in the order of the list."""
    stated = list(info.tasks)
    named = _named_folders(contents, sys) if not stated else []
    loose = _loose(contents, sys, modules) if not stated and not named else []
    given = stated or named or loose
    shared = [task for task in given if _is_shared(task, given, sys)]
    common = [file for task in shared for file in _files(contents, task, modules, notes)]
    found = []
    for task in given:
        if task in shared:
            continue
        own = _files(contents, task, modules, notes)
        own += _at_runtime(contents, own, modules, notes)
        files = tuple(_fitting([*own, *common], notes))
        moving = moving_routines(files)
        found.append(LoadedTask(task, files, _record(task, sys), moving))
    if stated:
        _note_unlisted(contents, stated, notes)
    elif named:
        notes.add(
            "BACKINFO/backinfo.txt, the list of loaded modules, is not in the backup: all modules "
            "of each task's folder are taken as loaded"
        )
    elif loose:
        notes.add(
            f"no task's folder (RAPID/TASK1) is at hand: what lies together is taken as loaded "
            f"together, {counted(loose, 'task')} that each begin in PROC main"
        )
    return found


def _loose(contents: Contents, sys: Parameters, modules: ModuleFiles) -> list[ListedTask]:
    """Tasks of folders of any name; beside system parameters what lies in HOME is not loaded."""
    home = f"{_HOME.casefold()}/" if sys else None
    names = [n for n in contents.names if home is None or not n.casefold().startswith(home)]
    found = loose_tasks(contents, names, modules)
    records = [one for one in sys.section("CAB_TASKS") if one.flag("motiontask")]
    if len(found) == len(records) == 1:
        return [replace(found[0], name=records[0].name)]
    return found


def _is_shared(task: ListedTask, given: Sequence[ListedTask], sys: Parameters) -> bool:
    if task.folder != _SHARED or len(given) < 2:
        return False
    return _record(task, sys) is None and (bool(sys) or task.name.upper() in ("", "SHARED"))


def _record(task: ListedTask, sys: Parameters) -> Record | None:
    return sys.named("CAB_TASKS", task.name)


# modules


def _files(
    contents: Contents, task: ListedTask, modules: ModuleFiles, notes: BackupNotes
) -> list[ModuleFile]:
    """The modules of a task that can be read; what cannot is noted."""
    missing = _Missing()
    names: list[str] = []
    for one in task.modules or _all_modules(contents, task):
        name = one if isinstance(one, str) else f"{contents.task(task.folder)}/{one.file}"
        found = contents.find(name)
        if found is None:
            missing.absent.append(name.rpartition("/")[2])
        else:
            names.append(found)
    readable, faults = [], 0
    for file in modules.read(names):
        if file.encoded:
            missing.encoded.append(file.name.rpartition("/")[2])
        elif file.fault:
            faults += 1
            if faults <= _FAULTS:
                notes.add(f"the module is left out: {file.fault}", file.name, file.line)
        else:
            readable.append(file)
    place = contents.task(task.folder) or task.name
    if faults > _FAULTS:
        notes.add(f"{place}: {faults - _FAULTS} more modules cannot be parsed and are left out")
    if missing.absent:
        count = f"{len(missing.absent)} of {counted(task.modules, 'listed module')}"
        are = "is" if len(missing.absent) == 1 else "are"
        notes.add(f"{place}: {count} {are} not in the backup: {listed(missing.absent)}")
    if missing.encoded:
        notes.add(
            f"{place}: only the controller can read encoded modules, which are left out: "
            f"{listed(missing.encoded)}"
        )
    return readable


def _at_runtime(
    contents: Contents, files: Sequence[ModuleFile], modules: ModuleFiles, notes: BackupNotes
) -> list[ModuleFile]:
    """Modules of the controller's disk that those of a task load, and so on."""
    found: dict[str, ModuleFile] = {}
    todo = list(files)
    while todo:
        file = todo.pop(0)
        for path in loaded_at_runtime(file):
            name = contents.find(path)
            if name is None:
                notes.add(f"{file.name} loads {path}, which is not in the backup")
            elif name not in found and name not in {one.name for one in files}:
                (one,) = modules.read([name])
                if one.modules:
                    found[name] = one
                    todo.append(one)
                    notes.add(f"{name}, which {file.name} loads as it runs, is taken as loaded")
                else:
                    why = one.fault or "only the controller can read it"
                    notes.add(f"{name}, which {file.name} loads, is left out: {why}")
    return list(found.values())


def _all_modules(contents: Contents, task: ListedTask) -> list[str]:
    return [
        name
        for name in contents.below(contents.task(task.folder))
        if (found := _FOLDER.fullmatch(name)) is not None
        and (found[1] or "").upper() == task.folder
        and name.lower().endswith(MODULES)
    ]


def _fitting(files: Sequence[ModuleFile], notes: BackupNotes) -> list[ModuleFile]:
    """Those that a controller could load together, earlier ones first."""
    taken: dict[str, str] = {}
    fitting = []
    for file in files:
        double = doubled(file, taken)
        if double is None:
            fitting.append(file)
        else:
            name, first = double
            anew = "twice" if first == file.name else f"anew, which {first} has"
            notes.add(f"{file.name} is left out: it declares {name} {anew}")
    return fitting


def _note_unlisted(contents: Contents, tasks: Sequence[ListedTask], notes: BackupNotes) -> None:
    known = {f"RAPID/{t.folder}/{m.file}".casefold() for t in tasks for m in t.modules}
    others = [
        name
        for name in contents.below("RAPID")
        if name.lower().endswith(MODULES) and name.casefold() not in known
    ]
    if others:
        are = "is" if len(others) == 1 else "are"
        notes.add(f"not in the list of loaded modules, and so not read, {are} {listed(others)}")


def _named_folders(contents: Contents, sys: Parameters) -> list[ListedTask]:
    """Tasks by their folders, called as SYS.cfg has them where it has as many."""
    found = filter(None, map(_FOLDER.fullmatch, contents.names))
    folders = sorted({(one[1] or "").upper() for one in found}, key=lambda name: int(name[4:] or 0))
    records = sys.section("CAB_TASKS")
    own = [folder for folder in folders if folder != _SHARED] or folders
    paired = zip(own, records, strict=True) if len(own) == len(records) else ()
    called = {folder: record.name for folder, record in paired} | {"": contents.root.name}
    return [ListedTask(folder, called.get(folder, ""), "", (), 1) for folder in folders]


# arms and entries


def unit_groups(sys: Parameters) -> dict[str, tuple[str, list[str]]]:
    """The groups of units by name, in lower case: the robot of each (or ``""``), other units."""
    return {
        group.name.casefold(): (group.text("robot") or "", group.numbered("mechanicalunit_"))
        for group in sys.section("MECHANICAL_UNIT_GROUP")
    }


def moves_an_arm(task: LoadedTask, tasks: Sequence[LoadedTask]) -> bool:
    """Whether a task is a motion task: by SYS.cfg, or else by what its routines do."""
    if any(_is_flagged(one) for one in tasks):
        return _is_flagged(task)
    return bool(task.moving)


def _is_flagged(task: LoadedTask) -> bool:
    return task.record is not None and task.record.flag("motiontask")


def named_group(task: LoadedTask) -> str | None:
    """The group of units that a task moves, in lower case; None if it names none."""
    group = None if task.record is None else task.record.text("usemechanicalunitgroup")
    return None if group is None else group.casefold()


def arm_of(
    task: LoadedTask, groups: Mapping[str, tuple[str, list[str]]], robots: Sequence[str]
) -> int | None:
    """Index of the arm that a motion task moves; None if it moves none.

    Args:
        task: a motion task.
        groups: see `unit_groups`.
        robots: names of the arms.
    """
    group = named_group(task)
    if group is not None and group in groups:
        return _called(groups[group][0] or group, robots)
    if len(robots) == 1:
        return 0
    for name in (group, task.name.partition("_")[2], task.name):
        found = None if not name else _called(name, robots)
        if found is not None:
            return found
    return None


def _called(name: str, robots: Sequence[str]) -> int | None:
    folded = [robot.casefold().replace("_", "") for robot in robots]
    key = name.casefold().replace("_", "")
    return folded.index(key) if key in folded else None


def task_of(
    task: LoadedTask, robot: int | None, hooks: Mapping[str, str], notes: BackupNotes
) -> Task:
    """What is handed out of a task.

    Args:
        task: with its modules.
        robot: index of its arm.
        hooks: by routine, in lower case, when the controller runs it by itself.
        notes: where is said that the entry is missing.
    """
    files = tuple(file.name for file in task.files)
    stated = (task.record.text("entry") if task.record is not None else None) or _MAIN
    if robot is None:
        return Task(task.name, None, files, None, stated if task.record is not None else None)
    entries: list[BackupEntry] = []
    first: BackupEntry | None = None
    for file in task.files:
        for routine in file.routines:
            if routine.kind != "proc" or routine.local:
                continue
            entry = BackupEntry(
                routine.text,
                file.name,
                hooks.get(routine.name, ""),
                tuple(p.text for p in routine.parameters if not p.optional),
                task.moving.get(id(routine), 0),
            )
            if routine.name == stated.casefold():
                first = entry
            elif id(routine) in task.moving:
                entries.append(entry)
    if first is not None:
        entries.insert(0, first)
    elif entries:
        notes.add(f"task {task.name}: its entry, PROC {stated}, is in none of the modules at hand")
    elif files:
        notes.add(f"task {task.name} has neither PROC {stated} nor another that moves the robot")
    else:
        notes.add(f"task {task.name} has no module that can be read")
    return Task(
        task.name,
        robot,
        files,
        entries[0].file if entries else None,
        None if first is None else first.name,
        tuple(entries),
    )
