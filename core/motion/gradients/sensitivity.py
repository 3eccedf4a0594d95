"""Places on a path that keep their meaning while its waypoints and zones change, and how the
configurations there change: forward derivatives of all of them at once.

A place is a share of the straight part of a segment, or of the stretch inside a zone. On paths of
joint moves alone q is linear in the waypoints and in how far the zones reach,

    straight part   q = q₀ + (ρ_out + λ (1 − ρ_out − ρ_in)) Δq
    zone            q = q_wp − ρ_in Δq₀ (1 − f(s)) + ρ_out Δq₁ g(s)     (see `blend`;
                    f and g are each corner's own where it is blended in time)

so that the derivatives follow from those of ρ, which `zones.Reach` brings along. On other paths
places are found between the path's samples, and change as `path_tangents` says.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean
from ..geometry.corners import POSITION, STOP
from ..geometry.joint_curves import quintics
from ..geometry.reach import Reach
from ..model.blend import HERMITE
from ..path.path import Path
from .path_tangents import PathTangents
from .segment_tangents import Directions, ReachTangents

_GRID, _ZOOMS = 41, 3
"""Shares that are looked at, and how often more closely."""


@dataclass(frozen=True)
class PathPlaces:
    """L places on a path of M segments.

    Args:
        part: (L,), k for the straight part of segment k, M + i for the zone at inner waypoint i.
        share: (L,), from 0 at the part's beginning to 1 at its end.
    """

    part: IntArray
    share: FloatArray

    def with_more(self, others: PathPlaces) -> PathPlaces:
        """These, then others."""
        return PathPlaces(
            np.concatenate([self.part, others.part]), np.concatenate([self.share, others.share])
        )


def sigma_of(path: Path, places: PathPlaces) -> FloatArray:
    """(L,), σ of the places."""
    begin, end = _parts(path.layout.waypoint, path.layout.extent[:, POSITION])
    return _between(begin, np.maximum(begin, end), places)


def _between(begin: FloatArray, end: FloatArray, places: PathPlaces) -> FloatArray:
    """Values at the places between those at beginning and end of all parts."""
    share = places.share.reshape(-1, *[1] * (begin.ndim - 1))
    return np.asarray(begin[places.part] + share * (end - begin)[places.part])


def place_near(path: Path, sigma: float, q: FloatArray) -> PathPlaces:
    """The place on a path nearest to a configuration (N,), in the part that σ lies in."""
    begin, end = _parts(path.layout.waypoint, path.layout.extent[:, POSITION])
    inside = (begin <= sigma) & (sigma <= end)
    part = int(np.argmax(inside)) if inside.any() else int(np.argmin(np.abs(begin - sigma)))
    lower, upper = 0.0, 1.0
    for _ in range(_ZOOMS):
        shares = np.linspace(lower, upper, _GRID)
        places = PathPlaces(np.full(_GRID, part), shares)
        k = int(np.argmin(np.linalg.norm(configurations(path, places) - q, axis=1)))
        lower, upper = shares[max(k - 1, 0)], shares[min(k + 1, _GRID - 1)]
    return PathPlaces(np.array([part]), shares[k : k + 1])


def configurations(path: Path, places: PathPlaces) -> FloatArray:
    """(L, N), the configurations at the places."""
    if not path.segments.joint_moves_alone:
        return _between_samples(path, sigma_of(path, places))
    if path.model.joint.kind != "quintic":
        q = np.empty((len(places.part), path.q.shape[1]))
        corners, law = path.corners, path.model.joint.coefficients
        given = path.segments.ends.q, corners.kind, corners.reach, law
        _configurations(*given, places.part, places.share, q)
        return q
    base, entering, leaving = _weights(path, places)
    waypoints = _waypoints(path)
    before, after = _neighbours(path, places)
    reach = _reach(path, places)
    steps = np.diff(waypoints, axis=0)
    q = waypoints[base]
    q = q + (reach[:, 0] * entering)[:, None] * steps[before]
    return np.asarray(q + (reach[:, 1] * leaving)[:, None] * steps[after])


@lean
def _configurations(
    ends: FloatArray,
    kind: IntArray,
    reach: FloatArray,
    law: FloatArray,
    part: IntArray,
    share: FloatArray,
    q: FloatArray,
) -> None:
    """`configurations` where corners are polynomials; see `_weights`."""
    count = ends.shape[0]
    for k in range(part.size):
        zone, s = part[k] >= count, share[k]
        corner = part[k] - count if zone else part[k]
        arriving = leaving = 0.0
        if zone:
            f = g = 0.0
            for i in range(law.shape[1] - 1, -1, -1):
                f, g = f * s + law[1, i], g * s + law[2, i]
            if kind[corner] != STOP:
                arriving = reach[corner, POSITION, 0] * (f - 1.0)
                leaving = reach[corner, POSITION, 1] * g
            for j in range(q.shape[1]):
                before, at, after = ends[corner, 0, j], ends[corner, 1, j], ends[corner + 1, 1, j]
                q[k, j] = at + arriving * (at - before) + leaving * (after - at)
            continue
        if corner < count - 1 and kind[corner] != STOP:
            arriving = reach[corner, POSITION, 0]
        if corner > 0 and kind[corner - 1] != STOP:
            leaving = reach[corner - 1, POSITION, 1]
        along = leaving + (1.0 - arriving - leaving) * s
        for j in range(q.shape[1]):
            q[k, j] = ends[corner, 0, j] + along * (ends[corner, 1, j] - ends[corner, 0, j])


class Sensitivity:
    """Forward derivatives of a path along K directions.

    Args:
        path: the path.
        directions: of the change.
    """

    def __init__(self, path: Path, directions: Directions) -> None:
        self._path, self._directions = path, directions
        joints_alone = path.segments.joint_moves_alone
        self._whole = None if joints_alone else PathTangents(path, directions)
        self._reaches = ReachTangents(directions) if self._whole is None else self._whole.reaches

    def reach(self, reach: Reach) -> FloatArray:
        """(K,), how a reach, or the room between zones, changes."""
        return self._reaches.of(reach)

    def configurations(self, places: PathPlaces, q: FloatArray) -> FloatArray:
        """(L, N, K), how the configurations q (L, N) at the places change."""
        if self._whole is None:
            return _tangents(self._path, places, self._directions, self._reaches)
        layout = self._whole.layout
        begin, end = _parts(layout.waypoint, layout.extent[:, POSITION])
        sigma = sigma_of(self._path, places)
        return self._whole.configurations(sigma, q, _between(begin, end, places))


def _tangents(
    path: Path, places: PathPlaces, directions: Directions, reaches: ReachTangents
) -> FloatArray:
    """(L, N, K) on paths of joint moves alone."""
    base, entering, leaving = _weights(path, places)
    entering_dot, leaving_dot = _weight_dots(path, places, directions.count, reaches)
    steps = np.diff(_waypoints(path), axis=0)
    steps_dot = np.diff(directions.waypoints, axis=0)
    before, after = _neighbours(path, places)
    reach = _reach(path, places)
    reach_dot = _combined(path, places, reaches.of_corners(path.corners)[:, POSITION], 0.0)
    out = directions.waypoints[base].copy()
    for side, weight, weight_dot, segment in (
        (0, entering, entering_dot, before),
        (1, leaving, leaving_dot, after),
    ):
        moved = reach[:, side, None] * steps[segment]
        out += moved[:, :, None] * weight_dot[:, None, :]
        out += (reach[:, side] * weight)[:, None, None] * steps_dot[segment]
        out += (weight[:, None] * steps[segment])[:, :, None] * reach_dot[:, side][:, None, :]
    return np.asarray(out)


def _waypoints(path: Path) -> FloatArray:
    q = path.segments.ends.q
    return np.concatenate([q[:1, 0], q[:, 1]])


def _parts(waypoint: FloatArray, extent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """σ at beginning and end of all parts (2 M − 1, ...), from that of the waypoints (M + 1, ...)
    and the extents of the zones (M − 1, 2, ...); or how they change."""
    none = np.zeros((1, *extent.shape[2:]))
    before, after = np.concatenate([extent[:, 0], none]), np.concatenate([none, extent[:, 1]])
    begin = np.concatenate([waypoint[:-1] + after, waypoint[1:-1] - extent[:, 0]])
    end = np.concatenate([waypoint[1:] - before, waypoint[1:-1] + extent[:, 1]])
    return begin, end


def _neighbours(path: Path, places: PathPlaces) -> tuple[IntArray, IntArray]:
    """The segments before and after each place; twice its own for a straight part."""
    count = len(path.segments.scale)
    zone = places.part >= count
    corner = places.part - count
    return np.where(zone, corner, places.part), np.where(zone, corner + 1, places.part)


def _weights(path: Path, places: PathPlaces) -> tuple[IntArray, FloatArray, FloatArray]:
    """q = waypoint[base] + ρ₀ w₀ Δq_before + ρ₁ w₁ Δq_after, and so for straight parts too.

    There ρ₀ = 1 − ρ_out − ρ_in counts with λ, and ρ₁ = ρ_out with 1; see `_reach`.
    """
    count = len(path.segments.scale)
    zone = places.part >= count
    timed = path.model.joint.kind == "quintic"
    basis = HERMITE if timed else path.model.joint.coefficients
    values = places.share[:, None] ** np.arange(basis.shape[1]) @ basis.T
    f, g = values[:, 1], values[:, 2]
    if timed:
        shape = _quintics(path, places)
        f, g = (
            np.sum(values[:, 1:] * (shape[:, :, leg] + shape[:, :, 2]), axis=1) for leg in (0, 1)
        )
    base = np.where(zone, places.part - count + 1, places.part)
    return base, np.where(zone, f - 1.0, places.share), np.where(zone, g, 1.0)


def _quintics(path: Path, places: PathPlaces) -> FloatArray:
    """(L, 5, 3), see `quintics`; of places in zones alone."""
    corner = places.part - len(path.segments.scale)
    return quintics(path.corners)[np.where(corner >= 0, corner, 0)]


def _weight_dots(
    path: Path, places: PathPlaces, count: int, reaches: ReachTangents
) -> tuple[FloatArray, FloatArray]:
    """(L, K) each, derivatives of f and g in corners that are blended in time; else zero."""
    dots = np.zeros((2, len(places.part), count))
    for i, blend in path.corners.timed.items():
        rows = np.flatnonzero(places.part == len(path.segments.scale) + i)
        powers = places.share[rows, None] ** np.arange(HERMITE.shape[1])
        for leg in range(2):
            for basis, reach in ((1 + leg, blend.rates[leg]), (4 + leg, blend.bends[leg])):
                dots[leg, rows] += np.outer(powers @ HERMITE[basis], reaches.of(reach))
    return dots[0], dots[1]


def _reach(path: Path, places: PathPlaces) -> FloatArray:
    """(L, 2), ρ₀ and ρ₁ of `_weights`."""
    return _combined(path, places, _live(path))


def _live(path: Path) -> FloatArray:
    """(M − 1, 2), how far each zone reaches; 0 at stops."""
    corners = path.corners
    return np.where((corners.kind == STOP)[:, None], 0.0, corners.reach[:, POSITION])


def _combined(path: Path, places: PathPlaces, reach: FloatArray, whole: float = 1.0) -> FloatArray:
    """ρ₀ and ρ₁ from the zones' reaches, (M − 1, 2, ...) → (L, 2, ...)."""
    count = len(path.segments.scale)
    zone = places.part >= count
    none = np.zeros((1, *reach.shape[2:]))
    arriving = np.concatenate([reach[:, 0], none])
    leaving = np.concatenate([none, reach[:, 1]])
    straight = whole - arriving - leaving
    segment = np.where(zone, 0, places.part)
    out = np.stack([straight[segment], leaving[segment]], 1)
    corner = (places.part - count)[zone]
    out[zone] = reach[corner]
    return out


