"""How far a controller cuts each corner, and the zones with which another cuts as far.

A corner's cut is the distance in m from the waypoint to the emulated path of the TCP. For two
straight legs that deflect by δ and a zone of radius r it is k r sin(δ/2), with k = 1/2 + 2 β(1/2)
for a polynomial blend and 1/(2 cos²(δ/4)) for a tangent arc; the emulator knows it everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..dialect import Dialect
from ..motion.geometry.corners import POSITION, STOP, TURNING
from ..motion.geometry.segments import JOINT_SEGMENT
from ..motion.model.rules import Overlap
from ..motion.path.path import OverlapError, Path, Route
from ..program.program import Program
from ..program.zone import FINE, Angle, ContourFraction, Radius, VendorZone, Zone, ZoneKind
from ..robot.kinematics.chain_kernels import poses
from .emulation import Party

_ROUNDS = 12
_MET = 2e-4
"""Share of a cut by which it may miss what is wanted before another round is made."""
_STRAIGHT = 2e-6
"""m of cut below which a corner is straight, and its zone without effect on the path."""
_STILL = 1e-6
"""m: a reach below is no distance of the TCP; the tool merely turns."""
_KEPT = 1 - 1e-4
"""Share of what fits that a zone is given, so that it does not touch its neighbour."""
_SMALLER = 0.99
"""Factor by which zones are made smaller that touch for all that."""
_TRIES = 100
_DIGITS = 7
"""Decimals of m to which radii are rounded."""
_NOMINAL = 1e-3
"""m of a sphere that only its angle is used of."""


@dataclass(frozen=True, slots=True)
class EmulatedCorner:
    """What a controller makes of the zone between two moves.

    Args:
        passed: whether the robot passes without stopping.
        cut: m from the waypoint to the path.
        reach: m of the TCP from the waypoint to the nearer edge of the zone.
        turn: rad of the tool's turn inside the zone before the waypoint.
    """

    passed: bool
    cut: float
    reach: float
    turn: float
    zone: Zone


def corners_of(path: Path) -> list[EmulatedCorner]:
    """The M − 1 corners of a path."""
    return [_corner(path, i) for i in range(len(path.route.zones))]


def _corner(path: Path, i: int) -> EmulatedCorner:
    zone = path.route.zones[i]
    if path.corners.kind[i] == STOP:
        return EmulatedCorner(False, 0.0, 0.0, 0.0, zone)
    distance = _distances(path, i)
    turn = float(path.segments.turn[i]) * path.corners.reach[i, TURNING, 0]
    edges = float(min(distance[0], distance[-1]))
    return EmulatedCorner(True, _least(path, i, distance), edges, turn, zone)


def _rows(path: Path, i: int) -> NDArray[np.int64]:
    """Samples inside a zone, one at each σ."""
    at = path.layout.waypoint[i + 1]
    before, after = path.layout.extent[i, POSITION]
    slack = 1e-9 * (1.0 + at)
    first = int(np.searchsorted(path.sigma, at - before - slack))
    last = int(np.searchsorted(path.sigma, at + after + slack, "right"))
    sigma, index = np.unique(path.sigma[first:last], return_index=True)
    # Two samples at one edge differ by rounding only.
    keep = np.concatenate([[True], np.diff(sigma) > slack])
    return np.asarray(first + index[keep])


def _distances(path: Path, i: int) -> FloatArray:
    """m from the waypoint to the TCP at the samples inside a zone."""
    chain = path.route.chains[i]
    rows = np.concatenate([path.route.ends.q[i, 1][None], path.q[_rows(path, i)]])
    _, position = poses(chain, np.ascontiguousarray(rows))
    return np.asarray(np.linalg.norm(position[1:] - position[0], axis=1))


def _least(path: Path, i: int, distance: FloatArray) -> float:
    """The least distance, by a parabola through the least sample and its neighbours."""
    k = int(np.argmin(distance))
    if not 0 < k < len(distance) - 1:
        return float(distance[k])
    sigma = path.sigma[_rows(path, i)][k - 1 : k + 2]
    square = distance[k - 1 : k + 2] ** 2
    (a, b), (before, after) = np.diff(sigma), np.diff(square)
    bend = (after / b - before / a) / (a + b)
    if bend <= 0.0:
        return float(distance[k])
    slope = (after / b * a + before / a * b) / (a + b)
    return float(np.sqrt(max(square[1] - 0.25 * slope**2 / bend, 0.0)))


def fit_zones(
    party: Party,
    dialect: Dialect | None,
    program: Program,
    route: Route,
    wanted: Sequence[EmulatedCorner],
) -> Path:
    """The path through zones with which a controller cuts corners as far as wanted.

    Each zone's size is scaled by the ratio of the cuts until they agree: cuts are nearly
    proportional to sizes. Zones that reach as far as the controller lets them stay there.

    Args:
        program, route: what it drives; the route's zones are replaced.
        wanted: one for each corner of the route.

    Raises:
        MotionError: a corner that the arm cannot follow.
    """
    zones = [_first_guess(dialect, program, route, i, corner) for i, corner in enumerate(wanted)]
    # Blends that overlap would change the route; while sizes are sought they shrink instead.
    model = replace(party.model, overlap=Overlap.SHRINK)
    if party.model.overlap is Overlap.HALF:
        model = party.model
    for _ in range(_ROUNDS):
        found = corners_of(party.path(_with_zones(route, zones), program, model))
        better = [_better(z, w, f) for z, w, f in zip(zones, wanted, found, strict=True)]
        settled = better == zones
        zones = better
        if settled:
            break
    zones = [_within(zone, corner) for zone, corner in zip(zones, found, strict=True)]
    return _apart(party, program, route, zones)


def _with_zones(route: Route, zones: Sequence[Zone]) -> Route:
    return replace(route, zones=tuple(zones))


def _first_guess(
    dialect: Dialect | None, program: Program, route: Route, i: int, corner: EmulatedCorner
) -> Zone:
    """A zone of the preferred kind, as large as the other controller's."""
    if not corner.passed:
        return FINE
    if dialect is None:
        return corner.zone
    joint = bool((route.ends.kind[i : i + 2] == JOINT_SEGMENT).any())
    # The zone belongs to the move that ends at the waypoint.
    kinds = dialect.words(program.moves[route.moves[i]]).zones
    if corner.reach < _STILL and not joint:
        return _turning_zone(dialect, kinds, corner)
    for kind in kinds:
        if isinstance(kind, ZoneKind):
            same = isinstance(corner.zone, VendorZone) and corner.zone.kind == kind
            distance = kind.reach is None and corner.reach >= _STILL
            guess = corner.reach if distance else 0.5 * kind.largest
            return corner.zone if same else kind.sized(guess)
        if kind is Radius:
            return _radius(dialect, corner)
        if kind is ContourFraction and joint:
            return ContourFraction(0.5)
        if kind is Angle and not joint and corner.turn > 0:
            return Angle(corner.turn)
    return FINE


