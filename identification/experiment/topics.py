"""Runs about open questions of the motion model, beside those of all kinds (`candidates`).

The model has figures for some of the questions, and none for others. So runs of a topic cross its
factors: every pair of levels gets a run before what is left of the time goes to those that tell
most of the figures there are (`selection`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, islice

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.program.move import Move, MoveJ
from ...core.program.speed import Speed, speed_shown
from ...core.program.tool import WORLD
from ...core.program.zone import FINE, ContourFraction
from ...core.robot.kinematics.chain_kernels import jacobians
from ...core.robot.work_chain import work_chain
from .candidates import LONGEST_LEG, ZONE_ROOM, PostureFamily
from .checking import check
from .family import APPROACH, Made, joint_target
from .kinds import DRAGGING, Kind, Topic
from .plan import RADII, CandidateRun, PlannedCorner, Skipped, Study
from .postures import ROOM
from .star import Leg, Spoke, Star

FAST, MIDDLING = 1.0, 0.5
"""m/s, beside the greatest speed that the language takes."""
BLENDED = (0.2, 0.8)
"""m/s at which corners of all kinds are passed."""
SHORT = (0.0075, 0.015, 0.03, 0.06)
"""Lengths of short legs, as shares of the reach."""
DEFLECTIONS = (math.radians(4), math.radians(20), math.radians(60))
"""rad between short legs."""
SHORT_ZONES = 3
CHAIN = 9
"""Short legs in a row."""
BREAKS = (0.0, math.radians(45), math.radians(90))
"""rad by which lines turn where the tool begins to turn otherwise."""
SPIN = math.radians(40)
"""rad by which the tool turns to either side of where it stands."""
SHARES = (1.0, -1.0, 0.5, 0.25, 0.0)
"""Of a leg through the centre, places between which stops are driven; they end where they began."""
SMALLER = (1.0, 0.7, 0.5, 0.35)
"""Sizes that are tried one after the other where there is no room."""
AMPLITUDES = (0.004, 0.012, 0.04)
"""rad of slow ways to and fro: within what friction fades in, and beyond."""
TO_AND_FRO = (0.5, 1.0, 0.0, 1.0, 0.0)
"""Of these ways: a stop without turning back shows what is the stop's own."""
RATES = (0.01, 0.04)
"""rad/s of a joint that turns back."""
STOPPED = 0.3
"""s that a stop takes, by estimate."""
CRUISE_RATES = (0.15, 0.4, 1.2)
"""rad/s of these: below the speed from which they drag, about it, and above."""
CRUISE = 0.6
"""s that each lasts: drag shows some 0.15 s after the joint has come up to speed."""
RESTED, REST_RATE = 0.5, 0.02
"""s that such a joint rests behind a stop, while the last joint turns at so many rad/s: what shows
late is seen to its end, and the log's time goes on."""
BLENDS = (
    *(Kind.LINES, Kind.JOINTS, Kind.ARCS),
    *(Kind.LINES_AND_JOINTS, Kind.LINES_AND_ARCS, Kind.JOINTS_AND_ARCS),
    *(Kind.UNEQUAL_LINES, Kind.UNEQUAL_JOINTS),
)


def runs_about(topic: Topic, family: PostureFamily) -> Iterator[Made]:
    """All runs of a topic at a posture, and what is not possible."""
    yield from _RUNS[topic](family)


def _study(
    topic: Topic, family: PostureFamily, conditions: Sequence[tuple[str, ...]], *joints: int
) -> Study:
    """What a run is for that has these levels of the topic's factors together."""
    posture = f"posture {family.number + 1}"
    pairs = {frozenset(pair) for one in conditions for pair in combinations(one, 2)}
    pairs |= {frozenset((one[0], posture)) for one in conditions}
    levels = frozenset(f"{topic}: {' and '.join(sorted(pair))}" for pair in pairs)
    return Study(topic, levels, joints)


