"""Pairs of bodies that touch because a part is taken there, or released."""

from __future__ import annotations

import math
from collections.abc import Callable, Set
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...handling.handling import Handling
from ..distance.solid import TriangleMesh
from .bodies import BodyKind
from .scene import TOUCH, CollisionScene, TouchingPairs

RESTING = 2e-3
"""m by which a part may be off, or in, what it rests on where it is taken or released."""
BESIDE = 0.01
"""m within which a part may be beside what it does not touch there, as in a holder."""
APART = 1e-3
"""m beyond what has to be kept, from which pairs that touched count as apart."""

_FAR = 0.02
"""m that a tool is moved along a part, and twice its depth, before it has come out of it by
`RESTING`."""


class AtHandling(NamedTuple):
    """Pairs that may touch at an end of a move where parts are taken or released.

    Args:
        pairs: (K, 2), as indices of bodies.
        floor: (K, 2) m, next to the move's beginning and to its end, see `TouchingPairs`.
    """

    pairs: IntArray
    floor: FloatArray


def pairs_at_handling(
    scene: CollisionScene, handling: Handling, move: int, ends: FloatArray, clearance: float
) -> AtHandling:
    """The pairs that may touch at the ends of a move.

    That is the tool and a part that it takes at the move's end or has released at its beginning,
    and a part that is carried with what it rests on there. A part goes no deeper than `RESTING`
    into what it rests on, and a tool no deeper into a part than where it takes or releases it and
    as much more. What a part is beside there, nearer than the clearance and `BESIDE`, it does not
    touch.

    Args:
        scene: with the parts where they are on the move.
        handling: of the program.
        move: index in the program.
        ends: (2, N), where the move begins and ends.
        clearance: m, kept where pairs are apart.
    """
    at_end = handling.before[move], handling.behind[move]
    rows = _rows_of(scene, at_end[0] | at_end[1])
    floors = [
        _floors(scene, rows, names, q, clearance) for names, q in zip(at_end, ends, strict=True)
    ]
    floor = np.stack(floors, axis=1)
    chosen = np.isfinite(floor).any(axis=1)
    return AtHandling(scene.pairs[rows[chosen]], floor[chosen])


def touching_pairs(
    scene: CollisionScene,
    moves: tuple[int, int],
    pairs: IntArray,
    floor: FloatArray,
    shrunk: Callable[[], CollisionScene],
) -> TouchingPairs:
    """Pairs (K, 2) of a scene that may touch at an end of a way.

    Args:
        scene: of one of the way's moves.
        moves, floor: see `TouchingPairs`.
        shrunk: gives the same scene with parts smaller by `RESTING`.
    """
    meshed = np.array(
        [any(isinstance(scene.bodies[k].solid, TriangleMesh) for k in pair) for pair in pairs]
    )
    meshed &= (floor < 0.0).any(axis=1)
    smaller = shrunk().of_pairs(pairs) if meshed.any() else None
    return TouchingPairs(scene.of_pairs(pairs), moves, floor, smaller, meshed)


def _rows_of(scene: CollisionScene, names: Set[str]) -> IntArray:
    """Rows of the pairs of parts with these names, and what takes them or what is not carried."""
    rows: list[int] = []
    things = np.array([body.thing in names for body in scene.bodies])
    for row in np.flatnonzero(things[scene.pairs].any(axis=1)).tolist():
        first, second = (scene.bodies[k] for k in scene.pairs[row])
        gripped = first.kind is BodyKind.TOOL and second.kind is BodyKind.PART and first.own
        held = any(b.kind is BodyKind.HELD and b.thing in names for b in (first, second))
        if gripped or (held and first.own != second.own):
            rows.append(row)
    return np.array(rows, dtype=np.int64)


def _floors(
    scene: CollisionScene, rows: IntArray, names: Set[str], q: FloatArray, clearance: float
) -> FloatArray:
    """See ``floor`` of `TouchingPairs`, of one end of the move."""
    within = max(RESTING, min(clearance, BESIDE))
    distance, _ = scene.chosen_distances(q[None], (np.zeros_like(rows), rows), within)
    floor = np.full(len(rows), math.inf)
    bodies = [[scene.bodies[k] for k in scene.pairs[row]] for row in rows]
    deepest: dict[tuple[str, str], float] = {}
    for (first, second), d in zip(bodies, distance.tolist(), strict=True):
        key = first.thing, second.thing
        deepest[key] = min(deepest.get(key, 0.0), d)
    for k, (first, second) in enumerate(bodies):
        if first.kind is BodyKind.TOOL and second.kind is BodyKind.PART:
            if second.thing in names:
                floor[k] = deepest[first.thing, second.thing] - RESTING
        elif distance[k] < within:
            held = first if first.kind is BodyKind.HELD else second
            if held.thing in names:
                floor[k] = -RESTING if distance[k] < RESTING else TOUCH
    return floor


