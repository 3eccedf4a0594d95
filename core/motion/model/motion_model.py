"""What is known of how one vendor's controller drives: blends, zone rules, timing.

Read from a TOML file in which every figure states where it comes from.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Any

from ...errors import InputError, UnknownNameError
from ...files.reading import read_toml
from ...program.move import ArcOrientation
from ..command.elasticity import RIGID, Elasticity, elasticity
from ..command.smoothing import Smoothing, window_for_jerk
from ..timing.torque import WITHOUT_LIMIT, Torque, torque
from .blend import PARABOLA, Blend
from .provenance import Provenance, read_provenance


class Overlap(StrEnum):
    """What happens where the zones of neighbouring waypoints would overlap."""

    HALF = "half"
    """No zone reaches further than half way to a neighbour (ABB, KUKA)."""
    SHRINK = "shrink"
    """Both zones shrink in proportion until they touch (UR, motion version 2)."""
    SKIP = "skip"
    """The later waypoint is left out (UR, motion version 1)."""


class OrientationZone(StrEnum):
    """Where the tool begins to turn towards the next target."""

    OWN = "own"
    """In a zone of its own, not smaller than the TCP's (ABB ``pzone_ori``)."""
    TCP = "tcp"
    """In the TCP's zone."""


class Space(StrEnum):
    """The space a corner between a joint move and a TCP move is blended in."""

    JOINT = "joint"
    TCP = "tcp"


class DurationRule(StrEnum):
    """How a move is driven that is programmed to take a time."""

    SCALED = "scaled"
    """As without, all its speeds slowed in common."""
    THIRDS = "thirds"
    """Accelerating over the first third of the time, braking over the last (UR)."""


LARGEST = 1e12
LONGEST = 10.0
"""s, or rad or m: far beyond any average, ramp or wait of a controller."""
MOST_SCALE = 1e4
MOST_NUMBERS = 20
"""Averages one after the other, or joints."""


class LineTurn(StrEnum):
    """How the tool turns along lines, and what limits of turning hold for there."""

    AXIS = "axis"
    """About one axis; for the whole turn."""
    SWIVEL = "swivel"
    """By the swivel of its x axis and the rotation about that; for each of both (KUKA)."""


class ArcTurn(StrEnum):
    """How the tool turns along arcs, whatever their programs say."""

    PROGRAMMED = "programmed"
    """As the program says."""
    AXIS = "axis"
    """About one axis, from the orientation at the start to that at the end."""
    PATH = "path"
    """With the arc, and evenly by the rest of its turn."""

    def follows(self, programmed: ArcOrientation) -> bool:
        """Whether the tool turns with an arc for which a program says how."""
        if self is ArcTurn.PROGRAMMED:
            return programmed is ArcOrientation.FOLLOWS_ARC
        return self is ArcTurn.PATH


class Pace(StrEnum):
    """How fast zones are driven."""

    LIMITS = "limits"
    """As fast as the limits along the path allow."""
    SUPERPOSED = "superposed"
    """As fast as legs from rest to rest that overlap in time; see `superposed` (KUKA, UR)."""


