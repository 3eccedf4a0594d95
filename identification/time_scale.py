"""Whether a log shows nothing but another clock, or another speed override, than the emulation.

Both are one number, and no figure of a motion model: they are looked for before any of these. A
clock stretches all of a motion alike, stops and accelerations as well; under an override speeds
are lower and accelerations as they were. Where the motion alone takes longer, in accelerations or
at stops, neither explains it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from scipy.optimize import brentq

from ..core.errors import FlybyError
from ..core.motion.emulator.controller import Controller
from .prediction import PERIOD, Prediction, predict

LEAST = 0.003
"""By how much a scale must differ from one. Clocks of controllers are right to less; the simulated
one of RobotStudio is off by 0.008."""
EXPLAINED = 0.15
"""Share of the joints' distance at their time (rms) that a scale alone may leave."""
HINTED = 0.5
"""Share that one may leave which explains the log together with other figures."""
BETTER = 0.7
"""Share of what a clock leaves that an override may leave at most to be the likelier one."""
SLOWEST = 0.02
"""Least override that is looked for."""


class Cause(StrEnum):
    """What makes a log slower or faster than its emulation, all over."""

    CLOCK = "clock"
    OVERRIDE = "override"


@dataclass(frozen=True, eq=False)
class TimeScale:
    """What alone explains the times of a log.

    Args:
        cause: which number it is.
        value: logged over emulated time, or the share of all speeds.
        before, after: rad (m), of joints at their time (rms), without and with it.
    """

    cause: Cause
    value: float
    before: float
    after: float

    @property
    def ratio(self) -> float:
        """Logged over emulated speed, about."""
        return 1.0 / self.value if self.cause is Cause.CLOCK else self.value

    @property
    def alone(self) -> bool:
        """Whether it explains the log without anything else."""
        return self.after < EXPLAINED * self.before

    @property
    def told(self) -> str:
        """In a sentence."""
        return explained(self.cause, self.value, "this log", self.alone)


def explained(cause: Cause, value: float, what: str, alone: bool) -> str:
    """What a scale makes of some logs, in a sentence.

    Args:
        cause: which number it is.
        value: logged over emulated time, or the share of all speeds.
        what: of what, ``this log``, ``these logs``.
        alone: whether it explains them without anything else.
    """
    if cause is Cause.OVERRIDE:
        how = f"drove as under a speed override of {100 * value:.1f} %"
    else:
        more = "longer than" if value > 1.0 else "less time than"
        how = f"took {100 * abs(value - 1.0):.1f} % {more} emulated, evenly"
    beside = "" if alone else ", beside what other figures explain"
    return f"in {what} the robot {how}{beside}: check override and clock"


def time_scale(
    controller: Controller, found: Prediction, period: float = PERIOD
) -> TimeScale | None:
    """The one number that explains most of how much slower or faster a log is; None if none does.

    Args:
        controller: that the prediction is of.
        found: the log beside its emulation at full speed.
        period: s between samples of the emulation.
    """
    drift, figures = found.alignment.drift, found.figures
    if abs(drift) < LEAST:
        return None
    before = figures.joint_time_rms
    best = TimeScale(Cause.CLOCK, 1.0 + drift, before, figures.joint_clock_rms)
    slower = _overridden(controller, found, period) if drift > 0 else None
    if slower is not None and slower.after < BETTER * best.after:
        best = slower
    return best if best.after < HINTED * before else None


def _overridden(controller: Controller, found: Prediction, period: float) -> TimeScale | None:
    """The override at which the motion takes as long as the log."""
    program, timing = found.driven.program, found.driven.timing
    alignment = found.alignment
    wanted = timing.duration + alignment.logged_moving - alignment.moving

    def late(share: float) -> float:
        return controller.stamp_slower(program, timing, share).duration - wanted

    try:
        if late(SLOWEST) <= 0 or late(1.0) >= 0:
            return None
        share = float(brentq(late, SLOWEST, 1.0, xtol=1e-5))
        made = predict(controller, found.name, program, found.log, period, share)
    except FlybyError:
        return None
    before = found.figures.joint_time_rms
    return TimeScale(Cause.OVERRIDE, share, before, made.figures.joint_time_rms)
