"""A time-stamped path: samples at increasing times."""

from __future__ import annotations

import csv
import io
import math
import os
import secrets
import shutil
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.lib.npyio import NpzFile
from numpy.typing import NDArray

from ..errors import InputError
from ..robot.inertia import Inertia
from ..robot.model import Robot

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
MOST_SAMPLES = 20_000_000
"""Some 5 GB of a six-axis robot's samples; at a period of 4 ms nearly a day."""
_ARRAYS = ("t", "q", "dq", "ddq", "position", "quaternion", "sigma", "move")


@dataclass(frozen=True)
class Trajectory:
    """T samples of a motion.

    Args:
        t: (T,) s, increasing.
        q, dq, ddq: (T, N), joints and external axes in rad or m, and their derivatives in time.
        position: (T, 3) m, the TCP in the world; of a stationary tool, in the work object.
        quaternion: (T, 4), w x y z, likewise.
        sigma: (T,), path parameter; after smoothing in time, that of the middle of the window.
        move: (T,), index of the move being driven.
    """

    t: FloatArray
    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    position: FloatArray
    quaternion: FloatArray
    sigma: FloatArray
    move: IntArray

    def __post_init__(self) -> None:
        count = len(self.t)
        for name in _ARRAYS:
            array = getattr(self, name)
            if len(array) != count:
                raise InputError(f"a trajectory of {count} samples has {len(array)} of {name}")
            if not np.isfinite(array).all():
                raise InputError(f"a trajectory's {name} must be finite")
        if count == 0 or (np.diff(self.t) <= 0).any():
            raise InputError("a trajectory needs samples at increasing times")

    @property
    def duration(self) -> float:
        """From the first sample to the last, s."""
        return float(self.t[-1] - self.t[0])

    def resampled(self, period: float) -> Trajectory:
        """The same motion every ``period`` s, and at its end.

        Joints and their velocities are those of the cubics that meet both at the samples. The
        TCP's position, the quaternion (then normalised), the accelerations and σ are linear
        between samples, so resample to periods no longer than the motion's own detail.

        Raises:
            InputError: the period is not finite and above zero, or makes too many samples.
        """
        from scipy.interpolate import CubicHermiteSpline

        t = sample_times(self.t[0], self.t[-1], period)
        if len(self.t) == 1:
            return self
        joints = CubicHermiteSpline(self.t, self.q, self.dq)
        nearest = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.t) - 1)
        weight = np.stack([np.interp(t, self.t, row) for row in self._continuous().T], -1)
        quaternion = weight / np.linalg.norm(weight, axis=1, keepdims=True)
        position = np.stack([np.interp(t, self.t, row) for row in self.position.T], -1)
        ddq = np.stack([np.interp(t, self.t, row) for row in self.ddq.T], -1)
        return Trajectory(
            t,
            joints(t),
            joints(t, 1),
            ddq,
            position,
            quaternion,
            np.interp(t, self.t, self.sigma),
            self.move[nearest],
        )

    def _continuous(self) -> FloatArray:
        """The quaternions with signs that do not jump."""
        dots = np.sum(self.quaternion[1:] * self.quaternion[:-1], axis=1)
        signs = np.concatenate([[1.0], np.cumprod(np.where(dots < 0, -1.0, 1.0))])
        return np.asarray(self.quaternion * signs[:, None])

    def torque(self, robot: Robot, load: Inertia | None = None) -> FloatArray:
        """Joint torques (T, N) in N m of the rigid-body model, ``load`` in the flange's frame."""
        return robot.inverse_dynamics(self.q, self.dq, self.ddq, load)

    def mechanical_work(self, robot: Robot, load: Inertia | None = None) -> float:
        """Work in J that the joints deliver; braking gives nothing back."""
        power = np.maximum(self.torque(robot, load) * self.dq, 0.0).sum(axis=1)
        return float(np.trapezoid(power, self.t))

    def save_csv(self, path: Path | str) -> None:
        """Write t, joints, TCP and move (header ``t,q1,…,qn,x,y,z,qw,qx,qy,qz,move``); whole or
        not at all."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        joints = [f"q{j + 1}" for j in range(self.q.shape[1])]
        writer.writerow(["t", *joints, "x", "y", "z", "qw", "qx", "qy", "qz", "move"])
        columns = np.column_stack([self.t, self.q, self.position, self.quaternion])
        for row, move in zip(columns, self.move, strict=True):
            writer.writerow([*(f"{value:.9g}" for value in row), int(move) + 1])
        write_whole(Path(path), text.getvalue().encode())

    @classmethod
    def load_csv(cls, path: Path | str) -> Trajectory:
        """Read what `save_csv` wrote.

        Velocities are central differences of the joints, accelerations those of the velocities
        (`numpy.gradient`; one-sided at the ends, zero for less than three samples).

        Raises:
            InputError: naming file and line.
        """
        path = Path(path)
        try:
            rows = list(csv.reader(path.read_text("utf-8").splitlines()))
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: not a readable trajectory: {error}") from error
        tail = ["x", "y", "z", "qw", "qx", "qy", "qz", "move"]
        header = rows[0] if rows else []
        size = len(header) - 1 - len(tail)
        joints = [f"q{j + 1}" for j in range(size)]
        if size < 1 or header != ["t", *joints, *tail]:
            raise InputError(f"{path}:1: the header must be t,q1,…,qn,{','.join(tail)}")
        data = np.empty((len(rows) - 1, len(header)))
        for line, row in enumerate(rows[1:], start=2):
            data[line - 2] = _numbers(row, len(header), f"{path}:{line}")
        t, q = data[:, 0], data[:, 1 : 1 + size]
        if len(t) > 1 and (np.diff(t) <= 0).any():
            line = int(np.flatnonzero(np.diff(t) <= 0)[0]) + 3
            raise InputError(f"{path}:{line}: times must increase")
        dq, ddq = _finite_rates(t, q)
        move = data[:, -1].astype(np.int64) - 1
        return cls(t, q, dq, ddq, data[:, -8:-5], data[:, -5:-1], np.zeros(len(t)), move)

    def save_npz(self, path: Path | str) -> None:
        """Write all arrays under their names; whole or not at all."""
        buffer = io.BytesIO()
        np.savez_compressed(buffer, **{name: getattr(self, name) for name in _ARRAYS})
        write_whole(Path(path), buffer.getvalue())

    @classmethod
    def load_npz(cls, path: Path | str) -> Trajectory:
        """Read what `save_npz` wrote.

        Raises:
            InputError: naming the file.
        """
        try:
            with Path(path).open("rb") as file:
                data = np.load(file, allow_pickle=False)
                if not isinstance(data, NpzFile):
                    raise InputError(f"{path}: not a saved trajectory: a single array")
                missing = [name for name in _ARRAYS if name not in data]
                if missing:
                    raise InputError(f"{path}: not a saved trajectory: no {', '.join(missing)}")
                arrays = {name: data[name] for name in _ARRAYS}
        except OSError as error:
            reason = error.strerror or error
            raise InputError(f"{path}: not a readable trajectory: {reason}") from error
        except (ValueError, EOFError, BadZipFile, zlib.error, NotImplementedError) as error:
            # NumPy's own words advise to allow pickles, which would run what the file says.
            raise InputError(f"{path}: not a saved trajectory, or a damaged one") from error
        try:
            return cls(**arrays)
        except (InputError, TypeError) as error:
            raise InputError(f"{path}: not a saved trajectory: {error}") from error


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


def _finite_rates(t: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    if len(t) < 3:
        return np.zeros_like(q), np.zeros_like(q)
    dq = np.gradient(q, t, axis=0)
    return dq, np.gradient(dq, t, axis=0)


def sample_times(start: float, end: float, period: float) -> FloatArray:
    """Times every ``period`` from start, and the end.

    A last time within a thousandth of a period of the end gives way to it.

    Raises:
        InputError: the period is not finite and above zero, or makes more than `MOST_SAMPLES`.
    """
    if not 0 < period < math.inf:
        raise InputError(f"a period must be finite and above zero, not {period}")
    if not (end - start) / period < MOST_SAMPLES:
        raise InputError(
            f"{end - start:.6g} s sampled every {period:g} s make more than {MOST_SAMPLES:,} "
            f"samples: give a period of at least {(end - start) / (MOST_SAMPLES - 1):.2g} s"
        )
    count = int(np.floor((end - start) / period + 1e-9))
    t = start + period * np.arange(count + 1)
    if count > 0 and end - t[-1] <= 1e-3 * period:
        t[-1] = end
    elif end > start:
        t = np.append(t, end)
    return np.asarray(t)


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that it is there whole or not at all.

    A link stays a link to the file that is written, and a file keeps its permissions.
    """
    path = path.resolve()
    draft = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    try:
        with draft.open("xb") as file:
            file.write(data)
        if path.exists():
            shutil.copymode(path, draft)
        os.replace(draft, path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
