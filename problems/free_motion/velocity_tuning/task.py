"""What is wanted of a motion along a fixed path."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.motion.model.consumption import SQUARED_TORQUE, Consumption
from ....core.motion.timing.stamping import StampLimits, StandingStillError
from ...checks import all_of_kind, of_kind, positive, within
from .drives import JointDrive
from .path import FixedPath, Torques


@dataclass(frozen=True)
class TuningObjective:
    """w T / T₀ + (1 − w) E / E₀, with T₀ and E₀ = ∫ |p| dt of the fastest motion within the same
    limits.

    Args:
        time_weight: w in [0, 1]: 1 for time alone, 0 for energy alone.
        consumption: whose integral over time is E.
        duration: s, the longest that the motion may take; None for any.

    Raises:
        InputError: a number out of its range.
    """

    time_weight: float = 1.0
    consumption: Consumption = SQUARED_TORQUE
    duration: float | None = None

    def __post_init__(self) -> None:
        within("TuningObjective.time_weight", self.time_weight, 0.0, 1.0)
        of_kind("TuningObjective.consumption", self.consumption, Consumption)
        if self.duration is not None:
            positive("TuningObjective.duration", self.duration)


FASTEST = TuningObjective()


@dataclass(frozen=True, eq=False)
class TuningTask:
    """A path with all that limits the motion on it, from rest to rest.

    Args:
        path: the path.
        drives: one an axis; empty where no torque counts.
        jerk: (N,) rad/s³, may be inf; None for none.
        objective: what is to be small.

    Raises:
        InputError: sizes do not fit, or torques are wanted and not known.
        StandingStillError: a torque limit forbids standing still somewhere on the path.
    """

    path: FixedPath
    drives: tuple[JointDrive, ...] = ()
    jerk: FloatArray | None = None
    objective: TuningObjective = FASTEST

    def __post_init__(self) -> None:
        of_kind("TuningTask.path", self.path, FixedPath)
        of_kind("TuningTask.objective", self.objective, TuningObjective)
        all_of_kind("TuningTask.drives", self.drives, JointDrive)
        if len(self.drives) not in (0, self.path.size):
            raise InputError(
                f"TuningTask.drives: one an axis ({', '.join(self.path.names)}), "
                f"not {len(self.drives)}"
            )
        if self.jerk is not None:
            object.__setattr__(self, "jerk", self._checked_jerk())
        self.objective.consumption.squares(self.path.size)
        if self.drives:
            self._check_standing()

    @cached_property
    def torques(self) -> Torques:
        """What the motors give; without drives they have no friction and no inertia.

        Raises:
            InputError: torques are not known.
        """
        return Torques.of(self.path, self.drives or (JointDrive(),) * self.path.size)

    @property
    def limited(self) -> bool:
        """Whether a torque is limited."""
        return any(math.isfinite(drive.torque.torque[0]) for drive in self.drives)

    @property
    def convex(self) -> bool:
        """Whether one convex program gives the optimum."""
        jerk = self.jerk is not None and bool(np.isfinite(self.jerk).any())
        friction = any(drive.viscous > 0.0 for drive in self.drives)
        rubbing = friction and (self.limited or self.objective.time_weight < 1.0)
        return not (jerk or rubbing or any(drive.torque.falls for drive in self.drives))

    @cached_property
    def standstill(self) -> FloatArray:
        """(N,) N m, the motors' limits at speed zero; inf without."""
        drives = self.drives or (JointDrive(),) * self.path.size
        return np.array([drive.torque.torque[0] for drive in drives])

    def rows(self) -> StampLimits:
        """The path's limits with rows of torque behind them, as they are at speed zero."""
        limits = self.path.limits
        if not self.limited:
            return limits
        which = np.isfinite(self.standstill)
        torques, most = self.torques, self.standstill[which]
        held = torques.c[..., which]
        a, b, lower, upper = (
            np.concatenate(pair, axis=2)
            for pair in (
                (limits.a, torques.a[..., which]),
                (limits.b, torques.b[..., which]),
                (limits.lower, -most - held),
                (limits.upper, most - held),
            )
        )
        return StampLimits(limits.spacing, a, b, lower, upper, limits.ceiling)

    def _checked_jerk(self) -> FloatArray:
        try:
            jerk = np.asarray(self.jerk, dtype=float)
        except (TypeError, ValueError):
            jerk = np.empty(0)
        if jerk.shape != (self.path.size,) or not (jerk > 0.0).all():
            raise InputError(
                f"TuningTask.jerk: one number above zero an axis ({', '.join(self.path.names)}), "
                f"not {self.jerk!r}"
            )
        return jerk

    def _check_standing(self) -> None:
        if not self.limited:
            return
        over = np.abs(self.torques.c) - self.standstill
        if not (over > 0.0).any():
            return
        interval, end, joint = (int(i) for i in np.unravel_index(np.argmax(over), over.shape))
        need, most = abs(self.torques.c[interval, end, joint]), self.standstill[joint]
        way = float(
            self.path.limits.spacing[: interval + end].sum() / self.path.limits.spacing.sum()
        )
        raise StandingStillError(
            f"joint {self.path.names[joint]} needs {need:.4g} N m to hold the arm still at "
            f"{way:.0%} of the path, and its limit is {most:.4g} N m: no motion along this "
            "path is possible; change the configuration, the load or the limit",
            interval + end,
            joint,
        )
