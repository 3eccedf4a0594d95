"""Logged runs as users name them: records, programs with logs, folders of both."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import InputError, OptionError
from ..catalogue import registry

if TYPE_CHECKING:
    from ...core.robot.model import Robot
    from ...core.vendor import Vendor
    from ...identification.logs import Columns, LoggedRun
    from ...identification.logs.records import Record

RECORD = ".json"
LOGS = (".csv", ".txt", ".tsv", ".log", ".xml")
"""Suffixes of a log beside a program of the same name."""


@dataclass(frozen=True)
class LoggedRuns:
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
) -> LoggedRuns:
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
        for file, record in [(path, _record(path))] if named else _in_folder(path, vendor):
            if file in files:
                continue
            if not named and record is not None and record.robot != robot.name:
                others += 1
                continue
            files.append(file)
            log = _log_beside(file) if record is None else record.log
            logs += [] if log is None else [log]
            runs.append(_read(file, record, vendor, robot, columns))
    if not paths:
        raise OptionError("which logs? Name records of runs, programs with a log, or folders")
    if not runs:
        where = ", ".join(map(str, paths))
        raise InputError(
            f"{where}: no run of {robot.name}: name records of runs (JSON), programs with a log of "
            "the same name beside them, or folders of these"
        )
    return LoggedRuns(tuple(runs), (*files, *logs), others)


def robot_of_records(paths: Sequence[Path]) -> str | None:
    """The robot whose runs the records of runs are that users name; None where none names one.

    Raises:
        OptionError: they are of several robots.
    """
    files = [
        file
        for path in paths
        for file in (sorted(path.rglob(f"*{RECORD}")) if path.is_dir() else [path])
    ]
    robots = sorted({one.robot for one in map(_record, files) if one is not None})
    if len(robots) > 1:
        raise OptionError(
            f"the records are runs of {' and '.join(robots)}: give {spelt('robot')}, whose runs "
            "are taken"
        )
    return robots[0] if robots else None


def _in_folder(folder: Path, vendor: Vendor) -> Iterator[tuple[Path, Record | None]]:
    """Records of runs, and programs that have their log beside them."""
    for file in sorted(folder.rglob("*")):
        suffix = file.suffix.lower()
        if suffix == RECORD:
            record = _record(file)
            if record is not None:
                yield file, record
        elif suffix in vendor.suffixes and _log_beside(file) is not None:
            yield file, None


def _record(file: Path) -> Record | None:
    from ...identification.logs.records import find_record

    return find_record(file) if file.suffix.lower() == RECORD else None


def _log_beside(program: Path) -> Path | None:
    beside = (program.with_suffix(suffix) for suffix in LOGS)
    return next((log for log in beside if log.is_file() and log != program), None)


def _read(
    file: Path, record: Record | None, vendor: Vendor, robot: Robot, columns: Columns | None
) -> LoggedRun:
    from ...identification.logs import LoggedRun, load_run, read_samples

    if file.suffix.lower() == RECORD:
        find = registry().find_robot
        # What is no record, load_run refuses and says why.
        run = load_run(file, find) if record is None else record.run(find)
        if run.robot != robot.name:
            raise InputError(f"{file}: the run is one of {run.robot}, not of {robot.name}")
        return run
    log = _log_beside(file)
    if log is None:
        if not file.exists():
            raise InputError(f"{file}: there is no such file or folder")
        raise InputError(f"{file}: there is no log of the same name beside it ({', '.join(LOGS)})")
    program = vendor.read_file(file, robot=robot)
    samples = read_samples(log, robot, columns)
    return LoggedRun(log.stem, robot.name, None, program, samples.t, samples.q, samples.notes)