def _turning_zone(
    dialect: Dialect, kinds: Sequence[type[Zone] | ZoneKind], corner: EmulatedCorner
) -> Zone:
    """For corners at which the TCP stays and the tool turns on."""
    if dialect.zone_parts and Radius in kinds:
        return Radius(_NOMINAL, _NOMINAL, _NOMINAL, angle=corner.turn)
    return Angle(corner.turn) if Angle in kinds else FINE


def _radius(dialect: Dialect, corner: EmulatedCorner) -> Radius:
    """A sphere, with the parts beside the TCP's if the language has them."""
    zone, tcp = corner.zone, corner.reach
    if not dialect.zone_parts:
        return Radius(tcp)
    if isinstance(zone, Radius):
        return _resized(replace(zone, name=None), tcp)
    return Radius(tcp, tcp, tcp, angle=zone.angle if isinstance(zone, Angle) else 0.0)


def _size(zone: Zone) -> float:
    if isinstance(zone, Radius):
        return zone.tcp
    if isinstance(zone, VendorZone):
        return zone.size
    return zone.angle if isinstance(zone, Angle) else getattr(zone, "fraction", 0.0)


def _is_distance(zone: Zone) -> bool:
    """Whether its size is how far before the waypoint it begins, m."""
    return isinstance(zone, Radius) or (isinstance(zone, VendorZone) and zone.kind.reach is None)


