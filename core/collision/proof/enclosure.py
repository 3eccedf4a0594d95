"""Verified bounds of a path's configurations on intervals of it.

On joint-space pieces an interval is one of the curve's own parameter s, in which the joints are
polynomials: their Taylor expansion about the middle bounds them exactly as tightly as it should.
On TCP-space pieces it is one of σ, and `tcp_enclosure` verifies a box.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numba import njit

from ...arrays import FloatArray, IntArray
from ...motion.geometry.corners import POSITION
from ...motion.geometry.curve_bounds import expand
from ...motion.geometry.curves import Curves, Samples, parameter_jet
from ...motion.path.path import Path
from ...robot.kinematics.chain import Chain
from .boxes import Boxes
from .tcp_enclosure import enclose

Span = tuple[float, float]
"""First and last σ."""


class EnclosedIntervals(NamedTuple):
    """M intervals of a path with what is known of q there.

    Args:
        piece: (M,), index of the piece that each lies in.
        begin, end: (M,), in s on joint-space pieces, in σ on the others.
        ends: (M, 2, N), configurations at both ends of intervals of TCP-space pieces.
        boxes: the enclosures.
    """

    piece: IntArray
    begin: FloatArray
    end: FloatArray
    ends: FloatArray
    boxes: Boxes

    def __len__(self) -> int:
        return len(self.piece)


@dataclass(frozen=True)
class Enclosure:
    """Makes enclosures of one trajectory of P pieces.

    Args:
        edge: (P + 1,), σ of the pieces' ends.
        window: (P, 4), of the joints' curves; straight on TCP-space pieces.
        joints: curves of joint-space pieces.
        curve: (P,), which of them is a piece's own; -1 on TCP-space pieces.
        path: where pieces are in TCP space, what they belong to; else None.
    """

    edge: FloatArray
    window: FloatArray
    joints: Curves
    curve: IntArray
    path: Path | None = None

    @classmethod
    def of(cls, path: Path) -> Enclosure:
        """For a path."""
        pieces = path.pieces
        own = pieces.curve[:, POSITION]
        straight = np.array([0.0, 1.0, 1.0, 1.0])
        window = np.where(pieces.joint_space[:, None], path.joint.window[own], straight)
        curve = np.where(pieces.joint_space, own, -1)
        return cls(pieces.edge, window, path.joint, curve, path)

    @property
    def size(self) -> int:
        """N."""
        return int(self.joints.control.shape[2])

    def whole(self, piece: IntArray) -> FloatArray:
        """(M,), how long pieces are in their own parameters."""
        return np.asarray(np.where(self.curve < 0, np.diff(self.edge), 1.0)[piece])

    def over(self, spans: Sequence[Span], pieces: Iterable[int] | None = None) -> EnclosedIntervals:
        """One interval for every piece that spans of σ touch, no wider than needed.

        On TCP-space pieces they are widened to the path's samples: those are known to lie on one
        branch of inverse kinematics.

        Args:
            spans: first and last σ of each.
            pieces: the pieces wanted; None for all.
        """
        owners, begins, ends, corners = [], [], [], []
        edge = self.edge
        wanted = range(len(edge) - 1) if pieces is None else pieces
        for p, (first, last) in product(wanted, spans):
            if last < edge[p] or first > edge[p + 1]:
                continue
            begin, end, between = self._placed(p, max(first, edge[p]), min(last, edge[p + 1]))
            if end >= begin:
                owners.append(p)
                begins.append(begin)
                ends.append(end)
                corners.append(between)
        return self._enclosed(
            np.array(owners, dtype=np.int64),
            np.array(begins),
            np.array(ends),
            np.array(corners).reshape(-1, 2, self.size),
        )

    def _placed(self, piece: int, first: float, last: float) -> tuple[float, float, FloatArray]:
        """A cut of a piece in the piece's own parameter, and the configurations at its ends."""
        path = self.path
        if path is None or self.curve[piece] >= 0:
            window = self.window[piece]
            begin, end = (min(max(parameter_jet(window, x)[0], 0.0), 1.0) for x in (first, last))
            return begin, end, np.zeros((2, self.size))
        rows = slice(*path.pieces.first_sample[piece : piece + 2])
        sigma, q = path.sigma[rows], path.q[rows]
        i = max(int(np.searchsorted(sigma, first, "right")) - 1, 0)
        j = min(int(np.searchsorted(sigma, last, "left")), len(sigma) - 1)
        return float(sigma[i]), float(sigma[j]), q[[i, j]]

    def halves(self, intervals: EnclosedIntervals, which: IntArray) -> EnclosedIntervals:
        """Both halves of some intervals, (2 K,): those of the i-th are at 2 i and 2 i + 1."""
        begin, end = intervals.begin[which], intervals.end[which]
        middle = 0.5 * (begin + end)
        q, ends = intervals.boxes.q[which], intervals.ends[which]
        return self._enclosed(
            np.repeat(intervals.piece[which], 2),
            np.stack([begin, middle], -1).ravel(),
            np.stack([middle, end], -1).ravel(),
            np.stack([ends[:, 0], q, q, ends[:, 1]], 1).reshape(-1, 2, q.shape[1]),
        )

    def sigma(self, piece: IntArray, parameter: FloatArray) -> FloatArray:
        """σ (M,) of places given in the pieces' own parameters."""
        start, length, d0, d1 = self.window[piece].T
        s = parameter
        across = s * (1 - s)
        mapped = start + length * (s * s + d0 * across) / (1 + (d0 + d1 - 2) * across)
        return np.asarray(np.where(self.curve[piece] < 0, s, mapped))

    def _enclosed(
        self, piece: IntArray, begin: FloatArray, end: FloatArray, ends: FloatArray
    ) -> EnclosedIntervals:
        boxes = Boxes.empty(len(piece), self.size)
        curve = self.curve[piece]
        rows = np.flatnonzero(curve >= 0)
        _enclose_joints(self.joints, curve[rows], begin[rows], end[rows], rows, boxes)
        rows = np.flatnonzero(curve < 0)
        if self.path is not None and len(rows):
            _enclose_tcp(self.path, piece, begin, end, ends, rows, boxes)
        return EnclosedIntervals(piece, begin, end, ends, boxes)


