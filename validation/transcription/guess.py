"""A start that holds all limits: small zones, one speed from the first line's end to the last's
beginning, as slow as the limits ask for."""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray
from .curves import BlendCurve
from .layout import Layout
from .task import TranscriptionTask
from .transcription import Transcription

_HALVINGS = 60


def initial_guess(problem: Transcription, share: float = 0.5) -> FloatArray:
    """Variables of a slow motion through the task's waypoints.

    Args:
        problem: what to start.
        share: radius of each zone as a share of the largest that neighbours leave.
    """
    task, layout = problem.task, problem.layout
    x = np.zeros(problem.n)
    points = task.points
    x[layout.points] = points
    x[layout.tcp] = tcp = task.tcp.values(points)
    x[layout.length] = np.linalg.norm(np.diff(points, axis=0), axis=1)
    nearest = np.linalg.norm(np.diff(tcp, axis=0), axis=1)
    x[layout.radius] = 0.5 * share * np.minimum(nearest[:-1], nearest[1:])
    _set_zones(x, layout, task)
    _set_timing(x, layout, problem.blend, 1.0)
    speed = 1.0 / _hurry(problem, x)
    _set_timing(x, layout, problem.blend, 0.98 * speed)
    return x


def _set_zones(x: FloatArray, layout: Layout, task: TranscriptionTask) -> None:
    for via in range(layout.vias):
        here = task.points[via + 1]
        for side, leg, there in (
            (0, via, task.points[via]),
            (1, via + 1, task.points[via + 2]),
        ):
            share = _exit(task, here, there, float(x[layout.radius[via]]))
            x[layout.cut[leg, 1 - side]] = share * x[layout.length[leg]]
            edge = here + share * (there - here)
            x[layout.edge[via, side]] = task.tcp.values(edge[None])[0]


def _exit(task: TranscriptionTask, here: FloatArray, there: FloatArray, radius: float) -> float:
    """Share of the joint line at which the TCP leaves its sphere: the first sign change on a grid,
    then bisection."""
    shares = np.linspace(0.0, 1.0, 201)
    tcp = task.tcp.values(here + shares[:, None] * (there - here))
    beyond = int(np.argmax(np.linalg.norm(tcp - tcp[0], axis=1) > radius))
    low, high = shares[max(beyond - 1, 0)], shares[beyond]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        at = task.tcp.values((here + middle * (there - here))[None])[0]
        low, high = (middle, high) if np.linalg.norm(at - tcp[0]) <= radius else (low, middle)
    return float(0.5 * (low + high))


def _set_timing(x: FloatArray, layout: Layout, blend: BlendCurve, speed: float) -> None:
    """Times of a motion at ``speed`` rad/s, from rest and to rest on the first and last line."""
    for segment in range(layout.segments):
        leg = segment // 2
        if segment % 2:
            first = blend.entry_slope * x[layout.cut[leg, 1]]
            last = blend.exit_slope * x[layout.cut[leg + 1, 0]]
            time = 2.0 * first * last / (speed * (first + last))
            rates = time * speed / first, time * speed / last
        else:
            along = float(x[layout.length[leg]] - x[layout.cut[leg]].sum())
            rates = (0.0, 2.0) if segment == 0 else (1.0, 1.0)
            rates = (2.0, 0.0) if segment == layout.segments - 1 else rates
            time = along * max(rates) / speed
        tau = layout.tau[segment]
        x[layout.time[segment]] = time
        x[layout.rate[segment]] = rates[0] + (rates[1] - rates[0]) * tau
        x[layout.s[segment]] = rates[0] * tau + 0.5 * (rates[1] - rates[0]) * tau**2
        x[layout.push[segment]] = (rates[1] - rates[0]) / time


def _hurry(problem: Transcription, x: FloatArray) -> float:
    """By how much the motion is too fast: the worst share of a velocity's limit, or the root of
    that of an acceleration's, which is what a slower motion lowers in proportion."""
    velocity, acceleration = problem.worst_shares(x)
    return max(velocity, float(np.sqrt(acceleration)))
