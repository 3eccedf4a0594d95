"""The scenes of a program that takes parts and releases them.

Where a part is taken or released it touches the tool and what it rests on. Such pairs are left out
of the scenes of a *way*: the move that leads there or away, and as many more as it takes until they
are apart, a tool that draws back in two moves, or a part that is lifted a little first.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..cell.cell import Cell
from ..errors import InputError
from ..handling.arrangement import Arrangement
from ..handling.handling import Handling
from ..motion.path.path import Path
from ..program.program import Program
from ..program.tool import Tool
from .proof.certificate import SceneOf, scenes_of
from .scene.bodies import BodyKind
from .scene.handled_pairs import APART, RESTING, pairs_at_handling, touching_pairs
from .scene.scene import CollisionScene, TouchingPairs

_OFF = 1e-4
"""m by which a part is farther from what it rests on at the end of a move that it is lifted on."""


def scenes_along(
    cell: Cell,
    handling: Handling | None,
    program: Program,
    plan: Callable[[], Path],
    clearance: float,
) -> SceneOf:
    """The scenes of a program's moves, with or without parts.

    Args:
        cell: what stands around.
        handling: of the program; None for a cell without parts.
        program: its moves tell which tools are driven.
        plan: gives the program's path, which is asked for where there are parts.
        clearance: see `HandledScenes`.

    Raises:
        InputError: the cell has parts, and nobody says where they are.
        MotionError: the program cannot be driven.
    """
    if handling is None:
        return scenes_of(cell)
    return HandledScenes(PartScenes(cell), handling, program, plan(), clearance)


class PartScenes:
    """Scenes of a cell with its parts, each made once and then rearranged.

    Args:
        cell: what stands around.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self._made: dict[tuple[Tool, float], CollisionScene] = {}
        self._known: dict[tuple[Tool, float, int], tuple[Arrangement, CollisionScene]] = {}

    def at(self, tool: Tool, parts: Arrangement, smaller: float = 0.0) -> CollisionScene:
        """The scene with a tool mounted and the parts at their places.

        Args:
            tool: which.
            parts: all of them.
            smaller: m by which they are smaller all round.

        Raises:
            InputError: the scene cannot be made.
        """
        key = tool, smaller, id(parts)
        if key not in self._known:
            if key[:2] not in self._made:
                self._made[key[:2]] = CollisionScene(self._cell, tool, parts, smaller)
            self._known[key] = parts, self._made[key[:2]].rearranged(parts)
        return self._known[key][1]


class _Way(NamedTuple):
    """Moves in a row along which a pair of bodies may touch.

    Args:
        tool: that is driven.
        pair: of bodies.
        first, last: indices of moves.
        floor: m, next to the beginning and to the end; infinite where it may not touch.
    """

    tool: Tool
    pair: tuple[int, int]
    first: int
    last: int
    floor: tuple[float, float]

    def joins(self, other: _Way) -> bool:
        """Whether this begins where parts are handled, and a later one of the same pair ends so
        before it is apart."""
        open_ends = math.isinf(self.floor[1]) and math.isinf(other.floor[0])
        return open_ends and self.first <= other.last and other.first <= self.last

    def joined(self, other: _Way) -> _Way:
        """Both as one."""
        floor = self.floor[0], other.floor[1]
        return self._replace(last=max(self.last, other.last), floor=floor)