Sized = TypeVar("Sized", bound=Zone)


def _resized(zone: Sized, size: float) -> Sized:
    """The zone with another size; a sphere's further parts keep their ratio to the TCP's."""
    if isinstance(zone, Radius):
        scale = size / zone.tcp if zone.tcp > 0 else 1.0
        parts = zone.reorientation * scale, zone.external * scale
        return replace(zone, tcp=size, reorientation=parts[0], external=parts[1])
    if isinstance(zone, ContourFraction):
        return replace(zone, fraction=min(1.0, size))
    if isinstance(zone, Angle):
        return replace(zone, angle=min(size, math.pi))
    if isinstance(zone, VendorZone):
        return replace(zone, size=min(size, zone.kind.largest))
    return zone


def _better(zone: Zone, wanted: EmulatedCorner, found: EmulatedCorner) -> Zone:
    """The zone scaled so that the cut becomes what is wanted."""
    size = _size(zone)
    if not (wanted.passed and found.passed) or size == 0.0:
        return zone
    if wanted.cut < _STRAIGHT:
        return _as_far(zone, wanted, found)
    if found.cut < _STRAIGHT:
        return zone
    ratio = wanted.cut / found.cut
    if abs(ratio - 1.0) < _MET:
        return zone
    if _is_distance(zone) and found.reach < size * _KEPT:
        # Larger has no effect: begin again from what is in effect.
        return zone if ratio > 1.0 else _resized(zone, found.reach * ratio)
    return _resized(zone, size * ratio)


def _as_far(zone: Zone, wanted: EmulatedCorner, found: EmulatedCorner) -> Zone:
    """The zone of a straight corner: it keeps its reach, which of kinds by speed is not their size,
    but grows about as its square."""
    by_speed = isinstance(zone, VendorZone) and zone.kind.reach is not None
    if not by_speed or min(wanted.reach, found.reach) < _STILL:
        return zone
    ratio = math.sqrt(wanted.reach / found.reach)
    return zone if abs(ratio - 1.0) < _MET else _resized(zone, _size(zone) * ratio)


def _within(zone: Zone, found: EmulatedCorner) -> Zone:
    """The zone, no larger than the controller lets it be."""
    if _is_distance(zone) and found.passed and _STILL < found.reach < _size(zone) * _KEPT:
        zone = _resized(zone, found.reach * _KEPT)
    return _rounded(zone)


def _rounded(zone: Zone) -> Zone:
    if isinstance(zone, VendorZone):
        size = zone.kind.rounded(zone.size)
        return replace(zone, size=size) if size > 0.0 else FINE
    if not isinstance(zone, Radius):
        return zone
    parts = [round(value, _DIGITS) for value in (zone.tcp, zone.reorientation, zone.external)]
    if parts[0] == 0.0:
        return zone
    return replace(zone, tcp=parts[0], reorientation=parts[1], external=parts[2])


def _apart(party: Party, program: Program, route: Route, zones: list[Zone]) -> Path:
    """Through zones made smaller where the controller would leave a waypoint out for them."""
    touching: tuple[int, ...] = ()
    for _ in range(_TRIES):
        try:
            return party.path(_with_zones(route, zones), program)
        except OverlapError as overlap:
            touching = overlap.corners
        for i in touching:
            for k in range(max(0, i - 1), min(len(zones), i + 2)):
                zones[k] = _resized(zones[k], _size(zones[k]) * _SMALLER)
    for i in touching:
        zones[i] = FINE
    return party.path(_with_zones(route, zones), program)
