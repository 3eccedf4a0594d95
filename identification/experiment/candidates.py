"""The runs that an experiment may have: all corners of a kind of moves at a posture and a speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.move import Move, MoveC, MoveJ
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from ...core.program.zone import FINE
from .checking import Refused, check
from .plan import CandidateRun, Kind, Plan, PlannedCorner, Skipped
from .postures import Site
from .star import Leg, Spoke, Star
from .words import Words

LEGS: dict[Kind, tuple[Leg, ...]] = {
    Kind.LINES: (Leg.LINE,),
    Kind.JOINTS: (Leg.JOINT,),
    Kind.ARCS: (Leg.ARC,),
    Kind.LINES_AND_JOINTS: (Leg.LINE, Leg.JOINT),
    Kind.LINES_AND_ARCS: (Leg.LINE, Leg.ARC),
    Kind.TURNS: (Leg.TURN,),
    Kind.LINE_STOPS: (Leg.LINE,),
    Kind.JOINT_STOPS: (Leg.JOINT,),
}
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
APPROACH = 0.25
"""m/s, about, on the way to the start."""


@dataclass(frozen=True)
class _Signed(PlannedCorner):
    """A corner to one side or the other.

    Args:
        sign: -1 or 1.
    """

    sign: float


@dataclass(frozen=True)
class PostureFamily:
    """Everything at one posture.

    Args:
        words: of the vendor's language.
        controller: that emulates.
        plan: what was asked for.
        radii: of the zones, m.
        number: of the posture, from 0.
        site: the posture.
        reach: of the robot, m.
        random: what is drawn from.
    """

    words: Words
    controller: Controller
    plan: Plan
    radii: tuple[float, ...]
    number: int
    site: Site
    reach: float
    random: np.random.Generator

    def candidates(self) -> Iterator[tuple[CandidateRun, Run] | Skipped]:
        """All runs with their emulations, and what is not possible."""
        for kind in self.plan.kinds:
            if kind is Kind.SINGLE_AXES:
                yield from self._single_axes()
                continue
            for speed in self.plan.speeds:
                yield from (
                    self._corners(kind, speed) if kind.has_corners else self._stops(kind, speed)
                )

    def _place(self, kind: Kind, speed: float | None = None) -> str:
        at = "" if speed is None else f" at {1e3 * speed:.5g} mm/s"
        return f"{kind}{at}, posture {self.number + 1}"

    def _name(self, kind: Kind, speed: float | None, number: int | None = None) -> str:
        parts = [f"p{self.number + 1}", kind.short]
        parts += [] if speed is None else [f"v{1e3 * speed:.5g}".replace(".", "d")]
        parts += [] if number is None else [str(number + 1)]
        return "_".join(parts)

    def _star(self) -> Star:
        robot, site = self.controller.robot, self.site
        return Star(self.words.vendor, robot, self.plan.tool, site.q, site.plane)

    # Corners

    def _corners(self, kind: Kind, speed: float) -> Iterator[tuple[CandidateRun, Run] | Skipped]:
        """The runs of all corners; where there is no room for the largest zones, without them."""
        first = self.random.uniform(0, 2 * math.pi)
        corners = self._shuffled()
        try:
            self._check_speed(kind, speed, corners, first)
        except Refused as error:
            yield Skipped(self._place(kind, speed), str(error))
            return
        without: list[Skipped] = []
        for count in range(len(self.radii), 0, -1):
            kept = self.radii[:count]
            some = [corner for corner in corners if corner.radius in kept]
            try:
                made = self._grown(kind, speed, some, first)
            except FlybyError as error:
                zone = f"{self._place(kind, speed)}, zone {1e3 * kept[-1]:.5g} mm"
                without.append(Skipped(zone, str(error)))
                continue
            yield from without
            yield from made
            return
        yield Skipped(self._place(kind, speed), without[-1].reason)

    def _check_speed(
        self, kind: Kind, speed: float, corners: Sequence[_Signed], first: float
    ) -> None:
        """Whether the speed is reached at the smallest zones and with the longest legs, which takes
        one emulation to know.

        Raises:
            Refused: it is not.
        """
        smallest = [corner for corner in corners if corner.radius == min(self.radii)]
        ramp = 0.5 * (LONGEST_LEG * self.reach - min(self.radii))
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

    def _shuffled(self) -> list[_Signed]:
        """All corners, small zones first, turns in a drawn order and to drawn sides."""
        corners = []
        for radius in self.radii:
            for turn in self.random.permutation(self.plan.turns):
                sign = self.random.choice([-1.0, 1.0])
                corners.append(_Signed(float(turn), radius, float(sign)))
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
        star = self._star()
        turns = [corner.sign * corner.turn for corner in corners]
        spokes = star.walk(LEGS[kind], turns, [_need(corner, ramp) for corner in corners], first)
        slopes = np.array([star.slope(spoke.angle) for spoke in spokes])
        said = self._speeds(speed, slopes)
        begin = star.approach(spokes[0], self._gentle(slopes))
        moves: list[Move] = []
        for corner, (spoke, then) in zip(corners, pairwise(spokes), strict=True):
            moves.append(star.inward(spoke, said[spoke.leg], self.words.zone(corner.radius)))
            moves.append(star.outward(then, said[then.leg]))
        designed = tuple(PlannedCorner(corner.turn, corner.radius) for corner in corners)
        name = self._name(kind, speed, number)
        return self._candidate(name, kind, speed, designed, begin, moves)

    # Stops and single axes

    def _stops(self, kind: Kind, speed: float) -> Iterator[tuple[CandidateRun, Run] | Skipped]:
        """Straight moves of several lengths, a stop behind each."""
        angle = self.random.uniform(0, 2 * math.pi)
        length = min(0.5 * LONGEST_LEG * self.reach, max(0.04, 0.6 * speed))
        try:
            star = self._star()
            spoke = Spoke(angle, LEGS[kind][0], length)
            slopes = np.array([star.slope(angle)])
            said = self._speeds(speed, slopes)[spoke.leg]
            begin = star.approach(spoke, self._gentle(slopes), STOP_SHARES[0])
            moves = [star.to(spoke, share, said) for share in STOP_SHARES[1:]]
            candidate = self._candidate(self._name(kind, speed), kind, speed, (), begin, moves)
            yield candidate, check(self.controller, candidate, self.plan.margin)
        except FlybyError as error:
            yield Skipped(self._place(kind, speed), str(error))

    def _single_axes(self) -> Iterator[tuple[CandidateRun, Run] | Skipped]:
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
                moves.append(MoveJ(_joint_target(there), said, FINE, self.plan.tool))
        begin = MoveJ(_joint_target(q), said, FINE, self.plan.tool)
        kind = Kind.SINGLE_AXES
        candidate = self._candidate(self._name(kind, None), kind, None, (), begin, moves)
        try:
            yield candidate, check(self.controller, candidate, self.plan.margin)
        except FlybyError as error:
            yield Skipped(self._place(kind), str(error))

    # All runs

    def _speeds(self, speed: float, slopes: FloatArray) -> dict[Leg, Speed]:
        path, arc = self.words.path_speed(speed), self.words.path_speed(speed, MoveC)
        joint = self.words.joint_speed(speed, slopes)
        return {Leg.LINE: path, Leg.TURN: path, Leg.ARC: arc, Leg.JOINT: joint}

    def _gentle(self, slopes: FloatArray) -> Speed:
        """Of the way to the start."""
        return self.words.joint_speed(APPROACH, slopes)

    def _candidate(
        self,
        name: str,
        kind: Kind,
        speed: float | None,
        corners: tuple[PlannedCorner, ...],
        begin: MoveJ,
        moves: Sequence[Move],
    ) -> CandidateRun:
        # Stars and axes are approached in joints.
        assert isinstance(begin.target, JointTarget)
        program = Program((begin, *moves), name, begin.target)
        start = np.array(begin.target.joints)
        return CandidateRun(name, kind, self.number, speed, corners, program, start)


def _joint_target(q: FloatArray) -> JointTarget:
    return JointTarget(tuple(float(value) for value in q))


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