def _made(
    family: PostureFamily,
    topic: Topic,
    candidate: CandidateRun,
    conditions: Sequence[tuple[str, ...]],
    *joints: int,
) -> Made:
    """A run, looked at.

    Raises:
        FlybyError: it is not possible.
    """
    study = _study(topic, family, conditions, *joints)
    candidate = replace(candidate, study=study)
    return candidate, check(family.controller, candidate, family.plan.margin)


def _mps(speed: float) -> str:
    return f"{1e3 * speed:.5g} mm/s"


def _speeds(family: PostureFamily, *usual: float) -> Sequence[float]:
    """Those that were asked for, or the usual ones as far as the language takes them."""
    return family.plan.speeds or tuple(dict.fromkeys(min(v, family.words.top) for v in usual))


# Short legs


def _short_legs(family: PostureFamily) -> Iterator[Made]:
    """Polygons of several lengths of legs, one zone and one speed in a run."""
    for speed in _speeds(family, MIDDLING, FAST, family.words.top):
        for number, radius in enumerate(_short_radii(family)):
            place = f"{family.place(Kind.SHORT_LEGS, speed)}, zone {1e3 * radius:.5g} mm"
            chains = _chains(family.reach, radius)
            refused = "no short leg takes the zone whole"
            while chains:
                try:
                    yield _chain_run(family, speed, radius, chains, number)
                    break
                except FlybyError as error:
                    refused = str(error)
                    # What reaches farthest goes first.
                    far = [float(np.linalg.norm(chain, axis=1).max()) for chain in chains]
                    del chains[int(np.argmax(far))]
            else:
                yield Skipped(place, refused)


def _short_radii(family: PostureFamily) -> Sequence[float]:
    """Zones, m, that the longest of the short legs takes whole, or those that were asked for."""
    most = max(SHORT) * family.reach / ZONE_ROOM
    fit = [radius for radius in RADII if radius <= most]
    chosen = np.unique(np.linspace(0, len(fit) - 1, SHORT_ZONES).round().astype(int))
    return family.plan.radii or [fit[k] for k in chosen]


def _chains(reach: float, radius: float) -> list[FloatArray]:
    """Corners (K, 2) in m of chains of short legs that take a zone whole, shortest legs first."""
    lengths = [round(share * reach, 3) for share in SHORT]
    return [
        _chain(length, turn, ROOM * reach)
        for length in lengths
        for turn in DEFLECTIONS
        if length >= ZONE_ROOM * radius
    ]


def _chain(length: float, turn: float, room: float) -> FloatArray:
    """Corners (K, 2) of a chain within so many m of the centre: on a circle, if that is no larger,
    else to and fro across a line."""
    circle = length / (2.0 * math.sin(0.5 * turn))
    if circle <= room:
        angle = turn * np.arange(CHAIN + 1)
        return circle * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    count = max(2, min(CHAIN, int(2.0 * room / length)))
    along = length * math.cos(0.5 * turn) * (np.arange(count + 1) - 0.5 * count)
    aside = 0.5 * length * math.sin(0.5 * turn) * (-1.0) ** np.arange(count + 1)
    return np.stack([along, aside], axis=1)


def _chain_run(
    family: PostureFamily, speed: float, radius: float, chains: Sequence[FloatArray], number: int
) -> Made:
    star, zone = family.star(), family.words.zone(radius)
    moves: list[Move] = []
    corners: list[PlannedCorner] = []
    conditions: list[tuple[str, ...]] = []
    begin: MoveJ | None = None
    for points in chains:
        spokes = [Spoke(math.atan2(y, x), Leg.LINE, math.hypot(x, y)) for x, y in points]
        legs = np.diff(points, axis=0)
        headings = [math.atan2(y, x) for x, y in legs]
        slopes = np.array([star.slope(angle) for angle in headings])
        said = family.words.path_speed(speed, slopes=slopes)
        if begin is None:
            begin = star.approach(spokes[0], family.gentle(slopes))
        else:
            moves.append(star.to(spokes[0], 1.0, family.words.path_speed(APPROACH)))
        moves += [star.to(spoke, 1.0, said, zone) for spoke in spokes[1:-1]]
        moves.append(star.to(spokes[-1], 1.0, said))
        turn = abs(math.remainder(headings[1] - headings[0], 2.0 * math.pi))
        corners += [PlannedCorner(turn, radius)] * (len(legs) - 1)
        length = f"legs of {1e3 * float(np.linalg.norm(legs[0])):.4g} mm"
        bent = f"corners of {math.degrees(turn):.3g}°"
        conditions.append((_mps(speed), f"zone {1e3 * radius:.5g} mm", length, bent))
    assert begin is not None
    name = family.name(Kind.SHORT_LEGS, speed, number)
    run = family.candidate(name, Kind.SHORT_LEGS, speed, corners, begin, moves)
    return _made(family, Topic.SHORT_LEGS, run, conditions)


