"""Figures of elastic joints; what they mean is in `flyby.core.motion.command.elasticity`."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError
from .figures import FitRange, Stage, Tables, check_figures, figure, member
from .kinds import FINITE, NOT_NEGATIVE, RealNumber, Row, TruthValue, Whole

_LEAD = FitRange(-5e-3, 5e-3, 1e-4)


@dataclass(frozen=True)
class Carried:
    """A mass on the axis of a joint, as the gears before it feel it."""

    joint: int = member(
        "joint", Whole(), "the joint of the arm, counted from one, on whose axis the mass is"
    )
    lead: tuple[float, ...] = member(
        "lead_s2_per_m2",
        Row(FINITE),
        "lead in rad per N m, times kg, of each joint before that, first to last; a rigid "
        "mass has none below zero, what is fitted may, as joints also bend each other",
        unit="s²/m²",
        fit=_LEAD,
    )


@dataclass(frozen=True)
class Coupled:
    """A joint that the torque on another one bends as well."""

    joint: int = member("joint", Whole(), "the joint that leads, counted from one")
    by: int = member("by", Whole(), "the joint whose torque does it, counted from one")
    share: float = member(
        "share",
        RealNumber(),
        "share of what the stiffness of that one alone lets it give way by",
        unit="1",
        fit=FitRange(-2.0, 2.0, 0.1),
    )


@dataclass(frozen=True)
class Elasticity:
    """What commanded joints lead their links by.

    Raises:
        InputError: a figure makes no sense, on its own or beside the others.
    """

    own: tuple[float, ...] = figure(
        "own_s2",
        Row(FINITE),
        Stage.LEAD,
        "lead per acceleration of the joint itself, whatever the posture; joints beyond have none",
        unit="s²",
        default=(),
        fit=_LEAD,
    )
    carried: tuple[Carried, ...] = figure(
        "carried", Tables(Carried), Stage.LEAD, "masses on the arm", default=()
    )
    slack: tuple[float, ...] = figure(
        "slack_rad",
        Row(NOT_NEGATIVE),
        Stage.LEAD,
        "how much farther a joint gives way at most before its gear is stiff; joints beyond do not",
        unit="rad",
        default=(),
        fit=FitRange(0.0, 5e-3, 1e-4),
    )
    slack_averaged: bool = figure(
        "slack_averaged",
        TruthValue(),
        Stage.LEAD,
        "whether the longest of the averages over time comes behind what slack adds",
        default=False,
    )
    lag: tuple[float, ...] = figure(
        "lag_s",
        Row(FINITE),
        Stage.LEAD,
        "how far a joint is ahead of the others where it moves (below zero: behind), as the "
        "servos of a measured arm follow at different distances; joints beyond are not",
        unit="s",
        default=(),
        fit=_LEAD,
    )
    weight: tuple[float, ...] = figure(
        "weight",
        Row(FINITE),
        Stage.LEAD,
        "how many times the masses' weight the gear of a joint holds, which uses up slack; "
        "joints beyond hold none",
        unit="1",
        default=(),
        fit=FitRange(-10.0, 10.0, 0.5),
    )
    spring: tuple[float, ...] = figure(
        "spring_rad",
        Row(FINITE),
        Stage.LEAD,
        "lead that a spring which balances the arm adds to what the gear holds, times the "
        "sine of the joint; joints beyond have none",
        unit="rad",
        default=(),
        fit=FitRange(-0.05, 0.05, 1e-3),
    )
    coupled: tuple[Coupled, ...] = figure(
        "coupled", Tables(Coupled), Stage.LEAD, "joints that the torque on others bends", default=()
    )

    def __post_init__(self) -> None:
        check_figures(self, "elasticity.")
        for k, mass in enumerate(self.carried):
            if len(mass.lead) >= mass.joint:
                raise InputError(
                    f"elasticity.carried[{k}]: a mass on the axis of joint b (counted from one) is "
                    f"carried by the joints before it; joint {mass.joint} has {mass.joint - 1}, "
                    f"lead_s2_per_m2 has {len(mass.lead)}"
                )
        for k, pair in enumerate(self.coupled):
            if pair.joint == pair.by:
                raise InputError(
                    f"elasticity.coupled[{k}]: joint and by are two joints, not "
                    f"{pair.joint} and {pair.by}"
                )


RIGID = Elasticity()
