"""What a log, or an emulated motion, shows of the corner between two straight legs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray
from ..core.errors import InputError

OFF_THE_LEGS = 5e-5
"""m from a leg beyond which the TCP counts as having left it: ten times the resolution of logs
with 10⁻⁴ degree at an arm of three metres."""


@dataclass(frozen=True)
class MeasuredCorner:
    """Figures of one corner.

    Args:
        apex: m, the TCP's least distance from the waypoint.
        entry, exit: m from the waypoint along the legs, where the TCP leaves the first and meets
            the second one (to within `OFF_THE_LEGS`); 0 if it never leaves them.
        duration: s inside the sphere that was looked at.
    """

    apex: float
    entry: float
    exit: float
    duration: float


def measure_corner(
    t: FloatArray, tcp: FloatArray, points: FloatArray, radius: float
) -> MeasuredCorner:
    """The figures of a corner.

    Args:
        t: (T,) s.
        tcp: (T, 3) m, the TCP.
        points: (3, 3) m, the ends of the two legs; the waypoint is the middle one.
        radius: m, of the sphere round the waypoint to look at; somewhat beyond the zone.

    Raises:
        InputError: the TCP is never inside the sphere.
    """
    begin, waypoint, end = points
    from_waypoint = np.linalg.norm(tcp - waypoint, axis=1)
    inside = np.flatnonzero(from_waypoint < radius)
    if len(inside) == 0:
        raise InputError(f"the TCP stays {from_waypoint.min():.3g} m away from the waypoint")
    rows = slice(inside[0], inside[-1] + 1)
    path = tcp[rows] - waypoint
    apex = int(np.argmin(from_waypoint[rows]))
    into, out = (leg / np.linalg.norm(leg) for leg in (begin - waypoint, end - waypoint))
    away = _distance(path, into), _distance(path, out)
    left = np.flatnonzero(away[0][: apex + 1] > OFF_THE_LEGS)
    met = np.flatnonzero(away[1][apex:] > OFF_THE_LEGS)
    entry = float(path[left[0]] @ into) if len(left) else 0.0
    leave = float(path[apex + met[-1]] @ out) if len(met) else 0.0
    apex_distance = float(least_distance(path))
    return MeasuredCorner(apex_distance, max(entry, 0.0), max(leave, 0.0), float(np.ptp(t[rows])))


def _distance(path: FloatArray, unit: FloatArray) -> FloatArray:
    """Distances of points from a line through the origin."""
    return np.asarray(np.linalg.norm(path - np.outer(path @ unit, unit), axis=1))


def least_distance(path: FloatArray) -> float:
    """Least distance from the origin to the polyline through the points."""
    step = np.diff(path, axis=0)
    square = np.maximum(np.sum(step * step, axis=1), 1e-30)
    share = np.clip(-np.sum(path[:-1] * step, axis=1) / square, 0.0, 1.0)
    return float(np.linalg.norm(path[:-1] + share[:, None] * step, axis=1).min())
