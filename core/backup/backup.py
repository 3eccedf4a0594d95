"""What a controller's backup holds, whichever vendor's it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..display import counted, in_line
from ..errors import Note
from ..program.target import JointTarget
from ..program.tool import Tool, WorkObject
from ..robot.model import Robot


class SignalKind(StrEnum):
    """Direction and width of a signal, seen from the controller."""

    DIGITAL_INPUT = "digital input"
    DIGITAL_OUTPUT = "digital output"
    ANALOG_INPUT = "analog input"
    ANALOG_OUTPUT = "analog output"
    GROUP_INPUT = "group input"
    GROUP_OUTPUT = "group output"


@dataclass(frozen=True, slots=True)
class Signal:
    """A signal of a controller.

    Args:
        name: as programs write it.
        kind: what it is.
        address: where it lies on its device, as the controller writes it; None if not stated.
    """

    name: str
    kind: SignalKind
    address: str | None = None


@dataclass(frozen=True)
class BackupRobot:
    """A robot of a backup.

    Args:
        unit: the controller's name of it (``ROB_1``).
        written: its type, as the controller writes it.
        robot: the arm with the backup's own figures (ranges, base, external axes), each group with
            its origin; None if flyby does not know the arm.
        lacks: what is not known of it, and what to do; empty if nothing is.
        stated: what programs may ask of it, by the call in lower case, in the program's units.
    """

    unit: str
    written: str
    robot: Robot | None
    lacks: tuple[str, ...] = ()
    stated: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class BackupEntry:
    """A routine from which a task's program can be run.

    Args:
        name: as ``--entry`` takes it.
        file: that holds it, below the backup's root.
        comment: what the controller says of it (a program number, say).
        parameters: names of those that must be given.
        moves: statements in it, and in what it calls, that move the robot; None if nobody counted.
    """

    name: str
    file: str
    comment: str = ""
    parameters: tuple[str, ...] = ()
    moves: int | None = None


@dataclass(frozen=True)
class Task:
    """A program that a controller runs.

    Args:
        name: the controller's.
        robot: index of the robot that it moves; None for a task without motion.
        files: its source files below the backup's root, in the order in which they are loaded; no
            other file is looked at when a routine of it is read.
        main: the file to read first; None if nothing can be run.
        entry: the routine that the controller would start; None if the operator chooses.
        entries: routines that can be run.
    """

    name: str
    robot: int | None
    files: tuple[str, ...]
    main: str | None
    entry: str | None = None
    entries: tuple[BackupEntry, ...] = ()


@dataclass(frozen=True)
class Backup:
    """A backup, opened.

    Args:
        source: what was opened: a folder, a zip, a file.
        root: the folder on disk that holds the controller's files; of a zip, where it was unpacked.
        vendor: name of the vendor.
        controller: name and type as the backup states them.
        version: of the controller's software, as stated.
        robots: the arms.
        tasks: the programs.
        tools, frames: by name, those that the controller declares for all of its programs.
        homes: named positions.
        comments: what the operator calls a tool or frame, by its name.
        signals: in the controller's order.
        motion: figures of the motion model that the backup states, by their names in motion files
            (``"time.period_s"``), each with its value and its origin.
        notes: what is left out, missing or doubtful, with its file.
        unpacked: the folder that an archive was unpacked to; None of what is no archive.
    """

    source: Path
    root: Path
    vendor: str
    controller: str
    version: str
    robots: tuple[BackupRobot, ...]
    tasks: tuple[Task, ...]
    tools: Mapping[str, Tool] = field(default_factory=dict)
    frames: Mapping[str, WorkObject] = field(default_factory=dict)
    homes: Mapping[str, JointTarget] = field(default_factory=dict)
    comments: Mapping[str, str] = field(default_factory=dict)
    signals: tuple[Signal, ...] = ()
    motion: Mapping[str, tuple[Any, str]] = field(default_factory=dict)
    notes: tuple[Note, ...] = ()
    unpacked: Path | None = None

    def __post_init__(self) -> None:
        for name in ("tools", "frames", "homes", "comments", "motion"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def __repr__(self) -> str:
        return in_line(
            f"Backup {self.source.name} of {self.vendor}: {counted(self.robots, 'robot')}, "
            f"{counted(self.tasks, 'task')}, {counted(self.signals, 'signal')}"
        )
