"""The pieces of a path, on which every channel is one curve, and their samples."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...robot.kinematics.lean import lean

WAYPOINT = -1
"""Stands for a channel in `Pieces.source` where a boundary is a waypoint."""


@dataclass(frozen=True)
class Sampling:
    """How densely a path is sampled; pieces get at least ``least`` intervals.

    Args:
        step: m of TCP path between samples of TCP-space pieces.
        turn: rad of tool rotation, likewise.
        joint: rad of joint motion between samples of joint-space pieces.
        blend: intervals on each half of a zone, at least.
        least, most: bounds on the number of even intervals of a piece.
        halvings: how often the interval next to a stop, or to a change of programmed speed, is
            halved towards it: slow robots reach their speed within a fraction of a millimetre.
        approach: how often at most the interval next to a zone is halved towards it, until it is
            no longer than the zone's own: a robot slows down for a small zone within little path.
    """

    step: float = 0.02
    turn: float = 0.08
    joint: float = 0.06
    blend: int = 8
    least: int = 4
    most: int = 200
    halvings: int = 9
    approach: int = 0


class PieceIndices(NamedTuple):
    """Where the samples and intervals of P pieces are, as kernels take it; see `Pieces`.

    Args:
        first_sample, first_interval: (P + 1,).
        segment: (P,).
    """

    first_sample: IntArray
    first_interval: IntArray
    segment: IntArray


@dataclass(frozen=True)
class Pieces:
    """P pieces.

    Args:
        edge: (P + 1,), σ of the boundaries.
        source: (P + 1, 3), what each boundary is: waypoint index, then channel and side of a
            zone's edge (`WAYPOINT` and 0 for the waypoint itself).
        segment: (P,), the segment whose speed and load apply.
        joint_space: (P,) bool.
        curve: (P, 3), index of each channel's curve (the joints' curve in the first column of
            joint-space pieces).
        intervals: (P,).
        even: (P,), intervals before those at graded ends were halved.
        lean: (P,), how often the steps between samples are halved from a piece's beginning to its
            end: where a blend's legs differ much in extent, its parameter runs unevenly in σ.
        graded: (P, 2), how often the intervals at the beginning and the end are halved.
        stop: (P + 1,) bool, boundaries at which the robot comes to rest.
    """

    edge: FloatArray
    source: IntArray
    segment: IntArray
    joint_space: NDArray[np.bool_]
    curve: IntArray
    intervals: IntArray
    even: IntArray
    lean: IntArray
    graded: IntArray
    stop: NDArray[np.bool_]

    @cached_property
    def first_sample(self) -> IntArray:
        """(P + 1,), index of each piece's first sample; samples stand at both ends of a piece."""
        return np.concatenate([[0], np.cumsum(self.intervals + 1)])

    @cached_property
    def first_interval(self) -> IntArray:
        """(P + 1,), index of each piece's first interval."""
        return np.concatenate([[0], np.cumsum(self.intervals)])

    @property
    def indices(self) -> PieceIndices:
        """Where samples and intervals are."""
        return PieceIndices(self.first_sample, self.first_interval, self.segment)

    @cached_property
    def sample_pieces(self) -> IntArray:
        """(S,), the piece of every sample."""
        return np.repeat(np.arange(len(self.segment)), self.intervals + 1)

    @cached_property
    def sample_shares(self) -> FloatArray:
        """(S,), how far along its piece every sample stands, from 0 to 1."""
        return np.concatenate(
            [
                _shares(int(even), int(lean), int(first), int(last))
                for even, lean, (first, last) in zip(self.even, self.lean, self.graded, strict=True)
            ]
        )

    def sigma(self) -> FloatArray:
        """(S,), σ of every sample."""
        piece, share = self.sample_pieces, self.sample_shares
        return (1.0 - share) * self.edge[piece] + share * self.edge[piece + 1]

    @cached_property
    def interval_samples(self) -> IntArray:
        """(K,), index of the sample at the left end of each interval."""
        return np.arange(self.first_interval[-1]) + self.interval_pieces

    @cached_property
    def interval_ends(self) -> IntArray:
        """(K, 2), index of the samples at both ends of each interval."""
        left = self.interval_samples
        return np.stack([left, left + 1], -1)

    @property
    def interval_pieces(self) -> IntArray:
        """(K,), the piece of every interval."""
        return np.repeat(np.arange(len(self.segment)), self.intervals)

    @property
    def interval_segments(self) -> IntArray:
        """(K,), the segment of every interval."""
        return np.repeat(self.segment, self.intervals)

    def around(self, waypoint: FloatArray, extent: FloatArray) -> IntArray:
        """(C, 3), the first piece, the first behind the waypoint and the last piece of zones.

        Args:
            waypoint: (C,), σ of their waypoints.
            extent: (C, 2), extent on σ before and after them.
        """
        middle = 0.5 * (self.edge[1:] + self.edge[:-1])
        before, after = extent.T
        places = np.stack([waypoint - before, waypoint, waypoint + after], -1)
        return np.asarray(np.searchsorted(middle, places) - np.array([0, 0, 1]))

    def refined(self, coarse: NDArray[np.bool_], times: int) -> Pieces:
        """The same with so many times as many even intervals in pieces that are (P,) bool."""
        even = np.where(coarse, times * self.even, self.even)
        return replace(self, even=even, intervals=self.intervals + even - self.even)

    def pull_sigma(
        self, sigma_bar: FloatArray, waypoint_bar: FloatArray, extent_bar: FloatArray
    ) -> None:
        """Reverse of `sigma`: add to the gradients of the layout's waypoints and extents."""
        first, edge_bar = self.first_sample, np.zeros(len(self.edge))
        given = first, self.sample_shares, self.source, sigma_bar
        _pull_sigma(*given, edge_bar, waypoint_bar, extent_bar)


@lean
def _pull_sigma(
    first: IntArray,
    share: FloatArray,
    source: IntArray,
    sigma_bar: FloatArray,
    edge_bar: FloatArray,
    waypoint_bar: FloatArray,
    extent_bar: FloatArray,
) -> None:
    for p in range(first.size - 1):
        for k in range(first[p], first[p + 1]):
            edge_bar[p] += (1.0 - share[k]) * sigma_bar[k]
            edge_bar[p + 1] += share[k] * sigma_bar[k]
    for k in range(edge_bar.size):
        waypoint, channel, side = source[k, 0], source[k, 1], source[k, 2]
        waypoint_bar[waypoint] += edge_bar[k]
        if channel != WAYPOINT:
            extent_bar[waypoint - 1, channel, side] += edge_bar[k] if side else -edge_bar[k]


@cache
def _shares(even: int, lean: int, first: int, last: int) -> FloatArray:
    """Samples of one piece from 0 to 1, their steps shrinking by 2^lean along it, the first and
    the last step halved that often."""
    steps = 0.5 ** (lean * np.linspace(0.0, 1.0, even))
    shares = np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])
    shares[-1] = 1.0
    begin = shares[1] * 0.5 ** np.arange(first, 0, -1)
    end = 1.0 - (1.0 - shares[-2]) * 0.5 ** np.arange(1, last + 1)
    return np.concatenate([shares[:1], begin, shares[1:-1], end, shares[-1:]])
