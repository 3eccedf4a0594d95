"""Curves over time that a page plots: speed, what joints take of their limits, energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.motion.emulator.run import Run
from ...core.motion.timing.energy import by_load, loads_of
from ...core.motion.timing.torque import shares_taken
from ...core.robot.model import Robot
from ..geometry import tcp_speed
from .track_content import (
    PageChart,
)

SPEED, POSITION, VELOCITY, ACCELERATION, TORQUE, CLEARANCE, ENERGY, PUSH, BETWEEN = (
    "speed",
    "position",
    "velocity",
    "acceleration",
    "torque",
    "clearance",
    "energy",
    "push",
    "between",
)
CHARTS = (
    PageChart(SPEED, "TCP speed", "mm/s"),
    PageChart(POSITION, "Joint position", "% of range from its middle", (-100.0, 100.0)),
    PageChart(VELOCITY, "Joint speed", "% of limit", (-100.0, 100.0)),
    PageChart(ACCELERATION, "Joint acceleration", "% of limit", (-100.0, 100.0)),
    PageChart(TORQUE, "Joint torque", "% of limit", (-100.0, 100.0)),
    PageChart(CLEARANCE, "Clearance to the cell", "mm"),
    PageChart(ENERGY, "Mechanical work so far", "kJ"),
    PageChart(PUSH, "TCP acceleration", "m/s²"),
)
"""Of a driven program. Positions, speeds and clearances need no curves: the page has them."""
_PERCENT = 0.5
"""By how much a percentage may be off."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve over the samples of a trajectory.

    Args:
        name: of it.
        chart: key of its chart.
        values: (T,).
        tolerance: by how much it may be off.
        stepped: whether it keeps its value up to the next.
        axis: whose it is.
    """

    name: str
    chart: str
    values: FloatArray
    tolerance: float
    stepped: bool = False
    axis: int | None = None

    def joined(self, parts: Sequence[Curve]) -> Curve:
        """The same curve over all parts of a trajectory."""
        values = [part.values for part in parts]
        if self.chart == ENERGY:
            ends = np.cumsum([0.0, *(float(one[-1]) for one in values)])
            values = [one + start for one, start in zip(values, ends, strict=False)]
        widest = max(part.tolerance for part in parts)
        return replace(self, values=np.concatenate(values), tolerance=widest)


def curves_of(run: Run, robot: Robot) -> list[Curve]:
    """The curves of a run."""
    speed = 1e3 * tcp_speed(run)
    fine = max(0.003 * float(speed.max(initial=0.0)), 0.1)
    wanted = [run.program.moves[i].speed.tcp for i in run.trajectory.move]
    programmed = np.array([np.nan if v is None else 1e3 * v for v in wanted])
    curves = [Curve("driven", SPEED, speed, fine)]
    if np.isfinite(programmed).any():
        curves.append(Curve("programmed", SPEED, programmed, 0.1, stepped=True))
    curves += _accelerations(run, robot)
    curves += _torques(run, robot)
    curves.append(_push(run))
    return curves


def _push(run: Run) -> Curve:
    """Acceleration of the TCP, m/s²."""
    trajectory = run.trajectory
    if len(trajectory.t) < 3:
        push = np.zeros(len(trajectory.t))
    else:
        velocity = np.gradient(trajectory.position, trajectory.t, axis=0)
        push = np.linalg.norm(np.gradient(velocity, trajectory.t, axis=0), axis=1)
        # Where the tool changes without a motion, the TCP jumps.
        push = np.minimum(push, np.percentile(push, 99.9))
    return Curve("TCP", PUSH, push, max(0.02 * float(push.max(initial=0.0)), 0.01))


def _segments(run: Run) -> IntArray:
    """(T,), the segment of each sample."""
    place = {move: k for k, move in enumerate(run.path.route.moves)}
    return np.array([place[move] for move in run.trajectory.move.tolist()], dtype=np.int64)


def _accelerations(run: Run, robot: Robot) -> list[Curve]:
    """Accelerations of axes in percent of what their moves may take; none where torques limit."""
    most = run.timing.limits.acceleration[_segments(run), : robot.size]
    share = np.where(np.isfinite(most), 100.0 * run.trajectory.ddq_motor / most, np.nan)
    return [
        Curve(name, ACCELERATION, share[:, j], 2 * _PERCENT, axis=j)
        for j, name in enumerate(robot.axis_names)
        if np.isfinite(share[:, j]).any()
    ]


def _torques(run: Run, robot: Robot) -> list[Curve]:
    """Torques of axes in percent of their limits, and the work that all of them do."""
    trajectory, torque = run.trajectory, run.path.model.torque
    found = []
    if torque.own:
        q, dq, ddq = map(np.ascontiguousarray, (trajectory.q, trajectory.dq, trajectory.ddq))
        share = 100.0 * shares_taken(torque, robot, q, dq, ddq)
        found += [
            Curve(name, TORQUE, share[:, j], 2 * _PERCENT, axis=j)
            for j, name in enumerate(robot.axis_names[: share.shape[1]])
        ]
    if not robot.links:
        return found
    pushed = _inverse_dynamics(run, robot)
    effort = robot.limits.effort
    if not torque.own:
        found += [
            Curve(name, TORQUE, 100.0 * pushed[:, j] / effort[j], 2 * _PERCENT, axis=j)
            for j, name in enumerate(robot.axis_names)
            if np.isfinite(effort[j]) and np.isfinite(pushed[:, j]).all()
        ]
    power = np.maximum(np.nan_to_num(pushed) * trajectory.dq, 0.0).sum(axis=1)
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(trajectory.t)
    work = 1e-3 * np.concatenate([[0.0], np.cumsum(steps)])
    return [*found, Curve("all joints", ENERGY, work, max(0.002 * float(work[-1]), 1e-4))]


def _inverse_dynamics(run: Run, robot: Robot) -> FloatArray:
    """(T, N) N m."""
    trajectory = run.trajectory
    pushed = np.zeros_like(trajectory.q)
    for load, rows in by_load(loads_of(run.program, run.path), _segments(run)):
        q, dq, ddq = (a[rows] for a in (trajectory.q, trajectory.dq, trajectory.ddq))
        pushed[rows] = robot.inverse_dynamics(q, dq, ddq, load)
    return pushed
