"""A time-stamped path: samples at increasing times."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...display import counted, in_line
from ...errors import InputError
from ...files.arrays import read_npz
from ...files.reading import read_text
from ...files.writing import write_file
from ...robot.inertia import Inertia
from ...robot.model import Robot
from .smoothing import States

MOST_SAMPLES = 20_000_000
"""Some 5 GB of a six-axis robot's samples; at a period of 4 ms nearly a day."""
MOST_BYTES = 2_000_000_000
"""Of the arrays of a saved trajectory: of six axes ten hours at a period of 4 ms."""
MOST_CSV_BYTES = 200_000_000
"""Of one saved as text, which takes some ten times as much memory to read."""
_ARRAYS = ("t", "q", "dq", "ddq", "position", "quaternion", "sigma", "move")
_MOTORS = ("q_motor", "dq_motor", "ddq_motor")
Leads = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]
_GAPS = "gaps"
_PART = "part"
_TAIL = ("x", "y", "z", "qw", "qx", "qy", "qz", "move")


@dataclass(frozen=True)
class Trajectory:
    """T samples of a motion: of the links and what they carry, and of the motors that drive them.

    Where gears are elastic, motors lead their links (`elasticity`), and a controller logs the
    motors. What a robot's tool does, and what it comes near to, is the links'.

    Args:
        t: (T,) s, increasing.
        q, dq, ddq: (T, N), joints and external axes in rad or m, and their derivatives in time.
            Of the links.
        position: (T, 3) m, the TCP in the world; of a stationary tool, in the work object.
        quaternion: (T, 4), w x y z, likewise.
        sigma: (T,), path parameter; after smoothing in time, that of the middle of the window.
        move: (T,), index of the move being driven.
        lead: by how much motors are ahead of the links in each of the three, (T, N), on the side
            of the links; None where they never are. What is some milliradians needs no more
            digits.
        gaps: indices of the samples that follow a move which cannot be driven, increasing; the
            clock stands still there, and how the robot came there is not known.
    """

    t: FloatArray
    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    position: FloatArray
    quaternion: FloatArray
    sigma: FloatArray
    move: IntArray
    lead: Leads | None = None
    gaps: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        count = len(self.t)
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        arrays.update(zip(_MOTORS, self.lead or (), strict=False))
        for name, array in arrays.items():
            if len(array) != count:
                raise InputError(f"a trajectory of {count} samples has {len(array)} of {name}")
            if not np.isfinite(array).all():
                raise InputError(f"a trajectory's {name} must be finite")
        steps = np.diff(self.t)
        steps[np.array(self.gaps, dtype=int) - 1] = 1.0
        if count == 0 or (steps <= 0).any():
            raise InputError("a trajectory needs samples at increasing times")

    def __repr__(self) -> str:
        top = np.abs(self.dq).max()
        return in_line(
            f"Trajectory: {self.duration:.3f} s, {counted(self.t, 'sample')} of "
            f"{counted(self.q.shape[1], 'axis', 'axes')}, at most {top:.3g} rad/s or m/s"
        )

    @property
    def q_motor(self) -> FloatArray:
        """(T, N), where motors are: what a controller logs."""
        return self.q if self.lead is None else self.q + self.lead[0]

    @property
    def dq_motor(self) -> FloatArray:
        """(T, N), its derivative in time."""
        return self.dq if self.lead is None else self.dq + self.lead[1]

    @property
    def ddq_motor(self) -> FloatArray:
        """(T, N), the second."""
        return self.ddq if self.lead is None else self.ddq + self.lead[2]

    @property
    def duration(self) -> float:
        """From the first sample to the last, s."""
        return float(self.t[-1] - self.t[0])

    def parts(self) -> list[Trajectory]:
        """What lies between gaps."""
        if not self.gaps:
            return [self]
        ends = [0, *self.gaps, len(self.t)]
        return [self._rows(slice(a, b)) for a, b in pairwise(ends)]

    def _rows(self, rows: slice) -> Trajectory:
        arrays: Any = {name: getattr(self, name)[rows] for name in _ARRAYS}
        lead = self.lead
        if lead is not None:
            lead = lead[0][rows], lead[1][rows], lead[2][rows]
        return Trajectory(**arrays, lead=lead)

    def resampled(self, period: float) -> Trajectory:
        """The same motion every ``period`` s, and at its end; of each part for itself.

        Joints and their velocities are those of the cubics that meet both at the samples. The
        TCP's position, the quaternion (then normalised), the accelerations and σ are linear
        between samples, so resample to periods no longer than the motion's own detail.

        Raises:
            InputError: the period is not finite and above zero, or makes too many samples.
        """
        if self.gaps:
            return joined([part.resampled(period) for part in self.parts()])
        t = sample_times(self.t[0], self.t[-1], period)
        if len(self.t) == 1:
            return self
        nearest = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 1)
        weight = np.stack([np.interp(t, self.t, row) for row in self._continuous().T], -1)
        quaternion = weight / np.linalg.norm(weight, axis=1, keepdims=True)
        position = np.stack([np.interp(t, self.t, row) for row in self.position.T], -1)
        return Trajectory(
            t,
            *_resampled(self.t, (self.q, self.dq, self.ddq), t),
            position,
            quaternion,
            np.interp(t, self.t, self.sigma),
            self.move[nearest],
            None if self.lead is None else _rounded(*_resampled(self.t, self.lead, t)),
        )

    def _continuous(self) -> FloatArray:
        """The quaternions with signs that do not jump."""
        dots = np.sum(self.quaternion[1:] * self.quaternion[:-1], axis=1)
        signs = np.concatenate([[1.0], np.cumprod(np.where(dots < 0, -1.0, 1.0))])
        return np.asarray(self.quaternion * signs[:, None])

    def torque(self, robot: Robot, load: Inertia | None = None) -> FloatArray:
        """Torques (T, N) in N m that the links ask for, by the rigid-body model; ``load`` in the
        flange's frame."""
        return robot.inverse_dynamics(self.q, self.dq, self.ddq, load)

    def mechanical_work(self, robot: Robot, load: Inertia | None = None) -> float:
        """Work in J that the joints deliver; braking gives nothing back."""
        power = np.maximum(self.torque(robot, load) * self.dq, 0.0).sum(axis=1)
        return float(np.trapezoid(power, self.t))

    def csv(self) -> bytes:
        """t, joints, TCP and move as text (header ``t,q1,…,qn,x,y,z,qw,qx,qy,qz,move``), of
        elastic joints the motors (``q1_motor,…,qn_motor``), with gaps the ``part``, from 1."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        joints = [f"q{j + 1}" for j in range(self.q.shape[1])]
        more = [] if self.lead is None else [f"{name}_motor" for name in joints]
        parts = [_PART] if self.gaps else []
        writer.writerow(["t", *joints, *_TAIL, *more, *parts])
        columns = np.column_stack([self.t, self.q, self.position, self.quaternion])
        motors = self.q_motor[:, : len(more)]
        numbers = 1 + np.searchsorted(self.gaps, np.arange(len(self.t)), side="right")
        for row, move, motor, part in zip(columns, self.move, motors, numbers, strict=True):
            cells = [*(f"{value:.9g}" for value in row), int(move) + 1]
            cells += [f"{value:.9g}" for value in motor]
            writer.writerow([*cells, int(part)] if parts else cells)
        return text.getvalue().encode()

    def save_csv(self, path: Path | str) -> None:
        """Write `csv` into a file, whole or not at all."""
        write_file(Path(path), self.csv())

    @classmethod
    def load_csv(cls, path: Path | str) -> Trajectory:
        """Read what `save_csv` wrote.

        Velocities are central differences of the joints, accelerations those of the velocities
        (`numpy.gradient`; one-sided at the ends, zero for less than three samples).

        Raises:
            InputError: naming file and line.
        """
        path = Path(path)
        text = read_text(path, MOST_CSV_BYTES)
        try:
            rows = list(csv.reader(text.splitlines()))
        except csv.Error as error:  # a field beyond what any number takes
            raise InputError(f"{path}: not a readable trajectory: {error}") from error
        header = rows[0] if rows else []
        size = header.index(_TAIL[0]) - 1 if _TAIL[0] in header else 0
        joints = [f"q{j + 1}" for j in range(size)]
        motors = [f"{name}_motor" for name in joints]
        whole = ["t", *joints, *_TAIL]
        known = (whole, whole + motors)
        if size < 1 or header not in (*known, *([*names, _PART] for names in known)):
            raise InputError(
                f"{path}:1: the header must be t,q1,…,qn,{','.join(_TAIL)}, and may go on with "
                f"q1_motor,…,qn_motor and {_PART}"
            )
        data = np.empty((len(rows) - 1, len(header)))
        for line, row in enumerate(rows[1:], start=2):
            data[line - 2] = _numbers(row, len(header), f"{path}:{line}")
        gaps: tuple[int, ...] = ()
        if header[-1] == _PART:
            gaps = tuple(map(int, 1 + np.flatnonzero(np.diff(data[:, -1]))))
            data = data[:, :-1]
        t = data[:, 0]
        steps = np.diff(t)
        steps[np.array(gaps, dtype=int) - 1] = 1.0
        if (steps <= 0).any():
            line = int(np.flatnonzero(steps <= 0)[0]) + 3
            raise InputError(f"{path}:{line}: times must increase")
        parts = [_of_columns(rows, size) for rows in np.split(data, gaps)]
        return replace(joined(parts), t=t) if gaps else parts[0]

    def npz(self) -> bytes:
        """All arrays under their names, of elastic joints ``q_motor``, ``dq_motor`` and
        ``ddq_motor``, and ``gaps`` where there are any."""
        buffer = io.BytesIO()
        names = _ARRAYS if self.lead is None else (*_ARRAYS, *_MOTORS)
        arrays = {name: getattr(self, name) for name in names}
        if self.gaps:
            arrays[_GAPS] = np.array(self.gaps)
        np.savez_compressed(buffer, **arrays)
        return buffer.getvalue()

    def save_npz(self, path: Path | str) -> None:
        """Write `npz` into a file, whole or not at all."""
        write_file(Path(path), self.npz())

    @classmethod
    def load_npz(cls, path: Path | str) -> Trajectory:
        """Read what `save_npz` wrote.

        Raises:
            InputError: naming the file.
        """
        try:
            arrays = read_npz(path, _ARRAYS, MOST_BYTES, (_MOTORS, (_GAPS,)))
            q, dq, ddq = (arrays.pop(name, None) for name in _MOTORS)
            gaps = arrays.pop(_GAPS, np.empty(0))
            made: Any = {**arrays, "gaps": tuple(map(int, gaps))}
            if q is not None and dq is not None and ddq is not None:
                made["lead"] = _leads((arrays["q"], arrays["dq"], arrays["ddq"]), (q, dq, ddq))
            return cls(**made)
        except (InputError, TypeError, ValueError) as error:
            told = str(error).removeprefix(f"{path}: ")
            raise InputError(f"{path}: not a saved trajectory: {told}") from error


def joined(parts: Sequence[Trajectory], firsts: Sequence[int] | None = None) -> Trajectory:
    """Motions one after the other, on one clock that stands still in the gaps between them.

    Args:
        parts: at least one; all of the same axes.
        firsts: what to add to the indices of moves of each; None for nothing.
    """
    if len(parts) == 1 and not any(firsts or ()):
        return parts[0]
    rows: dict[str, list[Any]] = {name: [] for name in _ARRAYS}
    t, sigma = 0.0, 0.0
    for part, first in zip(parts, firsts or [0] * len(parts), strict=True):
        moved = {
            "t": part.t - part.t[0] + t,
            "sigma": part.sigma + sigma,
            "move": part.move + first,
        }
        for name in _ARRAYS:
            rows[name].append(moved.get(name, getattr(part, name)))
        t, sigma = float(moved["t"][-1]), float(moved["sigma"][-1])
    arrays: Any = {name: np.concatenate(found) for name, found in rows.items()}
    lead: Leads | None = None
    if any(part.lead is not None for part in parts):
        leads = [no_leads(part.q.shape) if part.lead is None else part.lead for part in parts]
        place, speed, push = (np.concatenate(found) for found in zip(*leads, strict=True))
        lead = place, speed, push
    gaps = np.cumsum([len(part.t) for part in parts])[:-1]
    return Trajectory(**arrays, lead=lead, gaps=tuple(map(int, gaps)))


def _of_columns(data: FloatArray, size: int) -> Trajectory:
    """A motion of so many axes from the columns of a text; see `Trajectory.load_csv`."""
    tcp = 1 + size
    t, q, motor = data[:, 0], data[:, 1:tcp], data[:, tcp + len(_TAIL) :]
    rates = _finite_rates(t, q)
    return Trajectory(
        t,
        q,
        *rates,
        data[:, tcp : tcp + 3],
        data[:, tcp + 3 : tcp + 7],
        np.zeros(len(t)),
        data[:, tcp + 7].astype(np.int64) - 1,
        _leads((q, *rates), (motor, *_finite_rates(t, motor))) if motor.size else None,
    )


def _numbers(row: Sequence[str], count: int, where: str) -> list[float]:
    """The finite numbers of one line."""
    try:
        values = [float(value) for value in row]
    except ValueError as error:
        raise InputError(f"{where}: {count} numbers expected: {error}") from error
    if len(values) != count:
        raise InputError(f"{where}: {count} numbers expected, not {len(values)}")
    if not all(map(math.isfinite, values)):
        raise InputError(f"{where}: a number is not finite")
    return values


def no_leads(shape: tuple[int, int]) -> Leads:
    """Room for leads (T, N)."""
    place, speed, push = (np.zeros(shape, dtype=np.float32) for _ in range(3))
    return place, speed, push


def _leads(links: States, motors: States) -> Leads:
    """What motors are ahead by."""
    return _rounded(*(b - a for a, b in zip(links, motors, strict=True)))


def _rounded(place: FloatArray, speed: FloatArray, push: FloatArray) -> Leads:
    return place.astype(np.float32), speed.astype(np.float32), push.astype(np.float32)


def _resampled(t: FloatArray, states: States | Leads, at: FloatArray) -> States:
    """Joints at other times: cubics through positions and velocities, accelerations linear."""
    from scipy.interpolate import CubicHermiteSpline

    joints = CubicHermiteSpline(t, states[0], states[1])
    ddq = np.stack([np.interp(at, t, row) for row in states[2].T], -1)
    return joints(at), joints(at, 1), ddq


def _finite_rates(t: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    if len(t) < 3:
        return np.zeros_like(q), np.zeros_like(q)
    dq = np.gradient(q, t, axis=0)
    return dq, np.gradient(dq, t, axis=0)


def sample_times(
    start: float,
    end: float,
    period: float,
    within: tuple[float, float] = (-math.inf, math.inf),
) -> FloatArray:
    """Times every ``period`` from start, and the end.

    A last time within a thousandth of a period of the end gives way to it.

    Args:
        start, end: s.
        period: s.
        within: s, from when to when they are wanted; one more is given at either side.

    Raises:
        InputError: the period is not finite and above zero, or makes more than `MOST_SAMPLES`.
    """
    if not 0 < period < math.inf:
        raise InputError(f"a period must be finite and above zero, not {period}")
    span = min(end, within[1]) - max(start, within[0])
    if not span / period < MOST_SAMPLES:
        raise InputError(
            f"{span:.6g} s sampled every {period:g} s make more than {MOST_SAMPLES:,} "
            f"samples: give a period of at least {span / (MOST_SAMPLES - 1):.2g} s"
        )
    count = int(np.floor((end - start) / period + 1e-9))
    first = int(np.clip((within[0] - start) / period, 0, count))
    last = int(np.clip(np.ceil((within[1] - start) / period), 0, count))
    t = start + period * np.arange(first, last + 1)
    if last < count:
        return np.asarray(t)
    if count > 0 and end - t[-1] <= 1e-3 * period:
        t[-1] = end
    elif end > start:
        t = np.append(t, end)
    return np.asarray(t)
