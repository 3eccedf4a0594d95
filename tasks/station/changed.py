"""What an improvement of a station's programs returns."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from ...core.display import in_line
from ...core.door import spelt, switched
from ...core.errors import InputError, Note
from ...core.files.reading import MOST_TOML_BYTES, read_text
from ...core.notebook import page, table
from ...core.source.patch.runnable import runnable_files
from ...core.station.station import RobotStation

if TYPE_CHECKING:
    from ...problems.improve.solution import Solution
    from ...problems.improve.station.feasibility import StationSnapshot

ROBOTS = (
    ("robot", "left"),
    ("drives, s", "right"),
    ("after", "right"),
    ("ends, s", "right"),
    ("after", "right"),
    ("proven", "left"),
)
_PATHS = re.compile(r"""(?P<before>\b(program|cell|answers)\s*=\s*)("[^"\n]*"|'[^'\n]*')""")
_TABLE = re.compile(r"^\s*\[\[?(?P<name>[^\]\n]*)\]", re.MULTILINE)


@dataclass(frozen=True, repr=False)
class ChangedStation:
    """A station with better programs.

    Args:
        file: the station file.
        station: as it was given.
        before, after: the station with the programs as given, and with the new ones.
        solutions: by robot; robots that stay as they are may be left out.
        notes: what a user should know.
    """

    file: Path
    station: RobotStation
    before: StationSnapshot
    after: StationSnapshot
    solutions: Mapping[str, Solution]
    notes: tuple[Note, ...]

    def __repr__(self) -> str:
        made = f"{self.before.duration:.3f} s → {self.after.duration:.3f} s"
        return in_line(f"Station {self.file.name}: {made if self.changed else 'unchanged'}")

    @property
    def changed(self) -> bool:
        """Whether any program is another one than was given."""
        return any(solution.changed for solution in self.solutions.values())

    @property
    def proven(self) -> bool:
        """Whether every robot is proven to keep clear of its cell; of each other they are."""
        return all(solution.proven for solution in self.solutions.values())

    @property
    def gain(self) -> float:
        """Percent of the station time that is saved."""
        return 100.0 * (1.0 - self.after.duration / self.before.duration)

    def robot_rows(self) -> list[tuple[str, ...]]:
        """A line a robot."""
        rows = []
        for name in self.station.members:
            solution = self.solutions.get(name)
            states = self.before, self.after
            drives = [state.station.members[name].run.duration for state in states]
            ends = [state.run.schedules[name].end for state in states]
            said = "stays" if solution is None else _said(solution)
            times = [drives[0], drives[1], ends[0], ends[1]]
            rows.append((name, *(f"{t:.3f}" for t in times), said))
        return rows

    @property
    def files(self) -> dict[str, bytes]:
        """The station for a folder: every robot's files in one of its name, and the station file.

        Raises:
            InputError: a program was not read from source files.
        """
        return self.files_in(None)

    def files_in(self, out: Path | None) -> dict[str, bytes]:
        """The same for a folder that is known: cell files are named by their way from there."""
        made: dict[str, bytes] = {}
        places: dict[str, str] = {}
        for name, member in self.station.members.items():
            solution = self.solutions.get(name)
            texts = {} if solution is None else solution.texts
            backup = getattr(member.program.setup, "backup", None)
            if backup is not None:
                from ..backup.copy import copy_of

                changed = {Path(file.name): file.data for file in texts.values()}
                copied = copy_of(backup, changed, Path(name)).files
                made |= {path.as_posix(): data for path, data in copied.items()}
                places[name] = name
                continue
            own = runnable_files(member.program, texts)
            made |= {f"{name}/{PurePath(file).as_posix()}": data for file, data in own.items()}
            places[name] = name
        made[self.file.name] = self._text(places, made, out).encode()
        return made

    def _text(self, places: Mapping[str, str], made: Mapping[str, bytes], out: Path | None) -> str:
        """The station file with the new programs' places."""
        text = read_text(self.file, MOST_TOML_BYTES)
        parts, last = [], 0
        for robot, found in _paths(text):
            if robot not in places:
                continue
            given = found[3][1:-1]
            if found[2] == "program":
                new = _place_of(PurePath(given).name, robot, made)
            elif out is None:
                new = Path(os.path.abspath(self.file.parent / given)).as_posix()
            else:
                new = Path(os.path.relpath(self.file.parent / given, out)).as_posix()
            parts += [text[last : found.start()], found["before"], f'"{new}"']
            last = found.end()
        return "".join([*parts, text[last:]])

    def refuse_shared(self) -> None:
        """Refuse changes in place of a file that several robots drive.

        Raises:
            InputError: naming the file and the robots.
        """
        owners: dict[str, str] = {}
        for name, solution in self.solutions.items():
            for file in solution.texts.values():
                other = owners.setdefault(os.path.realpath(file.name), name)
                if other != name:
                    raise InputError(
                        f"{switched('in_place')}: {other} and {name} both drive {file.name}, and "
                        f"each needs numbers of its own: name a folder by {spelt('out')}"
                    )

    def as_json(self) -> dict[str, Any]:
        """All figures; times in s."""
        return {
            "station_time_before_s": self.before.duration,
            "station_time_s": self.after.duration,
            "changed": self.changed,
            "proven": self.proven,
            "robots": [
                {
                    "name": row[0],
                    "drives_before_s": float(row[1]),
                    "drives_s": float(row[2]),
                    "ends_before_s": float(row[3]),
                    "ends_s": float(row[4]),
                    "proven": row[5],
                }
                for row in self.robot_rows()
            ],
            "notes": [str(note) for note in self.notes],
        }

    def _repr_html_(self) -> str:
        return page(repr(self), table(ROBOTS, self.robot_rows()), notes=self.notes)


def refuse_unwritable(file: Path, robots: Iterable[str]) -> None:
    """Refuse a station file in which the programs' places cannot be changed.

    Raises:
        InputError: naming the robot.
    """
    found = _paths(read_text(file, MOST_TOML_BYTES))
    known = {robot for robot, path in found if path[2] == "program"}
    for name in robots:
        if name not in known:
            raise InputError(
                f"{file.name}: the new place of {name}'s program can be written only where its old "
                f"one has a line of its own, below [robot.{name}]: write it so"
            )


def _paths(text: str) -> Iterator[tuple[str, re.Match[str]]]:
    """The robots' paths in a station file, with whose they are."""
    heads = list(_TABLE.finditer(text))
    for found in _PATHS.finditer(text):
        head = [h for h in heads if h.start() < found.start()][-1:]
        keys = [word.strip(" \"'") for word in head[0]["name"].split(".")] if head else []
        if len(keys) == 2 and keys[0] == "robot":
            yield keys[1], found


def _said(solution: Solution) -> str:
    proof = solution.certificate
    if proof is None or not proof.proven:
        return "not proven" if proof is None else proof.message
    free = math.isinf(proof.clearance)
    return "nothing is near" if free else f"{1e3 * proof.clearance:.1f} mm to its cell"


def _place_of(name: str, robot: str, made: Mapping[str, bytes]) -> str:
    """Where a robot's program lies among the new files: its file, or its folder."""
    for path in made:
        if path.startswith(f"{robot}/") and PurePath(path).name == name:
            return path
    return robot