class HandledScenes:
    """The scenes of a cell with its parts where they are on each move.

    On the ways at whose ends parts are taken or released, the pairs that touch there are left out,
    to be proven clear from where they are apart, and not too deep in each other before.

    Args:
        scenes: of the cell.
        handling: of the program. Others that have the same targets where parts are handled handle
            them alike.
        program: its moves tell which tools are driven.
        path: of moves of the program in a row.
        clearance: m that is to be kept, with what the motion model leaves open.
        first: index in the program of the path's first move.
    """

    def __init__(
        self,
        scenes: PartScenes,
        handling: Handling,
        program: Program,
        path: Path,
        clearance: float = 0.0,
        first: int = 0,
    ) -> None:
        self._scenes, self._handling, self._program = scenes, handling, program
        self._path, self._clearance, self._first = path, clearance, first
        self._known: dict[tuple[Tool, int], CollisionScene] = {}

    def __call__(self, tool: Tool, move: int = 0, /) -> CollisionScene:
        """See `SceneOf`."""
        ways = self._ways.get(move, [])
        key = tool, move if ways else -1 - self._same_before(move)
        if key not in self._known:
            made = self._scenes.at(tool, self._handling.arrangements[move])
            self._known[key] = made.leaving_out(ways) if ways else made
        return self._known[key]

    def _same_before(self, move: int) -> int:
        """The first of the moves up to this one along which nothing changes hands."""
        arrangements = self._handling.arrangements
        while move > 0 and arrangements[move - 1] is arrangements[move]:
            move -= 1
        return move

    @cached_property
    def _ways(self) -> dict[int, list[TouchingPairs]]:
        """What touches along each move."""
        alike: dict[tuple[int, int], list[_Way]] = {}
        for way in self._joined():
            alike.setdefault((way.first, way.last), []).append(way)
        found: dict[int, list[TouchingPairs]] = {}
        for (first, last), ways in alike.items():
            tool, parts = ways[0].tool, self._handling.arrangements[first]
            made = touching_pairs(
                self._scenes.at(tool, parts),
                (first, last),
                np.array([way.pair for way in ways], dtype=np.int64),
                np.array([way.floor for way in ways]),
                lambda tool=tool, parts=parts: self._scenes.at(tool, parts, RESTING),  # type: ignore[misc]
            )
            for k in self._driven:
                if first <= k <= last:
                    found.setdefault(k, []).append(made)
        return found

    def _joined(self) -> list[_Way]:
        """All ways, those of one pair that run into each other joined."""
        handled = self._handling
        moves = [i for i in self._driven if handled.before[i] or handled.behind[i]]
        ways: list[_Way] = []
        latest: dict[tuple[Tool, tuple[int, int]], int] = {}
        for way in (way for move in moves for way in self._ways_of(move)):
            before = latest.get((way.tool, way.pair))
            if before is not None and ways[before].joins(way):
                ways[before] = ways[before].joined(way)
            else:
                latest[way.tool, way.pair] = len(ways)
                ways.append(way)
        return ways

    @cached_property
    def _rows(self) -> IntArray:
        """(S,), the move that each sample of the path is of."""
        return self._first + self._path.sample_moves()

    @cached_property
    def _driven(self) -> list[int]:
        """Indices of the moves that the path drives."""
        return list(dict.fromkeys(self._rows.tolist()))

    def _along(self, move: int) -> FloatArray:
        """(M, N), samples of a move."""
        return np.asarray(self._path.q[self._rows == move])

    def _scene(self, move: int) -> CollisionScene | None:
        """With all pairs; None where it cannot be made, which is said when it is asked for."""
        try:
            tool = self._program.moves[move].tool
            return self._scenes.at(tool, self._handling.arrangements[move])
        except InputError:
            return None

    def _ways_of(self, move: int) -> Iterator[_Way]:
        """Those that begin or end with a move at an end of which parts are handled."""
        scene = self._scene(move)
        if scene is None:
            return
        q = self._along(move)
        pairs, floor = pairs_at_handling(scene, self._handling, move, q[[0, -1]], self._clearance)
        if not len(pairs):
            return
        ends = [np.isfinite(floor[:, end]) for end in (0, 1)]
        last = np.where(ends[0], self._until(scene, move, pairs, 1), move)
        first = np.where(ends[1], self._until(scene, move, pairs, -1), move)
        for k, pair in enumerate(pairs.tolist()):
            begin, end = floor[k].tolist()
            yield _Way(scene.tool, (pair[0], pair[1]), int(first[k]), int(last[k]), (begin, end))

    def _until(self, scene: CollisionScene, move: int, pairs: IntArray, step: int) -> IntArray:
        """The move on which each pair (K, 2) is first apart, going on from a move, or back.

        Beyond one move a pair is let go only where it goes on coming apart: a tool that is moved to
        and fro in a part, or a part along the table, is not on its way out.
        """
        found = np.full(len(pairs), move)
        left = np.flatnonzero(self._still_near(scene, move, pairs, step))
        while len(left):
            k = self._driven.index(move) + step
            beyond = self._scene(self._driven[k]) if 0 <= k < len(self._driven) else None
            if beyond is None or beyond.tool != scene.tool:
                break
            move = self._driven[k]
            alike = [_alike(scene, beyond, pair) for pair in pairs[left].tolist()]
            left = left[np.array(alike, dtype=np.bool_)]
            left = left[self._lifted(beyond, move, pairs[left], step)]
            found[left], scene = move, beyond
            left = left[self._still_near(scene, move, pairs[left], step)]
        return found

    def _distances(
        self, scene: CollisionScene, move: int, pairs: IntArray, step: int
    ) -> FloatArray:
        """(M, K) m along a move, or back along it, up to where pairs are apart."""
        limit = self._clearance + APART
        return scene.of_pairs(pairs).distances(self._along(move), limit).distance[::step]

    def _still_near(
        self, scene: CollisionScene, move: int, pairs: IntArray, step: int
    ) -> BoolArray:
        """Which pairs are apart nowhere on a move, and no part but is lifted there."""
        distance = self._distances(scene, move, pairs, step)
        near = (distance < self._clearance + APART).all(axis=0)
        rises = distance[-1] > distance[0] + _OFF
        return np.asarray(near & (self._drawn(scene, pairs) | rises))

    def _lifted(self, scene: CollisionScene, move: int, pairs: IntArray, step: int) -> BoolArray:
        """Which pairs only get farther from each other on a move, until they are apart."""
        distance = self._distances(scene, move, pairs, step)
        before = ~np.logical_or.accumulate(distance >= self._clearance + APART)
        falls = (distance < np.maximum.accumulate(distance, axis=0) - _OFF) & before
        return np.asarray((distance[-1] > distance[0] + _OFF) & ~falls.any(axis=0))

    def _drawn(self, scene: CollisionScene, pairs: IntArray) -> BoolArray:
        """Which pairs are of a tool and what it draws back from, or comes to."""
        held = [[scene.bodies[k].kind is BodyKind.HELD for k in pair] for pair in pairs.tolist()]
        return np.asarray(~np.array(held, dtype=np.bool_).reshape(-1, 2).any(axis=1))


def _alike(one: CollisionScene, other: CollisionScene, pair: tuple[int, int]) -> bool:
    """Whether two bodies are on the same frames, at the same places, in two scenes."""
    bodies = [(one.bodies[k], other.bodies[k]) for k in pair]
    return all(a.frame == b.frame and a.placement == b.placement for a, b in bodies)
