"""Which moment of an emulated motion each sample of a log belongs to, by place alone.

The match runs forward only: a path that crosses itself or goes back the way it came is matched in
its order. Time plays no part, so a slow or late log matches as well as a punctual one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import FloatArray, IntArray

COARSE = 800
"""Steps of the path, and at most about as many of the log, that the forward match looks at."""
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
        """The nearest point to each sample (T, N) between two vertices."""
        last = np.maximum(last, first + 1)
        segment, share = np.empty(len(q), dtype=np.int64), np.empty(len(q))
        # Windows of like width together, so that few of them are padded.
        order = np.argsort(last - first)
        begin = 0
        while begin < len(q):
            ahead = order[begin : begin + _MOST_ROWS]
            count = max(1, _MOST_CELLS // int((last - first)[ahead].max()))
            rows = ahead[:count]
            segment[rows], share[rows] = self._project(q[rows], first[rows], last[rows])
            begin += len(rows)
        time = (1 - share) * self.t[segment] + share * self.t[segment + 1]
        arc = (1 - share) * self.arc[segment] + share * self.arc[segment + 1]
        place = (1 - share)[:, None] * self.q[segment] + share[:, None] * self.q[segment + 1]
        return Match(time, arc, q - place, float(self.arc[-1]))

    def _project(
        self, q: FloatArray, first: IntArray, last: IntArray
    ) -> tuple[IntArray, FloatArray]:
        """Segment (R,) and share of it (R,) of the nearest point to each sample (R, N)."""
        width = int((last - first).max())
        segment = np.minimum(first[:, None] + np.arange(width), (last - 1)[:, None])
        begin = self.q[segment]
        step, away = self.q[segment + 1] - begin, q[:, None, :] - begin
        share = np.sum(away * step, axis=2) / np.sum(step * step, axis=2)
        share = np.clip(share, 0.0, 1.0)
        rest = away - share[:, :, None] * step
        best = np.argmin(np.sum(rest * rest, axis=2), axis=1)
        rows = np.arange(len(q))
        return segment[rows, best], share[rows, best]


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