def _enclose_tcp(
    path: Path,
    piece: IntArray,
    begin: FloatArray,
    end: FloatArray,
    ends: FloatArray,
    rows: IntArray,
    boxes: Boxes,
) -> None:
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    for chain, own in _by_chain(path, piece, rows):
        curves = (np.ascontiguousarray(c) for c in path.pieces.curve[piece[own]].T)
        enclose(
            chain,
            path.route.solved,
            path.route.prescribed,
            path.tcp.curves,
            Samples(middle[own], *curves),
            half[own],
            _guess(path, piece[own], middle[own]),
            ends[own],
            own,
            boxes,
        )


def _by_chain(path: Path, piece: IntArray, rows: IntArray) -> list[tuple[Chain, IntArray]]:
    chains = path.route.chains
    segment = path.pieces.segment[piece[rows]]
    used = {id(chains[k]): chains[k] for k in np.unique(segment)}
    if len(used) == 1:
        return [(chain, rows) for chain in used.values()]
    owner = np.array([id(chains[k]) for k in segment])
    return [(chain, rows[owner == key]) for key, chain in used.items()]


def _guess(path: Path, piece: IntArray, sigma: FloatArray) -> FloatArray:
    """(M, N), q by Taylor's formula from the nearest sample of the same piece."""
    first = path.pieces.first_sample
    # Samples of one piece only: those at its ends share σ with its neighbours'.
    right = np.searchsorted(path.sigma, sigma)
    right = np.clip(right, first[piece] + 1, first[piece + 1] - 1)
    left_near = sigma - path.sigma[right - 1] < path.sigma[right] - sigma
    near = right - left_near
    step = (sigma - path.sigma[near])[:, None]
    states = path.states
    return np.asarray(states.q[near] + step * (states.dq[near] + 0.5 * step * states.ddq[near]))


@njit(cache=True, error_model="numpy")
def _enclose_joints(
    curves: Curves,
    curve: IntArray,
    begin: FloatArray,
    end: FloatArray,
    rows: IntArray,
    boxes: Boxes,
) -> None:
    """Enclose q on intervals of s of the joints' curves ``curve`` (M,)."""
    size = boxes.q.shape[1]
    taylor = np.empty((curves.coefficients.shape[1], size))
    for m in range(rows.size):
        row = rows[m]
        half = 0.5 * (end[m] - begin[m])
        expand(curves, curve[m], 0.5 * (begin[m] + end[m]), 0, size, taylor)
        for j in range(size):
            reach = first = second = 0.0
            power = half
            for k in range(1, taylor.shape[0]):
                term = abs(taylor[k, j]) * power
                reach += term
                first += k * term
                second += k * (k - 1) * term
                power *= half
            boxes.q[row, j] = taylor[0, j]
            boxes.rate[row, j] = half * taylor[1, j]
            boxes.reach[row, j] = reach
            boxes.first[row, j] = first
            boxes.second[row, j] = second
        boxes.verified[row] = True
