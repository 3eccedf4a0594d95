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
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import inner, lean
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
    q = np.empty((len(places.part), path.q.shape[1]))
    given = path.segments.ends.q, _zones_of(path)
    _configurations(*given, places.part, places.share, q)
    return q


class _Zones(NamedTuple):
    """What zones make of the way past their waypoints.

    Args:
        kind: (M − 1,), of the corners.
        reach: (M − 1, 3, 2), of them.
        laws: (M − 1, 2, C), f and g of `blend` by rising powers of the share.
    """

    kind: IntArray
    reach: FloatArray
    laws: FloatArray


def _zones_of(path: Path) -> _Zones:
    corners, blend = path.corners, path.model.joint
    timed = blend.kind == "quintic"
    basis = HERMITE if timed else blend.coefficients
    laws = np.empty((len(corners.kind), 2, basis.shape[1]))
    laws[:] = basis[1:3]
    if timed:
        shape = quintics(corners)
        for leg in range(2):
            laws[:, leg] = (shape[:, :, leg] + shape[:, :, 2]) @ basis[1:]
    return _Zones(corners.kind, corners.reach, laws)


@inner
def _law(laws: FloatArray, s: float) -> tuple[float, float]:
    """f and g at a share s of a zone."""
    f = g = 0.0
    for i in range(laws.shape[1] - 1, -1, -1):
        f, g = f * s + laws[0, i], g * s + laws[1, i]
    return f, g


@inner
def _weights(zones: _Zones, part: int, s: float) -> tuple[int, float, float]:
    """A place as waypoint k + w₀ Δq before it + w₁ Δq after it: k, w₀ and w₁."""
    kind, reach, laws = zones
    i, count = part - kind.size - 1, kind.size + 1
    if i >= 0:
        if kind[i] == STOP:
            return i + 1, 0.0, 0.0
        f, g = _law(laws[i], s)
        return i + 1, reach[i, POSITION, 0] * (f - 1.0), reach[i, POSITION, 1] * g
    arriving = leaving = 0.0
    if part < count - 1 and kind[part] != STOP:
        arriving = reach[part, POSITION, 0]
    if part > 0 and kind[part - 1] != STOP:
        leaving = reach[part - 1, POSITION, 1]
    return part, 0.0, leaving + (1.0 - arriving - leaving) * s


@inner
def _weights_dot(
    zones: _Zones, part: int, s: float, reach_dot: FloatArray, laws_dot: FloatArray, d: int
) -> tuple[float, float]:
    """How w₀ and w₁ change along a direction; see `_push`."""
    kind, reach, laws = zones
    i, count = part - kind.size - 1, kind.size + 1
    if i >= 0:
        if kind[i] == STOP:
            return 0.0, 0.0
        f, g = _law(laws[i], s)
        before, after = reach_dot[i, 0, d] * (f - 1.0), reach_dot[i, 1, d] * g
        if laws_dot.shape[0] > 0:
            f, g = _law(laws_dot[i, :, :, d], s)
            before += reach[i, POSITION, 0] * f
            after += reach[i, POSITION, 1] * g
        return before, after
    # The reaches of stops do not change.
    along = 0.0
    if part < count - 1:
        along -= s * reach_dot[part, 0, d]
    if part > 0:
        along += (1.0 - s) * reach_dot[part - 1, 1, d]
    return 0.0, along


@lean
def _configurations(
    ends: FloatArray, zones: _Zones, part: IntArray, share: FloatArray, q: FloatArray
) -> None:
    """`configurations` on joint moves alone."""
    for k in range(part.size):
        at, before, after = _weights(zones, part[k], share[k])
        for j in range(q.shape[1]):
            q[k, j] = ends[at, 0, j]
            if before != 0.0:
                q[k, j] += before * (ends[at, 0, j] - ends[at - 1, 0, j])
            if after != 0.0:
                q[k, j] += after * (ends[at, 1, j] - ends[at, 0, j])


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
    zones, ends, corners = _zones_of(path), path.segments.ends.q, path.corners
    laws_dot = np.zeros(
        (len(corners.timed) and len(corners.kind), *zones.laws.shape[1:], directions.count)
    )
    for i, blend in corners.timed.items():
        for leg, (rate, bend) in enumerate(zip(blend.rates, blend.bends, strict=True)):
            laws_dot[i, leg] += np.outer(HERMITE[1 + leg], reaches.of(rate))
            laws_dot[i, leg] += np.outer(HERMITE[4 + leg], reaches.of(bend))
    dots = directions.waypoints, reaches.of_corners(corners)[:, POSITION], laws_dot
    out = np.empty((len(places.part), *directions.waypoints.shape[1:]))
    _push(ends, zones, places.part, places.share, dots, out)
    return out


@lean
def _push(
    ends: FloatArray,
    zones: _Zones,
    part: IntArray,
    share: FloatArray,
    dots: tuple[FloatArray, FloatArray, FloatArray],
    out: FloatArray,
) -> None:
    """Forward of `_configurations`; ``dots``: how waypoints (M + 1, N, K), reaches (M − 1, 2, K)
    and laws (M − 1, 2, C, K; none where they do not) change."""
    waypoint, reach_dot, laws_dot = dots
    for k in range(part.size):
        at, before, after = _weights(zones, part[k], share[k])
        for d in range(out.shape[2]):
            given = zones, part[k], share[k], reach_dot, laws_dot, d
            before_dot, after_dot = _weights_dot(*given)
            for j in range(out.shape[1]):
                moved = waypoint[at, j, d]
                if at > 0 and part[k] > ends.shape[0] - 1:
                    moved += before * (waypoint[at, j, d] - waypoint[at - 1, j, d])
                    moved += before_dot * (ends[at, 0, j] - ends[at - 1, 0, j])
                moved += after * (waypoint[at + 1, j, d] - waypoint[at, j, d])
                moved += after_dot * (ends[at, 1, j] - ends[at, 0, j])
                out[k, j, d] = moved


def _parts(waypoint: FloatArray, extent: FloatArray) -> tuple[FloatArray, FloatArray]:
    """σ at beginning and end of all parts (2 M − 1, ...), from that of the waypoints (M + 1, ...)
    and the extents of the zones (M − 1, 2, ...); or how they change."""
    none = np.zeros((1, *extent.shape[2:]))
    before, after = np.concatenate([extent[:, 0], none]), np.concatenate([none, extent[:, 1]])
    begin = np.concatenate([waypoint[:-1] + after, waypoint[1:-1] - extent[:, 0]])
    end = np.concatenate([waypoint[1:] - before, waypoint[1:-1] + extent[:, 1]])
    return begin, end


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
