"""Figures of one robot's servos; what they mean is in `flyby.core.motion.command.servo`."""

from __future__ import annotations

from dataclasses import dataclass

from .figures import FitRange, Stage, check_figures, figure
from .kinds import FINITE, NOT_NEGATIVE, POSITIVE, RealNumber, Row

_TRAVEL = FitRange(1e-5, 0.1, 1e-3)


@dataclass(frozen=True)
class Servo:
    """How the motors of one robot, and links with them, are off what its controller commands.

    Raises:
        InputError: a figure makes no sense.
    """

    friction: tuple[float, ...] = figure(
        "friction_rad",
        Row(FINITE),
        Stage.LEAD,
        "how far friction sets a joint off as it begins to move, at most, and twice as far "
        "where it turns back (above zero: ahead); joints beyond are not",
        unit="rad (m of a linear axis)",
        default=(),
        fit=FitRange(-5e-3, 5e-3, 1e-4),
    )
    rise: float = figure(
        "friction_rise_rad",
        RealNumber(POSITIVE),
        Stage.LEAD,
        "way of the joint within which that sets in",
        unit="rad (m of a linear axis)",
        default=2e-4,
        fit=_TRAVEL,
    )
    fade: float = figure(
        "friction_fade_s",
        RealNumber(POSITIVE),
        Stage.LEAD,
        "time within which that fades, as the servo makes up for it",
        unit="s",
        default=0.6,
        fit=FitRange(0.01, 1e4, 0.3),
    )
    drag: tuple[float, ...] = figure(
        "drag_s",
        Row(FINITE),
        Stage.LEAD,
        "how far a joint comes ahead where it runs fast for a while, per velocity (below zero: "
        "behind); joints beyond do not",
        unit="s",
        default=(),
        fit=FitRange(-0.02, 0.02, 1e-3),
    )
    drag_speed: float = figure(
        "drag_speed_radps",
        RealNumber(POSITIVE),
        Stage.LEAD,
        "speed at which that is half of what it is per velocity of fast joints",
        unit="rad/s (m/s of a linear axis)",
        default=0.3,
        fit=FitRange(0.01, 10.0, 0.3),
    )
    drag_delay: float = figure(
        "drag_delay_s",
        RealNumber(NOT_NEGATIVE),
        Stage.LEAD,
        "how much later that shows",
        unit="s",
        default=0.14,
        fit=FitRange(0.0, 1.0, 0.02),
    )

    rest: float = figure(
        "rest_s",
        RealNumber(NOT_NEGATIVE),
        Stage.TIMING,
        "how much longer than time.settling_s a stop on the way that the program states may take, "
        "until the servos are in position",
        unit="s",
        default=0.0,
        fit=FitRange(0.0, 1.0, 0.01),
    )

    def __post_init__(self) -> None:
        check_figures(self, "servo.")

    @property
    def still(self) -> bool:
        """Whether no joint is ever off."""
        return not (any(self.friction) or any(self.drag))


IDEAL = Servo()
