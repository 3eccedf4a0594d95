"""How one vendor's controller drives, as far as it is known: blends, rules of zones, timing.

Each figure is stated once, as a field (`figures`); files state what of them differs
(`motion_file`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from ...display import counted, in_line
from .blend import PARABOLA, Blend
from .elasticity import RIGID, Elasticity
from .figures import Figure, FitRange, Stage, check_figures, figure, figures_of, part
from .kinds import POSITIVE, Choice, Range, RealNumber, Row, TruthValue
from .provenance import Provenance, of_each
from .rules import ArcTurn, DurationRule, LineTurn, OrientationZone, Overlap, Pace, Space
from .servo import IDEAL, Servo
from .taught_range import TaughtRange, merged
from .torque import WITHOUT_LIMIT, Torque

_WAIT = Range(0.0, 10.0)
"""s, or rad or m: far beyond any average, ramp or wait of a controller."""


@dataclass(frozen=True, repr=False)
class MotionModel:
    """How a controller drives.

    Args:
        provenance: of every figure, by its dotted key. One that is stated for several, as ``*`` or
            ``blend.*``, is kept for each of them that has none of its own.

    Raises:
        InputError: a figure makes no sense; the message names its key.
    """

    period: float = figure(
        "period_s",
        RealNumber(POSITIVE),
        Stage.SAMPLES,
        "interpolation period of the controller",
        unit="s",
        default=0.004,
        always=True,
    )
    tcp: Blend = part("blend.tcp", PARABOLA)
    joint: Blend = part("blend.joint", PARABOLA)
    orientation: Blend = part("blend.orientation", PARABOLA)
    line_turn: LineTurn = figure(
        "line.turn",
        Choice(LineTurn),
        Stage.PATH,
        "how the tool turns along lines, and what limits of turning hold for there",
        default=LineTurn.AXIS,
    )
    arc_turn: ArcTurn = figure(
        "arc.turn",
        Choice(ArcTurn),
        Stage.PATH,
        "how the tool turns along arcs",
        default=ArcTurn.PROGRAMMED,
    )
    overlap: Overlap = figure(
        "zone.overlap",
        Choice(Overlap),
        Stage.PATH,
        "what neighbouring zones do to each other",
        default=Overlap.HALF,
        always=True,
    )
    neighbour_fraction: float = figure(
        "zone.neighbour_fraction",
        RealNumber(
            Range(0.0, 0.5, above=True, reason="beyond a half, neighbouring zones would overlap")
        ),
        Stage.PATH,
        'share of the way to a neighbour that a zone may reach (overlap "half")',
        unit="1",
        default=0.5,
        always=True,
        fit=FitRange(0.0, 0.5),
    )
    orientation_zone: OrientationZone = figure(
        "zone.orientation",
        Choice(OrientationZone),
        Stage.PATH,
        "in which zone the tool begins to turn towards the next target",
        default=OrientationZone.TCP,
        always=True,
    )
    mixed_space: Space = figure(
        "zone.mixed_space",
        Choice(Space),
        Stage.PATH,
        "the space a corner between a joint move and a TCP move is blended in",
        default=Space.JOINT,
        always=True,
    )
    stops_at_pure_reorientation: bool = figure(
        "zone.stops_at_pure_reorientation",
        TruthValue(),
        Stage.PATH,
        "no zone between a TCP move and a mere reorientation",
        default=False,
        always=True,
    )
    pace: Pace = figure(
        "zone.pace", Choice(Pace), Stage.PATH, "how fast zones are driven", default=Pace.LIMITS
    )
    zone_time: float = figure(
        "zone.least_time_s",
        RealNumber(_WAIT),
        Stage.TIMING,
        "how long a zone takes at least, and each part of a wider one in which the tool turns",
        unit="s",
        default=0.0,
        fit=FitRange(0.0, 0.5, 1e-3),
    )
    duration: DurationRule = figure(
        "time.duration",
        Choice(DurationRule),
        Stage.TIMING,
        "how a move is driven that is programmed to take a time",
        default=DurationRule.SCALED,
    )
    start_ramp: float = figure(
        "time.start_ramp_s",
        RealNumber(_WAIT),
        Stage.TIMING,
        "over which a program's time comes up to speed when it starts",
        unit="s",
        default=0.0,
        fit=FitRange(),
    )
    ramp: float = figure(
        "time.ramp_s",
        RealNumber(_WAIT),
        Stage.TIMING,
        "length of a moving average over the place on the path, before the joints are "
        "smoothed: accelerations along the path rise and fall over this time",
        unit="s",
        default=0.0,
        fit=FitRange(0.0, 0.5, 0.02),
    )
    smoothing: tuple[float, ...] = figure(
        "time.smoothing_s",
        Row(_WAIT, per="average", single=True),
        Stage.TIMING,
        "lengths of moving averages, one after the other, over the commanded joints",
        unit="s",
        default=(),
        always=True,
        fit=FitRange(0.0, 0.5, 0.01),
    )
    joint_smoothing: tuple[float, ...] = figure(
        "time.joint_smoothing_s",
        Row(_WAIT, per="average", single=True),
        Stage.TIMING,
        "the same where all moves of a program are joint moves; without, as in other programs",
        unit="s",
        default=(),
        fit=FitRange(0.0, 0.5, 0.01),
    )
    settling: float | None = figure(
        "time.settling_s",
        RealNumber(_WAIT, optional=True),
        Stage.TIMING,
        "how long the stamped motion waits at stops on the way; without, until the commanded "
        "motion has come to rest, which takes the whole window of ramp and smoothing",
        unit="s",
        default=None,
        fit=FitRange(0.0, 1.0, 0.1),
    )
    in_position: float = figure(
        "time.in_position_rad",
        RealNumber(_WAIT),
        Stage.TIMING,
        "how near all axes are to be to a stop on the way for the wait to end earlier; zero "
        "for waits of one length",
        unit="rad (m of a linear axis)",
        default=0.0,
        fit=FitRange(0.0, 0.1, 2e-3),
    )
    in_position_time: float | None = figure(
        "time.in_position_time_s",
        RealNumber(_WAIT, optional=True),
        Stage.TIMING,
        "for how long they are to be; without, as long as the whole window of ramp and smoothing",
        unit="s",
        default=None,
        fit=FitRange(0.0, 1.0, 0.05),
    )
    jerk: float | None = figure(
        "time.jerk",
        RealNumber(POSITIVE, optional=True),
        Stage.TIMING,
        "joint jerk limit as a multiple of each joint's acceleration limit per second, held "
        "by lengthening the longest moving average",
        unit="1/s",
        default=None,
        always=True,
        fit=FitRange(),
    )
    tcp_speed: float | None = figure(
        "limit.tcp_speed",
        RealNumber(POSITIVE, optional=True),
        Stage.TIMING,
        "greatest speed of the TCP, whatever the program states; of moves with a time as well",
        unit="m/s",
        default=None,
    )
    # Where corners of superposed legs are too sharp for their speed, it makes blends smaller.
    tcp_acceleration: float | None = figure(
        "limit.tcp_acceleration",
        RealNumber(POSITIVE, optional=True),
        Stage.PATH,
        "along the path, where the program states none",
        unit="m/s²",
        default=None,
        fit=FitRange(),
    )
    reorientation_acceleration: float | None = figure(
        "limit.reorientation_acceleration",
        RealNumber(POSITIVE, optional=True),
        Stage.TIMING,
        "of the turn along the path, where the program states none",
        unit="rad/s²",
        default=None,
        fit=FitRange(),
    )
    centripetal: float | None = figure(
        "limit.centripetal",
        RealNumber(POSITIVE, optional=True),
        Stage.PATH,
        "greatest centripetal acceleration of the TCP, as a multiple of the acceleration "
        "along the path",
        unit="1",
        default=None,
        fit=FitRange(),
    )
    blend_acceleration: float = figure(
        "limit.blend_acceleration",
        RealNumber(POSITIVE),
        Stage.PATH,
        'what quintic blends of joint moves (blend.joint.kind "quintic") count as greatest '
        "acceleration of a joint, as a multiple of the programmed one: it gives the time they take",
        unit="1",
        default=1.0,
        fit=FitRange(),
    )
    joint_acceleration_scale: tuple[float, ...] = figure(
        "limit.joint_acceleration_scale",
        Row(Range(1e-4, 1e4), neutral=1.0),
        Stage.TIMING,
        "what the robot's own acceleration limits are multiplied by; joints beyond the last "
        "keep theirs",
        unit="1",
        default=(),
        fit=FitRange(0.1, 10.0, 0.5),
    )
    torque: Torque = part("torque", WITHOUT_LIMIT)
    elasticity: Elasticity = part("elasticity", RIGID)
    servo: Servo = part("servo", IDEAL)
    provenance: Mapping[str, Provenance] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_figures(self)
        object.__setattr__(self, "provenance", of_each(self.provenance, self.figures))

    def __repr__(self) -> str:
        averages = " + ".join(f"{1e3 * window:.4g}" for window in self.smoothing)
        stated = self.figures
        origins = Counter(self.provenance[key].status for key in stated & self.provenance.keys())
        known = ", ".join(f"{count} {status}" for status, count in sorted(origins.items()))
        return in_line(
            f"Motion model: period {1e3 * self.period:.4g} ms, zones {self.overlap}, "
            f"smoothing {f'{averages} ms' if averages else 'none'}, "
            f"{counted(stated, 'figure')}{f': {known}' if known else ''}"
        )

    @property
    def taught(self) -> TaughtRange | None:
        """What the runs cover that its figures were fitted to; None where no fit says so."""
        fits = (one.fit for one in self.provenance.values() if one.fit is not None)
        ranges = [fit.taught for fit in fits if fit.taught is not None]
        return merged(ranges) if ranges else None

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