# Turns


def _turns(family: PostureFamily) -> Iterator[Made]:
    """Turns at a point, and lines on which the tool turns otherwise behind a corner."""
    yield _first(family, Kind.POINT_TURNS, partial(_point_turns, family))
    for speed in _speeds(family, MIDDLING, family.words.top):
        yield _first(family, Kind.CORNER_TURNS, partial(_corner_turns, family, speed))


def _first(family: PostureFamily, kind: Kind, make: Callable[[float], Made]) -> Made:
    """The run of the first size that there is room for."""
    refused = ""
    for scale in SMALLER:
        try:
            return make(scale)
        except FlybyError as error:
            refused = str(error)
    return Skipped(family.place(kind), refused)


def _point_turns(family: PostureFamily, scale: float) -> Made:
    star, said = family.star(), family.words.path_speed(family.words.top)
    spokes = [Spoke(0.0, Leg.SPIN, scale * SPIN, axis) for axis in range(3)]
    begin = star.approach(spokes[0], family.gentle(np.array([star.slope(0.0)])), 0.0)
    moves = [star.to(spoke, share, said) for spoke in spokes for share in SHARES]
    name, top = family.name(Kind.POINT_TURNS, None), family.words.top
    run = family.candidate(name, Kind.POINT_TURNS, top, (), begin, moves)
    return _made(family, Topic.TURNS, run, [("at a point",)])


def _corner_turns(family: PostureFamily, speed: float, scale: float) -> Made:
    star = family.star()
    length = 0.5 * scale * LONGEST_LEG * family.reach
    radii = [radius for radius in family.radii if ZONE_ROOM * radius <= length]
    corners = [PlannedCorner(turn, radius) for radius in radii for turn in BREAKS]
    turns = [(-1.0) ** k * corner.turn for k, corner in enumerate(corners)]
    spokes = star.walk([Leg.TURN], turns, [length] * len(corners), 0.0)
    slopes = np.array([star.slope(spoke.angle) for spoke in spokes])
    said = family.words.path_speed(speed, slopes=slopes)
    moves: list[Move] = []
    for corner, spoke, then in zip(corners, spokes, spokes[1:], strict=False):
        moves.append(star.inward(spoke, said, family.words.zone(corner.radius)))
        moves.append(star.outward(then, said))
    begin = star.approach(spokes[0], family.gentle(slopes))
    name = family.name(Kind.CORNER_TURNS, speed)
    run = family.candidate(name, Kind.CORNER_TURNS, speed, corners, begin, moves)
    conditions = [
        (_mps(speed), f"zone {c.zone}", f"corners of {math.degrees(c.turn):.4g}°") for c in corners
    ]
    return _made(family, Topic.TURNS, run, conditions)


# Postures


def _rests(family: PostureFamily) -> Iterator[Made]:
    """Lines from rest to rest: up, out, aside and between, of several lengths."""
    yield _first(family, Kind.RESTS, partial(_rest_run, family))


