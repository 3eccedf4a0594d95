"""The coat on a painted part as a page shows it: at the end, and as it builds up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from ...core.arrays import FloatArray
from ...core.spatial.pose import Pose
from ...drawing.page.content import PageCoat, PageGrowth, PageSpray
from ...drawing.page.packing import Quantised, whole
from ...drawing.page.shapes import page_mesh
from ..results.painted import MICRON, TOLERANCE, PaintedPart

if TYPE_CHECKING:
    from ...problems.paint.spray.trajectory import PaintTrajectory

STEPS = 200
"""Of a thickness up to the target: finer than its colours."""
MOST_TIMES, MOST_NUMBERS = 120, 4_000_000
"""Times at which the coat is kept, and numbers that are: points × times."""
_TIP_EVERY = 0.05
"""s between directions of the nozzle."""


def page_coat(found: PaintedPart, place: Pose) -> PageCoat:
    """The coat of a painted part.

    Args:
        place: of the part in the world.
    """
    part = found.painting.judge.part
    _, last = list(found.coats.items())[-1]
    thickness = np.full(len(part.vertices), np.nan)
    thickness[part.painted] = last.thickness
    matrix = place.matrix()
    vertices = part.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    motion, begin = _driven(found)
    return PageCoat(
        0,
        page_mesh(vertices, part.faces),
        Quantised(thickness, 0.02 * MICRON),
        last.target,
        TOLERANCE,
        Quantised(_strokes(motion) + begin, 1e-3),
        _growth(found, motion, begin, last.target),
        _spray(found, motion, begin, place),
    )


def _driven(found: PaintedPart) -> tuple[PaintTrajectory, float]:
    """The gun's motion, and when it begins, s."""
    if found.made is None:
        return found.painting.best, 0.0
    motion = found.made.driven.trajectory
    return motion, float(found.made.driven.run.trajectory.t[-1]) - motion.total_duration


def _strokes(motion: PaintTrajectory) -> FloatArray:
    """(S, 2) s, when the gun is on."""
    on = np.concatenate([[False], motion.painting, [False]]).astype(np.int8)
    first, last = np.flatnonzero(np.diff(on) > 0), np.flatnonzero(np.diff(on) < 0)
    return np.column_stack([motion.times[first], motion.times[last]])


def _growth(
    found: PaintedPart, motion: PaintTrajectory, begin: float, target: float
) -> PageGrowth | None:
    """Thickness at times between which the gun paints equally long; None where it never does."""
    if not motion.painting.any():
        return None
    judge = found.painting.judge
    deposition = judge.deposition.with_visible(judge.visible(motion))
    points = judge.deposition.samples.size
    count = int(np.clip(MOST_NUMBERS // points, 8, MOST_TIMES))
    spent = np.concatenate([[0.0], np.cumsum(motion.duration * motion.painting)])
    edges = np.interp(np.linspace(0.0, spent[-1], count + 1), spent, motion.times)
    laid = np.asarray(deposition.rates(motion) @ _shares(motion.times, edges).toarray())
    step = target / STEPS
    # Sums are rounded, not what they are of: errors do not add up.
    sums = np.rint(np.cumsum(laid, axis=1) / step)
    steps = np.diff(sums, axis=1, prepend=0.0)
    return PageGrowth(Quantised(edges + begin, 1e-3), whole(steps), step)


def _shares(times: FloatArray, edges: FloatArray) -> sparse.csr_array:
    """(S, K) s that each segment has in each interval between edges."""
    cuts = np.unique(np.concatenate([times, edges]))
    middle, width = 0.5 * (cuts[1:] + cuts[:-1]), np.diff(cuts)
    segment = np.searchsorted(times, middle) - 1
    interval = np.searchsorted(edges, middle) - 1
    inside = (interval >= 0) & (interval < len(edges) - 1)
    shape = (len(times) - 1, len(edges) - 1)
    return sparse.csr_array((width[inside], (segment[inside], interval[inside])), shape=shape)


def _spray(found: PaintedPart, motion: PaintTrajectory, begin: float, place: Pose) -> PageSpray:
    """The cone in which paint leaves the gun, as it moves."""
    footprint = found.painting.judge.footprint
    count = max(2, int(motion.total_duration / _TIP_EVERY) + 1)
    times = np.linspace(0.0, motion.total_duration, count)
    nozzle = np.column_stack([np.interp(times, motion.times, axis) for axis in motion.nozzle.T])
    nozzle /= np.linalg.norm(nozzle, axis=1, keepdims=True)
    return PageSpray(
        Quantised(times + begin, 1e-3),
        Quantised(nozzle @ place.matrix()[:3, :3].T, 0.01),
        footprint.reference_distance,
        float(footprint.knots[-1]),
    )
