"""Parts that one robot of a station hands to another: one thing, in the cells of both.

The giver's cell has the part where it is taken from, the taker's where it is handed over. In proofs
it is the giver's, held or put down, until the taker drives off with it, and the taker's from there
on, where the giver has held it. While a robot comes to it or draws back it lies still: that is
proven in the robot's own cell.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..cell.geometry import Mesh
from ..collision.handled_scenes import scenes_along
from ..collision.mutual.handed_part import AwaitedPart, HandedPart
from ..collision.proof.certificate import SceneOf, certify_stretch
from ..collision.scene.bodies import BodyKind
from ..collision.scene.handled_pairs import RESTING
from ..errors import InputError, UnknownNameError
from ..handling.arrangement import Arrangement, PlacedPart
from ..handling.handling import ChangeOfHands, Handling
from ..spatial.pose import Pose
from .station import HandOver, RobotStation, StationRobot

_SAME = 2e-3
"""m by which the part may lie elsewhere in the cell of the taker than where it is given."""
_TURNED = math.radians(1.0)


@dataclass(frozen=True)
class FollowedHandOver:
    """A part that changes hands, with the programs as they are driven.

    Args:
        declared: whose part it is.
        released, taken: what the giver and the taker do.
        moves: index of the move that each is driven to where it stands with the part.
        leaving, coming, rests: see `HandedPart`.
        unproven: likewise.
    """

    declared: HandOver
    released: ChangeOfHands
    taken: ChangeOfHands
    moves: tuple[int, int]
    leaving: frozenset[int]
    coming: frozenset[int]
    rests: bool
    unproven: tuple[str, ...]

    def between(self, one: str, other: str) -> HandedPart | None:
        """The same of two robots; None where they are others."""
        names = self.declared.giver, self.declared.taker
        if names not in ((one, other), (other, one)):
            return None
        return HandedPart(
            int(names[0] != one),
            (self.declared.given, self.declared.taken),
            self.moves,
            self.leaving,
            self.coming,
            self.rests,
            self.unproven,
        )


@dataclass(frozen=True)
class HandOvers:
    """All of a station.

    Args:
        followed: each of them.
        handlings: of the robots that hand parts over, with each part whose it is.
    """

    followed: tuple[FollowedHandOver, ...] = ()
    handlings: Mapping[str, Handling] | None = None

    def between(self, one: str, other: str) -> list[HandedPart]:
        """Those of two robots."""
        found = (each.between(one, other) for each in self.followed)
        return [part for part in found if part is not None]

    def awaited(self, one: str, other: str) -> list[AwaitedPart]:
        """Those that one of two robots gets of a third one."""
        return [
            AwaitedPart(int(each.declared.taker != one), each.declared.taken, each.moves[1])
            for each in self.followed
            if each.declared.taker in (one, other) and each.declared.giver not in (one, other)
        ]

    def of(self, part: HandedPart, one: str, other: str) -> FollowedHandOver:
        """The one that `between` has made a part of."""
        return next(each for each in self.followed if each.between(one, other) == part)

    def handling(self, member: StationRobot) -> Handling | None:
        """Of a robot, with the parts that are handed over."""
        return (self.handlings or {}).get(member.name, member.handling)


class _Met(NamedTuple):
    """A part where it changes hands.

    Args:
        declared: whose part it is.
        released, taken: what the giver and the taker do.
        moves: index of the move that each is driven to where it stands with the part.
        fix: the part where it is given, in its frame as the taker's cell has it.
    """

    declared: HandOver
    released: ChangeOfHands
    taken: ChangeOfHands
    moves: tuple[int, int]
    fix: Pose


def check_hand_overs(station: RobotStation) -> list[_Met]:
    """Where parts change hands.

    Raises:
        InputError: a part does not change hands once, robots do not stop there, or the two cells
            have it in different places, shapes or weights.
    """
    lying = {name: member.handling for name, member in station.members.items()}
    found: list[_Met] = []
    for declared in _in_turn(station.hand_overs):
        met = _met(station, declared, lying)
        # Who hands it on has it as it was taken.
        lying[declared.taker] = _moved(lying[declared.taker], declared.taken, met.fix)
        found.append(met)
    return found


def _in_turn(hand_overs: Sequence[HandOver]) -> list[HandOver]:
    """Those by which a robot gets a part come before those by which it hands it on."""
    found: list[HandOver] = []
    left = list(hand_overs)
    while left:
        gets = {(each.taker, each.taken) for each in left}
        ready = [each for each in left if (each.giver, each.given) not in gets]
        found += ready or left
        left = [each for each in left if each not in found]
    return found


def follow_hand_overs(station: RobotStation) -> HandOvers:
    """Follow the parts that robots of a station hand to each other.

    Raises:
        InputError: as `check_hand_overs`.
    """
    lying = {name: member.handling for name, member in station.members.items()}
    known = check_hand_overs(station)
    for met in known:
        declared = met.declared
        lying[declared.giver] = _staying(lying[declared.giver], declared.given, met.released)
        lying[declared.taker] = _moved(lying[declared.taker], declared.taken, met.fix)
    followed = tuple(_followed(station, met, lying) for met in known)
    handlings = {name: handling for name, handling in lying.items() if handling is not None}
    return HandOvers(followed, handlings)


def _met(station: RobotStation, declared: HandOver, lying: Mapping[str, Handling | None]) -> _Met:
    where = "" if station.file is None else f"{station.file}: "
    where += f"hand_over of {declared.giver}.{declared.given}: "
    giver, taker = station.members[declared.giver], station.members[declared.taker]
    try:
        _check_single(station, declared)
        released, taken = _released(station, declared), _taken(station, declared)
        given, found = _places(declared, released, lying)
        moves = _stop(giver, released), _stop(taker, taken)
    except InputError as error:
        raise InputError(f"{where}{error}") from None
    return _Met(declared, released, taken, moves, found.pose.inverse() @ given.pose)


def _check_single(station: RobotStation, declared: HandOver) -> None:
    """A part has one giver and one taker."""
    givers = [(each.giver, each.given) for each in station.hand_overs]
    takers = [(each.taker, each.taken) for each in station.hand_overs]
    for known, robot, part in (
        (givers, declared.giver, declared.given),
        (takers, declared.taker, declared.taken),
    ):
        if known.count((robot, part)) > 1:
            raise InputError(
                f"{robot}.{part} stands in two [[hand_over]]: a part changes hands once"
            )


def _released(station: RobotStation, declared: HandOver) -> ChangeOfHands:
    """Where the giver lets go."""
    changes = _changes(station, declared.giver, declared.given)
    released = [change for change in changes if not change.taken]
    if [change.taken for change in changes] != [True, False]:
        raise InputError(
            f"{declared.giver} takes it {len(changes) - len(released)} times and lets go of it "
            f"{len(released)} times; a part that is handed over it takes once, and releases once "
            "(attach and release in its cell)"
        )
    return released[0]


def _taken(station: RobotStation, declared: HandOver) -> ChangeOfHands:
    """Where the taker takes it."""
    changes = _changes(station, declared.taker, declared.taken)
    if not changes or sum(change.taken for change in changes) != 1:
        raise InputError(
            f"{declared.taker} takes {declared.taken!r} {sum(c.taken for c in changes)} times; a "
            "part that is handed over it takes once (attach in its cell, and near_mm)"
        )
    return changes[0]


def _changes(station: RobotStation, robot: str, part: str) -> list[ChangeOfHands]:
    handling = station.members[robot].handling
    known = [] if handling is None else [placed.name for placed in handling.last]
    if handling is None or part not in known:
        raise UnknownNameError(f"part of the cell of {robot}", part, known)
    return [change for change in handling.changes if change.name == part]


def _places(
    declared: HandOver, released: ChangeOfHands, lying: Mapping[str, Handling | None]
) -> tuple[PlacedPart, PlacedPart]:
    """The part where the giver lets go of it, and where it is at first in the taker's cell."""
    giver, taker = (lying[name] for name in (declared.giver, declared.taker))
    assert giver is not None and taker is not None
    given = _part(_behind(giver, released), declared.given)
    found = _part(taker.arrangements[0], declared.taken)
    if given.carrier is not None or found.carrier is not None:
        axis = given.carrier or found.carrier
        raise InputError(f"it lies on {axis}, which moves: that is not followed")
    if not same_shape(given, found):
        raise InputError(
            f"its shape is another one than that of {declared.taker}.{declared.taken}: give both "
            "cells the same"
        )
    if given.part.load != found.part.load:
        raise InputError(
            f"it weighs {_weight(given)}, and {_weight(found)} as {declared.taker}."
            f"{declared.taken}: give both cells the same mass_kg, centre and inertia"
        )
    off = given.pose.inverse() @ found.pose
    turned = 2.0 * math.acos(min(1.0, abs(off.quaternion[0])))
    if math.hypot(*off.position) > _SAME or turned > _TURNED:
        x, y, z = (1e3 * v for v in given.pose.position)
        w, a, b, c = given.pose.quaternion
        raise InputError(
            f"{declared.giver} lets go of it {1e3 * math.hypot(*off.position):.1f} mm and "
            f"{math.degrees(turned):.1f}° from where {declared.taken!r} is in the cell of "
            f"{declared.taker}: there its pose is to be {{ xyz_mm = [{x:.3f}, {y:.3f}, {z:.3f}], "
            f"quat_wxyz = [{w:.6f}, {a:.6f}, {b:.6f}, {c:.6f}] }}"
        )
    return given, found


