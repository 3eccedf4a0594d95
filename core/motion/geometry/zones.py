"""How far each zone reaches along the segments on either side of its waypoint.

A reach is a fraction of its segment, seen from the waypoint. It comes with its derivatives with
respect to what it was made from, so that the reverse pass need not decide again which rule of
the vendor was active.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from ...arrays import IntArray
from ...errors import MotionError, Note
from ...program.zone import ROOM, Angle, ContourFraction, Fine, Radius, VendorZone, Zone
from ...robot.joint import JointLimits
from ...robot.kinematics.chain import Chain
from ..model.motion_model import MotionModel
from ..model.rules import OrientationZone, Overlap, Pace, Space
from .corners import JOINT_CORNER, POSITION, TCP_CORNER, Corners, Room, TimedBlend
from .neighbour_zones import STILL, NeighbourWays
from .overlaps import Reaches, left_out, shrunk, taken
from .reach import Part, Reach, least
from .segments import ARC_SEGMENT, JOINT_SEGMENT, Segments, in_time
from .smaller_blends import acceleration_along, share_kept
from .timed_blends import timed_blend
from .zone_exits import Exit, first_exit, first_turn

_NOTHING = 1e-9
"""A reach below is no zone."""
_UNSEEN = 1e-7
"""m, or share of a line, below which a zone by speed is a stop: that of a crawling robot."""
_ENDS = "q0", "q1"


class ZonePlanner:
    """Applies a vendor's zone rules to the corners of a path.

    Args:
        segments: the M segments.
        chains: the chain of each segment.
        model: the vendor's rules.
        moves: index in the program of the move of each segment, for messages.
        limits: the robot's.
    """

    def __init__(
        self,
        segments: Segments,
        chains: Sequence[Chain],
        model: MotionModel,
        moves: Sequence[int],
        limits: JointLimits,
    ) -> None:
        self._segments = in_time(segments, model.duration.ramp)
        # Plain numbers: corners are looked at one by one, where an array costs more than they do.
        self._kinds: list[int] = segments.ends.kind.tolist()
        self._lengths: list[float] = segments.length.tolist()
        self._chains = chains
        self._model = model
        self._moves = moves
        self._limits = limits
        self._notes: list[Note] = []
        self._kept: dict[int, Reach] = {}
        self._wanted: tuple[Sequence[Zone], list[Reaches]] = (), []
        self._known_ways: dict[float, NeighbourWays] = {}
        half = model.overlap is Overlap.HALF
        self._furthest = Reach(model.neighbour_fraction if half else 1.0)
        """Share of the way to a neighbouring point beyond which no zone reaches."""

    def corners(self, zones: Sequence[Zone]) -> Corners:
        """The corners at the inner waypoints.

        Args:
            zones: M − 1 zones; `Fine` where the robot stops for whatever reason.

        Raises:
            MotionError: a kind of zone that cannot be emulated, naming the move.
        """
        self._notes, self._kept = [], {}
        wanted = [self._reaches(i, zone) for i, zone in enumerate(zones)]
        self._wanted = zones, wanted
        overlapping: tuple[int, ...] = ()
        if self._model.overlap is Overlap.SHRINK:
            wanted, factors = shrunk(wanted)
            for i, factor in factors.items():
                self._note(i, f"overlapping blend shrunk to {100 * factor:.4g} %")
        elif self._model.overlap is Overlap.SKIP:
            overlapping = tuple(left_out(wanted))
            self._check_left_out(overlapping)
        if self._model.tcp.kind == "arc" and self._model.pace is Pace.SUPERPOSED:
            wanted = [self._lessened(i, pairs) for i, pairs in enumerate(wanted)]
        values = [[(before.value, after.value) for before, after in pairs] for pairs in wanted]
        reach = np.array(values).reshape(-1, 3, 2)
        kind = np.zeros(len(zones), dtype=np.int64)
        for i in map(int, np.flatnonzero(reach[:, POSITION].min(axis=1) > _NOTHING)):
            kind[i] = self._kind(i)
        timed = self._timed(kind, wanted)
        return Corners(kind, reach, wanted, self._kept, overlapping, self._notes, timed)

    def _check_left_out(self, corners: Sequence[int]) -> None:
        for corner in corners:
            if ARC_SEGMENT in self._kinds[corner : corner + 2]:
                raise MotionError(
                    "its blend overlaps a neighbouring one next to an arc, which cannot be left "
                    "out; make the blend radius smaller",
                    self._moves[corner],
                )

    def _timed(self, kind: IntArray, wanted: Sequence[Reaches]) -> dict[int, TimedBlend]:
        """The corners of joint moves that the vendor blends in time."""
        if self._model.joint.kind != "quintic":
            return {}
        factor = self._model.blend_acceleration
        found = {
            i: timed_blend(self._segments, i, wanted[i][POSITION], factor)
            for i in map(int, np.flatnonzero(kind == JOINT_CORNER))
        }
        return {i: blend for i, blend in found.items() if blend is not None}

    def rooms(self, zones: Sequence[Zone]) -> list[Room]:
        """What room the vendor's rules on neighbouring zones leave.

        Where none is below zero no zone is cut, shrunk or left out, and radii do what they say.

        Args:
            zones: as in `corners`.
        """
        if self._model.overlap is Overlap.HALF:
            return [room for i, zone in enumerate(zones) for room in self._halves(i, zone)]
        known, wanted = self._wanted
        if known is not zones:
            wanted = [self._reaches(i, zone) for i, zone in enumerate(zones)]
        return [
            Room(Reach(1.0) + own * Reach(-1.0), min(k, len(wanted) - 1))
            for k in range(len(wanted) + 1)
            if (own := taken(k, wanted, len(self._chains))).value != 0.0
        ]

    def share_taken(self, segment: int, zones: Sequence[Zone]) -> float:
        """Share of a segment that the zones at its ends take together; above 1 they overlap.

        Args:
            segment: its index.
            zones: as in `corners`; only those two count.
        """
        ends = range(max(segment - 1, 0), min(segment + 1, len(zones)))
        wanted = {i: self._reaches(i, zones[i]) for i in ends}
        return taken(segment, wanted, len(self._chains)).value

    def widest(self, i: int, most: float) -> float | None:
        """Radius (m) up to which no rule on neighbouring points cuts the zone at a corner.

        Args:
            i: index of the corner.
            most: share of the way to a neighbour that it takes at most, whatever the rules.

        Returns:
            None where the TCP stands still on both sides, so that a radius says nothing.
        """
        neighbours = self._neighbours(min(most, self._furthest.value))
        ways = [neighbours.way(segment, i) for segment in (i, i + 1)]
        return min((way.value for way in ways if way is not None), default=None)

    def _neighbours(self, share: float) -> NeighbourWays:
        """What lies up to a share of the way to the neighbouring points."""
        if share not in self._known_ways:
            self._known_ways[share] = NeighbourWays(self._segments, self._chains, share)
        return self._known_ways[share]

    def _halves(self, i: int, zone: Zone) -> list[Room]:
        """Half way to each neighbour, less the radius (m)."""
        if not isinstance(zone, Radius) or self._stops(i):
            return []
        halves = [self._half(segment, i) for segment in (i, i + 1)]
        less = Reach(-zone.tcp, (("tcp", i, -1.0),))
        return [Room(half + less, i) for half in halves if half is not None]

    def _kind(self, i: int) -> int:
        joint = self._kinds[i : i + 2].count(JOINT_SEGMENT)
        same_chain = self._chains[i] is self._chains[i + 1]
        if same_chain and joint == 1 and self._model.mixed_space is Space.TCP:
            raise MotionError(
                "a corner between a joint move and a move of the TCP, blended in TCP space, is not "
                'emulated; set zone.mixed_space = "joint" in the motion model',
                self._moves[i],
            )
        return TCP_CORNER if same_chain and joint == 0 else JOINT_CORNER

    def _reaches(self, i: int, zone: Zone) -> Reaches:
        """Reaches of position, turning and prescribed axes before the rules on overlap."""
        if isinstance(zone, Fine) or self._stops(i):
            return ((Reach(0.0), Reach(0.0)),) * 3
        if isinstance(zone, VendorZone):
            return (self._by_kind(i, zone),) * 3
        if isinstance(zone, ContourFraction):
            return (self._by_contour(i, zone.fraction),) * 3
        if isinstance(zone, Angle):
            pair = (self._by_angle(i, zone.angle, i), self._by_angle(i + 1, zone.angle, i))
            return (pair,) * 3
        tcp = self._by_radius(i, zone, zone.tcp, "tcp")
        if self._model.orientation_zone is OrientationZone.TCP or self._kind(i) == JOINT_CORNER:
            return (tcp,) * 3
        turning = external = tcp
        if zone.reorientation > zone.tcp:
            turning = self._by_radius(i, zone, zone.reorientation, "reorientation")
        if zone.external > zone.tcp and self._segments.delta_prescribed.shape[1] > 0:
            external = self._by_radius(i, zone, zone.external, "external")
        return tcp, turning, external

    def _stops(self, i: int) -> bool:
        """Whether the vendor makes no zone between a TCP move and a pure reorientation."""
        if not self._model.stops_at_pure_reorientation:
            return False
        still = [length < STILL for length in self._lengths[i : i + 2]]
        if JOINT_SEGMENT in self._kinds[i : i + 2] or still.count(True) != 1:
            return False
        self._note(i, "no zone between a move of the TCP and a pure reorientation: it stops here")
        return True

    def _note(self, i: int, message: str) -> None:
        self._notes.append(Note(message, self._moves[i]))

    def _by_contour(self, i: int, fraction: float) -> tuple[Reach, Reach]:
        """Reaches of a share of half the line; between two joint moves as far on both sides as on
        the shorter line."""
        half = self._model.neighbour_fraction
        share = Reach(fraction * half, (("tcp", i, half),))
        lines = [self._joint_distance(segment) for segment in (i, i + 1)]
        if any(line.value < STILL for line in lines):
            return share, share
        size = share * least(*lines)
        return size * lines[0].inverse(), size * lines[1].inverse()

    def _joint_distance(self, segment: int) -> Reach:
        """|Δq| of a joint move; 0 of others."""
        if self._segments.ends.kind[segment] != JOINT_SEGMENT:
            return Reach(0.0)
        way = self._segments.ends.q[segment, 1] - self._segments.ends.q[segment, 0]
        size = float(np.linalg.norm(way))
        along = way / max(size, STILL)
        return Reach(size, (("q1", segment, along), ("q0", segment, -along)))

    def _by_angle(self, segment: int, angle: float, corner: int) -> Reach:
        """Reach of a zone given as an angle (rad) of the tool's turn."""
        limit = Reach(self._model.neighbour_fraction)
        turn = float(self._segments.turn[segment])
        if self._segments.ends.kind[segment] == JOINT_SEGMENT:
            return self._joint_exit(
                segment, corner, Reach(angle, (("angle", corner, 1.0),)), limit, first_turn
            )
        if turn <= angle * 1e-12 or turn == 0.0:
            return limit
        parts: tuple[Part, ...] = (
            ("angle", corner, 1.0 / turn),
            ("turn", segment, -angle / turn**2),
        )
        return least(Reach(angle / turn, parts), limit)

    def _by_radius(self, i: int, zone: Radius, radius: float, name: str) -> tuple[Reach, Reach]:
        """Reaches of a sphere of ``radius`` m round waypoint i, the same on both sides."""
        return self._within(
            i, Reach(radius, ((name, i, 1.0),)), zone.angle, name == "tcp" and zone != ROOM
        )

    def _within(
        self, i: int, wanted: Reach, angle: float, told: bool = False
    ) -> tuple[Reach, Reach]:
        """Reaches of a sphere of ``wanted`` m, or in pure reorientation of ``angle`` rad.

        ``told``: whether a cut is worth a note.
        """
        size = wanted
        if self._model.overlap is Overlap.HALF:
            for segment in (i, i + 1):
                half = self._half(segment, i)
                if half is not None and half.value < size.value * (1 - 1e-9):
                    size = half
            if told and size.value < wanted.value * (1 - 1e-9):
                self._note(
                    i,
                    f"zone of {1e3 * wanted.value:g} mm cut to {1e3 * size.value:.4g} mm: it may "
                    "reach no further than half way to a neighbouring point",
                )
        return self._exit(i, i, size, angle), self._exit(i + 1, i, size, angle)

    def _by_kind(self, i: int, zone: VendorZone) -> tuple[Reach, Reach]:
        """Reaches of a make's own kind of zone: as far behind the waypoint as before it, along
        joint moves as far as they come in the time that the braking takes."""
        size, law = Reach(zone.size, (("tcp", i, 1.0),)), zone.kind.reach
        joint = (self._segments.ends.kind[i : i + 2] == JOINT_SEGMENT).any()
        if law is None or not joint:
            way = size if law is None else law(size, *self._rates(i, i, zone))
            if way.value < _UNSEEN:
                return Reach(0.0), Reach(0.0)
            told = law is None
            before = self._within(i, way, 0.0, told)
            return before[0], self._within(i, way * zone.ratio, 0.0)[1]
        (v, a), (_, onwards) = (self._rates(k, i, zone) for k in (i, i + 1))
        way = law(size, v, a)
        if way.value < _UNSEEN:
            return Reach(0.0), Reach(0.0)
        return self._along(i, way), self._along(i + 1, way * onwards / a * zone.ratio)

    def _along(self, segment: int, way: Reach) -> Reach:
        """A way along a segment as a share of it: it is that already of a joint move."""
        length = float(self._segments.length[segment])
        if self._segments.ends.kind[segment] != JOINT_SEGMENT:
            if length < STILL:
                return Reach(0.0)
            way = way / Reach(length, (("length", segment, 1.0),))
        return least(way, self._furthest)

    def _rates(self, segment: int, corner: int, zone: VendorZone) -> tuple[Reach, Reach]:
        """Speed and acceleration of a segment: m/s and m/s², in shares of the line of a joint
        move.

        Raises:
            MotionError: one of them is not bounded.
        """
        ends, word = self._segments.ends, zone.kind.word
        if ends.kind[segment] == JOINT_SEGMENT:
            return self._joint_rates(segment)
        speed = float(ends.speed[segment])
        if math.isinf(speed):
            raise MotionError(
                f"a zone by speed ({word}) needs a move of the TCP with a programmed speed; use a "
                "distance",
                self._moves[corner],
            )
        a = acceleration_along(self._segments, segment, self._model.tcp_acceleration)
        if math.isinf(a.value):
            raise MotionError(
                f"a zone by speed ({word}) needs an acceleration to brake with: program one, or "
                "set limit.tcp_acceleration in the motion model",
                self._moves[corner],
            )
        return Reach(speed, (("speed", segment, 1.0),)), a

    def _joint_rates(self, k: int) -> tuple[Reach, Reach]:
        """Of the joints that need longest for the line of a joint move."""
        ends, limits = self._segments.ends, self._limits
        step = self._segments.delta_q[k]
        moving = np.abs(step) > STILL
        if not moving.any():
            return Reach(0.0), Reach(1.0)
        scales = [self._model.acceleration_scale(j) for j in range(len(step))]
        shares = "joint_fraction", "joint_acceleration_fraction"
        own = limits.velocity, limits.acceleration * scales * ends.override[k]
        programmed = "joint_speed", "joint_acceleration"
        found = []
        for share, most, stated in zip(shares, own, programmed, strict=True):
            fraction, top = float(getattr(ends, share)[k]), float(getattr(ends, stated)[k])
            allowed = np.minimum(fraction * most, top)
            j = int(np.argmin(np.where(moving, allowed / np.maximum(np.abs(step), STILL), np.inf)))
            axis = np.zeros(len(step))
            axis[j] = math.copysign(1.0, step[j])
            way = Reach(abs(float(step[j])), (("q1", k, axis), ("q0", k, -axis)))
            by_share = fraction * float(most[j]) <= top
            limit = Reach(
                float(allowed[j]), ((share, k, float(most[j])) if by_share else (stated, k, 1.0),)
            )
            found.append(limit / way)
        return found[0], found[1]

    def _half(self, segment: int, corner: int) -> Reach | None:
        return self._neighbours(self._model.neighbour_fraction).way(segment, corner)

    def _exit(self, segment: int, corner: int, size: Reach, angle: float) -> Reach:
        """Share of a segment inside the sphere round the waypoint of ``corner``."""
        kind, length, limit = self._kinds[segment], self._lengths[segment], self._furthest
        if kind == JOINT_SEGMENT:
            return self._joint_exit(segment, corner, size, limit)
        if length < STILL:
            return self._by_angle(segment, angle, corner)
        if kind != ARC_SEGMENT:
            share = size.value / length
            if share > limit.value:
                return limit
            along = [(n, k, p / length) for n, k, p in size.parts]
            return Reach(share, (*along, ("length", segment, -share / length)))
        swept = float(self._segments.angle[segment])
        r = length / swept
        if size.value >= 2 * r:
            return limit
        half = math.asin(0.5 * size.value / r)
        slope = 1.0 / (swept * r * math.cos(half))
        parts: list[Part] = [(n, k, p * slope) for n, k, p in size.parts]
        parts.append(("length", segment, -slope * size.value / length))
        parts.append(("arc", segment, slope * size.value / swept - 2 * half / swept**2))
        return least(Reach(2 * half / swept, tuple(parts)), limit)

    def _joint_exit(
        self,
        segment: int,
        corner: int,
        size: Reach,
        limit: Reach,
        exits: Callable[..., Exit] = first_exit,
    ) -> Reach:
        """First exit from a zone on a joint line.

        Args:
            segment, corner: the line, and the corner of the zone.
            size: of the zone.
            limit: share of the line that it reaches at most.
            exits: finds it, by the TCP's distance or the tool's turn, of which the size is.
        """
        near, far = (1, 0) if segment == corner else (0, 1)
        q = self._segments.ends.q[segment]
        share, by_near, by_far, speed = exits(
            self._chains[segment], q[near], q[far], size.value, limit.value
        )
        if share < 0.0:
            return limit
        if speed <= 0.0:
            return Reach(share)
        parts: list[Part] = [(n, k, g / speed) for n, k, g in size.parts]
        parts.append((_ENDS[near], segment, by_near))
        parts.append((_ENDS[far], segment, by_far))
        return Reach(share, tuple(parts))

    def _lessened(self, i: int, pairs: Reaches) -> Reaches:
        """A zone made smaller where legs arrive at another speed than its arc's; see
        `smaller_blends`."""
        model, s = self._model, self._segments
        if model.centripetal is None or pairs[POSITION][0].value <= _NOTHING:
            return pairs
        if self._kind(i) != TCP_CORNER:
            return pairs
        found = share_kept(s, i, pairs[POSITION][0], model.tcp_acceleration, model.centripetal)
        if found is None:
            return pairs
        kept, why = found
        self._kept[i] = kept
        radius = 1e3 * pairs[POSITION][0].value * s.length[i]
        self._note(
            i,
            f"blend of {radius:.4g} mm made {kept.value * radius:.4g} mm: {why}",
        )
        return tuple((before * kept, after * kept) for before, after in pairs)