class ApartRows(NamedTuple):
    """Which of M samples along a way K pairs are apart at, from the first to the last.

    Args:
        first, last: (K,); a pair that never comes apart has its first behind its last.
    """

    first: IntArray
    last: IntArray

    @property
    def never(self) -> NDArray[np.bool_]:
        """Which pairs are apart at no sample, (K,)."""
        return self.first > self.last


def apart_rows(distance: FloatArray, limit: float, floor: FloatArray) -> ApartRows:
    """Where pairs that touch at an end of a way are apart.

    Args:
        distance: (M, K) m, along the way.
        limit: m, from which on they count as apart.
        floor: see `TouchingPairs`.
    """
    apart = distance >= limit
    some = apart.any(axis=0)
    count = len(distance)
    first = np.where(np.isfinite(floor[:, 0]), apart.argmax(axis=0), 0)
    last = np.where(np.isfinite(floor[:, 1]), count - 1 - apart[::-1].argmax(axis=0), count - 1)
    return ApartRows(np.where(some, first, count), np.where(some, last, -1))


def least_kept(
    touching: TouchingPairs, q: FloatArray, distance: FloatArray, apart: ApartRows
) -> FloatArray:
    """Signed distances (M, K) m that pairs keep along a way where they touch; infinite elsewhere.

    Next to its ends that is the floor. Farther on it is how far the two things have come apart
    already, less `RESTING`: a tool that draws back from a part does not go into it again. Nor does
    it go on across it: moved by more than it takes to get out, it has begun to.

    Args:
        touching: pairs that may touch at an end of the way.
        q: (M, N), along it.
        distance: (M, K) m, there.
        apart: where they are apart.
    """
    scene, floor = touching.scene, touching.floor
    bodies = [[scene.bodies[k] for k in pair] for pair in scene.pairs.tolist()]
    things = [tuple(body.thing for body in pair) for pair in bodies]
    both = np.empty_like(distance)
    for names in set(things):
        alike = [pair == names for pair in things]
        both[:, alike] = distance[:, alike].min(axis=1, keepdims=True)
    drawn = np.array([all(body.kind is not BodyKind.HELD for body in pair) for pair in bodies])
    # How deep something goes into a mesh is not known, and what is only beside a part is so on.
    steady = touching.meshed | (floor >= 0.0).T
    row = np.arange(len(q))[:, None]
    least = np.full_like(distance, math.inf)
    for end, at in ((0, row < apart.first), (-1, row > apart.last)):
        step = 1 if end == 0 else -1
        come = np.maximum.accumulate(both[::step], axis=0)[::step]
        come = come - np.maximum(both[end], 0.0) - RESTING
        deep = np.minimum(both[end], 0.0)
        across = drawn & (scene.shifts(q, q[end]) > _FAR - 2.0 * deep)
        come = np.maximum(come, np.where(across, deep + RESTING, -math.inf))
        kept = np.where(steady[end], floor[:, end], np.maximum(floor[:, end], come))
        least = np.where(at, np.minimum(least, kept), least)
    return least


def counted_distances(touching: TouchingPairs, q: FloatArray, clearance: float) -> FloatArray:
    """Signed distances (M, K) m at samples along a way, as far as they count; infinite elsewhere.

    They do where pairs that were apart do not keep the clearance, and where they are deeper in each
    other than they may be.

    Args:
        touching: pairs that may touch at an end of the way.
        q: (M, N), along all of it.
        clearance: m, kept where they are apart.
    """
    distance = touching.scene.distances(q, clearance + APART).distance
    apart = apart_rows(distance, clearance + APART, touching.floor)
    row = np.arange(len(q))[:, None]
    touches = (row < apart.first) | (row > apart.last)
    least = least_kept(touching, q, distance, apart)
    deep = distance < least
    if touching.shrunk is not None:
        into_mesh = touching.meshed & (least < 0.0)
        deep[into_mesh] = touching.shrunk.distances(q, APART).distance[into_mesh] <= 0.0
    near = distance < max(clearance, TOUCH)
    return np.where(np.where(touches, deep, near), distance, math.inf)
