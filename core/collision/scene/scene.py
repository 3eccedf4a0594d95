"""A cell with one tool mounted, asked for contacts, distances and their gradients."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...arrays import FloatArray
from ...cell.cell import Cell
from ...errors import InputError, Note
from ...handling.arrangement import Arrangement
from ...program.tool import FLANGE, Tool
from ...robot.model import Robot
from ..distance.answers import Contact, Distances, RecentDistances
from ..distance.closed_form import hulls_of, measure
from ..distance.coal_engine import CoalEngine
from ..distance.containment import Nesting
from ..distance.engine import BodyPoses, ContactEngine, DistanceEngine, Witness
from ..distance.fcl_engine import FclEngine
from .allowed_pairs import (
    Exclusion,
    always_touching,
    drop_own_overlaps,
    overlap_notes,
    robot_notes,
    sort_pairs,
)
from .bodies import Body, bodies_of
from .frames import FrameTree, distance_gradients, frame_tree, place_bodies
from .outline import Outlines, outlines_of
from .part_bodies import part_bodies, part_pairs, part_solids, refuse_parts

TOUCH = 1e-9
"""m within which bodies count as touching."""
CHUNK = 256
"""Configurations worked on at once."""


class TouchingPairs(NamedTuple):
    """K pairs of bodies that may touch at an end of a way: of a move, or of moves in a row.

    Args:
        scene: of these pairs alone.
        moves: indices of the way's first and last move in the program.
        floor: (K, 2) m, signed distance that they keep at least where they touch, next to the
            way's beginning and to its end; infinite where they may not touch.
        shrunk: of these pairs alone, with smaller parts; None if it is not needed.
        meshed: (K,), which of them have a depth in ``shrunk`` alone, where they keep off.
    """

    scene: CollisionScene
    moves: tuple[int, int]
    floor: FloatArray
    shrunk: CollisionScene | None
    meshed: NDArray[np.bool_]


class CollisionScene:
    """A cell with one tool mounted; it never changes.

    Args:
        cell: robot, tools, obstacles.
        tool: the mounted tool; its shape is the one that the cell has for its name.
        parts: where the cell's parts are, all of them; None for a cell without.
        smaller: m by which parts are smaller all round than the cell has them.

    Attributes:
        bodies: every solid, and what carries it.
        pairs: (P, 2) int64, the pairs that are looked at, as indices of bodies.
        exclusions: the pairs that are not, with reasons.
        frames: the frames that the bodies ride on.
        notes: what a user should know of shapes and pairs.
        left_out: the pairs that are not looked at here, as they touch at an end of a way that the
            move is of.
        whole: the scene with these, too.

    Raises:
        InputError: the robot has no shapes, the cell does not know the tool, a mesh cannot be
            used, or the cell has parts and nobody says where they are.
    """

    def __init__(
        self,
        cell: Cell,
        tool: Tool = FLANGE,
        parts: Arrangement | None = None,
        smaller: float = 0.0,
    ) -> None:
        if parts is None:
            refuse_parts(cell)
        found = bodies_of(cell, tool)
        self.cell = cell
        self.tool = tool
        self.robot: Robot = cell.robot
        self.frames: FrameTree = frame_tree(cell.robot)
        self._standing = found.bodies
        self._part_solids, odd = part_solids(cell.parts, smaller)
        self._set_bodies(parts or ())
        solids = [body.solid for body in self.bodies]
        nesting = Nesting(solids)
        self._hulls = hulls_of(solids)
        self._distances: DistanceEngine = CoalEngine(solids, nesting)
        self._contacts: ContactEngine = FclEngine(solids, nesting)
        self._recent = RecentDistances()

        pairs = sort_pairs(cell, self._standing)
        always = always_touching(self.robot, pairs.kept, self._touching)
        notes = overlap_notes(pairs, self.bodies, always)
        pairs = drop_own_overlaps(pairs, self.bodies, always)
        self._standing_pairs = pairs.kept
        self.exclusions: tuple[Exclusion, ...] = pairs.exclusions
        self.notes: tuple[Note, ...] = (
            *found.notes,
            *odd,
            *notes,
            *robot_notes(cell.robot),
        )
        self.left_out: tuple[TouchingPairs, ...] = ()
        self.whole = self
        self._set_pairs(parts or ())

    def rearranged(self, parts: Arrangement) -> CollisionScene:
        """The same scene with its parts elsewhere.

        Args:
            parts: all of them, in the order of this scene's.
        """
        other = copy(self)
        other.__dict__.pop("outlines", None)
        other._recent = RecentDistances()
        other._set_bodies(parts)
        other._set_pairs(parts)
        other.whole = other
        return other

    def leaving_out(self, touching: Sequence[TouchingPairs]) -> CollisionScene:
        """The same scene without pairs of it, which are then its ``left_out``."""
        gone = {(int(a), int(b)) for ways in touching for a, b in ways.scene.pairs}
        kept = np.array([pair not in gone for pair in self._pairs], dtype=np.bool_)
        other = self.of_pairs(self.pairs[kept])
        other.left_out, other.whole = tuple(touching), self
        return other

    def of_pairs(self, pairs: NDArray[np.int64]) -> CollisionScene:
        """The same scene with other pairs (P, 2) of its bodies."""
        other = copy(self)
        other._recent = RecentDistances()
        other.pairs = pairs
        other._pairs = [(int(a), int(b)) for a, b in pairs]
        other.left_out, other.whole = (), other
        return other

    def _set_bodies(self, parts: Arrangement) -> None:
        """Put all bodies in their places."""
        placed = part_bodies(self.robot, parts, self._part_solids)
        self.bodies: tuple[Body, ...] = (*self._standing, *placed)
        self._carriers = np.array([body.frame for body in self.bodies], dtype=np.int64)
        places = np.array([body.placement.matrix() for body in self.bodies])
        self._rotation = np.ascontiguousarray(places[:, :3, :3])
        self._translation = np.ascontiguousarray(places[:, :3, 3])

    def _set_pairs(self, parts: Arrangement) -> None:
        """Find the pairs of parts, those that always overlap the arm which holds them left out."""
        gone = frozenset(placed.name for placed in parts if placed.gone)
        pairs = part_pairs(self.cell, self.bodies, len(self._standing), gone)
        own = np.array([self.bodies[a].own and self.bodies[b].own for a, b in pairs], dtype=bool)
        own[own] = always_touching(self.robot, pairs[own], self._touching)
        self.pairs: NDArray[np.int64] = np.concatenate([self._standing_pairs, pairs[~own]])
        self._pairs = [(int(a), int(b)) for a, b in self.pairs]

    @property
    def body_names(self) -> tuple[str, ...]:
        """Names of the bodies."""
        return tuple(body.name for body in self.bodies)

    @cached_property
    def outlines(self) -> Outlines:
        """The bodies' supports, for proofs between configurations."""
        return outlines_of(self.bodies)

    def pair_names(self, pair: int) -> tuple[str, str]:
        """Names of the two bodies in row ``pair`` of `pairs`."""
        a, b = self.pairs[pair]
        return self.bodies[a].name, self.bodies[b].name

    def distances(
        self, q: ArrayLike, within: float = math.inf, costly_within: float = math.inf
    ) -> Distances:
        """Signed distances of all pairs at configurations q (M, N).

        Args:
            q: rad or m.
            within: m; pairs at least this far apart are only said to be so.
            costly_within: m, the same for pairs that no closed form tells, such as meshes: a
                thousand times as costly as the others.

        Returns:
            arrays that cannot be written to; recent answers are kept.
        """
        rows = self._rows(q)
        costly = min(within, costly_within)
        key = (rows.tobytes(), within, costly)
        return self._recent.get(key, lambda: self._measure(rows, within, costly))

    def chosen_distances(
        self, q: ArrayLike, which: tuple[ArrayLike, ArrayLike], within: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Signed distances (K,) m of chosen pairs at chosen configurations, and normals (K, 3).

        Args:
            q: (M, N) rad or m.
            which: samples (K,), rising, and pairs (K,).
            within: m, (K,) or one for all; pairs at least this far apart are only said to be so,
                with no normal.
        """
        rows = self._rows(q)
        samples, pairs = (np.asarray(index, dtype=np.int64) for index in which)
        distance = np.array(np.broadcast_to(within, samples.shape), dtype=float)
        normal = np.zeros((len(samples), 3))
        for start in range(0, len(rows), CHUNK):
            part = slice(*np.searchsorted(samples, [start, start + CHUNK]))
            self._choose(
                rows[start : start + CHUNK],
                samples[part] - start,
                pairs[part],
                distance[part],
                normal[part],
            )
        return distance, normal

    def _choose(
        self,
        q: FloatArray,
        samples: NDArray[np.int64],
        pairs: NDArray[np.int64],
        distance: FloatArray,
        normal: FloatArray,
    ) -> None:
        """Put measured distances (K,) and normals (K, 3) where pairs are nearer than said."""
        if not len(samples):
            return
        R, p = self._place(q)
        used, column = np.unique(pairs, return_inverse=True)
        found, bound = self._closed_forms(R, p, self.pairs[used], float(distance.max()))
        nearer = found.distance[samples, column] < distance
        distance[nearer] = found.distance[samples, column][nearer]
        normal[nearer] = found.normal[samples, column][nearer]
        for k in np.flatnonzero(bound[samples, column] < distance).tolist():
            m = samples[k]
            a, b = self._pairs[pairs[k]]
            witness = self._distances.distance(a, b, BodyPoses(R[m], p[m]), float(distance[k]))
            if witness is not None:
                distance[k], normal[k] = witness.distance, witness.normal

    def clearance(self, q: ArrayLike, within: float = math.inf) -> FloatArray:
        """Least signed distance (M,) m over all pairs, ``within`` where it is more.

        Args:
            q: (M, N) rad or m.
            within: m.
        """
        chunks = [self._least(rows, within) for rows in _chunks(self._rows(q))]
        return np.concatenate([np.empty(0), *chunks])

    def nearest(
        self, q: ArrayLike, pairs: NDArray[np.int64], within: float = math.inf
    ) -> tuple[float, int, int] | None:
        """The least signed distance of chosen pairs over all configurations q (M, N).

        Args:
            q: rad or m.
            pairs: (K,), rows of `pairs`.
            within: m.

        Returns:
            distance in m, sample and row of `pairs`; None if all are at least ``within`` apart. Of
            several pairs that overlap it need not be that which is deepest, where one is a mesh.
        """
        rows = self._rows(q)
        least: tuple[float, int, int] | None = None
        for start in range(0, len(rows) if len(pairs) else 0, CHUNK):
            R, p = self._place(rows[start : start + CHUNK])
            found, bound = self._closed_forms(R, p, self.pairs[pairs], within)
            m, k = np.unravel_index(int(found.distance.argmin()), found.distance.shape)
            if found.distance[m, k] < within:
                within = float(found.distance[m, k])
                least = within, start + int(m), int(pairs[k])
            places = _Places(R, p)
            left = np.argwhere(bound < within)
            for m, k in left[np.argsort(bound[tuple(left.T)])].tolist():
                if not bound[m, k] < within:
                    break
                a, b = self._pairs[pairs[k]]
                witness = self._distances.distance(a, b, places[m], within)
                if witness is not None:
                    within = float(witness.distance)
                    least = within, start + m, int(pairs[k])
        return least

    def gradients(
        self, q: ArrayLike, found: Distances, which: tuple[ArrayLike, ArrayLike]
    ) -> FloatArray:
        """Gradients ∂d/∂q = n · (J_a - J_b) of K of the distances, (K, N) m per rad or m.

        Zero where the pair is farther than was asked for; see `Distances.measured` for bodies
        that overlap without a depth.

        Args:
            q: (M, N), where ``found`` was measured.
            found: of `distances`.
            which: samples (K,) and pairs (K,), as `numpy.nonzero` gives them.
        """
        samples, pairs = (np.asarray(index, dtype=np.int64) for index in which)
        frames = self._carriers[self.pairs[pairs]]
        gradients = distance_gradients(
            self.frames,
            self._rows(q)[samples],
            frames[:, 0],
            frames[:, 1],
            found.point_a[samples, pairs],
            found.point_b[samples, pairs],
            found.normal[samples, pairs],
        )
        return np.asarray(gradients)

    def shifts(self, q: ArrayLike, start: ArrayLike) -> FloatArray:
        """How far the bodies of each pair are shifted against each other, (M, P) m.

        Args:
            q: (M, N) rad or m.
            start: (N,), from where they are there.
        """
        rows = self._rows(np.concatenate([np.asarray(start)[None], self._rows(q)]))
        R, p = self._place(rows)
        shifted = np.zeros((len(rows) - 1, len(self.pairs)))
        for one, other in (self.pairs.T, self.pairs.T[::-1]):
            seen = np.einsum("mpji,mpj->mpi", R[:, one], p[:, other] - p[:, one])
            shifted = np.maximum(shifted, np.linalg.norm(seen[1:] - seen[0], axis=2))
        return shifted

    def collides(self, q: ArrayLike) -> NDArray[np.bool_]:
        """Whether anything touches, (...,) bool for q (..., N)."""
        values = np.asarray(q, dtype=float)
        if values.ndim == 0:
            raise InputError(self._misfit(values.shape))
        rows = self._rows(values.reshape(-1, values.shape[-1]))
        hits = [self._hits(part) for part in _chunks(rows)]
        return np.concatenate([np.empty(0, dtype=np.bool_), *hits]).reshape(values.shape[:-1])

    def contact(self, q: ArrayLike) -> Contact | None:
        """Two bodies that touch at one configuration q (N,), None if nothing does.

        Of simple shapes it is the pair that overlaps most.
        """
        R, p = self._place(self._rows(np.asarray(q, dtype=float)[None]))
        places = BodyPoses(R[0], p[0])
        found, bound = self._closed_forms(R, p, self.pairs, TOUCH)
        if (found.distance < TOUCH).any():
            pair = int(found.distance[0].argmin())
            return Contact.of(*self.pair_names(pair), found.at(0, pair))
        for pair in np.argsort(bound[0]).tolist():
            a, b = self._pairs[pair]
            if bound[0, pair] < TOUCH and self._contacts.touch(a, b, places):
                return Contact.of(*self.pair_names(pair), self._witness(a, b, places))
        return None

    def witness(self, q: ArrayLike, pair: int) -> Witness:
        """Distance and nearest points of the bodies in row ``pair`` of `pairs` at q (N,)."""
        R, p = self._place(self._rows(np.asarray(q, dtype=float)[None]))
        return self._witness(*self._pairs[pair], BodyPoses(R[0], p[0]))

    def _witness(self, a: int, b: int, places: BodyPoses) -> Witness:
        witness = self._distances.distance(a, b, places, math.inf)
        assert witness is not None, "only distances of infinity and more are left out"
        return witness

    def _misfit(self, shape: tuple[int, ...]) -> str:
        return (
            f"robot {self.robot.name} has {self.robot.size} axes "
            f"({', '.join(self.robot.axis_names)}); configurations of shape {shape} do not fit"
        )

    def _rows(self, q: ArrayLike) -> FloatArray:
        rows = np.ascontiguousarray(q, dtype=float)
        if rows.ndim != 2 or rows.shape[1] != self.robot.size:
            raise InputError(self._misfit(rows.shape))
        if not np.isfinite(rows).all():
            raise InputError("a configuration holds numbers that are not finite")
        return rows

    def _place(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Places of all bodies: rotations (M, B, 3, 3) and positions (M, B, 3)."""
        R, p = place_bodies(self.frames, self._carriers, self._rotation, self._translation, q)
        return R, p

    def _closed_forms(
        self, R: FloatArray, p: FloatArray, pairs: NDArray[np.int64], within: float
    ) -> tuple[Distances, FloatArray]:
        """What closed forms tell, and lower bounds (M, P) of what is left, infinite where far."""
        found = Distances.farther(len(R), len(pairs), within)
        return found, measure(self._hulls, pairs, R, p, within, found.numbers)

    def _measure(self, q: FloatArray, within: float, costly: float) -> Distances:
        R, p = self._place(q)
        found, bound = self._closed_forms(R, p, self.pairs, within)
        # Infinite bounds are of pairs that closed forms have told.
        left = np.isfinite(bound)
        found.distance[left] = np.clip(bound[left], costly, within)
        places = _Places(R, p)
        for m, k in np.argwhere(bound < costly).tolist():
            witness = self._distances.distance(*self._pairs[k], places[m], costly)
            if witness is not None:
                found.put(m, k, witness)
        return found

    def _least(self, q: FloatArray, within: float) -> FloatArray:
        """The least distance (M,): pairs in order of their bounds, as long as they may be less."""
        R, p = self._place(q)
        found, bound = self._closed_forms(R, p, self.pairs, within)
        least = np.asarray(found.distance.min(axis=1, initial=within))
        places = _Places(R, p)
        samples, pairs = np.nonzero(bound < least[:, None])
        order = np.lexsort((bound[samples, pairs], samples))
        for m, k in zip(samples[order].tolist(), pairs[order].tolist(), strict=True):
            if bound[m, k] < least[m]:
                a, b = self._pairs[k]
                witness = self._distances.distance(a, b, places[m], float(least[m]))
                least[m] = least[m] if witness is None else witness.distance
        return least

    def _hits(self, q: FloatArray) -> NDArray[np.bool_]:
        """Whether anything touches, (M,)."""
        R, p = self._place(q)
        found, bound = self._closed_forms(R, p, self.pairs, TOUCH)
        hit = np.asarray((found.distance < TOUCH).any(axis=1))
        places = _Places(R, p)
        for m, k in np.argwhere((bound < TOUCH) & ~hit[:, None]).tolist():
            hit[m] = hit[m] or self._contacts.touch(*self._pairs[k], places[m])
        return hit

    def _touching(self, q: FloatArray, pairs: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether pairs (P, 2) of bodies touch, (M, P)."""
        R, p = self._place(q)
        found, bound = self._closed_forms(R, p, pairs, TOUCH)
        touching = found.distance < TOUCH
        places = _Places(R, p)
        for m, k in np.argwhere(bound < TOUCH).tolist():
            a, b = pairs[k].tolist()
            touching[m, k] = self._contacts.touch(a, b, places[m])
        return touching


class _Places(dict[int, BodyPoses]):
    """The places of the bodies in each configuration, made where they are asked for.

    One object a configuration: engines keep what they make of it.
    """

    def __init__(self, R: FloatArray, p: FloatArray) -> None:
        super().__init__()
        self._R, self._p = R, p

    def __missing__(self, m: int) -> BodyPoses:
        made = self[m] = BodyPoses(self._R[m], self._p[m])
        return made


def _chunks(rows: FloatArray) -> Iterator[FloatArray]:
    return (rows[k : k + CHUNK] for k in range(0, len(rows), CHUNK))