def _weight(placed: PlacedPart) -> str:
    load = placed.part.load
    return "nothing" if load is None else f"{load.mass:g} kg"


def same_shape(one: PlacedPart, other: PlacedPart) -> bool:
    """Whether two parts are of one shape: what their files hold counts, not their names."""
    first, second = one.part.geometry.shape, other.part.geometry.shape
    if isinstance(first, Mesh) and isinstance(second, Mesh):
        return np.array_equal(first.faces, second.faces) and np.allclose(
            first.vertices, second.vertices, rtol=0.0, atol=1e-9
        )
    return first == second


def _followed(
    station: RobotStation, met: _Met, lying: Mapping[str, Handling | None]
) -> FollowedHandOver:
    declared, moves = met.declared, met.moves
    giver, taker = station.members[declared.giver], station.members[declared.taker]
    found: list[frozenset[int]] = []
    unproven: list[str] = []
    rests = False
    for member, name, move, step in (
        (giver, declared.given, moves[0], 1),
        (taker, declared.taken, moves[1], -1),
    ):
        scenes = scenes_along(
            member.cell,
            lying[member.name],
            member.run.program,
            lambda run=member.run: run.path,  # type: ignore[misc]
            station.clearance,
        )
        way = list(_way(member, scenes, name, move, step))
        found.append(frozenset(way))
        unproven += _unproven(member, scenes, way, station.clearance)
        rests = rests or _rests(member, scenes, name, move, step)
    return FollowedHandOver(
        declared, met.released, met.taken, moves, found[0], found[1], rests, tuple(unproven)
    )


