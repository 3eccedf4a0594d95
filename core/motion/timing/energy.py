"""The energy of a stamped motion, with its gradient: a `Consumption` over time.

By the trapezium rule on the stamped samples from both sides of every knot. The usual one is the
papers': E = Σ ∫ τⱼ² dt ("Towards Energy Optimization using Trajectory Smoothing", equations 8, 9).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...errors import InputError
from ...program.move import Move
from ...program.program import Program
from ...robot.inertia import Inertia
from ...robot.model import Robot
from ..model.consumption import SQUARED_TORQUE, Consumption
from ..path.path import Path
from ..path.tcp_samples import States
from .timing import Timing


@dataclass(frozen=True)
class Energy:
    """The energy of a stamped path and what its reverse needs.

    Args:
        value: in the unit of the consumption; N² m² s of squared torques.
        torque: (K, 2, N) N m at both ends of every interval.
        motion: q, q̇ and q̈ there, (K, 2, N) each.
        loads: per interval, the load carried.
        consumption: what is integrated.
    """

    value: float
    torque: FloatArray
    motion: tuple[FloatArray, FloatArray, FloatArray]
    loads: tuple[Inertia | None, ...]
    consumption: Consumption = SQUARED_TORQUE


def loads_of(program: Program, path: Path) -> list[Inertia | None]:
    """What the flange carries on each segment of a program's path: tool and payload."""
    known: dict[object, Inertia | None] = {}
    found = []
    for index in path.route.moves:
        move = program.moves[index]
        key = move.tool, move.load
        if key not in known:
            known[key] = _carried(move)
        found.append(known[key])
    return found


def _carried(move: Move) -> Inertia | None:
    """The tool's load and the payload as one body in the flange's frame."""
    bodies = []
    if move.tool.robot_held and move.tool.load is not None:
        bodies.append(Inertia.of_load(move.tool.load))
    if move.load is not None:
        frame = move.tool.tcp if move.tool.robot_held else move.work_object.pose
        bodies.append(Inertia.of_load(move.load, frame))
    if not bodies:
        return None
    total = bodies[0]
    for body in bodies[1:]:
        total = total + body
    return total


def energy(
    robot: Robot,
    timing: Timing,
    loads: Sequence[Inertia | None],
    consumption: Consumption = SQUARED_TORQUE,
) -> Energy:
    """The energy of a stamped path; waits, at rest, count nothing.

    Args:
        robot: with the inertias of its links.
        timing: the stamped path.
        loads: (M,), what the flange carries on each segment.
        consumption: what is integrated.

    Raises:
        InputError: inertias are not known.
    """
    motion = _motion(timing)
    segment = timing.interval_segments
    torque = np.empty_like(motion[0])
    for load, rows in by_load(loads, segment):
        q, dq, ddq = (part[rows] for part in motion)
        torque[rows] = robot.inverse_dynamics(q, dq, ddq, load)
    if not np.isfinite(torque).all():
        axis = robot.axis_names[int(np.argwhere(~np.isfinite(torque))[0, 2])]
        raise InputError(f"the energy needs the inertia of axis {axis}, which is not known")
    steps = timing.end - timing.begin
    power = consumption.total(consumption.powers(torque, motion[1]))
    value = 0.5 * float(np.sum(steps * np.sum(power, axis=1)))
    return Energy(value, torque, motion, tuple(loads), consumption)


def energy_by_joint(timing: Timing, made: Energy) -> FloatArray:
    """(N,), what each joint takes; of squared torques they add up to the whole."""
    powers = made.consumption.powers(made.torque, made.motion[1])
    return np.asarray(0.5 * np.einsum("k,kej->j", timing.end - timing.begin, powers))


def by_load(
    loads: Sequence[Inertia | None], segment: NDArray[np.int64]
) -> list[tuple[Inertia | None, NDArray[np.int64]]]:
    """Intervals grouped by the load they are driven with.

    Args:
        loads: (M,), what the flange carries on each segment.
        segment: (K,), the segment of each interval.
    """
    kinds = dict.fromkeys(loads)
    return [
        (load, np.flatnonzero(np.array([other == load for other in loads])[segment]))
        for load in kinds
    ]


def _motion(timing: Timing) -> tuple[FloatArray, FloatArray, FloatArray]:
    states = timing.along.states
    left = timing.path.pieces.interval_samples
    ends = np.stack([left, left + 1], -1)
    x = np.stack([timing.stamp.x[:-1], timing.stamp.x[1:]], -1)[..., None]
    u = timing.stamp.u[:, None, None]
    dq, ddq = states.dq[ends], states.ddq[ends]
    return states.q[ends], dq * np.sqrt(x), dq * u + ddq * x


def pull_energy(
    robot: Robot, timing: Timing, made: Energy, states_bar: States
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Gradient of the energy: adds to that of ``timing.along.states``, returns those of x (K + 1,),
    t (K + 1,) and the intervals' spacing (K,)."""
    states, stamp = timing.along.states, timing.stamp
    left = timing.path.pieces.interval_samples
    ends = np.stack([left, left + 1], -1)
    steps = timing.end - timing.begin
    halves = 0.5 * steps[:, None, None]
    by_torque, by_rate = made.consumption.slopes(made.torque, made.motion[1])
    torque_bar = halves * by_torque
    bars = tuple(np.empty_like(made.torque) for _ in range(3))
    for load, rows in by_load(made.loads, timing.interval_segments):
        q, dq, ddq = (part[rows] for part in made.motion)
        parts = robot.pull_inverse_dynamics(q, dq, ddq, torque_bar[rows], load)
        for bar, part in zip(bars, parts, strict=True):
            bar[rows] = part
    q_bar, rate_bar, rise_bar = bars
    rate_bar += halves * by_rate
    x = np.stack([stamp.x[:-1], stamp.x[1:]], -1)[..., None]
    u = stamp.u[:, None, None]
    root = np.sqrt(x)
    rates, bends = states.dq[ends], states.ddq[ends]
    np.add.at(states_bar.q, ends, q_bar)
    np.add.at(states_bar.dq, ends, root * rate_bar + u * rise_bar)
    np.add.at(states_bar.ddq, ends, x * rise_bar)
    by_x = np.sum(bends * rise_bar, axis=2)
    safe = np.where(root > 0, root, 1.0)
    by_x += np.sum(np.where(root > 0, 0.5 / safe, 0.0) * rates * rate_bar, axis=2)
    by_u = np.sum(rates * rise_bar, axis=(1, 2))
    spacing = stamp.limits.spacing
    x_bar = np.zeros(len(stamp.x))
    x_bar[:-1] += by_x[:, 0] - by_u / (2 * spacing)
    x_bar[1:] += by_x[:, 1] + by_u / (2 * spacing)
    power = made.consumption.total(made.consumption.powers(made.torque, made.motion[1]))
    by_step = 0.5 * np.sum(power, axis=1)
    t_bar = np.zeros(len(stamp.t))
    t_bar[1:] += by_step
    t_bar[:-1] -= by_step
    return x_bar, t_bar, -by_u * stamp.u / spacing
