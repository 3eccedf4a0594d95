"""Figures of one robot's servos; what they mean is in `flyby.core.motion.command.servo`."""

from __future__ import annotations

from dataclasses import dataclass

from .figures import FitRange, Stage, check_figures, figure
from .kinds import FINITE, POSITIVE, RealNumber, Row

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
        "friction_fade_rad",
        RealNumber(POSITIVE),
        Stage.LEAD,
        "way of the joint within which that fades",
        unit="rad (m of a linear axis)",
        default=8e-3,
        fit=_TRAVEL,
    )

    def __post_init__(self) -> None:
        check_figures(self, "servo.")

    @property
    def rubs(self) -> bool:
        """Whether friction sets any joint off."""
        return any(self.friction)


IDEAL = Servo()