def _stop(member: StationRobot, change: ChangeOfHands) -> int:
    """The move at whose end a robot stands where it hands a part over.

    Raises:
        InputError: it does not stop there, or need not where what it waits for is there in time.
    """
    path = member.run.path
    driven = [move for move in path.route.moves if move <= change.move]
    if not driven:
        raise InputError(
            f"{member.name} hands {change.name!r} over before its first move: drive it there first"
        )
    k = len(driven) - 1
    passed = () if member.passing is None else member.passing.moves
    stops = path.pieces.stop[np.searchsorted(path.pieces.segment, k, side="right")]
    if not stops or any(driven[-1] <= move <= change.move for move in passed):
        span = member.program.moves[driven[-1]].statement
        where = "" if span is None else f"{span}: "
        raise InputError(
            f"{where}{member.name} hands {change.name!r} over where it does not stop: end the move "
            "before it at a stop"
        )
    return driven[-1]


def _way(member: StationRobot, scenes: SceneOf, name: str, move: int, step: int) -> Iterator[int]:
    """Moves on which a robot draws back from a part behind a move, or comes to it up to there."""
    driven = list(dict.fromkeys(member.run.path.route.moves))
    k = driven.index(move) + (step > 0)
    first = True
    while 0 <= k < len(driven):
        own = driven[k]
        scene = scenes(member.run.program.moves[own].tool, own)
        touching = {
            touch.scene.bodies[body].thing
            for touch in scene.left_out
            for pair in touch.scene.pairs
            for body in pair
        }
        if not first and name not in touching:
            return
        yield own
        first, k = False, k + step


