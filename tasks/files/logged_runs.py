"""Logged runs as users name them: records, programs with logs, folders of both."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.errors import InputError
from ..catalogue import registry

if TYPE_CHECKING:
    from ...core.robot.model import Robot
    from ...core.vendor import Vendor
    from ...identification.logs import Columns, LoggedRun

RECORD = ".json"
LOGS = (".csv", ".txt", ".tsv", ".log", ".xml")
"""Suffixes of a log beside a program of the same name."""


@dataclass(frozen=True)
class Found:
    """What was found where the user points.

    Args:
        runs: of the robot.
        files: that were read.
        others: how many runs of other robots lie in the folders.
    """

    runs: tuple[LoggedRun, ...]
    files: tuple[Path, ...]
    others: int


def find_runs(
    paths: Sequence[Path], vendor: Vendor, robot: Robot, columns: Columns | None = None
) -> Found:
    """Read all runs.

    In folders, runs of other robots are passed over; where one is named itself, it is refused.

    Args:
        paths: records of runs (JSON), programs that have their log beside them, and folders.
        vendor, robot: whose.
        columns: of the logs beside programs.

    Raises:
        InputError: a path names no run, a run cannot be read or is another robot's.
    """
    runs: list[LoggedRun] = []
    files: list[Path] = []
    logs: list[Path] = []
    others = 0
    for path in paths:
        named = not path.is_dir()
        for file in [path] if named else list(_in_folder(path, vendor)):
            if file in files:
                continue
            if not named and _of_another(file, robot):
                others += 1
                continue
            files.append(file)
            logs += [log for log in [_log_of(file)] if log is not None]
            runs.append(_read(file, vendor, robot, columns))
    if not runs:
        where = ", ".join(map(str, paths))
        raise InputError(
            f"{where}: no run of {robot.name}: name records of runs (JSON), programs with a log of "
            "the same name beside them, or folders of these"
        )
    return Found(tuple(runs), (*files, *logs), others)


def _in_folder(folder: Path, vendor: Vendor) -> Iterator[Path]:
    from ...identification.logs.records import robot_of_record

    for file in sorted(folder.rglob("*")):
        suffix = file.suffix.lower()
        if suffix == RECORD:
            if robot_of_record(file) is not None:
                yield file
        elif suffix in vendor.suffixes and _log_beside(file) is not None:
            yield file


def _of_another(file: Path, robot: Robot) -> bool:
    from ...identification.logs.records import robot_of_record

    return file.suffix.lower() == RECORD and robot_of_record(file) != robot.name


def _log_of(file: Path) -> Path | None:
    from ...identification.logs.records import log_of_record

    return log_of_record(file) if file.suffix.lower() == RECORD else _log_beside(file)


def _log_beside(program: Path) -> Path | None:
    beside = (program.with_suffix(suffix) for suffix in LOGS)
    return next((log for log in beside if log.is_file() and log != program), None)


def _read(file: Path, vendor: Vendor, robot: Robot, columns: Columns | None) -> LoggedRun:
    from ...identification.logs import LoggedRun, load_run, read_samples

    if file.suffix.lower() == RECORD:
        run = load_run(file, registry().find_robot)
        if run.robot != robot.name:
            raise InputError(f"{file}: the run is one of {run.robot}, not of {robot.name}")
        return run
    log = _log_beside(file)
    if log is None:
        raise InputError(f"{file}: there is no log of the same name beside it ({', '.join(LOGS)})")
    program = vendor.read_file(file, robot=robot)
    samples = read_samples(log, robot, columns)
    return LoggedRun(log.stem, robot.name, None, program, samples.t, samples.q, samples.notes)
