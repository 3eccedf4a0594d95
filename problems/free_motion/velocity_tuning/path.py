"""A path whose geometry is fixed, as velocity tuning needs it: its rates and what torques it takes.

Along σ, with x = σ̇² and u = σ̈, joints move by q̇ = q' √x and q̈ = q' u + q'' x, and a rigid arm
needs the torque

    τ = a u + b x + c,    a = M q',    b = M q'' + C(q, q') q',    c = g(q)

(Bobrow, Dubowsky and Gibson, "Time-optimal control of robotic manipulators along specified paths",
Int. J. Robotics Research 4(3), 1985).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.motion.emulator.binding_limits import row_names
from ....core.motion.emulator.controller import Controller
from ....core.motion.timing.energy import by_load, loads_of
from ....core.motion.timing.stamping import StampLimits
from ....core.motion.timing.timing import Timing
from ....core.program.program import Program
from ....core.robot.inertia import Inertia
from ....core.robot.model import Robot
from ...checks import of_kind
from .drives import JointDrive


class Rigid(NamedTuple):
    """Torques τ = a u + b x + c of the arm alone, (K, 2, N) each: at both ends of each interval."""

    a: FloatArray
    b: FloatArray
    c: FloatArray


@dataclass(frozen=True, eq=False)
class FixedPath:
    """A path of K intervals on N axes.

    Args:
        limits: what bounds its speed whatever the torques: joints, TCP, programmed speeds, stops.
        dq, ddq: (K, 2, N), q' and q'' at both ends of each interval, one-sided.
        rigid: torques of the arm; None where they are not known.
        names: (N,) of the axes, for messages.
        rows: names of the limits' rows, for reports.

    Raises:
        InputError: shapes do not fit.
    """

    limits: StampLimits
    dq: FloatArray
    ddq: FloatArray
    rigid: Rigid | None = None
    names: tuple[str, ...] = ()
    rows: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        of_kind("FixedPath.limits", self.limits, StampLimits)
        count = len(self.limits.spacing)
        for name in ("dq", "ddq"):
            of_kind(f"FixedPath.{name}", getattr(self, name), np.ndarray)
        shape = self.dq.shape
        if len(shape) != 3 or shape[:2] != (count, 2):
            raise InputError(f"FixedPath.dq has shape {shape}; it must be ({count}, 2, N)")
        for name, part in (("ddq", self.ddq), *zip("abc", self.rigid or (), strict=False)):
            if part.shape != shape:
                raise InputError(f"FixedPath: {name} has shape {part.shape}, dq has {shape}")
        if not (np.isfinite(self.dq).all() and np.isfinite(self.ddq).all()):
            raise InputError("FixedPath: q' and q'' must be finite")
        if not self.names:
            object.__setattr__(self, "names", tuple(f"J{j + 1}" for j in range(shape[2])))
        count = self.limits.a.shape[2]
        if not self.rows:
            named = [f"{name} acceleration" for name in self.names][:count]
            rest = [f"row {k + 1}" for k in range(len(named), count)]
            object.__setattr__(self, "rows", (*named, *rest))
        for what, given, wanted in (("names", self.names, shape[2]), ("rows", self.rows, count)):
            if len(given) != wanted:
                raise InputError(f"FixedPath.{what}: {wanted} are needed, not {len(given)}")

    @classmethod
    def of(cls, controller: Controller, program: Program, timing: Timing) -> FixedPath:
        """The path of a stamped program, with all limits that it was stamped by.

        Args:
            controller: that drove it.
            program: what was driven.
            timing: its stamp; the path and the limits count, not the times.
        """
        ends = timing.path.pieces.interval_ends
        states = timing.along.states
        q, dq, ddq = (np.ascontiguousarray(part[ends]) for part in states[:3])
        robot = controller.robot
        loads = loads_of(program, timing.path)
        rigid = None
        if robot.links:
            rigid = rigid_torques(robot, q, dq, ddq, loads, timing.interval_segments)
        rows = row_names(timing.path_limits, robot.axis_names)
        return cls(timing.path_limits.rows, dq, ddq, rigid, robot.axis_names, rows)

    @property
    def stops(self) -> NDArray[np.bool_]:
        """(K + 1,), knots at which the path comes to rest: the first, the last, and stops."""
        stops: NDArray[np.bool_] = self.limits.ceiling == 0.0
        stops[[0, -1]] = True
        return stops

    @property
    def size(self) -> int:
        """N."""
        return int(self.dq.shape[2])

    def u(self, x: FloatArray) -> FloatArray:
        """(K,), σ̈ in each interval of a motion with σ̇² = x (K + 1,) at the knots."""
        return np.asarray(np.diff(x) / (2.0 * self.limits.spacing))

    def steps(self, x: FloatArray) -> FloatArray:
        """(K,) s, the time that each interval takes."""
        root = np.sqrt(x)
        return np.asarray(2.0 * self.limits.spacing / (root[:-1] + root[1:]))


def at_ends(x: FloatArray) -> FloatArray:
    """(K, 2, 1), values (K + 1,) at the knots at both ends of each interval."""
    return np.stack([x[:-1], x[1:]], -1)[..., None]


def rigid_torques(
    robot: Robot,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    loads: Sequence[Inertia | None],
    segments: NDArray[np.int64],
) -> Rigid:
    """The arm's torques at samples (K, 2, N), by three passes of inverse dynamics.

    Args:
        robot: with the inertias of its links.
        q, dq, ddq: the path with respect to σ.
        loads: (M,), what the flange carries on each segment.
        segments: (K,), the segment of each interval.
    """
    a, b, c = (np.empty_like(q) for _ in range(3))
    still = np.zeros_like(q)
    for load, rows in by_load(loads, segments):
        at, rest = q[rows], still[rows]
        c[rows] = robot.inverse_dynamics(at, rest, rest, load)
        a[rows] = robot.inverse_dynamics(at, rest, dq[rows], load) - c[rows]
        b[rows] = robot.inverse_dynamics(at, dq[rows], ddq[rows], load) - c[rows]
    return Rigid(a, b, c)


@dataclass(frozen=True, eq=False)
class Torques:
    """What the motors give: τ = a u + b x + c + v √x, (K, 2, N) each; v is viscous friction."""

    a: FloatArray
    b: FloatArray
    c: FloatArray
    v: FloatArray

    @classmethod
    def of(cls, path: FixedPath, drives: Sequence[JointDrive]) -> Torques:
        """The motors' torques on a path.

        Args:
            path: with the arm's torques.
            drives: one an axis.

        Raises:
            InputError: torques are not known.
        """
        if path.rigid is None:
            raise InputError(
                "torques need the inertias of the robot's links, which are not known; add them to "
                "its description ([[link]] in a catalogue file, <inertial> in URDF)"
            )
        unknown = ~np.isfinite(path.rigid.c).all(axis=(0, 1))
        if unknown.any():
            name = path.names[int(np.argmax(unknown))]
            raise InputError(f"torques need the inertia of axis {name}, which is not known")
        inertia, coulomb, viscous = (
            np.array([getattr(drive, name) for drive in drives])
            for name in ("inertia", "coulomb", "viscous")
        )
        return cls(
            path.rigid.a + inertia * path.dq,
            path.rigid.b + inertia * path.ddq,
            path.rigid.c + coulomb * np.sign(path.dq),
            viscous * path.dq,
        )

    def at(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Torques (K, 2, N) at x (K + 1,) and u (K,)."""
        ends = at_ends(x)
        out = self.a * u[:, None, None] + self.b * ends + self.c + self.v * np.sqrt(ends)
        return np.asarray(out)
