"""``flyby import``: what a backup of a station holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.display import counted
from ..tasks.backup.opening import open_backup
from ..tasks.files.outputs import check_folder, write_in
from .output.console import print_json, print_rich, print_table, progress, warn_of
from .parameters import AsJson, Force

if TYPE_CHECKING:
    from ..core.backup.backup import Backup, BackupEntry, BackupRobot, Task
    from ..core.program.tool import Tool, WorkObject
    from ..core.spatial.pose import Pose

_MOST = 40
"""Rows of a table; ``--json`` has all."""


def import_(
    path: Annotated[
        Path, typer.Argument(help="Backup of a controller: folder, zip, .urp or .installation.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for cell, robot, motion and answers files with the backup's figures."
        ),
    ] = None,
    json: AsJson = False,
    force: Force = False,
) -> None:
    """Show what a station's backup holds: robots, programs, tools, frames, signals, what lacks."""
    check_folder("--out", out)
    with progress("opening the backup"):
        backup = open_backup(path)
    if json:
        print_json(_backup_json(backup))
    else:
        _print(backup)
    warn_of(backup.notes)
    if out is not None:
        _write(backup, path, out, force)


def _write(backup: Backup, path: Path, out: Path, force: bool) -> None:
    from ..tasks.backup.station_files import station_files

    with progress("reading its programs"):
        made = station_files(backup)
    warn_of(made.notes)
    files = {Path(name): data for name, data in made.files.items()}
    inputs = [path] if path.is_file() else []
    for file in write_in("--out", out, files, inputs, force):
        print_rich(f"wrote {file}")


def _print(backup: Backup) -> None:
    version = f", version {backup.version}" if backup.version else ""
    print_rich(f"{backup.source}: {backup.vendor}, {backup.controller or 'controller'}{version}")
    _rows("robots", _ROBOTS, [_robot_cells(robot) for robot in backup.robots])
    for robot in backup.robots:
        for lack in robot.lacks:
            print_rich(f"{robot.unit}: {lack}")
    _rows("tasks", _TASKS, [_task_cells(backup, task) for task in backup.tasks])
    entries = [(task, entry) for task in backup.tasks for entry in task.entries]
    several = len({task.name for task, _ in entries}) > 1
    cells = [_entry_cells(entry, task.name if several else None) for task, entry in entries]
    _rows("entries", _ENTRIES[0 if several else 1 :], cells)
    called = backup.comments
    _rows("tools", _TOOLS, [_tool_cells(*one, called) for one in backup.tools.items()])
    _rows("frames", _FRAMES, [_frame_cells(*one, called) for one in backup.frames.items()])
    if backup.homes:
        print_rich(f"named positions: {', '.join(backup.homes)}")
    if backup.signals:
        kinds = [signal.kind.value for signal in backup.signals]
        told = (counted(kinds.count(kind), kind) for kind in dict.fromkeys(kinds))
        print_rich(f"signals: {', '.join(told)}")
    for key, (value, origin) in backup.motion.items():
        print_rich(f"motion figure {key} = {_figure(value)} ({origin})")


