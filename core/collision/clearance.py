"""How near a driven program comes: to the cell, and with the arm's own parts to each other.

Looked at in small steps along the path, and closer where it is nearest: no proof, which is
`flyby.core.collision.proof`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import BoolArray, FloatArray
from ..cell.cell import Cell
from ..errors import InputError, Note
from ..handling.handling import Handling
from ..motion.path.path import Path
from ..program.program import Program
from ..program.tool import Tool
from .handled_scenes import HandledScenes, PartScenes
from .proof.certificate import SceneOf
from .scene.handled_pairs import counted_distances
from .scene.scene import TOUCH, CollisionScene, TouchingPairs

STEP = 0.01
"""rad (or m of a linear axis) from one configuration that is looked at to the next, about."""
_BETWEEN = 16
"""Configurations looked at on each side of the sample that is nearest."""


@dataclass(frozen=True, slots=True)
class Approach:
    """Where two bodies come near each other.

    Args:
        distance: m; negative by the depth where they overlap.
        pair: names of the bodies.
        move: index in the program.
    """

    distance: float
    pair: tuple[str, str]
    move: int

    @property
    def overlaps(self) -> bool:
        """Whether they touch."""
        return self.distance < TOUCH

    def __str__(self) -> str:
        first, second = self.pair
        if not self.overlaps:
            return f"{1e3 * self.distance:.1f} mm between {first} and {second}"
        # Where the surface of a mesh is cut there is no depth.
        depth = f" by {-1e3 * self.distance:.1f} mm" if self.distance < -1e-6 else ""
        return f"none, {first} and {second} overlap{depth}"


@dataclass(frozen=True, slots=True)
class MoveClearance:
    """How near one move comes; None where all is farther than was asked for.

    Args:
        move: index in the program.
        cell: of arm, tool and what is carried to what stands or lies around.
        own: of the arm's links, the tool and what is carried to each other.
    """

    move: int
    cell: Approach | None
    own: Approach | None


class NearestToCell(NamedTuple):
    """What is nearest at M samples.

    Args:
        distance: (M,) m; infinite where all is farther than was looked.
        first, second: (M, 3) m in the world, the nearest points; not numbers where there are none.
        pairs: names of the two bodies; None where there are none.
    """

    distance: FloatArray
    first: FloatArray
    second: FloatArray
    pairs: list[tuple[str, str] | None]

    @classmethod
    def none(cls, count: int) -> NearestToCell:
        """Nothing near at so many samples."""
        far = np.full(count, math.inf)
        return cls(
            far, np.full((count, 3), math.nan), np.full((count, 3), math.nan), [None] * count
        )


class ClearanceMeter:
    """Looks at runs of one program in its cell.

    Args:
        cell: what stands around.
        program: the whole program, as it was read.
        handling: where the cell's parts are; None for a cell without.
    """

    def __init__(self, cell: Cell, program: Program, handling: Handling | None = None) -> None:
        self._cell = cell
        self._program = program
        self._handling = handling
        self._scenes: dict[Tool, CollisionScene | None] = {}
        self._parts = PartScenes(cell)
        self.notes: list[Note] = []

    def over(self, path: Path, first: int, within: float = math.inf) -> list[MoveClearance]:
        """How near each move of a path comes.

        Args:
            path: of moves in a row.
            first: index of the first of them in the whole program.
            within: m; what is farther is left out. So is what is farther than the least so far and
                than the cell's own clearance.

        Raises:
            InputError: a mesh cannot be used.
        """
        found: list[MoveClearance] = []
        limits = [within, within]
        owners = path.sample_moves()
        rows = {
            first + move: _rows_of(path, owners == move) for move in dict.fromkeys(owners.tolist())
        }
        scenes, counted = self._along(path, first), dict[int, FloatArray]()
        for move, q in rows.items():
            scene = self._scene(scenes, move)
            if scene is None:
                continue
            own = _own_pairs(scene)
            told: list[Approach | None] = []
            for side, chosen in enumerate((~own, own)):
                pairs = np.flatnonzero(chosen)
                near = max(limits[side], min(self._cell.clearance, within))
                met = self._nearest(scene, q, pairs, near)
                for touching in () if side else scene.left_out:
                    met = self._or_touching(met, touching, move, rows, counted, near)
                told.append(None if met is None else Approach(*met, move))
                limits[side] = min(limits[side], math.inf if met is None else met[0])
            found.append(MoveClearance(move, *told))
        return found

    def along(
        self,
        paths: Iterable[tuple[Path, int]],
        q: FloatArray,
        moves: Sequence[int],
        within: float,
    ) -> NearestToCell:
        """What of the cell is nearest to the arm and what it carries, sample by sample.

        Args:
            paths: of the program's driven parts, and the index of the first move of each.
            q: (M, N) rad or m.
            moves: (M,), index in the program of the move that each sample is of.
            within: m; what is farther is left out.

        Raises:
            InputError: a mesh cannot be used.
        """
        found = NearestToCell.none(len(q))
        owners = np.asarray(moves, dtype=np.int64)
        scenes: dict[int, SceneOf | None] = {}
        for path, first in paths:
            made = self._along(path, first)
            scenes.update((first + move, made) for move in path.route.moves)
        for move in dict.fromkeys(owners.tolist()):
            scene = self._scene(scenes.get(move), move)
            if scene is None:
                continue
            rows = np.flatnonzero(owners == move)
            pairs = np.flatnonzero(~_own_pairs(scene))
            for row in rows.tolist():
                met = scene.nearest(q[row : row + 1], pairs, within)
                if met is not None:
                    witness = scene.witness(q[row], met[2])
                    found.distance[row] = met[0]
                    found.first[row], found.second[row] = witness.point_a, witness.point_b
                    found.pairs[row] = scene.pair_names(met[2])
        return found

    def _nearest(
        self, scene: CollisionScene, q: FloatArray, pairs: NDArray[np.int64], within: float
    ) -> tuple[float, tuple[str, str]] | None:
        """The least over samples (M, N), and round the nearest of them."""
        met = scene.nearest(q, pairs, within)
        if met is None:
            return None
        distance, sample, pair = met
        ends = [q[k] for k in (sample - 1, sample + 1) if 0 <= k < len(q)]
        between = [np.linspace(q[sample], end, _BETWEEN + 1, endpoint=False)[1:] for end in ends]
        if between:
            closer = scene.nearest(np.concatenate(between), pairs, distance)
            if closer is not None:
                distance, _, pair = closer
        return distance, scene.pair_names(pair)

    def _or_touching(
        self,
        met: tuple[float, tuple[str, str]] | None,
        touching: TouchingPairs,
        move: int,
        rows: Mapping[int, FloatArray],
        counted: dict[int, FloatArray],
        within: float,
    ) -> tuple[float, tuple[str, str]] | None:
        """What is nearest on a move, or pairs that touch at an end of a way where these count.

        Args:
            met: so far.
            touching: pairs of a way that the move is of.
            move: the move.
            rows: configurations along all moves.
            counted: what was found of ways already, by the ids of their pairs.
            within: m.
        """
        first, last = touching.moves
        way = [k for k in rows if first <= k <= last]
        if id(touching) not in counted:
            q = np.concatenate([rows[k] for k in way])
            counted[id(touching)] = counted_distances(touching, q, self._cell.clearance)
        begin = sum(len(rows[k]) for k in way[: way.index(move)])
        here = counted[id(touching)][begin : begin + len(rows[move])]
        least = float(here.min())
        if least >= within or (met is not None and met[0] <= least):
            return met
        pair = int(np.unravel_index(int(here.argmin()), here.shape)[1])
        return least, touching.scene.pair_names(pair)

    def _along(self, path: Path, first: int) -> SceneOf | None:
        """The scenes of a path with parts; None for a cell without."""
        if self._handling is None:
            return None
        kept = self._cell.clearance
        return HandledScenes(self._parts, self._handling, self._program, path, kept, first)

    def _scene(self, scenes: SceneOf | None, move: int) -> CollisionScene | None:
        """The scene of a move; None where shapes are not known, which is noted once."""
        tool = self._program.moves[move].tool
        if tool not in self._scenes:
            self._scenes[tool] = None
            try:
                made = CollisionScene(self._cell, tool) if scenes is None else scenes(tool, move)
                self._scenes[tool] = made
                self.notes += made.notes
            except InputError as error:
                self.notes.append(Note(f"clearances are not known: {error}", move))
        if self._scenes[tool] is None or scenes is None:
            return self._scenes[tool]
        return scenes(tool, move)


def _rows_of(path: Path, chosen: BoolArray) -> FloatArray:
    """Configurations along some of a path's samples, in small steps."""
    return in_steps(path.q[chosen], path.states.dq[chosen], path.sigma[chosen])


