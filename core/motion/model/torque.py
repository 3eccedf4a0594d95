"""Figures of the limits of torque; what they mean is in `flyby.core.motion.timing.torque`."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError
from .figures import FitRange, Stage, Tables, check_figures, figure, member
from .kinds import NOT_NEGATIVE, POSITIVE, Row, Whole


@dataclass(frozen=True)
class Borne:
    """A mass on the axis of a joint, as the motors before it feel it."""

    joint: int = member(
        "joint", Whole(), "the joint of the arm, counted from one, on whose axis the mass is"
    )
    share: tuple[float, ...] = member(
        "share_s2_per_m2",
        Row(NOT_NEGATIVE),
        "share of the limit per N m, times kg, of each joint before that, first to last",
        unit="s²/m²",
        fit=FitRange(0.0, 10.0, 0.05),
    )


@dataclass(frozen=True)
class Torque:
    """What share of its torque's limit a motion takes of each joint.

    Raises:
        InputError: a figure makes no sense, on its own or beside the others.
    """

    own: tuple[float, ...] = figure(
        "own_s2",
        Row(POSITIVE),
        Stage.TIMING,
        "share of its limit per acceleration of the joint itself, whatever the posture; "
        "joints that have one are limited by torque, those beyond by their acceleration",
        unit="s²/rad",
        default=(),
        fit=FitRange(1e-6, 10.0, 0.05),
    )
    carried: tuple[Borne, ...] = figure(
        "carried", Tables(Borne), Stage.TIMING, "masses on the arm", default=()
    )
    weight: tuple[float, ...] = figure(
        "weight",
        Row(NOT_NEGATIVE),
        Stage.TIMING,
        "share of the masses' weight that the joint's motor holds; joints beyond hold none",
        unit="1",
        default=(),
        fit=FitRange(0.0, 5.0, 0.5),
    )
    fade: tuple[float, ...] = figure(
        "fade_s2",
        Row(NOT_NEGATIVE),
        Stage.TIMING,
        "share of the limit that is lost per square of the joint's speed",
        unit="s²/rad²",
        default=(),
        fit=FitRange(0.0, 10.0, 0.2),
    )

    def __post_init__(self) -> None:
        check_figures(self, "torque.")
        for k, mass in enumerate(self.carried):
            if len(mass.share) >= mass.joint:
                raise InputError(
                    f"torque.carried[{k}]: a mass on the axis of joint b (counted from one) is "
                    f"carried by the joints before it; joint {mass.joint} has {mass.joint - 1}, "
                    f"share_s2_per_m2 has {len(mass.share)}"
                )
        most = max(map(len, (self.weight, self.fade, *(mass.share for mass in self.carried))))
        if most > len(self.own):
            raise InputError(
                f"torque.own_s2 has {len(self.own)} entries, one for each joint that torque "
                f"limits; weight, fade_s2 or carried go on to joint {most}"
            )


WITHOUT_LIMIT = Torque()
