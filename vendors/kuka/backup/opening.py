"""What is in an archive of a KUKA controller, put together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path, PurePosixPath

from ....core.backup.backup import Backup
from ....core.backup.contents import BackupNotes, listed
from ....core.errors import InputError
from ....core.robot.model import Robot
from .arms import lists_of, robots_of, tables_in
from .contents import Contents
from .declared import Declared, declared_in, machines_of
from .figures import motion_figures
from .identity import identity_of
from .marks import CONFIG, MACHINE, programs_in, root_in, vkrc_programs
from .signals import signals_in
from .tasks import source_files, tasks_of

VENDOR = "kuka"


def opened(source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
    """The archive in a folder; see `BackupOpener.open`."""
    notes = BackupNotes()
    contents = Contents(root, notes)
    if root_in(contents.names) is None and programs_in(contents.names) is None:
        raise InputError(
            f"{source}: no archive of a KUKA controller: no folder R1 or STEU with data lists, no "
            f"program, and no {MACHINE}, is in it"
        )
    layout = contents.layout
    volkswagens = vkrc_programs(contents.names, layout)
    if volkswagens:
        notes.add(
            "an archive of a VKRC (VW System Software): its programs in Folgen, UPs and Makros are "
            "left out, as their inline forms set speeds and stops by routines of Volkswagen's, "
            "which are not read. Export them for a KSS controller from the offline system"
        )
    if layout.copies:
        notes.add(f"{listed(layout.copies)} left out: {layout.robot or 'R1'} is read")
    if layout.loose:
        notes.add(
            f"read as parts of {layout.robot}, beside which they stand: {listed(layout.loose)}"
        )
    lists = lists_of(contents)
    identity = identity_of(contents, lists.machine)
    files = [name for name in source_files(contents) if name not in volkswagens]
    config_file = next((f for f in files if PurePosixPath(f).name.casefold() == CONFIG), None)
    config = contents.data(config_file)
    machines = machines_of(config, notes)
    robots = robots_of(contents, lists, machines, identity.robot, find_robot)
    arm = robots[0].robot
    tasks = tasks_of(contents, files)
    if volkswagens and lists.machine is None and config is None:
        raise InputError(f"{source}: {notes.all()[0]}")
    declared = Declared()
    if config is not None:
        declared = declared_in(config, machines, tables_in(lists), arm, notes)
    _note_missing(notes, bool(tasks), config is not None)
    data = [one for f in files if f.casefold().endswith(".dat") and (one := contents.source(f))]
    return Backup(
        source=source,
        root=root,
        vendor=VENDOR,
        controller=identity.controller,
        version=identity.version,
        robots=robots,
        tasks=tasks,
        tools=declared.tools,
        frames=declared.frames,
        homes=declared.homes,
        comments=declared.comments,
        signals=signals_in(data),
        motion=motion_figures(config, lists.machine),
        notes=notes.all(),
    )


def _note_missing(notes: BackupNotes, programs: bool, config: bool) -> None:
    """What an archive has, and this one lacks."""
    if not programs:
        notes.add("no programs are in it: no .src below R1")
    if not config:
        notes.add(f"no {CONFIG} is in it: tools, bases and homes are not known")
