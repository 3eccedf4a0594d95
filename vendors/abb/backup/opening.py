"""What is in a backup of an ABB controller, put together."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

from ....core.backup.backup import Backup, BackupRobot
from ....core.backup.contents import BackupNotes, listed
from ....core.errors import InputError
from ....core.robot.model import Robot
from ....core.source.collection import collection_paused
from .backinfo import BackInfo, arms_in, parse_backinfo
from .cfg import Parameters, parse_parameters
from .contents import Contents
from .declared import Declared
from .marks import modules_in, nested_in, root_in
from .mechanics import mechanics_of
from .modules import ModuleFiles
from .planner import motion_figures
from .signals import signals_of
from .tasks import LoadedTask, arm_of, loaded_tasks, moves_an_arm, named_group, task_of, unit_groups

VENDOR = "abb"
_CONTROLLERS = {"4": "S4C+", "5": "IRC5", "6": "IRC5", "7": "OmniCore"}
"""By the first digit of the software's version."""
_OPTIONS = ("system.xml", "BACKINFO/rw6system.xml")
_WITHIN = re.compile(r">([^<>]+)<")


def opened(source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
    """The backup in a folder; see `BackupOpener.open`."""
    with collection_paused():
        return _opened(source, root, find_robot)


def _opened(source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
    notes = BackupNotes()
    contents = Contents(root, notes)
    if root_in(contents.names) is None and modules_in(contents.names) is None:
        raise InputError(
            f"{source}: no backup of an ABB controller: neither BACKINFO/backinfo.txt nor "
            "RAPID/TASKn nor PROGMOD nor SYSPAR/MOC.cfg is in it"
        )
    nested = nested_in(contents.names)
    if nested:
        notes.add(
            f"further backups in it are left out, to be named by themselves: {listed(nested)}"
        )
    text = contents.text("BACKINFO/backinfo.txt")
    info = parse_backinfo(text or "")
    sys, moc, eio = (_parameters(contents, name, notes) for name in ("SYS", "MOC", "EIO"))
    tasks = loaded_tasks(contents, info, sys, ModuleFiles(contents), notes)
    if not (any(task.files for task in tasks) or sys or moc or eio or info.tasks):
        raise InputError(
            f"{source}: nothing of this backup can be read: {_first(notes) or 'it is empty'}"
        )
    if tasks and not sys.file and any(task.listed.folder for task in tasks):
        notes.add(
            "SYS.cfg is not in the backup: which tasks move an arm is taken from their routines, "
            "and they are taken to begin in PROC main"
        )
    return _backup(source, root, contents, info, (sys, moc, eio), tasks, find_robot, notes)


def _backup(
    source: Path,
    root: Path,
    contents: Contents,
    info: BackInfo,
    parameters: tuple[Parameters, Parameters, Parameters],
    tasks: Sequence[LoadedTask],
    find_robot: Callable[[str], Robot],
    notes: BackupNotes,
) -> Backup:
    sys, moc, eio = parameters
    groups = unit_groups(sys)
    members = {robot.casefold(): units for robot, units in groups.values() if robot}
    driven = {named_group(task) for task in tasks if moves_an_arm(task, tasks)}
    positioners = {
        group: units for group, (robot, units) in groups.items() if not robot and group in driven
    }
    products = info.arms or _products(contents)
    mechanics = mechanics_of(moc, products, members, find_robot, notes, positioners)
    robots = mechanics.robots if moc or tasks else ()
    if mechanics.alone:
        notes.add(f"no arm moves the units {listed(mechanics.alone)}: they are taken to stand")
    hooks = _hooks(sys)
    handed = []
    declared = Declared()
    for task in tasks:
        index = _index(task, tasks, groups, robots, notes)
        handed.append(task_of(task, index, hooks, notes))
        if index is not None:
            declared.add(task.name, task.files, robots[index].robot, notes)
    _note_hooks(sys, tasks, notes)
    _note_add_ins(sys, contents, notes)
    return Backup(
        source=source,
        root=root,
        vendor=VENDOR,
        controller=_controller(info, root),
        version=info.version,
        robots=robots,
        tasks=tuple(handed),
        tools=declared.tools,
        frames=declared.frames,
        homes=declared.homes,
        signals=signals_of(eio, notes),
        motion=motion_figures(moc, notes),
        notes=notes.all(),
    )


def _index(
    task: LoadedTask,
    tasks: Sequence[LoadedTask],
    groups: dict[str, tuple[str, list[str]]],
    robots: Sequence[BackupRobot],
    notes: BackupNotes,
) -> int | None:
    """Index of the arm that a task moves."""
    if not moves_an_arm(task, tasks):
        return None
    index = arm_of(task, groups, [robot.unit for robot in robots])
    if index is None:
        notes.add(f"motion task {task.name} moves no arm that is known: it is not driven")
    return index


def _controller(info: BackInfo, root: Path) -> str:
    digit = info.version.rpartition(" ")[2][:1]
    kind = _CONTROLLERS.get(digit, "") if info.version else ""
    return ", ".join(filter(None, (info.system or root.name, kind)))


def _parameters(contents: Contents, topic: str, notes: BackupNotes) -> Parameters:
    """A topic of the system parameters; empty where its file is missing or damaged."""
    names = (f"SYSPAR/{topic}.cfg", f"{topic}.cfg")
    name = next((found for one in names if (found := contents.find(one))), None)
    if name is None:
        return Parameters()
    text = contents.text(name)
    if text is None:
        return Parameters(name)
    parameters = parse_parameters(text, name)
    for note in parameters.notes:
        notes.add(note.message, *(() if note.span is None else (note.span.file, note.span.line)))
    return parameters


def _products(contents: Contents) -> tuple[str, ...]:
    """Arms among the options of ``system.xml``."""
    for name in _OPTIONS:
        arms = arms_in(_WITHIN.findall(contents.text(name) or ""))
        if arms:
            return arms
    return ()


def _hooks(sys: Parameters) -> dict[str, str]:
    """When the controller runs a routine by itself, by the routine's name in lower case."""
    found: dict[str, str] = {}
    for record in sys.section("CAB_EXEC_HOOKS"):
        routine, event = record.text("routine"), record.text("shelf") or record.text("event")
        if routine is not None:
            found.setdefault(routine.casefold(), f"event routine ({event or 'event not stated'})")
    return found


def _note_hooks(sys: Parameters, tasks: Sequence[LoadedTask], notes: BackupNotes) -> None:
    """Event routines that move an arm run beside the program."""
    hooks = _hooks(sys)
    found = {
        routine.text: hooks[routine.name]
        for task in tasks
        for file in task.files
        for routine in file.routines
        if routine.name in hooks and id(routine) in task.moving
    }
    if found:
        said = listed(f"{name}, {when}" for name, when in found.items())
        notes.add(f"the controller runs routines that move the robot by itself, not driven: {said}")


def _note_add_ins(sys: Parameters, contents: Contents, notes: BackupNotes) -> None:
    """Modules of add-ins are loaded from the controller's disk, of which a backup has HOME alone.

    Those of RobotWare itself (``RELEASE:``) are on every controller.
    """
    at_hand = {name.rpartition("/")[2].casefold() for name in contents.names}
    absent = []
    for record in sys.section("CAB_TASK_MODULES"):
        path = (record.text("file") or "").replace("\\", "/")
        name = path.rpartition("/")[2]
        if name and name.casefold() not in at_hand and not path.upper().startswith("RELEASE:"):
            absent.append(name)
    if absent:
        names = listed(dict.fromkeys(absent))
        notes.add(
            f"SYS.cfg loads modules that are not in the backup (of add-ins, or of HOME): {names}"
        )


def _first(notes: BackupNotes) -> str:
    return next((str(note) for note in notes.all()), "")
