"""What a motion has to keep clear of, and its distances linearised at places of the motion."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .....core.arrays import FloatArray, IntArray
from .....core.collision.scene.scene import CollisionScene
from .....core.errors import InputError
from ..motion.layout import VariableLayout
from ..motion.motion import Motion
from ..task.task import MotionTask
from ..transcription.rows import MotionRows, place_rows

_MARGIN = 5e-5
"""m beyond the clearance that are aimed at, so that the proof ends."""
_CURVED = 1.5
"""How much nearer than the linear model says a pair may come within the box."""
_FLAT = 1e-9
_SAGGING = 0.02
"""m within which it is looked how much nearer pairs come between places."""
_MORE = 1.2
_REACH = 3.0
"""m per rad within which pairs are measured at all."""
_FEW, _FAR, _NEAR = 50, 0.5, 0.1
"""Pairs up to which all within the first number of metres are measured; else the second."""


@dataclass(frozen=True)
class Surroundings:
    """A cell with a tool.

    Args:
        scene: bodies and their distances.
        clearance: m to be kept everywhere.

    Raises:
        InputError: the clearance is negative or not finite.
    """

    scene: CollisionScene
    clearance: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.clearance < math.inf:
            raise InputError(f"Surroundings.clearance is zero or more metres, not {self.clearance}")

    @property
    def wanted(self) -> float:
        """m that is aimed at."""
        return self.clearance + _MARGIN

    @property
    def reach(self) -> float:
        """m within which distances are measured; a pair that comes nearer from farther away is
        met when a motion is looked at."""
        return _FAR if len(self.scene.pairs) <= _FEW else _NEAR


@dataclass(frozen=True)
class Instants:
    """Instants of a motion: (M,) pieces and shares of them."""

    interval: IntArray
    share: FloatArray

    @classmethod
    def even(cls, pieces: int, parts: int) -> Instants:
        """``parts`` on every piece, its beginning included."""
        share = np.tile(np.arange(parts) / parts, pieces)
        return cls(np.repeat(np.arange(pieces), parts), share)

    def of(self, task: MotionTask, motion: Motion) -> FloatArray:
        """(M, N), all joints there."""
        powers = self.share[:, None] ** np.arange(motion.coefficients.shape[1])
        return task.whole(np.einsum("mc,mcn->mn", powers, motion.coefficients[self.interval]))

    def time(self, motion: Motion) -> FloatArray:
        """(M,) s."""
        return motion.knots[self.interval] + self.share * motion.durations[self.interval]


@dataclass(frozen=True)
class Linearised:
    """Distances of pairs at places, linear in the configuration.

    Every place has the same number of slots, so that the program's pattern stays what it is from
    one outer iteration to the next; slots that are not needed say nothing.

    Args:
        places: M of them.
        pair: (M, S), rows of the scene's pairs; −1 for an empty slot.
        distance: (M, S) m.
        normal: (M, S, n), by the joints that move; zero in empty slots.
        q: (M, n), configurations there.
    """

    places: Instants
    pair: IntArray
    distance: FloatArray
    normal: FloatArray
    q: FloatArray

    @property
    def count(self) -> int:
        """Number of distances."""
        return int((self.pair >= 0).sum())

    def rows(
        self,
        layout: VariableLayout,
        wanted: float,
        keep: FloatArray,
        sag: FloatArray,
        extra: FloatArray,
    ) -> MotionRows:
        """Constraints that say so.

        Args:
            layout: the variables.
            wanted: m.
            keep: (M, S) m, distances of the motion that is to satisfy the rows: what is a little
                nearer than wanted already may stay so.
            sag: (M, S) m, how much nearer pairs come beside the places.
            extra: (M, S) m on top.
        """
        slots = self.pair.shape[1]
        at = np.sum(self.normal * self.q[:, None], axis=2)
        least = at + np.minimum(wanted + sag, keep) + extra - self.distance
        least = np.where(self.pair >= 0, least, -np.inf)
        return place_rows(
            layout,
            np.repeat(self.places.interval, slots),
            np.repeat(self.places.share, slots),
            self.normal.reshape(-1, self.normal.shape[2]),
            least.ravel(),
        )

    def at(self, q: FloatArray) -> FloatArray:
        """(M, S) m, the linear distances at other configurations (M, n)."""
        return np.asarray(self.distance + np.einsum("msn,mn->ms", self.normal, q - self.q))


def linearised(
    task: MotionTask,
    around: Surroundings,
    q: FloatArray,
    places: Instants,
    box: float,
    slots: int,
) -> Linearised:
    """The distances that can matter within a box about configurations.

    Args:
        task, around: what is looked at.
        q: (M, N), where distances are linearised for each place.
        places: M of them.
        box: rad or m by which each joint may move.
        slots: pairs looked at in each place: those that could come nearest.
    """
    within = min(around.reach, around.wanted + _REACH * box)
    found = around.scene.distances(q, within)
    sample, pair = np.nonzero(found.distance < within)
    normal = around.scene.gradients(q, found, (sample, pair))[:, task.moving]
    distance = found.distance[sample, pair]
    steep = np.abs(normal).sum(axis=1)
    least = distance - _CURVED * box * steep
    kept = np.flatnonzero((least < around.wanted) & (steep > _FLAT))
    kept = kept[np.lexsort((least[kept], sample[kept]))]
    sample, pair, distance, normal = sample[kept], pair[kept], distance[kept], normal[kept]
    rank = np.arange(len(sample)) - np.searchsorted(sample, sample)
    fits = rank < slots
    sample, rank = sample[fits], rank[fits]
    shape = (len(q), slots)
    pairs = np.full(shape, -1, dtype=np.int64)
    distances, normals = np.zeros(shape), np.zeros((*shape, len(task.moving)))
    pairs[sample, rank] = pair[fits]
    distances[sample, rank], normals[sample, rank] = distance[fits], normal[fits]
    return Linearised(places, pairs, distances, normals, q[:, task.moving])


def sags(
    task: MotionTask, around: Surroundings, motion: Motion, cuts: Linearised, parts: int
) -> FloatArray:
    """(M, S) m, how much nearer each pair comes between a place and its neighbours than there.

    Args:
        task, around, motion: what is looked at.
        cuts: places, even ones on every piece, and pairs.
        parts: places looked at on every piece, a multiple of those of the cuts.
    """
    dense = Instants.even(len(motion), parts)
    distance = around.scene.distances(dense.of(task, motion), around.wanted + _SAGGING).distance
    count = len(cuts.places.share)
    step = len(dense.share) // count
    rows = np.arange(count)[:, None] * step + np.arange(1 - step, step)
    rows = np.clip(rows, 0, len(dense.share) - 1)
    pair = np.maximum(cuts.pair, 0)
    beside = distance[rows[:, :, None], pair[:, None, :]].min(axis=1)
    own = distance[np.arange(count)[:, None] * step, pair]
    return np.where(cuts.pair >= 0, own - beside, 0.0)


@dataclass(frozen=True)
class Breach:
    """Places of a motion at which pairs are too near.

    Args:
        places: (B,) of them.
        pair: (B,), rows of the scene's pairs.
        distance: (B,) m.
        normal: (B, n), its derivative by the joints that move.
        q: (B, n), configurations there.
    """

    places: Instants
    pair: IntArray
    distance: FloatArray
    normal: FloatArray
    q: FloatArray

    def blamed(
        self, cuts: Linearised, extra: FloatArray, wanted: float
    ) -> tuple[Linearised, FloatArray]:
        """Cuts, and what they have to keep on top (M, S) m, after a motion has been too near.

        The places on both sides have to keep more of the pair by what is missing; where the pair
        is not looked at yet it takes the place of the one that is farthest.
        """
        extra = extra.copy()
        pair, distance, normal = cuts.pair.copy(), cuts.distance.copy(), cuts.normal.copy()
        at = cuts.places.interval + cuts.places.share
        spacing = 1.0 / max(1, int(np.sum(cuts.places.interval == 0)))
        where = self.places.interval + self.places.share
        missing = _MORE * np.maximum(wanted - self.distance, 0.0)
        more = np.zeros(extra.shape)
        for b in range(len(where)):
            for m in np.flatnonzero(np.abs(at - where[b]) < spacing + 1e-9):
                known = np.flatnonzero(pair[m] == self.pair[b])
                if len(known):
                    more[m, known[0]] = max(more[m, known[0]], missing[b])
                    continue
                slack = np.where(pair[m] < 0, np.inf, distance[m] - extra[m] - more[m])
                slot = int(slack.argmax())
                pair[m, slot], normal[m, slot] = self.pair[b], self.normal[b]
                # The same tangent plane, written about the place's own configuration.
                distance[m, slot] = self.distance[b] + self.normal[b] @ (cuts.q[m] - self.q[b])
                extra[m, slot] = more[m, slot] = 0.0
        return replace(cuts, pair=pair, distance=distance, normal=normal), extra + more


def breaches(
    task: MotionTask, around: Surroundings, motion: Motion, places: Instants, within: float
) -> Breach | None:
    """Where a motion has pairs nearer than ``within`` m at places; None if nowhere."""
    q = places.of(task, motion)
    found = around.scene.distances(q, within)
    sample, pair = np.nonzero(found.distance < within)
    if not len(sample):
        return None
    normal = around.scene.gradients(q, found, (sample, pair))[:, task.moving]
    return Breach(
        Instants(places.interval[sample], places.share[sample]),
        pair,
        found.distance[sample, pair],
        normal,
        q[sample][:, task.moving],
    )
