"""Subdivision of a path until every pair of bodies is proven to keep a distance, or is not.

All intervals of one level are asked at once. What stays open on an interval goes on to both
halves of it, with the plane that last came between the bodies: it often closes the halves
without another distance query.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ..deviation.bounds import DeviationBounds, by_interval
from ..scene.scene import CollisionScene
from .boxes import Boxes
from .enclosure import EnclosedIntervals, Enclosure, Span
from .findings import Budget, FailureCause, NearestPair, UnprovenStretch
from .items import Items, Sweeps
from .sweep import sweep

ROUNDING = 1e-6
"""m by which measured distances may be off."""
_LOCATED = 1e-3
"""m of motion below which the beginning of a violation counts as found."""
_STALLED = 1e-7
"""m of motion below which an interval is not halved any more."""
_NARROWEST = 1e-9
"""Share of a piece, likewise."""
_WIDE = 0.25
"""m of motion above which bodies are not measured: what is far is seen from boxes, the rest is
halved anyway."""


@dataclass
class Prover:
    """Proves distances along one path in one scene.

    Args:
        enclosure: of the path.
        scene: the bodies.
        deviations: how far joints may be from the path.
        residual: m by which moving bodies may be elsewhere.
        budget: shared by all provers of a certificate.
    """

    enclosure: Enclosure
    scene: CollisionScene
    deviations: DeviationBounds
    residual: float
    budget: Budget

    def __post_init__(self) -> None:
        self.nearest = NearestPair()
        self.proven = math.inf
        """m, the least of what was proven so far."""

    def prove(
        self, spans: Sequence[Span], pieces: Sequence[int], wanted: float
    ) -> UnprovenStretch | None:
        """The first stretch on which ``wanted`` m are not kept; None if they are kept.

        A stretch that is too near counts before one that is merely not proven.
        """
        return _Search(self, wanted, None).run(spans, pieces)

    def tighten(
        self, spans: Sequence[Span], pieces: Sequence[int], resolution: float
    ) -> UnprovenStretch | None:
        """Prove the least distance itself, to ``resolution`` m; it stands in ``proven`` then.

        Where that cannot be done, ``proven`` stays what it was.
        """
        before, self.proven = self.proven, math.inf
        finding = _Search(self, -math.inf, resolution).run(spans, pieces)
        self.proven = before if finding is not None else max(before, self.proven)
        return finding

    def sweep(self, boxes: Boxes, begin: FloatArray, end: FloatArray, items: Items) -> Sweeps:
        """Lower bounds of distances on intervals with these enclosures, from σ to σ (M,)."""
        found = Sweeps(*(np.empty(len(items.pair)) for _ in Sweeps._fields))
        sweep(
            self.scene.frames,
            self.scene.outlines,
            self.scene.pairs,
            boxes,
            self.deviations,
            by_interval(self.deviations, begin, end),
            self.residual,
            items,
            found,
        )
        return found


class _Search:
    """One subdivision.

    Args:
        prover: what is known.
        wanted: m to prove.
        resolution: m below the least distance met that are enough instead; None to prove
            ``wanted``.
    """

    def __init__(self, prover: Prover, wanted: float, resolution: float | None) -> None:
        self._prover = prover
        self._wanted = wanted
        self._resolution = resolution
        self._violation: UnprovenStretch | None = None
        self._unproven: UnprovenStretch | None = None

    def run(self, spans: Sequence[Span], pieces: Sequence[int]) -> UnprovenStretch | None:
        """The first finding."""
        prover = self._prover
        intervals = prover.enclosure.over(spans, pieces)
        items = Items.every(len(intervals), len(prover.scene.pairs))
        if self._resolution is not None:
            self._look_around(intervals, items)
        while len(items.pair):
            prover.budget.take(len(intervals))
            items = self._open(intervals, items)
            items = items.chosen(self._worth_halving(intervals, items))
            if not len(items.pair):
                break
            if prover.budget.left < 0:
                self._keep(self._finding(intervals, items, 0, FailureCause.EXHAUSTED))
                break
            which, rows = np.unique(items.interval, return_inverse=True)
            intervals = prover.enclosure.halves(intervals, which)
            items = items._replace(interval=rows).on_both_halves()
        return self._violation or self._unproven

    def _look_around(self, intervals: EnclosedIntervals, items: Items) -> None:
        """Measure at the middles, so that there is a least distance to go by."""
        if self._prover.nearest.kept == math.inf:
            sound = items.chosen(intervals.boxes.verified[items.interval])
            self._measured(intervals, sound, self._swept(intervals, sound))

    @property
    def _goal(self) -> float:
        """m that every pair has to keep."""
        if self._resolution is None:
            return self._wanted
        return self._prover.nearest.kept - self._resolution

    def _open(self, intervals: EnclosedIntervals, items: Items) -> Items:
        """Prove what can be proven; the rest."""
        verified = intervals.boxes.verified[items.interval]
        unknown, known = items.chosen(~verified), items.chosen(verified)
        found = self._swept(intervals, known)
        left = self._left(found)
        # Where it is not known how far joints deviate, halving tells no more.
        wide = (found.motion > _WIDE) & np.isfinite(found.deviation)
        near = left & ~wide
        asked = self._measured(intervals, known.chosen(near), Sweeps(*(a[near] for a in found)))
        again = self._swept(intervals, asked)
        near = self._left(again)
        near &= self._judged(intervals, asked, again, near)
        return Items.joined(unknown, known.chosen(left & wide), asked.chosen(near))

    def _swept(self, intervals: EnclosedIntervals, items: Items) -> Sweeps:
        """Lower bounds of the items' distances."""
        of = self._prover.enclosure.sigma
        begin, end = (of(intervals.piece, edge) for edge in (intervals.begin, intervals.end))
        return self._prover.sweep(intervals.boxes, begin, end, items)

    def _left(self, found: Sweeps) -> NDArray[np.bool_]:
        """Which items are still open; the others count as proven."""
        # What is not a number is not proven.
        left = ~(found.lower >= self._goal)
        least = float(found.lower[~left].min(initial=math.inf))
        self._prover.proven = min(self._prover.proven, least)
        return np.asarray(left)

    def _measured(self, intervals: EnclosedIntervals, items: Items, found: Sweeps) -> Items:
        """The items with distances and planes at the middles."""
        if not len(items.pair):
            return items
        prover = self._prover
        which, rows = np.unique(items.interval, return_inverse=True)
        q = intervals.boxes.q[which]
        motion = np.nan_to_num(found.motion, nan=math.inf, posinf=math.inf)
        within = np.maximum(self._goal + motion, 0.0) + 2 * ROUNDING
        distance, normal = prover.scene.chosen_distances(q, (rows, items.pair), within)
        prover.budget.take(len(items.pair))
        met = np.flatnonzero(distance < within)
        if len(met):
            nearest = met[np.argmin((distance - found.deviation)[met])]
            self._remember(intervals, items._replace(distance=distance, normal=normal), nearest)
        return items._replace(distance=distance - ROUNDING, normal=normal)

    def _remember(self, intervals: EnclosedIntervals, items: Items, k: np.int64) -> None:
        """Keep the k-th item if it is the nearest so far."""
        prover, row = self._prover, int(items.interval[k])
        q, sigma = intervals.boxes.q[row], self._middle(intervals, row)
        here, asked = np.array([sigma]), np.arange(len(items.pair)) == k
        alone = items.chosen(asked)._replace(interval=np.zeros(1, np.int64))
        distance = float(items.distance[k])
        kept = distance - float(prover.sweep(Boxes.at(q), here, here, alone).deviation[0])
        if kept < prover.nearest.kept:
            piece, pair = int(intervals.piece[row]), int(items.pair[k])
            prover.nearest = NearestPair(kept, distance, sigma, piece, pair, q)

    def _judged(
        self, intervals: EnclosedIntervals, items: Items, found: Sweeps, near: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        """Note which open items are too near; whether halving them can tell more."""
        travel = found.travel
        stalled = near & (travel < _STALLED)
        if self._resolution is not None:
            self._note(intervals, items, stalled, FailureCause.STALLED)
            return ~stalled
        distance = items.distance + ROUNDING
        too_near = near & (distance < self._wanted)
        # On a wide interval the levers of the deviations are not known well.
        located = (travel < _LOCATED) | ~np.isfinite(found.deviation)
        deviated = near & located & ~(distance - found.deviation >= self._wanted)
        # Where the path alone is clear it is the deviations beside that leave it open.
        deviated |= stalled & (distance - travel >= self._wanted + 2.0 * ROUNDING)
        self._note(intervals, items, too_near, FailureCause.NEAR)
        self._note(intervals, items, deviated & ~too_near, FailureCause.DEVIATION)
        self._note(intervals, items, stalled & ~deviated, FailureCause.STALLED)
        return ~(stalled | deviated)

    def _note(
        self,
        intervals: EnclosedIntervals,
        items: Items,
        chosen: NDArray[np.bool_],
        cause: FailureCause,
    ) -> None:
        """Keep the first of the chosen items as a finding."""
        if chosen.any():
            # Items come in the order of the path.
            self._keep(self._finding(intervals, items, int(np.argmax(chosen)), cause))

    def _worth_halving(self, intervals: EnclosedIntervals, items: Items) -> NDArray[np.bool_]:
        """Which items lie before the first violation and are not too narrow to be halved."""
        row = items.interval
        piece, begin, end = intervals.piece[row], intervals.begin[row], intervals.end[row]
        narrow = end - begin < _NARROWEST * self._prover.enclosure.whole(piece)
        sound = intervals.boxes.verified[row]
        self._note(intervals, items, narrow & sound, FailureCause.STALLED)
        self._note(intervals, items, narrow & ~sound, FailureCause.UNVERIFIED)
        if self._violation is None:
            return ~narrow
        start = self._prover.enclosure.sigma(piece, begin)
        return np.asarray(~narrow & (start < self._violation.sigma))

    def _finding(
        self, intervals: EnclosedIntervals, items: Items, k: int, cause: FailureCause
    ) -> UnprovenStretch:
        row = int(items.interval[k])
        blamed = cause not in (FailureCause.UNVERIFIED, FailureCause.EXHAUSTED)
        enclosure, piece = self._prover.enclosure, intervals.piece[row : row + 1]
        begin, end = (enclosure.sigma(piece, a[row : row + 1]) for a in intervals[1:3])
        return UnprovenStretch(
            cause,
            int(piece[0]),
            float(begin[0]),
            float(end[0]),
            self._middle(intervals, row),
            intervals.boxes.q[row],
            int(items.pair[k]) if blamed else None,
            float(items.distance[k]) + ROUNDING if blamed else None,
            float(intervals.boxes.conditioning[row]),
        )

    def _middle(self, intervals: EnclosedIntervals, row: int) -> float:
        middle = 0.5 * (intervals.begin[row : row + 1] + intervals.end[row : row + 1])
        return float(self._prover.enclosure.sigma(intervals.piece[row : row + 1], middle)[0])

    def _keep(self, finding: UnprovenStretch) -> None:
        """Remember the first of each kind along the path."""
        if finding.cause is FailureCause.NEAR:
            if self._violation is None or finding.sigma < self._violation.sigma:
                self._violation = finding
        elif self._unproven is None or finding.begin < self._unproven.begin:
            self._unproven = finding
