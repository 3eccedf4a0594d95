"""What holds the speed down: the limit that binds in each interval of a stamped path, by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial

from ...program.speed import Speed
from ..timing.between_samples import BETWEEN, row_between
from ..timing.least_zone_times import LEAST_TIME
from ..timing.limits import CENTRIPETAL, PathLimits
from ..timing.stamping_kernels import CEILING, NEXT
from ..timing.superposed_legs import ZONE
from ..timing.timed_zones import TIMED
from .run import Run

STOP, CORNER, CENTRIPETAL_NAME = "stop", "corner", "centripetal acceleration"
PROGRAMMED_TIME = "programmed time"
PROGRAMMED = {
    "tcp": "programmed TCP speed",
    "reorientation": "programmed reorientation speed",
    "joint": "programmed joint speed",
    "external_linear": "programmed external speed",
    "external_angular": "programmed external speed",
    "joint_acceleration": "programmed joint acceleration",
    "tcp_acceleration": "programmed TCP acceleration",
    "reorientation_acceleration": "programmed reorientation acceleration",
}
"""Names of the limits that a program states, by the fields of its speeds."""
_FRACTIONS = {"joint_fraction": "joint", "joint_acceleration_fraction": "joint_acceleration"}
"""Of the robot's own limits: below 1 it is the program that states them."""


@dataclass(frozen=True, slots=True)
class LimitShare:
    """A limit and the share of a move's time, in (0, 1], for which it binds."""

    name: str
    share: float


def limit_seconds(run: Run, axis_names: Sequence[str]) -> list[dict[str, float]]:
    """For each segment of a run's path the s for which each limit binds."""
    names = interval_limits(run, axis_names)
    timing = run.timing
    spent: list[dict[str, float]] = [{} for _ in run.path.route.moves]
    durations = timing.end - timing.begin
    for segment, name, duration in zip(
        timing.interval_segments.tolist(), names, durations.tolist(), strict=True
    ):
        owner = spent[segment]
        owner[name] = owner.get(name, 0.0) + duration
    return spent


def limit_shares(run: Run, axis_names: Sequence[str]) -> list[tuple[LimitShare, ...]]:
    """For each segment of a run's path what limits it, the longest first."""
    return [shares_of(spent) for spent in limit_seconds(run, axis_names)]


def interval_limits(run: Run, axis_names: Sequence[str]) -> list[str]:
    """Name of the limit that binds in each of the K intervals of a run's path."""
    stamp, binding = run.timing.stamp, run.timing.path_limits.binding
    rows = row_names(run.timing.path_limits, axis_names)
    owners, limits = run.timing.interval_segments.tolist(), stamp.limit.tolist()
    # Intervals of one move are held by few limits.
    acceleration = cache(partial(_acceleration, run, rows))
    velocity = cache(partial(_velocity, run, axis_names))
    names: list[str] = [STOP] * len(limits)
    # An interval that is cut short by what follows is held by the limit of what follows.
    for k in range(len(names) - 1, -1, -1):
        code = limits[k]
        if code >= 0:
            names[k] = acceleration(owners[k], stamp.half_plane(code).row)
        elif code == NEXT and k + 1 < len(names):
            names[k] = names[k + 1]
        elif code in (CEILING, NEXT):
            _, row, owner = binding[k].tolist()
            names[k] = velocity(owner, row)
    return names


def row_names(limits: PathLimits, axis_names: Sequence[str]) -> tuple[str, ...]:
    """Names of the rows that a path is stamped by: accelerations, then torques from both sides."""
    accelerations = [f"{name} acceleration" for name in (*axis_names, "TCP", "reorientation")]
    names = [accelerations[j] for j in limits.limited]
    if limits.shares is not None:
        torques = [f"{axis_names[j]} torque" for j in range(limits.shares.h.shape[1])]
        names += 2 * torques
    return tuple(names)


def _velocity(run: Run, axis_names: Sequence[str], owner: int, row: int) -> str:
    """The velocity limit that is the ceiling at a knot, by segment and row or code."""
    if row in (ZONE, LEAST_TIME, TIMED):
        return CORNER
    if row == CENTRIPETAL:
        return CENTRIPETAL_NAME
    if row < 0:
        return STOP
    if row >= BETWEEN:
        row = row_between(row)
    speed = run.program.moves[run.path.route.moves[owner]].speed
    if speed.duration is not None:
        return PROGRAMMED_TIME
    stated = _stated(speed, run.timing.limits.velocity_source[owner][row])
    if stated is not None:
        return stated
    return f"{axis_names[row]} velocity" if row < len(axis_names) else "TCP speed"


def _acceleration(run: Run, rows: Sequence[str], owner: int, row: int) -> str:
    """The limit of acceleration or torque that binds in an interval, by segment and row."""
    limited = run.timing.path_limits.limited
    speed = run.program.moves[run.path.route.moves[owner]].speed
    source: tuple[str, float] | None = ("joint_acceleration_fraction", 1.0)  # of torques, too
    if row < len(limited):
        source = run.timing.limits.acceleration_source[owner][int(limited[row])]
    return _stated(speed, source) or rows[row]


def _stated(speed: Speed, source: tuple[str, float] | None) -> str | None:
    """Name of a limit that the program states; None for one of the robot's own."""
    if source is None:
        return None
    field = source[0]
    if field in _FRACTIONS:
        return PROGRAMMED[_FRACTIONS[field]] if getattr(speed, field) < 1.0 else None
    return PROGRAMMED.get(field)


def shares_of(spent: Mapping[str, float]) -> tuple[LimitShare, ...]:
    """Limits by the time for which they bind, the longest first; none where no time is spent."""
    total = sum(spent.values())
    if total <= 0.0:
        return ()
    order = sorted(spent.items(), key=lambda item: -item[1])
    return tuple(LimitShare(name, time / total) for name, time in order)