def in_steps(q: FloatArray, dq: FloatArray, sigma: FloatArray) -> FloatArray:
    """Configurations along samples in steps of about `STEP`, by cubics through these.

    Each joint runs steadily from sample to sample: near singular configurations, where derivatives
    are large, a cubic would swing out.

    Args:
        q, dq: (M, N), samples and their derivatives with respect to σ.
        sigma: (M,), σ of the samples, rising.
    """
    way = np.diff(q, axis=0)
    counts = np.ceil(np.abs(way).max(axis=1, initial=0.0) / STEP).astype(np.int64)
    counts = np.maximum(counts, 1)
    k = np.repeat(np.arange(len(way)), counts)
    t = (np.arange(len(k)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[k]
    rise, most = np.diff(sigma)[:, None], 3.0 * np.abs(way)
    first, last = (np.clip(np.nan_to_num(d * rise), -most, most)[k] for d in (dq[:-1], dq[1:]))
    t, way = t[:, None], way[k]
    cubic = t * (first + t * (3 * way - 2 * first - last + t * (first + last - 2 * way)))
    return np.ascontiguousarray(np.concatenate([q[k] + cubic, q[-1:]]))


def nearest_of(moves: Sequence[MoveClearance]) -> tuple[Approach | None, Approach | None]:
    """The least clearance to the cell, and between the arm's own parts; of equal ones the first."""
    cell = [move.cell for move in moves if move.cell is not None]
    own = [move.own for move in moves if move.own is not None]
    return _first_least(cell), _first_least(own)


def _first_least(met: Sequence[Approach]) -> Approach | None:
    # Passes over the same place differ in their last digits.
    least = min((side.distance for side in met), default=0.0) + 1e-9
    return next((side for side in met if side.distance <= least), None)


def _own_pairs(scene: CollisionScene) -> NDArray[np.bool_]:
    """Which pairs are of the arm and what it carries alone, (P,)."""
    own = np.array([body.own for body in scene.bodies])
    return np.asarray(own[scene.pairs].all(axis=1))