@dataclass(frozen=True)
class MotionModel:
    """How a controller drives.

    Args:
        period: interpolation period of the controller, s.
        tcp, joint, orientation: the blend laws of TCP positions, joints and orientations.
        overlap: what neighbouring zones do to each other.
        neighbour_fraction: share of the way to a neighbour that a zone may reach (`Overlap.HALF`).
        orientation_zone: see `OrientationZone`.
        mixed_space: see `Space`.
        stops_at_pure_reorientation: no zone between a TCP move and a mere reorientation.
        pace: see `Pace`.
        tcp_acceleration: m/s² along the path where the program states none; None for no limit.
        reorientation_acceleration: rad/s², likewise.
        line_turn: see `LineTurn`.
        arc_turn: see `ArcTurn`.
        centripetal: greatest centripetal acceleration of the TCP, as a multiple of the
            acceleration along the path; None for no limit.
        joint_acceleration_scale: what the robot's own acceleration limits are multiplied by, from
            the first joint of the arm on; joints beyond the last keep theirs.
        torque: what limits the acceleration of joints in the place of the robot's own figures; see
            `Torque`.
        duration: see `DurationRule`.
        start_ramp: s over which a program's time comes up to speed when it starts; see
            `StartRamp`.
        ramp: s, length of a moving average over the place on the path, before the joints are
            smoothed: accelerations along the path rise and fall over this time; see `ramped`.
        smoothing: lengths in s of the moving averages, one after the other, over the commanded
            joints; see `smoothing.Smoothing`.
        settling: s that the stamped motion waits at stops on the way; None waits until the
            commanded motion has come to rest, which takes the whole window.
        in_position: rad (m for a linear axis), how near all axes are to be to a stop on the way
            for the wait to end earlier; 0 for waits of one length; see `rests`.
        in_position_time: s, for how long they are to be; None for as long as the whole window of
            ramp and smoothing.
        elasticity: how far motors lead their links; see `Elasticity`.
        jerk: joint jerk limit as a multiple of each joint's acceleration limit per second, held
            by lengthening the longest moving average; None for no limit.
        provenance: of every figure, by its dotted key.
    """

    period: float = 0.004
    tcp: Blend = PARABOLA
    joint: Blend = PARABOLA
    orientation: Blend = PARABOLA
    overlap: Overlap = Overlap.HALF
    neighbour_fraction: float = 0.5
    orientation_zone: OrientationZone = OrientationZone.TCP
    mixed_space: Space = Space.JOINT
    stops_at_pure_reorientation: bool = False
    pace: Pace = Pace.LIMITS
    tcp_acceleration: float | None = None
    reorientation_acceleration: float | None = None
    line_turn: LineTurn = LineTurn.AXIS
    arc_turn: ArcTurn = ArcTurn.PROGRAMMED
    centripetal: float | None = None
    joint_acceleration_scale: tuple[float, ...] = ()
    torque: Torque = WITHOUT_LIMIT
    duration: DurationRule = DurationRule.SCALED
    start_ramp: float = 0.0
    ramp: float = 0.0
    smoothing: tuple[float, ...] = ()
    settling: float | None = None
    in_position: float = 0.0
    in_position_time: float | None = None
    elasticity: Elasticity = RIGID
    jerk: float | None = None
    provenance: Mapping[str, Provenance] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not 0 < self.period < math.inf:
            raise InputError(
                f"the controller's period_s must be finite and above zero, not {self.period}"
            )
        if not 0 < self.neighbour_fraction <= 0.5:
            raise InputError(
                f"zone.neighbour_fraction lies in (0, 0.5], not {self.neighbour_fraction}: "
                "beyond a half, neighbouring zones would overlap"
            )
        for key, durations in (
            ("time.start_ramp_s", (self.start_ramp,)),
            ("time.ramp_s", (self.ramp,)),
            ("time.smoothing_s", self.smoothing),
            ("time.settling_s", _stated(self.settling)),
            ("time.in_position_rad", (self.in_position,)),
            ("time.in_position_time_s", _stated(self.in_position_time)),
        ):
            for value in durations:
                if not 0 <= value <= LONGEST:
                    raise InputError(f"{key} must be from zero to {LONGEST:g}, not {value}")
        for key, row in (
            ("time.smoothing_s", self.smoothing),
            ("limit.joint_acceleration_scale", self.joint_acceleration_scale),
        ):
            if len(row) > MOST_NUMBERS:
                raise InputError(f"{key} has {len(row)} numbers; at most {MOST_NUMBERS} are taken")
        for key, value in (
            ("time.jerk", self.jerk),
            *((f"limit.{name}", getattr(self, name)) for name in _LIMITS),
        ):
            if value is not None and not 0 < value < math.inf:
                raise InputError(f"{key} must be finite and above zero, not {value}")
        if not all(
            1 / MOST_SCALE <= value <= MOST_SCALE for value in self.joint_acceleration_scale
        ):
            raise InputError(
                f"limit.joint_acceleration_scale must be from {1 / MOST_SCALE:g} to "
                f"{MOST_SCALE:g}, not {list(self.joint_acceleration_scale)}"
            )
        if not isinstance(self.stops_at_pure_reorientation, bool):
            raise InputError(
                "zone.stops_at_pure_reorientation is true or false, not "
                f"{self.stops_at_pure_reorientation!r}"
            )

    def smoothing_at(self, jerk_fraction: float) -> Smoothing:
        """What is done to the commanded joints where a share of the jerk limit is programmed."""
        made = Smoothing(tuple(width for width in self.smoothing if width > 0))
        if self.jerk is None:
            return made
        return made.lengthened_to(window_for_jerk(self.jerk * jerk_fraction))

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
        blends = (f"blend.{name}.{key}" for name in _BLENDS for key in ("kind", "alpha", "beta"))
        limits = (f"limit.{name}" for name in _LIMITS if getattr(self, name) is not None)
        optional = [key for key, name, no in _OPTIONAL if getattr(self, name) != no]
        parts = (*self.elasticity.figures, *self.torque.figures)
        scale = ("limit.joint_acceleration_scale",) if self.joint_acceleration_scale else ()
        return frozenset((*_SINGLE_FIGURES, *blends, *limits, *scale, *optional, *parts))


_TABLES = (
    "blend",
    "line",
    "arc",
    "zone",
    "time",
    "limit",
    "torque",
    "elasticity",
    "fits",
    "provenance",
)
_BLENDS = ("tcp", "joint", "orientation")
_LIMITS = ("tcp_acceleration", "reorientation_acceleration", "centripetal")
_OPTIONAL = (
    ("zone.pace", "pace", Pace.LIMITS),
    ("line.turn", "line_turn", LineTurn.AXIS),
    ("arc.turn", "arc_turn", ArcTurn.PROGRAMMED),
    ("time.duration", "duration", DurationRule.SCALED),
    ("time.start_ramp_s", "start_ramp", 0.0),
    ("time.ramp_s", "ramp", 0.0),
    ("time.settling_s", "settling", None),
    ("time.in_position_rad", "in_position", 0.0),
    ("time.in_position_time_s", "in_position_time", None),
)
"""Keys and fields of what most do without, and the values that stand for nothing."""
_SINGLE_FIGURES = (
    "period_s",
    "zone.overlap",
    "zone.neighbour_fraction",
    "zone.orientation",
    "zone.mixed_space",
    "zone.stops_at_pure_reorientation",
    "time.smoothing_s",
    "time.jerk",
)


