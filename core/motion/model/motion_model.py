"""How one vendor's controller drives, as far as it is known: blends, rules of zones, timing.

Each figure is stated once, as a field (`figures`); files state what of them differs
(`motion_file`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .blend import PARABOLA, Blend
from .elasticity import RIGID, Elasticity
from .figures import Figure, Fit, Stage, check_figures, figure, figures_of, part
from .kinds import POSITIVE, Choice, Range, RealNumber, Row, Truth
from .provenance import Provenance
from .rules import ArcTurn, DurationRule, LineTurn, OrientationZone, Overlap, Pace, Space
from .torque import WITHOUT_LIMIT, Torque

_WAIT = Range(0.0, 10.0)
"""s, or rad or m: far beyond any average, ramp or wait of a controller."""


@dataclass(frozen=True)
class MotionModel:
    """How a controller drives.

    Args:
        provenance: of every figure, by its dotted key.

    Raises:
        InputError: a figure makes no sense; the message names its key.
    """

    period: float = field(
        default=0.004,
        metadata=figure(
            "period_s",
            RealNumber(POSITIVE),
            Stage.SAMPLES,
            "s",
            "interpolation period of the controller",
            always=True,
        ),
    )
    tcp: Blend = field(default=PARABOLA, metadata=part("blend.tcp"))
    joint: Blend = field(default=PARABOLA, metadata=part("blend.joint"))
    orientation: Blend = field(default=PARABOLA, metadata=part("blend.orientation"))
    line_turn: LineTurn = field(
        default=LineTurn.AXIS,
        metadata=figure(
            "line.turn",
            Choice(LineTurn),
            Stage.PATH,
            "",
            "how the tool turns along lines, and what limits of turning hold for there",
        ),
    )
    arc_turn: ArcTurn = field(
        default=ArcTurn.PROGRAMMED,
        metadata=figure(
            "arc.turn", Choice(ArcTurn), Stage.PATH, "", "how the tool turns along arcs"
        ),
    )
    overlap: Overlap = field(
        default=Overlap.HALF,
        metadata=figure(
            "zone.overlap",
            Choice(Overlap),
            Stage.PATH,
            "",
            "what neighbouring zones do to each other",
            always=True,
        ),
    )
    neighbour_fraction: float = field(
        default=0.5,
        metadata=figure(
            "zone.neighbour_fraction",
            RealNumber(
                Range(
                    0.0, 0.5, above=True, reason="beyond a half, neighbouring zones would overlap"
                )
            ),
            Stage.PATH,
            "1",
            'share of the way to a neighbour that a zone may reach (overlap "half")',
            always=True,
            fit=Fit(0.0, 0.5),
        ),
    )
    orientation_zone: OrientationZone = field(
        default=OrientationZone.TCP,
        metadata=figure(
            "zone.orientation",
            Choice(OrientationZone),
            Stage.PATH,
            "",
            "in which zone the tool begins to turn towards the next target",
            always=True,
        ),
    )
    mixed_space: Space = field(
        default=Space.JOINT,
        metadata=figure(
            "zone.mixed_space",
            Choice(Space),
            Stage.PATH,
            "",
            "the space a corner between a joint move and a TCP move is blended in",
            always=True,
        ),
    )
    stops_at_pure_reorientation: bool = field(
        default=False,
        metadata=figure(
            "zone.stops_at_pure_reorientation",
            Truth(),
            Stage.PATH,
            "",
            "no zone between a TCP move and a mere reorientation",
            always=True,
        ),
    )
    pace: Pace = field(
        default=Pace.LIMITS,
        metadata=figure("zone.pace", Choice(Pace), Stage.PATH, "", "how fast zones are driven"),
    )
    duration: DurationRule = field(
        default=DurationRule.SCALED,
        metadata=figure(
            "time.duration",
            Choice(DurationRule),
            Stage.TIMING,
            "",
            "how a move is driven that is programmed to take a time",
        ),
    )
    start_ramp: float = field(
        default=0.0,
        metadata=figure(
            "time.start_ramp_s",
            RealNumber(_WAIT),
            Stage.TIMING,
            "s",
            "over which a program's time comes up to speed when it starts",
            fit=Fit(),
        ),
    )
    ramp: float = field(
        default=0.0,
        metadata=figure(
            "time.ramp_s",
            RealNumber(_WAIT),
            Stage.TIMING,
            "s",
            "length of a moving average over the place on the path, before the joints are "
            "smoothed: accelerations along the path rise and fall over this time",
            fit=Fit(0.0, 0.5, 0.02),
        ),
    )
    smoothing: tuple[float, ...] = field(
        default=(),
        metadata=figure(
            "time.smoothing_s",
            Row(_WAIT, per="average", single=True),
            Stage.TIMING,
            "s",
            "lengths of moving averages, one after the other, over the commanded joints",
            always=True,
            fit=Fit(0.0, 0.5, 0.01),
        ),
    )
    settling: float | None = field(
        default=None,
        metadata=figure(
            "time.settling_s",
            RealNumber(_WAIT, optional=True),
            Stage.TIMING,
            "s",
            "how long the stamped motion waits at stops on the way; without, until the commanded "
            "motion has come to rest, which takes the whole window of ramp and smoothing",
            fit=Fit(0.0, 1.0, 0.1),
        ),
    )
    in_position: float = field(
        default=0.0,
        metadata=figure(
            "time.in_position_rad",
            RealNumber(_WAIT),
            Stage.TIMING,
            "rad (m of a linear axis)",
            "how near all axes are to be to a stop on the way for the wait to end earlier; zero "
            "for waits of one length",
            fit=Fit(0.0, 0.1, 2e-3),
        ),
    )
    in_position_time: float | None = field(
        default=None,
        metadata=figure(
            "time.in_position_time_s",
            RealNumber(_WAIT, optional=True),
            Stage.TIMING,
            "s",
            "for how long they are to be; without, as long as the whole window of ramp and "
            "smoothing",
            fit=Fit(0.0, 1.0, 0.05),
        ),
    )
    jerk: float | None = field(
        default=None,
        metadata=figure(
            "time.jerk",
            RealNumber(POSITIVE, optional=True),
            Stage.TIMING,
            "1/s",
            "joint jerk limit as a multiple of each joint's acceleration limit per second, held "
            "by lengthening the longest moving average",
            always=True,
            fit=Fit(),
        ),
    )
    # Where corners of superposed legs are too sharp for their speed, it makes blends smaller.
    tcp_acceleration: float | None = field(
        default=None,
        metadata=figure(
            "limit.tcp_acceleration",
            RealNumber(POSITIVE, optional=True),
            Stage.PATH,
            "m/s²",
            "along the path, where the program states none",
            fit=Fit(),
        ),
    )
    reorientation_acceleration: float | None = field(
        default=None,
        metadata=figure(
            "limit.reorientation_acceleration",
            RealNumber(POSITIVE, optional=True),
            Stage.TIMING,
            "rad/s²",
            "of the turn along the path, where the program states none",
            fit=Fit(),
        ),
    )
    centripetal: float | None = field(
        default=None,
        metadata=figure(
            "limit.centripetal",
            RealNumber(POSITIVE, optional=True),
            Stage.PATH,
            "1",
            "greatest centripetal acceleration of the TCP, as a multiple of the acceleration "
            "along the path",
            fit=Fit(),
        ),
    )
    joint_acceleration_scale: tuple[float, ...] = field(
        default=(),
        metadata=figure(
            "limit.joint_acceleration_scale",
            Row(Range(1e-4, 1e4), neutral=1.0),
            Stage.TIMING,
            "1",
            "what the robot's own acceleration limits are multiplied by; joints beyond the last "
            "keep theirs",
            fit=Fit(0.1, 10.0, 0.5),
        ),
    )
    torque: Torque = field(default=WITHOUT_LIMIT, metadata=part("torque"))
    elasticity: Elasticity = field(default=RIGID, metadata=part("elasticity"))
    provenance: Mapping[str, Provenance] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_figures(self)

    def ramp_at(self, jerk_fraction: float) -> float:
        """The `ramp` where a share of the jerk is programmed."""
        return self.ramp / jerk_fraction

    def acceleration_scale(self, joint: int) -> float:
        """What the acceleration limit of a joint, counted from zero, is multiplied by."""
        scales = self.joint_acceleration_scale
        return scales[joint] if joint < len(scales) else 1.0

    @property
    def figures(self) -> frozenset[str]:
        """The dotted keys of all that the model states; each of them needs a provenance."""
        return frozenset(key for key, one in FIGURES.items() if one.stated(self))


FIGURES: Mapping[str, Figure] = {one.key: one for one in figures_of(MotionModel)}
"""All figures that a motion model may state, by their dotted keys."""


def first_change(one: MotionModel, other: MotionModel) -> Stage | None:
    """The first stage of an emulation in which two models differ; None if they state the same."""
    return min(
        (figure.stage for figure in FIGURES.values() if figure.of(one) != figure.of(other)),
        default=None,
    )