def _rest_run(family: PostureFamily, scale: float) -> Made:
    top, length = family.words.top, 0.5 * scale * LONGEST_LEG * family.reach
    upright, level = (_turned(family.star(), *plane) for plane in _planes(family))
    moves: list[Move] = []
    begin: MoveJ | None = None
    for star, angle in (*((upright, k * 0.25 * math.pi) for k in range(4)), (level, 0.5 * math.pi)):
        spoke = Spoke(angle, Leg.LINE, length)
        slopes = np.array([star.slope(angle)])
        begin = begin or star.approach(spoke, family.gentle(slopes), 0.0)
        said = family.words.path_speed(top, slopes=slopes)
        moves += [star.to(spoke, share, said) for share in SHARES]
    assert begin is not None
    run = family.candidate(family.name(Kind.RESTS, None), Kind.RESTS, top, (), begin, moves)
    return _made(family, Topic.POSTURES, run, [("lines",)])


def _planes(family: PostureFamily) -> tuple[tuple[FloatArray, FloatArray], ...]:
    """Directions outward and up, and outward and aside, in the world."""
    up = np.array([0.0, 0.0, 1.0])
    outward = family.star().place[1] - np.array(family.controller.robot.base.position)
    outward = outward - up * (outward @ up)
    away = float(np.linalg.norm(outward))
    outward = outward / away if away > 1e-6 else np.array([1.0, 0.0, 0.0])
    return (outward, up), (outward, np.cross(up, outward))


def _turned(star: Star, first: FloatArray, second: FloatArray) -> Star:
    """The star in another plane."""
    return replace(star, plane=np.stack([first, second, np.cross(first, second)], axis=1))


# Reversals


def _reversals(family: PostureFamily) -> Iterator[Made]:
    """One joint after the other slowly to and fro, as many in a run as there is time for."""
    number, driven = 0, set()
    for rate in RATES:
        each = sum(AMPLITUDES) * float(np.abs(np.diff([0.0, *TO_AND_FRO])).sum()) / rate
        each += STOPPED * len(AMPLITUDES) * len(TO_AND_FRO)
        count = max(1, int(family.plan.longest / each))
        for joints in _several(range(family.controller.robot.arm_size), count):
            said = [_alone(family, joint, rate) for joint in joints]
            new = [(j, v) for j, v in zip(joints, said, strict=True) if (j, v) not in driven]
            driven.update(new)  # A language's slowest may be the same for both.
            if not new:
                continue
            number += 1
            try:
                yield _reversal_run(family, new, number)
            except FlybyError as error:
                at = ", ".join(family.controller.robot.axis_names[joint] for joint in joints)
                yield Skipped(f"{family.place(Kind.REVERSALS)}, {at}", str(error))


def _several(joints: Iterable[int], count: int) -> Iterator[tuple[int, ...]]:
    rest = iter(joints)
    return iter(lambda: tuple(islice(rest, count)), ())


def _alone(family: PostureFamily, joint: int, rate: float) -> Speed:
    return family.words.joint_alone(joint, rate, _lever(family, joint))


def _lever(family: PostureFamily, joint: int) -> float:
    """m, of the TCP about a joint."""
    robot, tool = family.controller.robot, family.plan.tool
    J = jacobians(work_chain(robot, tool, WORLD), family.site.q[None])[0]
    return float(np.linalg.norm(J[:3, joint]))


def _rate(said: Speed) -> str:
    """Of a joint that moves alone, as it is programmed."""
    turn = said.reorientation
    return speed_shown(said) if turn is None else f"{math.degrees(turn):.3g}°/s"


def _driven_rate(family: PostureFamily, joint: int, said: Speed) -> float:
    """rad/s of a joint that moves alone; languages round what they say, or take no less."""
    most = float(family.controller.robot.limits.velocity[joint])
    if said.joint is not None:
        return min(most, said.joint)
    if said.tcp is None:
        return most * said.joint_fraction
    by_tool = math.inf if said.reorientation is None else said.reorientation
    return min(most, by_tool, said.tcp / max(_lever(family, joint), 1e-9))