def _rests(member: StationRobot, scenes: SceneOf, name: str, move: int, step: int) -> bool:
    """Whether a part is on something, in a robot's hand where that stands at the end of a move."""
    route = member.run.path.route
    end = route.ends.q[list(route.moves).index(move), 1]
    held = move if step > 0 else min((m for m in route.moves if m > move), default=move)
    scene = scenes(member.run.program.moves[held].tool, held).whole
    chosen = [
        k
        for k, pair in enumerate(scene.pairs)
        if name in {scene.bodies[body].thing for body in pair}
        and {scene.bodies[body].kind for body in pair} == {BodyKind.HELD, BodyKind.OBSTACLE}
    ]
    if not chosen:
        return False
    found = scene.of_pairs(scene.pairs[chosen]).distances(end[None], 2.0 * RESTING)
    return bool((found.distance < RESTING).any())


def _unproven(
    member: StationRobot, scenes: SceneOf, way: Sequence[int], clearance: float
) -> Iterator[str]:
    """What is not proven of a way in a robot's own cell."""
    path = member.run.path
    rows = np.isin(path.sample_moves(), way)
    if not rows.any():
        return
    span = float(path.sigma[rows].min()), float(path.sigma[rows].max())
    made = certify_stretch(member.controller, member.run, scenes, clearance, [span])
    if not made.proven:
        yield f"{member.name}: {made.message}"


# Arrangements


def _part(arrangement: Iterable[PlacedPart], name: str) -> PlacedPart:
    return next(placed for placed in arrangement if placed.name == name)


def _behind(handling: Handling, change: ChangeOfHands) -> Arrangement:
    """Where parts are behind a change."""
    rest = handling.arrangements[change.move + 1 :]
    return rest[0] if rest else handling.last


def _staying(handling: Handling | None, name: str, released: ChangeOfHands) -> Handling:
    """A part stays where it is let go, until another robot has it."""
    assert handling is not None
    given = replace(_part(_behind(handling, released), name), gone=False)
    return _changed(handling, name, lambda move: move > released.move, lambda _: given)


def _moved(handling: Handling | None, name: str, fix: Pose) -> Handling:
    """A part that is elsewhere in its own frame."""
    assert handling is not None
    return _changed(
        handling, name, lambda _: True, lambda placed: replace(placed, pose=placed.pose @ fix)
    )


def _changed(
    handling: Handling,
    name: str,
    where: Callable[[int], bool],
    change: Callable[[PlacedPart], PlacedPart],
) -> Handling:
    """With a part elsewhere on some moves; moves that had one arrangement have one."""
    known: dict[tuple[int, bool], Arrangement] = {}

    def changed(move: int, arrangement: Arrangement) -> Arrangement:
        key = id(arrangement), where(move)
        if key not in known:
            known[key] = tuple(
                change(placed) if placed.name == name and key[1] else placed
                for placed in arrangement
            )
        return known[key]

    whole = (*handling.arrangements, handling.last)
    *made, last = (changed(move, arrangement) for move, arrangement in enumerate(whole))
    return replace(handling, arrangements=tuple(made), last=last)
