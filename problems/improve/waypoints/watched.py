"""The places of a path that each scene looks at, and what bodies keep from each other there.

Where a part is taken or released it touches the tool and what it rests on. Next to there such pairs
may be in each other, no deeper than the proofs let them; from where they are apart for the first
time they keep clear. That is to be not much later than in the program as it was given, or it would
be fastest to slide a part along what it stands on.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import FloatArray, IntArray
from ....core.collision.proof.certificate import SceneOf
from ....core.collision.proof.verdict import CONTACT
from ....core.collision.scene.handled_pairs import RESTING
from ....core.collision.scene.scene import CollisionScene, TouchingPairs
from .block_emulation import DrivenBlock, Driver

_LATER = 1.5
"""Times the way of a pair until it is apart that a changed program may take."""
_BEYOND = 0.1
"""m beyond what is kept, to which distances are measured to find where it is reached."""


class Watch(Protocol):
    """Places that one scene looks at.

    Attributes:
        scene: the bodies; P pairs.
        places: (k,) indices of places.
        most: m, largest distance that a pair is to keep.
    """

    @property
    def scene(self) -> CollisionScene: ...

    @property
    def places(self) -> IntArray: ...

    @property
    def most(self) -> float: ...

    def wanted(self, q: FloatArray, distance: FloatArray) -> FloatArray:
        """What pairs are to keep, m: (k, P), or (P,) for the same at all places.

        Args:
            q: (k, N), configurations at the places.
            distance: (k, P) m, measured there.
        """
        ...


@dataclass(frozen=True)
class WatchedPlaces:
    """Places at which every pair keeps its distance.

    Args:
        scene, places: see `Watch`.
        least: (P,) m.
    """

    scene: CollisionScene
    places: IntArray
    least: FloatArray

    @property
    def most(self) -> float:
        return float(self.least.max(initial=0.0))

    def wanted(self, q: FloatArray, distance: FloatArray) -> FloatArray:
        return self.least


@dataclass(frozen=True)
class TouchingPlaces:
    """Places along a way on which pairs come off each other, or on to each other.

    Args:
        scene, places: see `Watch`.
        floor: (P, 2) m, what they keep where they touch, next to the beginning and to the end of
            the way; infinite where they may not touch.
        clear: m that they keep where they are apart.
        order: (k,), the places in the order of the path.
        ends: (2, N), where the way begins and ends.
        farthest: (P, 2) m, how far pairs may be shifted against each other from how they are at
            these ends until they are apart.
    """

    scene: CollisionScene
    places: IntArray
    floor: FloatArray
    clear: float
    order: IntArray
    ends: FloatArray
    farthest: FloatArray

    @property
    def most(self) -> float:
        return self.clear

    def wanted(self, q: FloatArray, distance: FloatArray) -> FloatArray:
        least = np.full(distance.shape, self.clear)
        for end, way in ((0, self.order), (1, self.order[::-1])):
            near = self._near(distance, way)
            near &= self.scene.shifts(q, self.ends[end]) <= self.farthest[:, end]
            near &= np.isfinite(self.floor[:, end])
            least = np.where(near, np.minimum(least, self.floor[:, end]), least)
        return least

    def _near(self, distance: FloatArray, way: IntArray) -> NDArray[np.bool_]:
        """(k, P), whether pairs have not been apart yet, places taken in this order."""
        near = np.empty(distance.shape, dtype=np.bool_)
        near[way] = np.logical_and.accumulate(distance[way] < self.clear, axis=0)
        return near

    def as_given(self, q: FloatArray, distance: FloatArray) -> TouchingPlaces:
        """The same with ways that are not much longer than those of a program as it was given.

        Args:
            q, distance: see `wanted`, of that program.
        """
        farthest = np.empty_like(self.floor)
        for end, way in ((0, self.order), (1, self.order[::-1])):
            near, columns = self._near(distance, way)[way], np.arange(distance.shape[1])
            d, shift = distance[way], self.scene.shifts(q[way], self.ends[end])
            last = np.maximum(near.sum(axis=0), 1)
            apart = np.minimum(last, len(way) - 1), columns
            before = np.maximum(apart[0] - 1, 0), columns
            rise = np.maximum(d[apart] - d[before], 1e-9)
            share = np.clip((self.clear - d[before]) / rise, 0.0, 1.0)
            reach = shift[before] + share * (shift[apart] - shift[before])
            farthest[:, end] = np.where(near.all(axis=0), np.inf, _LATER * reach + RESTING)
        return TouchingPlaces(
            self.scene, self.places, self.floor, self.clear, self.order, self.ends, farthest
        )


def watch(
    first: DrivenBlock, driver: Driver, scenes: SceneOf, clearance: float, least: float
) -> tuple[Watch, ...]:
    """Which scene looks at which places of a block.

    Args:
        first: the block as it was given.
        driver: of it.
        scenes: of its moves. In a zone between moves of two scenes both look.
        clearance: m to aim at.
        least: m that is required; pairs that are nearer than aimed at where the robot stops
            need keep no more than they have there.
    """
    moves = first.path.route.moves
    count = len(moves)
    own = [scenes(driver.program.moves[i].tool, i) for i in moves]
    part = driver.places.part
    segment = np.where(part >= count, part - count, part)
    after = np.where(part >= count, segment + 1, segment)
    found: list[Watch] = []
    stops = first.path.segments.ends.q[[0, -1], [0, 1]]
    for scene in {id(scene): scene for scene in own}.values():
        owned = np.array([other is scene for other in own])
        places = np.flatnonzero(owned[segment] | owned[after])
        ends = scene.distances(stops, clearance).distance.min(axis=0, initial=clearance)
        found.append(WatchedPlaces(scene, places, np.clip(ends, least, clearance)))
    touching = {id(pairs): pairs for scene in own for pairs in scene.left_out}
    for pairs in touching.values():
        owned = np.array([any(pairs is other for other in scene.left_out) for scene in own])
        # In a zone at an end of the way they are apart, as in the other move's scene.
        places = np.flatnonzero(owned[segment] & owned[after])
        order = np.lexsort((driver.places.share[places], part[places] >= count, segment[places]))
        k = np.flatnonzero(owned)
        ends = first.path.segments.ends.q[[k[0], k[-1]], [0, 1]]
        for made in _touching(pairs, clearance, places, order, ends):
            q = first.q[places]
            within = made.most + _BEYOND
            found.append(made.as_given(q, made.scene.distances(q, within).distance))
    return tuple(found)


def _touching(
    pairs: TouchingPairs, clearance: float, places: IntArray, order: IntArray, ends: FloatArray
) -> Iterator[TouchingPlaces]:
    """Those of a way, by what tells how deep bodies are in each other."""
    floor = pairs.floor
    none = np.zeros_like(floor)
    plain = ~pairs.meshed
    for chosen, scene, floors, clear in (
        (plain, pairs.scene, floor, clearance),
        # A part that is smaller all round is out of what it may be in, and as much farther away.
        (
            pairs.meshed,
            pairs.shrunk,
            np.where(floor < 0.0, CONTACT, floor),
            clearance + 2 * RESTING,
        ),
    ):
        if scene is not None and chosen.any():
            alone = scene.of_pairs(scene.pairs[chosen])
            yield TouchingPlaces(alone, places, floors[chosen], clear, order, ends, none[chosen])