def _reversal_run(family: PostureFamily, joints: Sequence[tuple[int, Speed]], number: int) -> Made:
    robot, tool, q = family.controller.robot, family.plan.tool, family.site.q
    moves = []
    for joint, said in joints:
        above = robot.limits.upper[joint] - q[joint] >= q[joint] - robot.limits.lower[joint]
        for amplitude in AMPLITUDES:
            for share in TO_AND_FRO:
                there = q.copy()
                there[joint] += round((1.0 if above else -1.0) * share * amplitude, 5)
                moves.append(MoveJ(joint_target(there), said, FINE, tool))
    begin = MoveJ(joint_target(q), family.gentle(np.array([family.star().slope(0.0)])), FINE, tool)
    name = family.name(Kind.REVERSALS, None, number - 1)
    run = family.candidate(name, Kind.REVERSALS, None, (), begin, moves)
    conditions = [(f"joint {robot.axis_names[j]}", _rate(v)) for j, v in joints]
    return _made(family, Topic.REVERSALS, run, conditions, *(joint for joint, _ in joints))


# Drag


def _cruises(family: PostureFamily) -> Iterator[Made]:
    """Joints that carry the arm, to and fro at several speeds, as many in a run as there is time
    for."""
    each = len(CRUISE_RATES) * 2 * (CRUISE + RESTED + 2.0 * STOPPED)
    count = max(1, int(family.plan.longest / each))
    joints = range(min(DRAGGING, family.controller.robot.arm_size - 1))
    for number, some in enumerate(_several(joints, count)):
        yield _first(family, Kind.CRUISES, partial(_cruise_run, family, some, number))


def _cruise_run(family: PostureFamily, joints: Sequence[int], number: int, scale: float) -> Made:
    robot, tool, q = family.controller.robot, family.plan.tool, family.site.q
    last = robot.arm_size - 1
    slow = _alone(family, last, REST_RATE)
    aside = RESTED * _driven_rate(family, last, slow)
    there, moves = q.copy(), []
    conditions: list[tuple[str, ...]] = []
    for joint in joints:
        above = robot.limits.upper[joint] - q[joint] >= q[joint] - robot.limits.lower[joint]
        for wanted in CRUISE_RATES:
            rate = min(wanted, 0.9 * float(robot.limits.velocity[joint]))
            said = _alone(family, joint, rate)
            conditions.append((f"joint {robot.axis_names[joint]}", _rate(said)))
            way = (1.0 if above else -1.0) * scale * rate * CRUISE
            for share in (1.0, 0.0):
                there[joint] = q[joint] + round(share * way, 5)
                moves.append(MoveJ(joint_target(there), said, FINE, tool))
                there[last] = q[last] + round(share * aside, 5)
                moves.append(MoveJ(joint_target(there), slow, FINE, tool))
    begin = MoveJ(joint_target(q), family.gentle(np.array([family.star().slope(0.0)])), FINE, tool)
    name = family.name(Kind.CRUISES, None, number)
    run = family.candidate(name, Kind.CRUISES, None, (), begin, moves)
    return _made(family, Topic.DRAG, run, conditions, *joints)


# Blends


def _blends(family: PostureFamily) -> Iterator[Made]:
    """Corners between moves of all kinds, and with all kinds of zones, that the language has."""
    words = family.words.of(MoveJ)
    contours = words is not None and ContourFraction in words.zones
    for kind in (*BLENDS, *[Kind.CONTOURS] * contours):
        for speed in _speeds(family, *BLENDED):
            for made in family.corners(kind, speed):
                if isinstance(made, Skipped):
                    yield made
                    continue
                candidate, run = made
                zones = dict.fromkeys(corner.zone for corner in candidate.corners)
                conditions = [(str(kind), _mps(speed), f"zone {zone}") for zone in zones]
                yield replace(candidate, study=_study(Topic.BLENDS, family, conditions)), run


_RUNS: dict[Topic, Callable[[PostureFamily], Iterator[Made]]] = {
    Topic.SHORT_LEGS: _short_legs,
    Topic.TURNS: _turns,
    Topic.POSTURES: _rests,
    Topic.REVERSALS: _reversals,
    Topic.BLENDS: _blends,
    Topic.DRAG: _cruises,
}
