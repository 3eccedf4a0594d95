"""A part that one robot hands to another: whose it is when, and what may touch it.

Up to where the other one drives off with it, it is the first one's, held or put down; from there on
it is the other one's. In between both may hold it, and then both stand. Where the first one comes
back before it is taken, it is the other one's that lies there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from .robot_motion import RobotMotion

_STANDS = 2e-3
"""m that a part is moved at most where its robot stands, and comes to rest or begins to move."""


@dataclass(frozen=True)
class HandedPart:
    """A part that one of two robots hands to the other.

    Args:
        giver: which of the two hands it over, 0 or 1.
        names: of the part in the cells of giver and taker.
        moves: index of the giver's move at whose end it lets go, and of the taker's at whose end it
            takes.
        leaving: indices of the giver's moves on which it draws back from the part.
        coming: of the taker's on which it comes to it.
        rests: whether it lies on something there, so that it may be let go of and taken later.
        unproven: what is not proven of these in the robots' own cells, where the part lies.
    """

    giver: int
    names: tuple[str, str]
    moves: tuple[int, int]
    leaving: frozenset[int]
    coming: frozenset[int]
    rests: bool
    unproven: tuple[str, ...] = ()


@dataclass(frozen=True)
class AwaitedPart:
    """A part that one of two robots gets of a third one, which has it until it is taken.

    Args:
        taker: which of the two gets it, 0 or 1.
        name: of the part in its cell.
        move: index of the move at whose end it takes it.
    """

    taker: int
    name: str
    move: int


class AwaitedPairs:
    """The pairs of bodies of two robots in which a part is none before it is taken.

    Args:
        part: that a third robot hands over.
        motions: of the one and of the other.
        pairs: (P, 2), their bodies.
    """

    def __init__(
        self, part: AwaitedPart, motions: tuple[RobotMotion, RobotMotion], pairs: IntArray
    ) -> None:
        self._part, self._taker = part, motions[part.taker]
        copy = np.array([own.body.thing == part.name for own in self._taker.bodies], np.bool_)
        self._its = copy[pairs[:, part.taker]]

    def skipped(self, i: IntArray, j: IntArray, pair: IntArray) -> NDArray[np.bool_]:
        """As `HandedPairs.skipped`."""
        moves = self._taker.moves[(i, j)[self._part.taker]]
        return np.asarray(self._its[pair] & (moves <= self._part.move))

    def skipped_at(
        self, _: tuple[FloatArray, FloatArray], moves: tuple[IntArray, IntArray], count: int
    ) -> NDArray[np.bool_]:
        """As `HandedPairs.skipped_at`."""
        own = moves[self._part.taker][:, None]
        return np.asarray(self._its[np.arange(count)[None]] & (own <= self._part.move))


class HandedPairs:
    """The pairs of bodies of two robots that a part which is handed over takes out of a proof.

    On their ways to and from the part robots are proven in their own cells, as it lies still then.

    Args:
        part: that is handed over.
        motions: of the one and of the other.
        pairs: (P, 2), their bodies.
    """

    def __init__(
        self, part: HandedPart, motions: tuple[RobotMotion, RobotMotion], pairs: IntArray
    ) -> None:
        self._part = part
        sides = (part.giver, 1 - part.giver)
        self._motions = motions[sides[0]], motions[sides[1]]
        copies = [
            np.array([own.body.thing == name for own in motion.bodies], dtype=np.bool_)
            for motion, name in zip(self._motions, part.names, strict=True)
        ]
        self._mine, self._theirs = (
            copy[pairs[:, side]] for copy, side in zip(copies, sides, strict=True)
        )
        self._copies = [np.flatnonzero(copy) for copy in copies]
        self._held = [
            np.flatnonzero(copy & motion.there(np.array([move]))[0])
            for copy, motion, move in zip(
                copies, self._motions, (part.moves[0], self._behind()), strict=True
            )
        ]
        count = [len(motion.run.program.moves) for motion in self._motions]
        self._leaving, self._coming = (
            np.isin(np.arange(n), list(which))
            for n, which in zip(count, (part.leaving, part.coming), strict=True)
        )

    def skipped(self, i: IntArray, j: IntArray, pair: IntArray) -> NDArray[np.bool_]:
        """Which items (K,) are none: intervals of the one and of the other, and rows of pairs."""
        giver, taker = (i, j) if self._part.giver == 0 else (j, i)
        moves = self._motions[0].moves[giver], self._motions[1].moves[taker]
        return self._out(pair, moves, self._still(0, giver), self._still(1, taker))

    def skipped_at(
        self, q: tuple[FloatArray, FloatArray], moves: tuple[IntArray, IntArray], count: int
    ) -> NDArray[np.bool_]:
        """The same of instants (T,) and all P pairs, (T, P), at configurations of both."""
        sides = (self._part.giver, 1 - self._part.giver)
        still = [self._stands(k, q[side]) for k, side in enumerate(sides)]
        rows = np.arange(count)[None]
        own = moves[sides[0]][:, None], moves[sides[1]][:, None]
        return self._out(rows, own, still[0][:, None], still[1][:, None])

    def _out(
        self,
        pair: IntArray,
        moves: tuple[IntArray, IntArray],
        giver_stands: NDArray[np.bool_],
        taker_stands: NDArray[np.bool_],
    ) -> NDArray[np.bool_]:
        mine, theirs = self._mine[pair], self._theirs[pair]
        given, taken = self._part.moves
        # Before it is taken the taker's is there for the giver alone that has left it.
        brings = (moves[0] <= given) | self._leaving[moves[0]]
        waits = theirs & (moves[1] <= taken) & brings
        put_down = (moves[0] > given) | giver_stands
        away = self._leaving[moves[0]] | giver_stands
        out = mine & (theirs | (moves[1] > taken) | (self._coming[moves[1]] & put_down))
        return np.asarray(out | waits | (theirs & taker_stands & away))

    def _behind(self) -> int:
        """The move on which the taker drives off; its last one where it does not."""
        moves = self._motions[1].run.path.route.moves
        return int(min([m for m in moves if m > self._part.moves[1]], default=moves[-1]))

    def _still(self, k: int, rows: IntArray) -> NDArray[np.bool_]:
        """Intervals in which a robot stands where it lets go or takes, but for next to nothing."""
        motion, move = self._motions[k], self._part.moves[k]
        own = motion.moves == move
        at = float(motion.sigma[own, 1].max()) if own.any() else -np.inf
        edge = motion.sigma[rows, 1 if k == 0 else 0]
        near = np.abs(edge - at) <= 1e-12 * max(1.0, abs(at))
        near &= own[rows] if k == 0 else motion.moves[rows] > move
        if len(self._copies[k]):
            most = motion.side.swept.motion[np.ix_(rows, self._copies[k])]
            there = motion.there(motion.moves[rows])[:, self._copies[k]]
            near &= np.where(there, most, 0.0).max(axis=1) <= _STANDS
        return np.asarray(near)

    def _stands(self, k: int, q: FloatArray) -> NDArray[np.bool_]:
        """The same of configurations (T, N)."""
        motion, move = self._motions[k], self._part.moves[k]
        route = motion.run.path.route
        end = route.ends.q[list(route.moves).index(move), 1]
        p = motion.placed(np.concatenate([end[None], q]))[1][:, self._held[k]]
        off = np.linalg.norm(p[1:] - p[:1], axis=-1)
        return np.asarray(off.max(axis=1, initial=0.0) <= _STANDS)
