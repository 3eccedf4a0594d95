"""The runs that an experiment may have: all corners of a kind of moves at a posture and a speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.errors import FlybyError
from ...core.motion.emulator.run import Run
from ...core.program.move import Move, MoveJ
from ...core.program.zone import FINE, ContourFraction, Zone
from .checking import Refused, check
from .family import Made, RunFamily, joint_target
from .kinds import Kind
from .plan import SPEEDS, CandidateRun, PlannedCorner, Skipped
from .star import Leg, Spoke

LEGS: dict[Kind, tuple[Leg, ...]] = {
    Kind.LINES: (Leg.LINE,),
    Kind.JOINTS: (Leg.JOINT,),
    Kind.ARCS: (Leg.ARC,),
    Kind.LINES_AND_JOINTS: (Leg.LINE, Leg.JOINT),
    Kind.LINES_AND_ARCS: (Leg.LINE, Leg.ARC),
    Kind.JOINTS_AND_ARCS: (Leg.JOINT, Leg.ARC),
    Kind.TURNS: (Leg.TURN,),
    Kind.LINE_STOPS: (Leg.LINE,),
    Kind.JOINT_STOPS: (Leg.JOINT,),
    Kind.CONTOURS: (Leg.JOINT,),
    Kind.UNEQUAL_LINES: (Leg.LINE,),
    Kind.UNEQUAL_JOINTS: (Leg.JOINT,),
    Kind.CORNER_TURNS: (Leg.TURN,),
}
SLOWER = {Kind.UNEQUAL_LINES: 0.4, Kind.UNEQUAL_JOINTS: 0.4}
"""Speed behind corners, as a share of that before them, of kinds where it is another one."""
CONTOUR_SHARES = (0.25, 0.5, 1.0)
"""Of zones that are given by a share of the contour."""
LONGEST_LEG = 0.25
"""Of a leg, as a share of the reach."""
ZONE_ROOM = 2.2
"""A leg's length over its zone's radius, at least: vendors cut zones at the half of a leg."""
GROWTH = 1.35
"""By which legs are lengthened until the speed is reached."""
FIRST_RAMP = 0.06
"""s in which the speed might be reached; legs begin that short."""
STOPPING = 0.6
"""s that a corner takes beside its way at full speed, by estimate."""
STOP_SHARES = (1.0, -1.0, 0.6, -0.4, 0.3, -0.1, 0.1, 0.0, 0.03)
"""Places on a straight leg, and beyond the centre, between which stops are driven."""
AXIS_SWING = math.radians(60)
"""rad by which a single joint moves at most."""


@dataclass(frozen=True)
class _Signed(PlannedCorner):
    """A corner to one side or the other.

    Args:
        sign: -1 or 1.
    """

    sign: float = 1.0


@dataclass(frozen=True)
class PostureFamily(RunFamily):
    """Everything at one posture."""

    def candidates(self) -> Iterator[Made]:
        """All runs with their emulations, and what is not possible."""
        for kind in self.plan.kinds:
            if kind is Kind.SINGLE_AXES:
                yield from self._single_axes()
                continue
            for speed in self.plan.speeds or SPEEDS:
                yield from (
                    self.corners(kind, speed) if kind.has_corners else self._stops(kind, speed)
                )

    # Corners

    def corners(self, kind: Kind, speed: float) -> Iterator[Made]:
        """The runs of all corners; where there is no room for the largest zones, without them."""
        first = self.random.uniform(0, 2 * math.pi)
        corners = self._shuffled(kind)
        try:
            self._check_speed(kind, speed, corners, first)
        except Refused as error:
            yield Skipped(self.place(kind, speed), str(error))
            return
        radii = sorted({corner.radius for corner in corners})
        without: list[Skipped] = []
        for count in range(len(radii), 0, -1):
            kept = radii[:count]
            some = [corner for corner in corners if corner.radius in kept]
            try:
                made = self._grown(kind, speed, some, first)
            except FlybyError as error:
                zone = f"{self.place(kind, speed)}, zone {1e3 * kept[-1]:.5g} mm"
                without.append(Skipped(zone, str(error)))
                continue
            yield from without
            yield from made
            return
        yield Skipped(self.place(kind, speed), without[-1].reason)

    def _check_speed(
        self, kind: Kind, speed: float, corners: Sequence[_Signed], first: float
    ) -> None:
        """Whether the speed is reached at the smallest zones and with the longest legs, which takes
        one emulation to know.

        Raises:
            Refused: it is not.
        """
        least = min(corner.radius for corner in corners)
        smallest = [corner for corner in corners if corner.radius == least]
        ramp = 0.5 * (LONGEST_LEG * self.reach - least)
        try:
            self._pieces(kind, speed, smallest, ramp, first)
        except Refused as error:
            if error.longer_legs_help:
                raise
        except FlybyError:
            return  # shorter legs may do

    def _grown(
        self, kind: Kind, speed: float, corners: Sequence[_Signed], first: float
    ) -> list[tuple[CandidateRun, Run]]:
        """Runs with legs as short as the speed allows.

        Raises:
            FlybyError: there are none; it says why.
        """
        longest = LONGEST_LEG * self.reach
        if max(ZONE_ROOM * corner.radius for corner in corners) > longest:
            raise Refused(f"the zone needs longer legs than {1e3 * longest:.0f} mm")
        last = 0.5 * (longest - max(corner.radius for corner in corners))
        ramp = min(FIRST_RAMP * speed, last)
        while True:
            try:
                return self._pieces(kind, speed, corners, ramp, first)
            except Refused as error:
                if not error.longer_legs_help or ramp >= last:
                    raise
            ramp = min(GROWTH * ramp, last)

    def _shuffled(self, kind: Kind) -> list[_Signed]:
        """All corners, small zones first, turns in a drawn order and to drawn sides."""
        sizes: list[tuple[float, float | None]] = [(radius, None) for radius in self.radii]
        if kind is Kind.CONTOURS:
            sizes = [(0.0, share) for share in CONTOUR_SHARES]
        corners = []
        for radius, share in sizes:
            for turn in self.random.permutation(self.plan.turns):
                sign = self.random.choice([-1.0, 1.0])
                corners.append(_Signed(float(turn), radius, share, sign=float(sign)))
        return corners

    def _pieces(
        self, kind: Kind, speed: float, corners: Sequence[_Signed], ramp: float, first: float
    ) -> list[tuple[CandidateRun, Run]]:
        made = []
        for number, part in enumerate(_parts(corners, ramp, speed, self.plan.longest)):
            candidate = self._corner_run(kind, speed, ramp, part, first, number)
            made.append((candidate, check(self.controller, candidate, self.plan.margin)))
        return made

    def _corner_run(
        self,
        kind: Kind,
        speed: float,
        ramp: float,
        corners: Sequence[_Signed],
        first: float,
        number: int,
    ) -> CandidateRun:
        star = self.star()
        turns = [corner.sign * corner.turn for corner in corners]
        spokes = star.walk(LEGS[kind], turns, [_need(corner, ramp) for corner in corners], first)
        slopes = np.array([star.slope(spoke.angle) for spoke in spokes])
        said = self.speeds(speed, slopes)
        behind = self.speeds(SLOWER.get(kind, 1.0) * speed, slopes)
        begin = star.approach(spokes[0], self.gentle(slopes))
        moves: list[Move] = []
        for corner, (spoke, then) in zip(corners, pairwise(spokes), strict=True):
            moves.append(star.inward(spoke, said[spoke.leg], self._zone(corner)))
            moves.append(star.outward(then, behind[then.leg]))
        designed = [PlannedCorner(corner.turn, corner.radius, corner.share) for corner in corners]
        name = self.name(kind, speed, number)
        return self.candidate(name, kind, speed, designed, begin, moves)

    def _zone(self, corner: PlannedCorner) -> Zone:
        if corner.share is not None:
            return ContourFraction(corner.share)
        return self.words.zone(corner.radius)

    # Stops and single axes

    def _stops(self, kind: Kind, speed: float) -> Iterator[Made]:
        """Straight moves of several lengths, a stop behind each."""
        angle = self.random.uniform(0, 2 * math.pi)
        length = min(0.5 * LONGEST_LEG * self.reach, max(0.04, 0.6 * speed))
        try:
            star = self.star()
            spoke = Spoke(angle, LEGS[kind][0], length)
            slopes = np.array([star.slope(angle)])
            said = self.speeds(speed, slopes)[spoke.leg]
            begin = star.approach(spoke, self.gentle(slopes), STOP_SHARES[0])
            moves = [star.to(spoke, share, said) for share in STOP_SHARES[1:]]
            candidate = self.candidate(self.name(kind, speed), kind, speed, (), begin, moves)
            yield candidate, check(self.controller, candidate, self.plan.margin)
        except FlybyError as error:
            yield Skipped(self.place(kind, speed), str(error))

    def _single_axes(self) -> Iterator[Made]:
        """One joint after the other to and fro, as far as it may and a quarter of that."""
        limits, q = self.controller.robot.limits, self.site.q
        said = self.words.fastest()
        moves: list[Move] = []
        for joint in range(self.controller.robot.arm_size):
            above = min(limits.upper[joint] - q[joint] - self.plan.margin, AXIS_SWING)
            below = min(q[joint] - limits.lower[joint] - self.plan.margin, AXIS_SWING)
            swing = above if above >= below else -below
            for share in (1.0, 0.0, 0.25, 0.0):
                there = q.copy()
                there[joint] += round(share * swing, 5)
                moves.append(MoveJ(joint_target(there), said, FINE, self.plan.tool))
        begin = MoveJ(joint_target(q), said, FINE, self.plan.tool)
        kind = Kind.SINGLE_AXES
        candidate = self.candidate(self.name(kind, None), kind, None, (), begin, moves)
        try:
            yield candidate, check(self.controller, candidate, self.plan.margin)
        except FlybyError as error:
            yield Skipped(self.place(kind), str(error))


def _need(corner: PlannedCorner, ramp: float) -> float:
    """m, length of a corner's legs: a stop at one end, the zone at the other, both clear of where
    the speed is reached."""
    return max(ZONE_ROOM * corner.radius, corner.radius + 2.0 * ramp)


def _parts(
    corners: Sequence[_Signed], ramp: float, speed: float, longest: float
) -> list[list[_Signed]]:
    """Corners in runs that last no longer than they may, by an estimate."""
    parts: list[list[_Signed]] = []
    spent = math.inf
    for corner in corners:
        each = 2.0 * _need(corner, ramp) / speed + STOPPING
        if spent + each > longest:
            parts.append([])
            spent = 0.0
        parts[-1].append(corner)
        spent += each
    return parts
