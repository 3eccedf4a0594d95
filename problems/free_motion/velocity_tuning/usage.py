"""How much of each limit a motion along a fixed path uses, by name."""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray
from .path import at_ends
from .task import TuningTask

SPEED = "speed"
"""Name of what bounds the speed alone: joints, TCP, tool, programmed speeds."""


def jerks(task: TuningTask, x: FloatArray) -> FloatArray:
    """(K + 1, N) rad/s³, as `Tuned.jerk`; at a stop the larger of both sides'.

    Args:
        task: with the path.
        x: (K + 1,), σ̇² at the knots.
    """
    path = task.path
    steps = path.steps(x)
    # Means of the joints' accelerations at both ends of each interval.
    middle = (path.dq * path.u(x)[:, None, None] + path.ddq * at_ends(x)).mean(axis=1)
    before = np.concatenate([np.zeros((1, path.size)), middle])
    after = np.concatenate([middle, np.zeros((1, path.size))])
    half = 0.5 * np.concatenate([[0.0], steps]), 0.5 * np.concatenate([steps, [0.0]])
    stops = path.stops
    passed = (after - before) / (half[0] + half[1])[:, None]
    into = np.abs(before) / np.where(half[0] > 0, half[0], np.inf)[:, None]
    out = np.abs(after) / np.where(half[1] > 0, half[1], np.inf)[:, None]
    return np.asarray(np.where(stops[:, None], np.maximum(into, out), passed))


def usage(task: TuningTask, x: FloatArray) -> dict[str, FloatArray]:
    """Share (K,) of each limit that is used in each interval, at the worse of its ends; 1 is all.

    Args:
        task: with the path and its limits.
        x: (K + 1,), σ̇² at the knots.
    """
    path = task.path
    limits = path.limits
    u, ends = path.u(x), at_ends(x)
    value = limits.a * u[:, None, None] + limits.b * ends
    found: dict[str, FloatArray] = {}

    def put(name: str, shares: FloatArray) -> None:
        found[name] = np.maximum(found.get(name, 0.0), shares.max(axis=1))

    with np.errstate(divide="ignore", invalid="ignore"):
        for side, bound in ((value, limits.upper), (-value, -limits.lower)):
            share = np.where(np.isfinite(bound) & (bound > 0.0), side / bound, 0.0)
            for row, name in enumerate(path.rows):
                put(name, share[:, :, row])
        speed = np.sqrt(np.where(limits.ceiling > 0.0, x / limits.ceiling, 0.0))
    put(SPEED, np.stack([speed[:-1], speed[1:]], -1))
    if task.limited:
        torque, rate = task.torques.at(x, u), np.abs(path.dq) * np.sqrt(ends)
        for j, drive in enumerate(task.drives):
            put(f"{path.names[j]} torque", np.abs(torque[..., j]) / drive.torque.at(rate[..., j]))
    if task.jerk is not None:
        share = np.abs(jerks(task, x)) / task.jerk
        for j, name in enumerate(path.names):
            put(f"{name} jerk", np.stack([share[:-1, j], share[1:, j]], -1))
    return found


def excess(task: TuningTask, x: FloatArray) -> float:
    """Largest share by which a limit is exceeded at a knot; 0 for none."""
    return max(0.0, *(float(shares.max()) - 1.0 for shares in usage(task, x).values()))
