"""Which moment of an emulated motion each sample of a log belongs to, by place alone.

The match runs forward: a path that crosses itself or goes back the way it came is matched in its
order. Time plays no part, so a slow or late log matches as well as a punctual one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray, IntArray

COARSE = 800
"""Steps of the path, and at most about as many of the log, that the forward match looks at."""
_BRANCHES = 4
"""Stretches of the path near a sample, of which one is chosen."""
_MOST_ROWS, _MOST_CELLS = 512, 100_000
"""Samples, and pairs of a sample and a segment, that are looked at together; bounds the memory."""


@dataclass(frozen=True, eq=False)
class Match:
    """Samples of a log on an emulated path of joints.

    Args:
        time: (T,) s, of the nearest point of the emulated path.
        arc: (T,) rad (m), length of the path of joints up to there.
        off: (T, N) rad (m), from there to the sample.
        length: rad (m), of the whole path of joints.
    """

    time: FloatArray
    arc: FloatArray
    off: FloatArray
    length: float

    @property
    def distance(self) -> FloatArray:
        """(T,) rad (m), from the path."""
        return np.asarray(np.linalg.norm(self.off, axis=1))


def match(t: FloatArray, path: FloatArray, q: FloatArray, least_step: float = 0.0) -> Match:
    """Match samples to a path.

    Args:
        t: (P,) s, increasing, of the emulated motion.
        path: (P, N) its joints.
        q: (T, N) samples of the log in the order of time.
        least_step: rad (m), steps of the log below this are noise.
    """
    line = _Polyline.of(t, path)
    if len(line.t) == 1:
        zero = np.zeros(len(q))
        return Match(zero + line.t[0], zero, q - line.q[0], 0.0)
    picked = _spaced(q, max(line.arc[-1] / COARSE, least_step))
    arcs = np.linspace(0.0, line.arc[-1], COARSE + 1)
    steps = _forward(q[picked], line.at(arcs))
    # Between two picks a sample lies between their knots, give or take two.
    before = np.searchsorted(picked, np.arange(len(q)), side="right") - 1
    after = np.minimum(before + 1, len(picked) - 1)
    low = arcs[np.clip(steps[before] - 2, 0, COARSE)]
    high = arcs[np.clip(steps[after] + 2, 0, COARSE)]
    first = np.searchsorted(line.arc, low, side="right") - 1
    last = np.searchsorted(line.arc, high, side="left")
    return line.nearest(q, np.minimum(first, len(line.arc) - 2), last)


@dataclass(frozen=True, eq=False)
class _Polyline:
    """A path without its standstills; of each the last sample stays."""

    t: FloatArray
    q: FloatArray
    arc: FloatArray

    @classmethod
    def of(cls, t: FloatArray, q: FloatArray) -> _Polyline:
        step = np.linalg.norm(np.diff(q, axis=0), axis=1)
        kept = np.concatenate([step > 1e-12, [True]])
        t, q = t[kept], q[kept]
        length = np.linalg.norm(np.diff(q, axis=0), axis=1)
        return cls(t, q, np.concatenate([[0.0], np.cumsum(length)]))

    def at(self, arc: FloatArray) -> FloatArray:
        """Points (K, N) at lengths along the path."""
        return np.stack([np.interp(arc, self.arc, column) for column in self.q.T], axis=-1)

    def nearest(self, q: FloatArray, first: IntArray, last: IntArray) -> Match:
        """The nearest point to each sample (T, N) between two vertices, in the order of the path:
        where it goes back the way it came, place alone says no more than that it is on either way.
        """
        last = np.maximum(last, first + 1)
        shape = len(q), _BRANCHES
        segment, share, away = np.empty(shape, dtype=np.int64), np.empty(shape), np.empty(shape)
        # Windows of like width together, so that few of them are padded.
        order = np.argsort(last - first)
        begin = 0
        while begin < len(q):
            ahead = order[begin : begin + _MOST_ROWS]
            count = max(1, _MOST_CELLS // int((last - first)[ahead].max()))
            rows = ahead[:count]
            segment[rows], share[rows], away[rows] = self._project(q[rows], first[rows], last[rows])
            begin += len(rows)
        arc = (1 - share) * self.arc[segment] + share * self.arc[segment + 1]
        chosen = np.arange(len(q)), _in_order(arc, away)
        segment, share = segment[chosen], share[chosen]
        time = (1 - share) * self.t[segment] + share * self.t[segment + 1]
        place = (1 - share)[:, None] * self.q[segment] + share[:, None] * self.q[segment + 1]
        return Match(time, arc[chosen], q - place, float(self.arc[-1]))

    def _project(
        self, q: FloatArray, first: IntArray, last: IntArray
    ) -> tuple[IntArray, FloatArray, FloatArray]:
        """Segment, share of it and squared distance (R, B) of the points that are nearer to a
        sample (R, N) than those before and behind, the nearest first; infinitely far where there
        are no more."""
        width = max(int((last - first).max()), _BRANCHES)
        segment = np.minimum(first[:, None] + np.arange(width), (last - 1)[:, None])
        begin = self.q[segment]
        step, away = self.q[segment + 1] - begin, q[:, None, :] - begin
        share = np.sum(away * step, axis=2) / np.sum(step * step, axis=2)
        share = np.clip(share, 0.0, 1.0)
        rest = away - share[:, :, None] * step
        square = np.sum(rest * rest, axis=2)
        edge = np.full((len(q), 1), np.inf)
        before, behind = np.hstack([edge, square[:, :-1]]), np.hstack([square[:, 1:], edge])
        square = np.where((square < before) & (square <= behind), square, np.inf)
        best = np.argsort(square, axis=1)[:, :_BRANCHES]
        rows = np.arange(len(q))[:, None]
        return segment[rows, best], share[rows, best], square[rows, best]


def _in_order(arc: FloatArray, square: FloatArray) -> IntArray:
    """Which of its candidates (T, B) each sample is taken for.

    As far as it is behind where the robot has been already, a candidate counts as off the path.

    Args:
        arc: rad (m), where on the path they are.
        square: their squared distances from the sample, the least first, infinite where there are
            no more.
    """
    chosen = np.zeros(len(arc), dtype=np.int64)
    several = np.append(np.isfinite(square[:, 1]), False)
    edges = np.flatnonzero(np.diff(several, prepend=False))
    done, reached = 0, -np.inf
    for first, stop in zip(edges[::2], edges[1::2], strict=True):
        reached = max(reached, arc[done:first, 0].max(initial=-np.inf))
        done = min(stop + 1, len(arc))  # The sample behind has one candidate, which decides.
        chosen[first:done] = _best_way(arc[first:done], square[first:done], reached)
        reached = max(reached, arc[first:done][np.arange(done - first), chosen[first:done]].max())
    return chosen


def _best_way(arc: FloatArray, square: FloatArray, reached: float) -> IntArray:
    """A candidate (T,) of each sample, such that squares add up to the least (Viterbi)."""
    rows, each = np.empty(arc.shape, dtype=np.int64), np.arange(arc.shape[1])
    total, top = np.zeros(arc.shape[1]), np.full(arc.shape[1], reached)
    for k, at in enumerate(arc):
        through = total[:, None] + np.maximum(top[:, None] - at, 0.0) ** 2
        rows[k] = through.argmin(axis=0)
        total = through[rows[k], each] + square[k]
        top = np.maximum(top[rows[k]], at)
    chosen = np.empty(len(arc), dtype=np.int64)
    at_last = int(np.argmin(total))
    for k in range(len(arc) - 1, -1, -1):
        chosen[k] = at_last
        at_last = int(rows[k, at_last])
    return chosen


def _spaced(q: FloatArray, step: float) -> IntArray:
    """Indices of samples each at least a step from the one before; the first and last as well."""
    picked = [0]
    square = step * step
    at = q[0]
    for k in range(1, len(q)):
        away = q[k] - at
        if away @ away >= square:
            picked.append(k)
            at = q[k]
    if picked[-1] != len(q) - 1:
        picked.append(len(q) - 1)
    return np.array(picked, dtype=np.int64)


def _forward(samples: FloatArray, knots: FloatArray) -> IntArray:
    """For each sample the index of a knot, never falling, such that the squared distances add up to
    the least."""
    cost = np.zeros(len(knots))
    came = np.empty((len(samples), len(knots)), dtype=np.int64)
    index = np.arange(len(knots))
    for k, sample in enumerate(samples):
        best = np.minimum.accumulate(cost)
        # Where the least so far was met: the last index at which it fell.
        fell = np.concatenate([[True], best[1:] < best[:-1]])
        came[k] = np.maximum.accumulate(np.where(fell, index, 0))
        away = knots - sample
        cost = best + np.einsum("ij,ij->i", away, away)
    steps = np.empty(len(samples), dtype=np.int64)
    at = int(np.argmin(cost))
    for k in range(len(samples) - 1, -1, -1):
        steps[k] = at
        at = int(came[k, at])
    return steps
