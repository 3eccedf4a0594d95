"""The motion that a point of the transcription stands for, between nodes too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.program.move import MoveJ
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from ...core.program.zone import FINE, Radius, Zone
from .curves import Curve, Line
from .transcription import Transcription

_UNLIMITED = Speed(tcp=100.0)
"""m/s: the joints' own limits alone count."""


@dataclass(frozen=True)
class Progress:
    """Where a segment is at K values of τ: s, w = ṡ t and z = s̈ t, each (K,)."""

    s: FloatArray
    w: FloatArray
    z: FloatArray


@dataclass(frozen=True)
class Samples:
    """A motion at R times.

    Args:
        t: (R,) s.
        q, dq, ddq: (R, n) of the joints that move; at a segment's end once for either side.
    """

    t: FloatArray
    q: FloatArray
    dq: FloatArray
    ddq: FloatArray


@dataclass(frozen=True, slots=True)
class Check:
    """What a motion holds between nodes.

    Args:
        velocity, acceleration: largest share of a joint's limit.
        clearance: least distance of any pair, m.
    """

    velocity: float
    acceleration: float
    clearance: float


def progress(problem: Transcription, x: FloatArray, segment: int, tau: FloatArray) -> Progress:
    """A segment at τ (K,) from 0 to 1: s̈ is linear between nodes, so that s is a cubic."""
    layout = problem.layout
    s, w, z = (x[part[segment]] for part in (layout.s, layout.rate, layout.push))
    t, nodes = x[layout.time[segment]], layout.tau[segment]
    i = np.clip(np.searchsorted(nodes, tau, "right") - 1, 0, len(nodes) - 2)
    h, length = tau - nodes[i], nodes[i + 1] - nodes[i]
    jerk = (z[i + 1] - z[i]) / length
    return Progress(
        s[i] + w[i] * h + t * (z[i] * h**2 / 2.0 + jerk * h**3 / 6.0),
        w[i] + t * (z[i] * h + jerk * h**2 / 2.0),
        z[i] + jerk * h,
    )


def sampled(problem: Transcription, x: FloatArray, count: int) -> Samples:
    """The motion at ``count`` times on every segment."""
    layout = problem.layout
    tau = np.linspace(0.0, 1.0, count)
    begin = np.concatenate([[0.0], np.cumsum(x[layout.time])])
    parts = []
    for segment in range(layout.segments):
        duration = float(x[layout.time[segment]])
        at = progress(problem, x, segment, tau)
        curve, points, theta = _segment(problem, x, segment, at.s)
        q, first, second = (curve.weights(theta, k).value @ points for k in range(3))
        w, z = at.w[:, None] / duration, at.z[:, None] / duration
        parts.append((begin[segment] + tau * duration, q, first * w, second * w**2 + first * z))
    t, q, dq, ddq = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Samples(t, q, dq, ddq)


def _segment(
    problem: Transcription, x: FloatArray, segment: int, s: FloatArray
) -> tuple[Curve, FloatArray, FloatArray]:
    """Curve, points (p, n) and θ (K, 5) of a segment at s (K,)."""
    layout, leg = problem.layout, segment // 2
    curve: Curve = problem.blend if segment % 2 else Line()
    cuts = ((leg, 1), (leg + 1, 0)) if segment % 2 else ((leg, 0), (leg, 1))
    theta = [s]
    for number, side in cuts:
        for index in (layout.cut[number, side], layout.length[number]):
            theta.append(np.full(len(s), x[index]))
    return curve, x[layout.points[leg : leg + curve.points]], np.column_stack(theta)


def check(problem: Transcription, x: FloatArray, count: int = 300) -> Check:
    """Limits and all of the task's clearances at ``count`` times on every segment."""
    samples = sampled(problem, x, count)
    velocity, acceleration = problem.task.limits()
    clearances = problem.task.clearances.values(samples.q)
    return Check(
        float(np.max(np.abs(samples.dq) / velocity)),
        float(np.max(np.abs(samples.ddq) / acceleration)),
        float(clearances.min(initial=np.inf)),
    )


def carried_over(coarse: Transcription, x: FloatArray, fine: Transcription) -> FloatArray:
    """The same motion on another grid."""
    source, target = coarse.layout, fine.layout
    y = np.zeros(fine.n)
    for name in ("time", "points", "length", "cut", "radius", "tcp", "edge"):
        y[getattr(target, name)] = x[getattr(source, name)]
    for k in range(target.segments):
        at = progress(coarse, x, k, target.tau[k])
        y[target.s[k]], y[target.rate[k]], y[target.push[k]] = at.s, at.w, at.z
    return y


def program(problem: Transcription, x: FloatArray) -> Program:
    """Joint moves with the via points and radii of x: what a controller drives by itself."""
    task, layout = problem.task, problem.layout
    waypoints = np.array(task.waypoints)
    waypoints[:, task.free] = x[layout.points]
    start, *targets = (JointTarget(tuple(float(v) for v in q)) for q in waypoints)
    zones: list[Zone] = [*(Radius(float(r)) for r in x[layout.radius]), FINE]
    moves = [
        MoveJ(target=target, speed=_UNLIMITED, zone=zone, tool=task.tool)
        for target, zone in zip(targets, zones, strict=True)
    ]
    return Program(tuple(moves), name="transcription", start=start)
