"""First guesses: along straight joint lines, with a stop at each of their corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .....core.arrays import FloatArray, IntArray
from ..task.limits import MotionLimits
from ..task.sampled import Plant, State, TcpSpeed
from ..task.task import MotionTask
from .grid import Grid
from .layout import VariableLayout
from .motion import Motion
from .scheme import Scheme

_LEAST = 4
"""Intervals on a straight line."""
_ATTEMPTS = 40
_HELD, _USED = 0.999, 0.98
"""Shares of torque limits: up to which a line can be held at all, and that its motion uses."""
_SHORTEST = 1e-2
"""s: a line that goes nowhere."""


@dataclass(frozen=True)
class Guess:
    """A motion to begin with.

    Args:
        layout: the variables.
        scale: T₀, s: its duration.
        x: the variables' values.
    """

    layout: VariableLayout
    scale: float
    x: FloatArray

    @property
    def motion(self) -> Motion:
        """As polynomials."""
        return Motion.of(self.layout, self.scale, self.x)


@dataclass(frozen=True)
class Polyline:
    """Straight joint lines through all waypoints.

    Args:
        points: (L + 1, n), joints that move.
        leg: (L,), the leg between waypoints of each line, rising.
    """

    points: FloatArray
    leg: IntArray

    @classmethod
    def direct(cls, task: MotionTask) -> Polyline:
        """Straight from waypoint to waypoint."""
        return cls(task.stations[:, task.moving], np.arange(task.legs))

    @classmethod
    def through(cls, task: MotionTask, vias: list[FloatArray]) -> Polyline:
        """With further corners (c, N) on each leg."""
        stations, points, leg = task.stations, [], []
        for k in range(task.legs):
            rows = [stations[k : k + 1], np.asarray(vias[k]).reshape(-1, task.robot.size)]
            points += rows
            leg += [k] * (1 + len(rows[1]))
        points.append(stations[-1:])
        return cls(np.concatenate(points)[:, task.moving], np.array(leg))


def first_guess(
    task: MotionTask,
    limits: MotionLimits,
    plant: Plant | None,
    line: Polyline,
    scheme: Scheme,
    nodes: int,
    group: int | None,
) -> Guess:
    """A motion along straight lines, as fast as the limits let a smooth one be.

    Args:
        task, limits, plant: what is asked.
        line: the way.
        scheme: between nodes.
        nodes: intervals in all, roughly.
        group: intervals that stretch together; None for whole legs.
    """
    reach = np.diff(line.points, axis=0)
    times = np.array(
        [
            _line_time(task, limits, plant, scheme, a, step, int(leg))
            for a, step, leg in zip(line.points, reach, line.leg, strict=False)
        ]
    )
    counts = np.maximum(np.round(nodes * times / times.sum()).astype(np.int64), _LEAST)
    leg = np.repeat(line.leg, counts)
    grid = Grid.even(np.repeat(times / counts, counts), leg)
    layout = VariableLayout(
        grid if group is None else grid.freed(group), scheme, reach.shape[1], breaks_of(task, leg)
    )
    x = np.zeros(layout.size)
    x[: 1 + layout.stretches] = 1.0
    share = times / times.sum()
    node = 0
    for k, count in enumerate(counts):
        _put_line(layout, x, node, int(count), line.points[k], reach[k], share[k])
        node += int(count)
    return Guess(layout, float(times.sum()), x)


def breaks_of(task: MotionTask, leg: IntArray) -> tuple[int, ...]:
    """Nodes at which the acceleration may jump, for intervals on these legs."""
    ends = np.searchsorted(leg, np.arange(1, task.legs))
    return tuple(
        int(node)
        for k, (node, waypoint) in enumerate(zip(ends, task.waypoints, strict=True))
        if waypoint.stop or task.load(k) != task.load(k + 1)
    )


def _profile(scheme: Scheme, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """From 0 to 1 in unit time over ``count`` intervals, at rest and (if continuous) without
    acceleration at both ends: position and velocity at the points, second derivatives."""
    layout = VariableLayout(Grid.even(np.ones(count), np.zeros(count, dtype=np.int64)), scheme, 1)
    shares = scheme.shares if scheme.continuous else np.array([0.5])
    places = (np.arange(count)[:, None] + shares) / count
    e = np.zeros(layout.rises)
    e[layout.rise] = np.sin(2 * np.pi * places)
    s, v = np.zeros(layout.points), np.zeros(layout.points)
    for k in range(count):
        start, own = layout.first[k], e[layout.rise[k]]
        for i in range(1, scheme.steps + 1):
            u = i / scheme.steps
            s[start + i] = s[start] + u * v[start] / count
            s[start + i] += scheme.position_at(u) @ own / count**2
            v[start + i] = v[start] + scheme.velocity_at(u) @ own / count
    return s / s[-1], v / s[-1], e / s[-1]


def _put_line(
    layout: VariableLayout,
    x: FloatArray,
    node: int,
    count: int,
    begin: FloatArray,
    step: FloatArray,
    share: float,
) -> None:
    s, v, e = _profile(layout.scheme, count)
    points = layout.first[node] + np.arange(len(s))
    x[layout.q[points]] = begin + s[:, None] * step
    x[layout.d[points]] = v[:, None] * step / share
    rises = layout.rise[node, 0] + np.arange(len(e))
    x[layout.e[rises]] = e[:, None] * step / share**2


def _line_time(
    task: MotionTask,
    limits: MotionLimits,
    plant: Plant | None,
    scheme: Scheme,
    begin: FloatArray,
    step: FloatArray,
    leg: int,
) -> float:
    """s in which a straight line is driven."""
    s, v, e = _profile(scheme, 16)
    size = np.abs(step)
    # Of intervals as wide as these, the peaks between nodes are hardly higher.
    by_speed = 1.1 * size * np.abs(v).max() / limits.velocity
    by_rise = np.sqrt(1.1 * size * np.abs(e).max() / limits.acceleration)
    jerk = np.abs(np.diff(e)).max() * 16 if scheme.continuous else 0.0
    by_jerk = np.cbrt(1.5 * size * jerk / limits.jerk)
    time = max(_SHORTEST, *by_speed, *by_rise, *by_jerk)
    q, dq = begin + s[:, None] * step, v[:, None] * step
    if np.isfinite(limits.tcp_speed):
        speed = TcpSpeed(task, 1.0).velocity(q, dq)
        time = max(time, 1.1 * float(np.linalg.norm(speed, axis=1).max()) / limits.tcp_speed)
    if plant is None or not limits.dynamic:
        return float(time)
    ddq = np.interp(np.linspace(0, 1, len(s)), np.linspace(0, 1, len(e)), e)[:, None] * step
    motion = State(q, dq, ddq, np.full(len(q), leg))
    still = plant.torques(State(q, 0 * q, 0 * q, motion.leg))
    used = _most_used(limits, still, 0 * still)
    held = used < _HELD
    # Where the torques cannot hold the joints on this line, what is left of them when nothing
    # has to be held sets the pace: the optimisation finds its own way there.
    bias = 0.0 if held else still
    aim = max(_USED, 0.5 * (1.0 + used)) if held else _USED
    for _ in range(_ATTEMPTS):
        driven = State(q, dq / time, ddq / time**2, motion.leg)
        if _most_used(limits, plant.torques(driven) - bias, plant.rates(driven)) <= aim:
            break
        time *= 1.25
    return float(time)


def _most_used(limits: MotionLimits, torque: FloatArray, rate: FloatArray) -> float:
    """The largest share of a torque limit that is used."""
    return float(np.abs(limits.torques.shares(torque, rate)).max())