def load_motion_model(
    path: Path, base: MotionModel | None = None, robot: str | None = None
) -> MotionModel:
    """Read a motion model.

    Args:
        path: TOML. A file may name the one ``robot`` that it holds for.
        base: what holds where the file states nothing; None for the defaults of `MotionModel`.
        robot: that is to be driven, such as ``abb/irb6640-180-255``; None for any.

    Raises:
        InputError: the file is missing or no TOML, is another robot's, a key is unknown, a value
            has the wrong type or range; the message names file and key.
    """
    data = read_toml(path, LARGEST)
    own = data.pop("robot", robot)
    if robot is not None and own != robot:
        raise InputError(f"{path}: it says how {own} is driven, not {robot}")
    try:
        return _model(data, MotionModel() if base is None else base)
    except (InputError, TypeError, ValueError) as error:
        raise InputError(f"{path}: {error}") from error


def _model(data: dict[str, Any], base: MotionModel) -> MotionModel:
    tables = (_table(key, data.pop(key, {})) for key in _TABLES)
    blend, line, arc, zone, time, limit, most, lead, fits, origins = tables
    values: dict[str, Any] = {
        "provenance": {**base.provenance, **read_provenance(fits, origins)},
        "torque": torque(most, base.torque),
        "elasticity": elasticity(lead, base.elasticity),
    }
    _take(data, values, "", {"period_s": ("period", _number)})
    blends = {name: (name, partial(_blend, getattr(base, name))) for name in _BLENDS}
    _take(blend, values, "blend.", blends)
    _take(line, values, "line.", {"turn": ("line_turn", LineTurn)})
    _take(arc, values, "arc.", {"turn": ("arc_turn", ArcTurn)})
    _take(
        zone,
        values,
        "zone.",
        {
            "overlap": ("overlap", Overlap),
            "neighbour_fraction": ("neighbour_fraction", _number),
            "orientation": ("orientation_zone", OrientationZone),
            "mixed_space": ("mixed_space", Space),
            "stops_at_pure_reorientation": ("stops_at_pure_reorientation", _truth),
            "pace": ("pace", Pace),
        },
    )
    _take(
        time,
        values,
        "time.",
        {
            "duration": ("duration", DurationRule),
            "start_ramp_s": ("start_ramp", _number),
            "ramp_s": ("ramp", _number),
            "smoothing_s": ("smoothing", _numbers),
            "settling_s": ("settling", _number),
            "in_position_rad": ("in_position", _number),
            "in_position_time_s": ("in_position_time", _number),
            "jerk": ("jerk", lambda v: None if v == "none" else _number(v)),
        },
    )
    _take(
        limit,
        values,
        "limit.",
        {
            "tcp_acceleration": ("tcp_acceleration", _number),
            "reorientation_acceleration": ("reorientation_acceleration", _number),
            "centripetal": ("centripetal", _number),
            "joint_acceleration_scale": ("joint_acceleration_scale", _row),
        },
    )
    return replace(base, **values)


def _take(
    table: dict[str, Any], values: dict[str, Any], prefix: str, keys: Mapping[str, Any]
) -> None:
    for key, entry in table.items():
        if key not in keys:
            raise UnknownNameError(
                "key of a motion model", prefix + key, (prefix + k for k in keys)
            )
        name, convert = keys[key]
        try:
            values[name] = convert(entry)
        except (InputError, TypeError, ValueError) as error:
            raise InputError(f"{prefix}{key}: {error}") from error


def _stated(value: float | None) -> tuple[float, ...]:
    return () if value is None else (value,)


def _table(key: str, entry: Any) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise InputError(f"{key}: a table is expected, not {entry!r}")
    return entry


def _blend(base: Blend, entry: Any) -> Blend:
    if not isinstance(entry, dict):
        raise InputError(f"a table is expected, not {entry!r}")
    values: dict[str, Any] = {}
    keys = {"kind": ("kind", str), "alpha": ("alpha", _row), "beta": ("beta", _row)}
    _take(entry, values, "", keys)
    return replace(base, **values)


def _number(entry: Any) -> float:
    if isinstance(entry, bool) or not isinstance(entry, int | float):
        raise InputError(f"a number is expected, not {entry!r}")
    return float(entry)


def _row(entry: Any) -> tuple[float, ...]:
    if not isinstance(entry, list):
        raise InputError(f"a list of numbers is expected, not {entry!r}")
    return tuple(map(_number, entry))


def _numbers(entry: Any) -> tuple[float, ...]:
    """Several numbers, or one; a single zero means none."""
    if isinstance(entry, list):
        return _row(entry)
    value = _number(entry)
    return () if value == 0.0 else (value,)


def _truth(entry: Any) -> bool:
    if not isinstance(entry, bool):
        raise InputError(f"true or false is expected, not {entry!r}")
    return entry
