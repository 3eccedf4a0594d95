"""What one robot turns while another one works on it, on moves that both make together.

There the two do not move by clocks of their own: how near the one comes to what the other turns is
proven of the worker's own motion, which carries the table along (`..proof`), and not here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import BoolArray, FloatArray, IntArray
from .conflict import Conflict, ConflictCause
from .robot_motion import RobotMotion


class Unproven(NamedTuple):
    """A move on which a robot is not proven to keep clear of what it works on.

    Args:
        move: index of it.
        pair: names of its body and of the other's.
        distance: m between them; None where it was not measured.
        times: s of its own, and of the other's, there.
        why: in a sentence.
    """

    move: int
    pair: tuple[str, str]
    distance: float | None
    times: tuple[float, float]
    why: str


@dataclass(frozen=True)
class CarriedWork:
    """Moves that one of two robots makes on what the other one turns.

    Args:
        worker: which of the two works on it, 0 or 1.
        frames: that carry what the other one turns, of the other's.
        blocks: moves of the worker in a row, by index, and those of the other that are made
            together with them.
        unproven: what is not proven of the worker's motion on these.
    """

    worker: int
    frames: frozenset[int]
    blocks: tuple[Mapping[int, int], ...]
    unproven: tuple[Unproven, ...]

    def conflicts(self) -> Iterator[Conflict]:
        """What is not proven, as of the two robots."""
        both = {own: other for block in self.blocks for own, other in block.items()}
        for found in self.unproven:
            moves, pair = (found.move, both[found.move]), found.pair
            one, other = found.times
            times = (one, one), (other, other)
            if self.worker:
                moves, pair, times = moves[::-1], pair[::-1], times[::-1]
            cause = ConflictCause.CARRIED
            yield Conflict(cause, moves, pair, found.distance, times, (0, 0), found.why)


class CarriedPairs:
    """The pairs of bodies of two robots that are proven elsewhere.

    Args:
        work: of the two.
        motions: of the one and of the other.
        pairs: (P, 2), their bodies.
    """

    def __init__(
        self, work: CarriedWork, motions: tuple[RobotMotion, RobotMotion], pairs: IntArray
    ) -> None:
        self._sides = work.worker, 1 - work.worker
        self._motions = motions[self._sides[0]], motions[self._sides[1]]
        own = np.array([body.moves for body in self._motions[0].bodies], np.bool_)
        turned = np.array([b.body.frame in work.frames for b in self._motions[1].bodies], np.bool_)
        self._its = own[pairs[:, self._sides[0]]] & turned[pairs[:, self._sides[1]]]
        self._block = [
            np.full(len(motion.run.program.moves), none)
            for motion, none in zip(self._motions, (-1, -2), strict=True)
        ]
        for number, block in enumerate(work.blocks):
            self._block[0][list(block)] = number
            self._block[1][list(block.values())] = number

    def skipped(self, i: IntArray, j: IntArray, pair: IntArray) -> BoolArray:
        """As `HandedPairs.skipped`."""
        worker, other = ((i, j)[side] for side in self._sides)
        return np.asarray(
            self._its[pair]
            & self._at_once(self._motions[0].moves[worker], self._motions[1].moves[other])
        )

    def skipped_at(
        self, _: tuple[FloatArray, FloatArray], moves: tuple[IntArray, IntArray], count: int
    ) -> NDArray[np.bool_]:
        """As `HandedPairs.skipped_at`."""
        at_once = self._at_once(*(moves[side] for side in self._sides))
        return np.asarray(self._its[np.arange(count)[None]] & at_once[:, None])

    def _at_once(self, worker: IntArray, other: IntArray) -> BoolArray:
        return np.asarray(self._block[0][worker] == self._block[1][other])
