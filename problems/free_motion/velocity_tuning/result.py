"""A tuned motion: how fast the path is passed, and what that takes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from ....core.arrays import FloatArray
from ....core.motion.timing.timing import Settling, Timing
from .path import at_ends
from .task import TuningTask
from .usage import excess, jerks, usage


class Way(StrEnum):
    """How a motion was found."""

    SWEEPS = "sweeps"
    """One sweep back and one forth (`flyby.core.motion.timing.stamping`)."""
    CONVEX = "convex"
    """One second-order cone program."""
    SEQUENTIAL = "sequential"
    """A sequence of them, each within the true limits."""

    @property
    def said(self) -> str:
        """What can be said of a motion that was found so."""
        return {
            Way.SWEEPS: "the fastest there is",
            Way.CONVEX: "the best there is",
            Way.SEQUENTIAL: "the best that was found",
        }[self]


@dataclass(frozen=True, eq=False)
class Tuned:
    """A motion along a fixed path.

    Args:
        task: what was wanted.
        x: (K + 1,), σ̇² at the knots.
        way: how it was found.
        iterations: convex programs that were solved.
    """

    task: TuningTask
    x: FloatArray
    way: Way
    iterations: int = 0

    @property
    def u(self) -> FloatArray:
        """(K,), σ̈ in each interval."""
        return self.task.path.u(self.x)

    @property
    def steps(self) -> FloatArray:
        """(K,) s, the time that each interval takes."""
        return self.task.path.steps(self.x)

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
        return np.asarray(self.task.path.dq * np.sqrt(at_ends(self.x)))

    @property
    def energy(self) -> float:
        """The objective's consumption over time."""
        consumption = self.task.objective.consumption
        power = consumption.total(consumption.powers(self.torque, self.rates))
        return 0.5 * float(self.steps @ power.sum(axis=1))

    @property
    def flow(self) -> float:
        """∫ |p| dt: what is consumed and what is left over, added up."""
        consumption = self.task.objective.consumption
        flow = consumption.flow(consumption.powers(self.torque, self.rates))
        return 0.5 * float(self.steps @ flow.sum(axis=1))

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
    def usage(self) -> dict[str, FloatArray]:
        """Share (K,) of each limit, by name, that is used in each interval; 1 is all."""
        return usage(self.task, self.x)

    @property
    def active(self) -> tuple[str, ...]:
        """(K,), the limit that is used most in each interval."""
        used = self.usage
        names = tuple(used)
        return tuple(names[k] for k in np.argmax(list(used.values()), axis=0))

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
