"""What holds the speed down: the limit that binds in each interval of a stamped path, by name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..timing.between_samples import BETWEEN, row_between
from ..timing.least_zone_times import LEAST_TIME
from ..timing.limits import CENTRIPETAL, PathLimits
from ..timing.stamping_kernels import CEILING, NEXT
from ..timing.superposed_legs import ZONE
from ..timing.timed_zones import TIMED
from .run import Run

STOP, CORNER = "stop", "corner"
PROGRAMMED = {
    "tcp": "programmed TCP speed",
    "reorientation": "programmed reorientation speed",
    "joint": "programmed joint speed",
    "external_linear": "programmed external speed",
    "external_angular": "programmed external speed",
}


@dataclass(frozen=True, slots=True)
class LimitShare:
    """A limit and the share of a move's time, in (0, 1], for which it binds."""

    name: str
    share: float


def limit_shares(run: Run, axis_names: Sequence[str]) -> list[tuple[LimitShare, ...]]:
    """For each segment of a run's path what limits it, the longest first."""
    names = interval_limits(run, axis_names)
    timing = run.timing
    spent: list[dict[str, float]] = [{} for _ in run.path.route.moves]
    durations = timing.end - timing.begin
    for segment, name, duration in zip(timing.interval_segments, names, durations, strict=True):
        owner = spent[int(segment)]
        owner[name] = owner.get(name, 0.0) + float(duration)
    return [_shares(owner) for owner in spent]


def interval_limits(run: Run, axis_names: Sequence[str]) -> list[str]:
    """Name of the limit that binds in each of the K intervals of a run's path."""
    stamp = run.timing.stamp
    rows = row_names(run.timing.path_limits, axis_names)
    names: list[str] = [STOP] * len(stamp.limit)
    # An interval that is cut short by what follows is held by the limit of what follows.
    for k in range(len(names) - 1, -1, -1):
        code = int(stamp.limit[k])
        if code >= 0:
            names[k] = rows[stamp.half_plane(code).row]
        elif code == NEXT and k + 1 < len(names):
            names[k] = names[k + 1]
        elif code in (CEILING, NEXT):
            names[k] = _velocity(run, k, axis_names)
    return names


def row_names(limits: PathLimits, axis_names: Sequence[str]) -> tuple[str, ...]:
    """Names of the rows that a path is stamped by: accelerations, then torques from both sides."""
    accelerations = [f"{name} acceleration" for name in (*axis_names, "TCP", "reorientation")]
    names = [accelerations[j] for j in limits.limited]
    if limits.shares is not None:
        torques = [f"{axis_names[j]} torque" for j in range(limits.shares.h.shape[1])]
        names += 2 * torques
    return tuple(names)


def _velocity(run: Run, knot: int, axis_names: Sequence[str]) -> str:
    """The velocity limit that is the ceiling at a knot."""
    _, row, owner = (int(i) for i in run.timing.path_limits.binding[knot])
    if row in (ZONE, LEAST_TIME, TIMED):
        return CORNER
    if row == CENTRIPETAL:
        return "centripetal acceleration"
    if row < 0:
        return STOP
    if row >= BETWEEN:
        row = row_between(row)
    if run.program.moves[run.path.route.moves[owner]].speed.duration is not None:
        return "programmed time"
    source = run.timing.limits.velocity_source[owner][row]
    if source is not None and source[0] in PROGRAMMED:
        return PROGRAMMED[source[0]]
    return f"{axis_names[row]} velocity" if row < len(axis_names) else "TCP speed"


def _shares(spent: dict[str, float]) -> tuple[LimitShare, ...]:
    total = sum(spent.values())
    if total <= 0.0:
        return ()
    order = sorted(spent.items(), key=lambda item: -item[1])
    return tuple(LimitShare(name, time / total) for name, time in order)