def _between_samples(path: Path, sigma: FloatArray) -> FloatArray:
    """Configurations (L, N) at σ (L,): the quintics that meet values and two derivatives."""
    at = np.clip(np.searchsorted(path.sigma, sigma, side="right") - 1, 0, len(path.sigma) - 2)
    length = path.sigma[at + 1] - path.sigma[at]
    z = (sigma - path.sigma[at]) / np.where(length > 0, length, 1.0)
    z = np.clip(z, 0.0, 1.0)[:, None]
    L = length[:, None]
    q0, dq0, ddq0 = (array[at] for array in path.states[:3])
    q1, dq1, ddq1 = (array[at + 1] for array in path.states[:3])
    z3, z4, z5 = z**3, z**4, z**5
    return np.asarray(
        q0 * (1 - 10 * z3 + 15 * z4 - 6 * z5)
        + L * dq0 * (z - 6 * z3 + 8 * z4 - 3 * z5)
        + L**2 * ddq0 * (0.5 * z**2 - 1.5 * z3 + 1.5 * z4 - 0.5 * z5)
        + q1 * (10 * z3 - 15 * z4 + 6 * z5)
        + L * dq1 * (-4 * z3 + 7 * z4 - 3 * z5)
        + L**2 * ddq1 * (0.5 * z3 - z4 + 0.5 * z5)
    )
