"""A proof that a motion is free of circles, between samples too.

A quadratic Bézier arc stays within |p₀ − 2p₁ + p₂|/4 of its chord. So the chord's distance from a
circle's centre less this bound is a distance that the whole arc keeps; where it is not enough, the
arc is halved, which quarters the bound.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from ...core.arrays import FloatArray
from .arcs import Arcs
from .scenes import Scene

_DEPTH = 40


class Answer(StrEnum):
    """What the proof came to."""

    FREE = "free"
    HIT = "hit"
    UNPROVEN = "unproven"


@dataclass(frozen=True, slots=True)
class Freedom:
    """Outcome of `prove_free`.

    Args:
        answer: ``free`` if every arc keeps the clearance from every circle.
        clearance: the least distance from a rim that is proven, or the one seen at the hit.
        arc: index of the first arc that hits, or could not be decided; −1 if free.
        circle: index of the circle that it hits; −1 if free.
        place: (x, y) there; the end of the motion if free.
    """

    answer: Answer
    clearance: float
    arc: int
    circle: int
    place: tuple[float, float]

    @property
    def free(self) -> bool:
        """Whether it is proven."""
        return self.answer is Answer.FREE


def prove_free(arcs: Arcs, scene: Scene, clearance: float = 0.0) -> Freedom:
    """Prove that a motion stays ``clearance`` away from every circle's rim, or find where not.

    A motion that touches the required distance exactly can be neither proven nor refuted: ask for a
    little less than the motion was planned with.
    """
    pieces = arcs.controls
    arc, circle = (a.ravel() for a in np.indices((len(pieces), len(scene.circles))))
    pieces = pieces[arc]
    proven = np.inf
    for _ in range(_DEPTH):
        if not len(arc):
            return Freedom(Answer.FREE, float(proven), -1, -1, _place(arcs.controls[-1, 2]))
        centre, radius = scene.centres[circle], scene.radii[circle]
        ends = np.linalg.norm(pieces[:, ::2] - centre[:, None], axis=2) - radius[:, None]
        hits = np.flatnonzero(ends.min(axis=1) < clearance)
        if len(hits):
            first = hits[0]
            worst = int(np.argmin(ends[first]))
            place = _place(pieces[first, 2 * worst])
            seen = float(ends[first, worst])
            return Freedom(Answer.HIT, seen, int(arc[first]), int(circle[first]), place)
        bound = _chord_distance(pieces, centre) - _bulge(pieces) - radius
        sure = bound >= clearance
        proven = min(proven, float(bound[sure].min(initial=np.inf)))
        pieces = _halves(pieces[~sure])
        arc, circle = np.repeat(arc[~sure], 2), np.repeat(circle[~sure], 2)
    place = _place(pieces[0, 0])
    return Freedom(Answer.UNPROVEN, clearance, int(arc[0]), int(circle[0]), place)


def _bulge(pieces: FloatArray) -> FloatArray:
    """How far each arc is from its chord at most (k,)."""
    bend = pieces[:, 0] - 2.0 * pieces[:, 1] + pieces[:, 2]
    return np.asarray(np.linalg.norm(bend, axis=1) / 4.0)


def _chord_distance(pieces: FloatArray, centre: FloatArray) -> FloatArray:
    """Distance of each chord from its centre (k,)."""
    begin, chord = pieces[:, 0] - centre, pieces[:, 2] - pieces[:, 0]
    length = np.maximum(np.einsum("kd,kd->k", chord, chord), 1e-300)
    s = np.clip(-np.einsum("kd,kd->k", begin, chord) / length, 0.0, 1.0)
    return np.asarray(np.linalg.norm(begin + s[:, None] * chord, axis=1))


def _halves(pieces: FloatArray) -> FloatArray:
    """Both halves of each arc (2k, 3, 2), by de Casteljau's algorithm."""
    p0, p1, p2 = pieces[:, 0], pieces[:, 1], pieces[:, 2]
    left, right = (p0 + p1) / 2.0, (p1 + p2) / 2.0
    middle = (left + right) / 2.0
    halves = np.stack([p0, left, middle, middle, right, p2], axis=1)
    return halves.reshape(-1, 3, 2)


def _place(point: FloatArray) -> tuple[float, float]:
    return float(point[0]), float(point[1])
