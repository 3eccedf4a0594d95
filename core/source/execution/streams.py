"""Motion that a computer sends while a program runs (EGM, RSI, ``servoj``), from a file.

A stream is a table of joint values over time. It is driven as a chain of joint moves, each with its
time, through those of its rows between which the joints run straight, and passes them closely.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from ...arrays import FloatArray
from ...errors import InputError, SourceError, Span
from ...files.reading import read_bytes
from ...program.move import MoveJ
from ...program.speed import Speed
from ...program.target import JointTarget
from ...program.zone import FINE, Radius
from ...robot.model import Robot

_STRAIGHT = math.radians(0.05)
"""rad by which the joints may be off a straight course, over time, between two targets."""
_PASSED = Radius(1e-3)
"""In which targets are passed: the nearest that all controllers take."""
_MOST_ROWS = 1_000_000
_LARGEST_FILE = 200_000_000
_SLACK = 1.001
"""Times its greatest speed that a joint may be asked for: files are rounded."""


@dataclass(frozen=True, eq=False)
class Stream:
    """Joint values over time.

    Args:
        times: (n,) s, growing.
        joints: (n, k) rad.
        file: where it stands, for messages.
    """

    times: FloatArray
    joints: FloatArray
    file: str

    def moves(self, span: Span, robot: Robot | None) -> list[MoveJ]:
        """The joint moves that drive it, the first to where it begins.

        Args:
            span: of the statement that is streamed to.
            robot: that it is sent to; None where none is known.

        Raises:
            SourceError: a joint would turn faster than it can, or the arm has another number.
        """
        if robot is not None:
            self._check(span, np.array([joint.velocity for joint in robot.joints]))
        rows = self._rows()
        moves = [MoveJ(JointTarget(tuple(map(float, self.joints[0]))), Speed())]
        for before, row in pairwise(rows):
            duration = float(self.times[row] - self.times[before])
            target = JointTarget(tuple(map(float, self.joints[row])))
            zone = FINE if row == rows[-1] else _PASSED
            moves.append(MoveJ(target, Speed(duration=duration), zone))
        return moves

    def _check(self, span: Span, velocity: FloatArray) -> None:
        if len(velocity) != self.joints.shape[1]:
            raise SourceError(
                f"{self.file} has {self.joints.shape[1]} joints, but the arm {len(velocity)}", span
            )
        rates = np.abs(np.diff(self.joints, axis=0)) / np.diff(self.times)[:, None]
        over = np.argwhere(rates > _SLACK * velocity)
        if len(over):
            row, joint = (int(k) for k in over[0])
            raise SourceError(
                f"{self.file}, line {row + 3}: joint {joint + 1} turns at "
                f"{math.degrees(rates[row, joint]):.4g}°/s, faster than its "
                f"{math.degrees(velocity[joint]):.4g}°/s",
                span,
            )

    def _rows(self) -> list[int]:
        """Rows between which the joints run straight over time, with the first and the last."""
        kept = {0, len(self.times) - 1}
        todo = [(0, len(self.times) - 1)]
        while todo:
            first, last = todo.pop()
            if last - first < 2:
                continue
            share = (self.times[first : last + 1] - self.times[first]) / (
                self.times[last] - self.times[first]
            )
            line = self.joints[first] + share[:, None] * (self.joints[last] - self.joints[first])
            off = np.abs(self.joints[first : last + 1] - line).max(axis=1)
            worst = int(off.argmax())
            if off[worst] > _STRAIGHT:
                kept.add(first + worst)
                todo += [(first, first + worst), (first + worst, last)]
        return sorted(kept)


def _nothing(*_: object) -> None:
    return None


@dataclass
class Streaming:
    """What a run does about moves that a computer sends.

    Args:
        robot: that they are sent to.
        driven: called with each, and the statement that it is sent to.
        lost: called where what is sent cannot be driven.
    """

    robot: Robot | None = None
    driven: Callable[[MoveJ, Span], None] = _nothing
    lost: Callable[[Span], None] = _nothing


def load_stream(path: Path) -> Stream:
    """The stream in a CSV file, whose first line is ``time,j1,j2,…``: s and degrees; ``j1_rad``
    stands for radians.

    Raises:
        InputError: the file cannot be read, or is none such; the message names the line.
    """
    lines = list(
        csv.reader(read_bytes(path, _LARGEST_FILE).decode("utf-8-sig", "replace").splitlines())
    )
    names = [name.strip().casefold() for name in (lines[0] if lines else [])]
    units = _units(names, path)
    if not 3 <= len(lines) <= _MOST_ROWS:
        raise InputError(f"{path}: a stream has 2 to {_MOST_ROWS:,} rows, not {len(lines) - 1:,}")
    rows = np.array([_row(line, len(names), path, k) for k, line in enumerate(lines[1:], 2)])
    later = np.diff(rows[:, 0]) > 0
    if not later.all():
        raise InputError(f"{path}:{int(later.argmin()) + 3}: times must grow from row to row")
    return Stream(rows[:, 0], rows[:, 1:] * units, str(path))


def _units(names: list[str], path: Path) -> FloatArray:
    """What a number of each joint is in rad."""
    plain = [f"j{k + 1}" for k in range(len(names) - 1)]
    for suffix, unit in (("", math.pi / 180), ("_rad", 1.0)):
        if len(names) > 1 and names == ["time", *(name + suffix for name in plain)]:
            return np.full(len(plain), unit)
    raise InputError(
        f"{path}:1: a stream begins with the line time,j1,j2,… (s, degrees) or "
        f"time,j1_rad,j2_rad,…, not {','.join(names)!r}"
    )


def _row(line: list[str], count: int, path: Path, number: int) -> list[float]:
    try:
        values = [float(text) for text in line]
    except ValueError:
        raise InputError(f"{path}:{number}: {','.join(line)!r} are no numbers") from None
    if len(values) != count or not all(map(math.isfinite, values)):
        raise InputError(
            f"{path}:{number}: {count} finite numbers are wanted, not {','.join(line)!r}"
        )
    return values
