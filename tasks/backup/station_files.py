"""What a backup says of its station as flyby's own files: cell, robot, motion, answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.errors import FlybyError, Note
from ..catalogue import registry

if TYPE_CHECKING:
    from ...core.backup.backup import Backup, Task
    from ...core.robot.model import Robot


@dataclass(frozen=True)
class StationFiles:
    """Files of a station.

    Args:
        files: contents by name.
        notes: what could not be made.
    """

    files: Mapping[str, bytes]
    notes: tuple[Note, ...]


def station_files(backup: Backup) -> StationFiles:
    """Cell, robot, motion and answers of every robot that a backup moves.

    A backup without programs has those of its robots, and no answers.

    Of one robot they are ``cell.toml``, ``robot.toml``, ``motion.toml`` and ``answers.toml``; of
    several each is named after its task as well. The cell names the other files; what stands around
    the robot no backup says, and it has to be added.
    """
    files: dict[str, bytes] = {}
    notes: list[Note] = []
    moving = [task for task in backup.tasks if task.robot is not None] or _without_programs(backup)
    for task in moving:
        suffix = f"_{_in_file_names(task.name)}" if len(moving) > 1 else ""
        known = backup.robots[task.robot] if task.robot is not None else None
        if known is None or known.robot is None:
            notes.append(Note(f"no cell is written of {task.name}: its robot is not known"))
            continue
        try:
            files |= _cell(backup, known.robot, suffix)
        except FlybyError as error:
            notes.append(Note(f"no cell is written of {task.name}: {error}"))
        if not task.files:
            continue
        try:
            files[f"answers{suffix}.toml"] = _answers(backup, task)
        except FlybyError as error:
            notes.append(Note(f"no answers are asked for {task.name}: {error}"))
    return StationFiles(files, tuple(notes))


def _without_programs(backup: Backup) -> list[Task]:
    """A task of each robot, with nothing to run."""
    from ...core.backup.backup import Task

    return [Task(robot.unit, number, (), None) for number, robot in enumerate(backup.robots)]


def _in_file_names(task: str) -> str:
    """A task's name as names of files have it."""
    return "".join(sign if sign.isalnum() else "_" for sign in task.lower())


def _cell(backup: Backup, robot: Robot, suffix: str) -> dict[str, bytes]:
    from ...core.cell.cell_text import cell_text
    from ...core.robot.catalogue_text import robot_text

    robot_file, motion_file = f"robot{suffix}.toml", f"motion{suffix}.toml"
    files = {robot_file: _headed(backup, robot_text(robot))}
    if backup.motion:
        files[motion_file] = _headed(backup, _motion(backup, robot))
    motion = motion_file if backup.motion else None
    text = cell_text(robot, robot_file, backup.tools, backup.frames, motion)
    return {f"cell{suffix}.toml": _headed(backup, text), **files}


def _motion(backup: Backup, robot: Robot) -> str:
    """The figures that the controller's own files state, each with its source."""
    from ...core.files.toml_text import string_text
    from ...core.motion.model.motion_file import figures_text
    from ...core.motion.model.provenance import provenance_text

    vendor = registry().find_vendor(backup.vendor).with_stated(robot, backup.motion)
    model = vendor.motion_of(robot)
    origins = {key: model.provenance[key] for key in backup.motion}
    lines = [f"robot = {string_text(robot.name)}", figures_text(model, backup.motion)]
    return "\n".join([*lines, "", provenance_text(origins)])


def _answers(backup: Backup, task: Task) -> bytes:
    from ..read import SourceOptions, answers_of
    from ..results.questions import Questions
    from .opening import read_task, setup_in

    options = SourceOptions(task=task.name)
    setup = setup_in(backup, task, options)
    program = read_task(backup, task, setup, None, answers_of(options), (), None)
    return Questions.of(program.questions, task.name).toml.encode()


def _headed(backup: Backup, text: str) -> bytes:
    said = ", ".join(filter(None, (backup.source.name, backup.controller, backup.version)))
    return f"# From the backup {' '.join(said.split())}\n{text}".encode()
