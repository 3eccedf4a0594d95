"""What is proven of pairs that touch at an end of a way: clear where apart, else not too deep."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...motion.path.path import Path
from ..scene.handled_pairs import APART, ApartRows, apart_rows, least_kept
from ..scene.scene import CollisionScene, TouchingPairs
from .enclosure import Span
from .findings import FailureCause, UnprovenStretch
from .subdivision import Prover
from .verdict import CONTACT

_SLACKS = (APART, 4.0 * APART, 16.0 * APART)
"""m beyond what is proven, from which pairs count as apart; the first at which they are clear."""


class SceneFinding(NamedTuple):
    """What is not proven.

    Args:
        scene: the bodies.
        stretch: where.
        wanted: m that was to be kept there; negative is how deep bodies may be in each other.
    """

    scene: CollisionScene
    stretch: UnprovenStretch
    wanted: float


@dataclass(frozen=True)
class TouchingProof:
    """Proves pairs that touch at an end of one way.

    Args:
        touching: the pairs.
        path: the way is on.
        moves: of the way, as far as they are looked at.
        spans: of the path, that are to be proven.
        provers: make those of a scene, with a residual, and their pieces.
        residual: m.
        wanted: m that bodies keep where they are apart.
    """

    touching: TouchingPairs
    path: Path
    moves: Collection[int]
    spans: Sequence[Span]
    provers: Callable[[CollisionScene, float], list[tuple[Prover, list[int]]]]
    residual: float
    wanted: float

    def findings(self) -> list[SceneFinding]:
        """What is not proven of them."""
        touching = self.touching
        rows, distance = self._sampled()
        found = list(self._back_in(rows, distance))
        left = np.arange(len(touching.floor))
        before: dict[int, list[SceneFinding]] = {}
        for slack in _SLACKS:
            limit = self.wanted + self.residual + slack
            apart = apart_rows(distance[:, left], limit, touching.floor[left])
            # What is nowhere apart by more is not proven to be clear where it is by less.
            for row in left[apart.never].tolist():
                found += before.get(row, [])
            again = np.zeros(len(left), dtype=np.bool_)
            for first, last, which in _alike(apart):
                span = float(self.path.sigma[rows[first]]), float(self.path.sigma[rows[last]])
                scene = touching.scene.of_pairs(touching.scene.pairs[left[which]])
                met = self._prove(scene, self.residual, [span], self.wanted)
                # What is near again once it was apart is so, wherever apart is said to begin.
                again[which] = bool(met) and slack < _SLACKS[-1] and not _near(met)
                if again[which].any():
                    before |= dict.fromkeys(left[which].tolist(), met)
                else:
                    found += met
            done = ~again
            found += self._too_deep(left[done], _of(apart, done), rows)
            left = left[again]
        return found

    def never_apart(self) -> bool:
        """Whether a pair is apart nowhere on the way."""
        _, distance = self._sampled()
        limit = self.wanted + self.residual + APART
        return bool(apart_rows(distance, limit, self.touching.floor).never.any())

    def _sampled(self) -> tuple[IntArray, FloatArray]:
        """Rows of the path that are of the way, and the pairs' distances (M, K) there."""
        rows = np.flatnonzero(np.isin(self.path.sample_moves(), list(self.moves)))
        within = self.wanted + self.residual + _SLACKS[-1]
        return rows, self.touching.scene.distances(self.path.q[rows], within).distance

    def _back_in(self, rows: IntArray, distance: FloatArray) -> Iterator[SceneFinding]:
        """Where pairs have gone into each other again, or on across, before they were apart."""
        touching, scene, path = self.touching, self.touching.scene, self.path
        limit = self.wanted + self.residual + APART
        apart = apart_rows(distance, limit, touching.floor)
        least = least_kept(touching, path.q[rows], distance, apart)
        asked = np.zeros(len(rows), dtype=np.bool_)
        for first, last in self.spans:
            asked |= (path.sigma[rows] >= first) & (path.sigma[rows] <= last)
        deep = (distance < least) & np.isfinite(least) & asked[:, None]
        deep &= least > touching.floor.min(axis=1)
        for pair in np.flatnonzero(deep.any(axis=0)).tolist():
            k = int(np.where(deep[:, pair], distance[:, pair], math.inf).argmin())
            row = int(rows[k])
            sigma, kept = float(path.sigma[row]), float(least[k, pair])
            piece = int(np.searchsorted(path.pieces.first_sample, row, "right")) - 1
            stretch = UnprovenStretch(
                FailureCause.NEAR,
                piece,
                sigma,
                sigma,
                sigma,
                path.q[row],
                0,
                float(distance[k, pair]),
                1.0,
            )
            yield SceneFinding(scene.of_pairs(scene.pairs[pair : pair + 1]), stretch, kept)

    def _too_deep(self, left: IntArray, apart: ApartRows, rows: IntArray) -> list[SceneFinding]:
        """Where pairs go deeper into each other than they may, before they are apart and behind.

        What the model's residual does there is left out: it is the emulated motion that touches.
        """
        touching, sigma = self.touching, self.path.sigma[rows]
        asked: dict[tuple[float, float, float, bool], list[int]] = {}
        for row, first, last in zip(left.tolist(), *apart, strict=True):
            floor = touching.floor[row].tolist()
            ends = [(0, first, floor[0]), (last, len(rows) - 1, floor[1])]
            if first > last:
                ends = [(0, len(rows) - 1, min(floor))]
            for begin, end, least in ends:
                if math.isfinite(least) and begin < end:
                    meshed = least < 0.0 and bool(touching.meshed[row])
                    key = float(sigma[begin]), float(sigma[end]), least, meshed
                    asked.setdefault(key, []).append(row)
        found: list[SceneFinding] = []
        for (begin, end, least, meshed), which in asked.items():
            scene = touching.scene if touching.shrunk is None or not meshed else touching.shrunk
            alone = scene.of_pairs(scene.pairs[which])
            kept = CONTACT if meshed or least > 0.0 else least
            met = self._prove(alone, 0.0, [(begin, end)], kept)
            found += [finding._replace(wanted=least) for finding in met]
        return found

    def _prove(
        self,
        scene: CollisionScene,
        residual: float,
        stretches: Sequence[Span],
        wanted: float,
    ) -> list[SceneFinding]:
        asked = [
            (max(first, begin), min(last, end))
            for first, last in self.spans
            for begin, end in stretches
            if first < end and last > begin
        ]
        if not asked:
            return []
        provers = self.provers(scene, residual)
        met = [prover.prove(asked, pieces, wanted) for prover, pieces in provers]
        return [SceneFinding(scene, stretch, wanted) for stretch in met if stretch is not None]


def _alike(apart: ApartRows) -> Iterator[tuple[int, int, BoolArray]]:
    """First and last sample, and the pairs that are apart from there to there."""
    both = np.stack(apart, axis=1)
    for first, last in np.unique(both[~apart.never], axis=0).tolist():
        yield first, last, (both == (first, last)).all(axis=1)


def _of(apart: ApartRows, which: BoolArray) -> ApartRows:
    return ApartRows(apart.first[which], apart.last[which])


def _near(met: Sequence[SceneFinding]) -> bool:
    return any(finding.stretch.cause is FailureCause.NEAR for finding in met)
