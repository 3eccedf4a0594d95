"""A tuned motion: how fast the path is passed, and what that takes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from ...core.motion.controller import Controller
from ...core.motion.timing import Settling, Timing
from ...core.program.program import Program
from .task import Task

FloatArray = NDArray[np.float64]


class Way(StrEnum):
    """How a motion was found."""

    SWEEPS = "sweeps"
    """One sweep back and one forth (`core.motion.stamping`)."""
    CONVEX = "convex"
    """One second-order cone program."""
    SEQUENTIAL = "sequential"
    """A sequence of them, each within the true limits."""


@dataclass(frozen=True, eq=False)
class Tuned:
    """A motion along a fixed path.

    Args:
        task: what was wanted.
        x: (K + 1,), σ̇² at the knots.
        way: how it was found.
        iterations: convex programs that were solved.
    """

    task: Task
    x: FloatArray
    way: Way
    iterations: int = 0

    @property
    def u(self) -> FloatArray:
        """(K,), σ̈ in each interval."""
        return np.asarray(np.diff(self.x) / (2.0 * self.task.path.limits.spacing))

    @property
    def steps(self) -> FloatArray:
        """(K,) s, the time that each interval takes."""
        root = np.sqrt(self.x)
        return np.asarray(2.0 * self.task.path.limits.spacing / (root[:-1] + root[1:]))

    @property
    def duration(self) -> float:
        """s, without waits."""
        return float(self.steps.sum())

    @property
    def torque(self) -> FloatArray:
        """(K, 2, N) N m of the motors at both ends of each interval."""
        return self.task.torques.at(self.x, self.u)

    @property
    def rates(self) -> FloatArray:
        """(K, 2, N), joint velocities there."""
        ends = np.stack([self.x[:-1], self.x[1:]], -1)[..., None]
        return np.asarray(self.task.path.dq * np.sqrt(ends))

    @property
    def energy(self) -> float:
        """The objective's consumption over time."""
        consumption = self.task.objective.consumption
        power = consumption.total(consumption.powers(self.torque, self.rates))
        return 0.5 * float(self.steps @ power.sum(axis=1))

    @property
    def energy_by_joint(self) -> FloatArray:
        """(N,), what each joint takes of it."""
        powers = self.task.objective.consumption.powers(self.torque, self.rates)
        return np.asarray(0.5 * np.einsum("k,kej->j", self.steps, powers))

    @property
    def jerk(self) -> FloatArray:
        """(K + 1, N) rad/s³: how fast acceleration changes from the middle of one interval to the
        middle of the next; from none where the path begins, ends or stops."""
        return jerks(self.task, self.x)

    @property
    def excess(self) -> float:
        """Largest share by which a limit is exceeded at a knot; 0 or a rounding error."""
        return excess(self.task, self.x)

    def timing(self, timing: Timing) -> Timing:
        """The stamp of a driven program with this motion in the place of its own.

        Args:
            timing: from which the path was made.
        """
        t = np.concatenate([[0.0], np.cumsum(self.steps)])
        stamp = replace(timing.stamp, x=self.x, t=t)
        return Timing.of(
            timing.path, timing.limits, timing.along, timing.path_limits, stamp, Settling()
        )

    def torque_between(
        self, controller: Controller, program: Program, timing: Timing, period: float = 1e-3
    ) -> FloatArray:
        """(T, N) N m of the motors every ``period`` s, between knots too.

        Args:
            controller, program, timing: from which the path was made.
            period: s.
        """
        own = self.timing(timing)
        t = np.arange(0.5 * period, own.duration, period)
        q, dq, ddq, _ = own.states_at(t)
        interval = np.clip(np.searchsorted(own.begin, t, "right") - 1, 0, None)
        segment = own.interval_segments[interval]
        torque = np.empty_like(q)
        loads = controller.loads(program, timing.path)
        for load in dict.fromkeys(loads):
            rows = np.flatnonzero(np.array([other == load for other in loads])[segment])
            torque[rows] = controller.robot.inverse_dynamics(q[rows], dq[rows], ddq[rows], load)
        for j, drive in enumerate(self.task.drives):
            torque[:, j] += drive.inertia * ddq[:, j] + drive.viscous * dq[:, j]
            torque[:, j] += drive.coulomb * np.sign(dq[:, j])
        return np.asarray(torque)


def jerks(task: Task, x: FloatArray) -> FloatArray:
    """(K + 1, N), as `Tuned.jerk`; at a stop the larger of both sides'."""
    path = task.path
    root = np.sqrt(x)
    steps = 2.0 * path.limits.spacing / (root[:-1] + root[1:])
    middle = middle_accelerations(task, x)
    before = np.concatenate([np.zeros((1, path.size)), middle])
    after = np.concatenate([middle, np.zeros((1, path.size))])
    half = 0.5 * np.concatenate([[0.0], steps]), 0.5 * np.concatenate([steps, [0.0]])
    stops = path.stops
    passed = (after - before) / (half[0] + half[1])[:, None]
    into = np.abs(before) / np.where(half[0] > 0, half[0], np.inf)[:, None]
    out = np.abs(after) / np.where(half[1] > 0, half[1], np.inf)[:, None]
    return np.asarray(np.where(stops[:, None], np.maximum(into, out), passed))


def middle_accelerations(task: Task, x: FloatArray) -> FloatArray:
    """(K, N), the mean of the joints' accelerations at both ends of each interval."""
    path = task.path
    u = np.diff(x) / (2.0 * path.limits.spacing)
    ends = np.stack([x[:-1], x[1:]], -1)[..., None]
    return np.asarray((path.dq * u[:, None, None] + path.ddq * ends).mean(axis=1))


def excess(task: Task, x: FloatArray) -> float:
    """Largest share by which a limit is exceeded at a knot."""
    path = task.path
    limits = path.limits
    u = np.diff(x) / (2.0 * limits.spacing)
    ends = np.stack([x[:-1], x[1:]], -1)[..., None]
    value = limits.a * u[:, None, None] + limits.b * ends
    worst = [0.0]
    with np.errstate(divide="ignore", invalid="ignore"):
        for side, bound in ((value, limits.upper), (-value, -limits.lower)):
            share = np.where(np.isfinite(bound) & (bound > 0.0), side / bound - 1.0, 0.0)
            worst.append(float(share.max(initial=0.0)))
        over = np.where(limits.ceiling > 0.0, x / limits.ceiling - 1.0, 0.0)
    worst.append(float(over.max()))
    if task.limited:
        torque, speed = task.torques.at(x, u), np.abs(path.dq) * np.sqrt(ends)
        for j, drive in enumerate(task.drives):
            share = np.abs(torque[..., j]) / drive.torque.at(speed[..., j]) - 1.0
            worst.append(float(share.max()))
    if task.jerk is not None:
        worst.append(float((np.abs(jerks(task, x)) / task.jerk).max()) - 1.0)
    return max(worst)
