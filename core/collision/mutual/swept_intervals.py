"""Where the bodies of one robot are on intervals of its path, and how far they move there.

With t from −1 to 1 along an interval, a body is where it stands at the middle, but for at most
``motion``: what the path makes of it, what deviations of the joints from the path add, and a
residual. A second, directed bound is linear in t with a remainder ``bend``, as in `..proof.sweep`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ..proof.boxes import Boxes
from ..proof.sweep import measure_levers, middle_of, place, travel
from ..scene.frames import FrameTree
from ..scene.outline import Outlines


class SweptIntervals(NamedTuple):
    """L intervals of one robot's path with its B bodies and F frames.

    Args:
        R, p: (L, F, 3, 3), (L, F, 3) m, the frames at the middles.
        centre, edges: (L, B, 3), (L, B, 3, 3) m, boxes round the bodies at the middles.
        motion: (L, B) m, how far a body gets from where it is at the middle; infinite where
            nothing is known.
        off: (L, B) m, of it what deviations and the residual add.
        bend: (L, B) m, bound of a body's acceleration by t.
        omega, origin: (L, B, 3), angular velocity and velocity of the world's origin by t at the
            middle.
        low, high: (L, B, 3) m, boxes along the world's axes that hold a body on the interval;
            turned inside out where it is not there.
    """

    R: FloatArray
    p: FloatArray
    centre: FloatArray
    edges: FloatArray
    motion: FloatArray
    off: FloatArray
    bend: FloatArray
    omega: FloatArray
    origin: FloatArray
    low: FloatArray
    high: FloatArray

    @staticmethod
    def empty(count: int, bodies: int, frames: int) -> SweptIntervals:
        """Room for ``count`` intervals."""
        return SweptIntervals(
            np.empty((count, frames, 3, 3)),
            np.empty((count, frames, 3)),
            np.empty((count, bodies, 3)),
            np.empty((count, bodies, 3, 3)),
            *(np.empty((count, bodies)) for _ in range(3)),
            *(np.empty((count, bodies, 3)) for _ in range(4)),
        )

    def joined(self, *more: SweptIntervals) -> SweptIntervals:
        """These, and more behind them."""
        return SweptIntervals._make(map(np.concatenate, zip(self, *more, strict=True)))

    def chosen(self, which: NDArray[np.bool_] | IntArray) -> SweptIntervals:
        """Some of them."""
        return SweptIntervals._make(a[which] for a in self)


@njit(cache=True, error_model="numpy")
def sweep_intervals(
    tree: FrameTree,
    outlines: Outlines,
    boxes: Boxes,
    most_off: FloatArray,
    residual: float,
    present: NDArray[np.bool_],
    found: SweptIntervals,
) -> None:
    """Fill in what bodies do on intervals.

    Args:
        tree: the frames.
        outlines: of B bodies, and of one more that stands in the world.
        boxes: enclosures of the L intervals.
        most_off: (L, N) rad or m, how far joints may be from the path.
        residual: m by which a moving body may be elsewhere.
        present: (L, B), which bodies are there.
        found: written.
    """
    at = middle_of(tree, outlines)
    still = outlines.frame.size - 1
    for i in range(boxes.q.shape[0]):
        place(at, boxes.q[i])
        measure_levers(at, boxes.reach[i], most_off[i])
        found.R[i], found.p[i] = at.R, at.p
        for b in range(still):
            motion = travel(at, boxes, most_off[i], residual, i, b, still)
            known = boxes.verified[i]
            found.motion[i, b] = motion.reach + motion.deviation if known else np.inf
            found.off[i, b] = motion.deviation
            found.bend[i, b] = motion.bend
            for k in range(3):
                found.omega[i, b, k] = motion.omega[k]
                found.origin[i, b, k] = motion.origin[k]
                width = 0.0
                for e in range(3):
                    found.edges[i, b, e, k] = at.edges[b, e, k]
                    width += abs(at.edges[b, e, k])
                width = min(width, outlines.reach[b]) + found.motion[i, b]
                found.centre[i, b, k] = at.centre[b, k]
                here = present[i, b]
                found.low[i, b, k] = at.centre[b, k] - width if here else np.inf
                found.high[i, b, k] = at.centre[b, k] + width if here else -np.inf