def _figure(value: object) -> str:
    """A figure without what binary fractions add to it."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_figure, value))}]"
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _rows(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    if not rows:
        return
    numbers = {"axes", "payload kg", "moves", "files", "mass kg"}
    sided = [(name, "right" if name in numbers else "left") for name in columns]
    print_table(sided, rows[:_MOST], title)
    if len(rows) > _MOST:
        print_rich(f"and {len(rows) - _MOST} more {title}; --json lists all")


_ROBOTS = (
    "unit",
    "type",
    "robot",
    "payload kg",
    "base x, y, z mm",
    "quaternion w, x, y, z",
    "external axes",
)
_TASKS = ("task", "moves", "files", "begins in", "with")
_ENTRIES = ("task", "entry", "moves", "file", "")
_TOOLS = ("tool", "x, y, z mm", "quaternion w, x, y, z", "mass kg", "")
_FRAMES = ("frame", "x, y, z mm", "quaternion w, x, y, z", "")


def _robot_cells(known: BackupRobot) -> tuple[str, ...]:
    robot = known.robot
    if robot is None:
        return (known.unit, known.written, "not known", "", "", "", "")
    payload = "" if robot.payload is None else f"{robot.payload:g}"
    axes = ", ".join(f"{axis.name} ({axis.role.value})" for axis in robot.external_axes)
    return (known.unit, known.written, robot.name, payload, *_pose(robot.base), axes)


def _task_cells(backup: Backup, task: Task) -> tuple[str, ...]:
    moves = "" if task.robot is None else backup.robots[task.robot].unit
    return (task.name, moves, str(len(task.files)), task.main or "", task.entry or "")


def _entry_cells(entry: BackupEntry, task: str | None) -> tuple[str, ...]:
    name = f"{entry.name}({', '.join(entry.parameters)})" if entry.parameters else entry.name
    moves = "" if entry.moves is None else str(entry.moves)
    return (*([] if task is None else [task]), name, moves, entry.file, entry.comment)


def _tool_cells(name: str, tool: Tool, called: Mapping[str, str]) -> tuple[str, ...]:
    mass = "" if tool.load is None else f"{tool.load.mass:g}"
    told = [called.get(name, ""), "" if tool.robot_held else "stands still"]
    return (name, *_pose(tool.tcp), mass, ", ".join(filter(None, told)))


def _frame_cells(name: str, frame: WorkObject, called: Mapping[str, str]) -> tuple[str, ...]:
    told = "held by the robot" if frame.robot_held else ""
    if frame.moved_by is not None:
        told = f"moved by {frame.moved_by}"
    shown = ", ".join(filter(None, (called.get(name, ""), told)))
    return (name, *_pose(frame.user @ frame.frame), shown)


def _place(pose: Pose) -> str:
    return ", ".join(f"{1e3 * v + 0.0:.1f}" for v in pose.position)


def _pose(pose: Pose) -> tuple[str, str]:
    return _place(pose), ", ".join(f"{v + 0.0:.4f}" for v in pose.quaternion)


def _backup_json(backup: Backup) -> dict[str, Any]:
    return {
        "source": str(backup.source),
        "vendor": backup.vendor,
        "controller": backup.controller,
        "version": backup.version,
        "robots": [_robot_json(robot) for robot in backup.robots],
        "tasks": [_task_json(backup, task) for task in backup.tasks],
        "tools": {name: _tool_json(tool) for name, tool in backup.tools.items()},
        "frames": {name: _frame_json(frame) for name, frame in backup.frames.items()},
        "comments": dict(backup.comments),
        "named_positions": {name: [*at.joints, *at.external] for name, at in backup.homes.items()},
        "signals": [
            {"name": one.name, "kind": one.kind.value, "address": one.address}
            for one in backup.signals
        ],
        "motion": {
            key: {"value": value, "origin": origin}
            for key, (value, origin) in backup.motion.items()
        },
        "notes": [str(note) for note in backup.notes],
        "units": "m, rad, s, kg; quaternions w, x, y, z",
    }


def _robot_json(known: BackupRobot) -> dict[str, Any]:
    robot = known.robot
    told: dict[str, Any] = {"unit": known.unit, "written": known.written, "lacks": [*known.lacks]}
    if robot is None:
        return told | {"robot": None}
    axes = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    return told | {
        "robot": robot.name,
        "payload_kg": robot.payload,
        "base": _pose_json(robot.base),
        "gravity_m_s2": list(robot.gravity),
        "axes": [
            {
                "name": joint.name,
                "kind": joint.kind.value,
                "lower": joint.lower,
                "upper": joint.upper,
                "velocity": joint.velocity,
                "acceleration": joint.acceleration,
            }
            for joint in axes
        ],
        "external_axes": {axis.name: axis.role.value for axis in robot.external_axes},
        "origins": dict(robot.origins),
        "doubts": list(robot.doubts),
    }


def _task_json(backup: Backup, task: Task) -> dict[str, Any]:
    return {
        "name": task.name,
        "moves": None if task.robot is None else backup.robots[task.robot].unit,
        "files": list(task.files),
        "main": task.main,
        "entry": task.entry,
        "entries": [
            {
                "name": entry.name,
                "file": entry.file,
                "comment": entry.comment,
                "parameters": list(entry.parameters),
                "moves": entry.moves,
            }
            for entry in task.entries
        ],
    }


def _tool_json(tool: Tool) -> dict[str, Any]:
    load = tool.load
    return {
        "tcp": _pose_json(tool.tcp),
        "robot_held": tool.robot_held,
        "load": None
        if load is None
        else {
            "mass_kg": load.mass,
            "centre": list(load.centre),
            "inertia_kgm2": list(load.inertia),
            "axes": list(load.axes),
        },
    }


def _frame_json(frame: WorkObject) -> dict[str, Any]:
    return {
        "user": _pose_json(frame.user),
        "object": _pose_json(frame.frame),
        "robot_held": frame.robot_held,
        "moved_by": frame.moved_by,
    }


def _pose_json(pose: Pose) -> dict[str, Any]:
    return {"position": list(pose.position), "quaternion": list(pose.quaternion)}
