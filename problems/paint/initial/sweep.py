"""One sweep, from its first points to waypoints that fit the surface: steps 3a to 3d.

Section IV-A of D. Gleeson et al. 2022. A last step of ours spreads the waypoints evenly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ....core.arrays import BoolArray, FloatArray
from .projection import Projector, SprayFrames

MOST_STEPS = 200
"""Rounds of divisions, at most."""
CORRECTIONS = 5
"""How often an end's place is corrected."""
LEAST_AHEAD = 0.5
"""Share of an end's step that must lead ahead; less, and it has come to a corner."""
BUNCHED = 0.4
"""Least step of the gun, as a share of that on the surface."""
SMOOTHINGS = 50
"""How often directions are smoothed, at most."""
END = 1e-5
"""m within which an end lies where it should."""
UNEVEN = 1.02
"""Ratio of longest and shortest segment above which waypoints are spread anew."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """Waypoints across the surface, from one edge to the other.

    Args:
        frames: (M) of the waypoints on the surface or its extension, tangents along the sweep.
        feasible: (M,) False for points interpolated over what is no surface.
    """

    frames: SprayFrames
    feasible: BoolArray

    @property
    def lengths(self) -> FloatArray:
        """(M-1,) m between neighbours, on the surface."""
        return np.asarray(np.linalg.norm(np.diff(self.frames.point, axis=0), axis=1))

    @property
    def length(self) -> float:
        """m of the whole."""
        return float(self.lengths.sum())

    def reversed(self) -> Sweep:
        """The sweep in the other direction."""
        point, tangent, spray = (values[::-1] for values in self.frames)
        return Sweep(SprayFrames(point, -tangent, spray), self.feasible[::-1])


def fit(projector: Projector, frames: SprayFrames, reach: float | None = None) -> Sweep | None:
    """The sweep of frames along a line; None where less than two of them are feasible.

    Args:
        projector: onto the surface.
        frames: (M) in the order of the sweep.
        reach: as in `Projector.project`.
    """
    sweep = trimmed(projector, frames, reach)
    if sweep is None:
        return None
    sweep = extended(projector, extended(projector, sweep.reversed()).reversed())
    sweep = divided(projector, merged(projector, sweep))
    sweep = spread(projector, sweep)
    sweep = steadied(projector, steadied(projector, directed(sweep)).reversed()).reversed()
    return unbunched(sweep, projector.plan.distance)


def trimmed(projector: Projector, frames: SprayFrames, reach: float | None = None) -> Sweep | None:
    """Step 3a: what is not feasible goes at the ends and is interpolated between."""
    projected = projector.project(frames, reach)
    good = np.flatnonzero(projected.feasible)
    if len(good) < 2:
        return None
    rows = np.arange(good[0], good[-1] + 1)
    filled = _interpolated(projected.frames.at(good), good.astype(float), rows.astype(float))
    return Sweep(filled, projected.feasible[rows])


def extended(projector: Projector, sweep: Sweep) -> Sweep:
    """Step 3b: the last point as far beyond the edge as the overhang, along the tangent.

    Where the surface goes on for more than half a segment, waypoints are added.
    """
    plan = projector.plan
    frames, feasible = sweep.frames, sweep.feasible
    corrections, gone = 0, 0.0
    while corrections < CORRECTIONS and gone < projector.guide.size:
        end = frames.at(slice(-1, None))
        farthest = plan.longest_segment + plan.overhang
        beyond = float(projector.beyond(end, end.tangent, farthest)[0])
        missing = min(plan.overhang - beyond, plan.longest_segment)
        if abs(missing) <= END or math.isinf(missing):
            break
        moved = SprayFrames(end.point + missing * end.tangent, end.tangent, end.spray)
        projected = projector.project(moved)
        step = (projected.frames.point - end.point)[0] * np.sign(missing)
        if not projected.feasible[0] or step @ end.tangent[0] < LEAST_AHEAD * np.linalg.norm(step):
            break
        added = missing > 0.5 * plan.longest_segment
        corrections += not added
        gone += float(np.linalg.norm(step))
        kept = len(feasible) if added else len(feasible) - 1
        frames = _joined(frames.at(slice(0, kept)), projected.frames)
        feasible = np.append(feasible[:kept], True)
    return Sweep(frames, feasible)


def merged(projector: Projector, sweep: Sweep) -> Sweep:
    """Step 3c: waypoints nearer than half a segment become one; ends stay where they are."""
    frames, feasible = sweep.frames, sweep.feasible
    for _ in range(len(feasible)):
        length = np.linalg.norm(np.diff(frames.point, axis=0), axis=1)
        k = int(np.argmin(length))
        if len(feasible) <= 2 or length[k] >= 0.5 * projector.plan.longest_segment:
            break
        last = len(feasible) - 1
        if k == 0 or k + 1 == last:
            gone = 1 if k == 0 else last - 1
            rows = np.delete(np.arange(last + 1), gone)
            frames, feasible = frames.at(rows), feasible[rows]
            continue
        middle = _between(frames.at([k]), frames.at([k + 1]))
        projected = projector.project(middle)
        frames = _joined(frames.at(slice(0, k)), projected.frames, frames.at(slice(k + 2, None)))
        feasible = np.concatenate([feasible[:k], projected.feasible, feasible[k + 2 :]])
    return Sweep(frames, feasible)


def divided(projector: Projector, sweep: Sweep) -> Sweep:
    """Step 3d: segments that are too long are halved until none is."""
    frames, feasible = sweep.frames, sweep.feasible
    for _ in range(MOST_STEPS):
        length = np.linalg.norm(np.diff(frames.point, axis=0), axis=1)
        long = np.flatnonzero(length > projector.plan.longest_segment * (1.0 + 1e-6))
        if len(long) == 0 or len(feasible) > 100 * MOST_STEPS:
            break
        projected = projector.project(_between(frames.at(long), frames.at(long + 1)))
        frames = SprayFrames(
            *(
                np.insert(old, long + 1, new, axis=0)
                for old, new in zip(frames, projected.frames, strict=True)
            )
        )
        feasible = np.insert(feasible, long + 1, projected.feasible)
    return Sweep(frames, feasible)


def spread(projector: Projector, sweep: Sweep) -> Sweep:
    """The sweep with the fewest segments, equally long, that are not too long."""
    longest = projector.plan.longest_segment
    for _ in range(3):
        lengths = sweep.lengths
        count = math.ceil(sweep.length / longest * (1.0 - 1e-6))
        if count == len(lengths) and lengths.max() <= min(
            UNEVEN * lengths.min(), longest * (1.0 + 1e-6)
        ):
            break
        at = np.concatenate([[0.0], np.cumsum(lengths)])
        wanted = np.linspace(0.0, at[-1], count + 1)
        placed = _interpolated(sweep.frames, at, wanted)
        projected = projector.project(placed.at(slice(1, -1)))
        ends = sweep.frames.at([0, -1])
        frames = _joined(ends.at([0]), projected.frames, ends.at([1]))
        feasible = np.concatenate([[True], projected.feasible, [True]])
        sweep = divided(projector, Sweep(frames, feasible))
    return sweep


def directed(sweep: Sweep) -> Sweep:
    """The sweep with tangents along the mean of the neighbouring segments."""
    steps = np.diff(sweep.frames.point, axis=0)
    steps /= np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-12)
    ways = np.concatenate([steps[:1], steps[1:] + steps[:-1], steps[-1:]])
    return Sweep(_framed(sweep.frames.point, ways, sweep.frames.spray), sweep.feasible)


def steadied(projector: Projector, sweep: Sweep) -> Sweep:
    """The sweep without nods to the side near its last edge.

    Inner points of what lies near or beyond the edge are found straight back along the tangent;
    where the surface bends aside, as a flange along an arch does, they come to lie on another part
    of its section. There the gun keeps its tilt to the side and turns along the sweep alone.
    """
    frames, plan = sweep.frames, projector.plan
    to_end = sweep.length - np.concatenate([[0.0], np.cumsum(sweep.lengths)])
    inner = np.flatnonzero(to_end > min(plan.overhang + plan.offset, 0.5 * sweep.length))
    spray = frames.spray.copy()
    for k in range(inner[-1] + 1, len(spray)):
        side = np.cross(spray[k - 1], frames.tangent[k])
        side /= np.linalg.norm(side)
        kept = spray[k] - (spray[k] @ side) * side
        length = float(np.linalg.norm(kept))
        spray[k] = kept / length if length > 0.5 else spray[k - 1]
    return Sweep(_framed(frames.point, frames.tangent, spray), sweep.feasible)


def unbunched(sweep: Sweep, distance: float) -> Sweep:
    """The sweep with directions smoothed until the gun gets on everywhere.

    In a hollow whose radius is near the gun's distance, a gun at right angles to the surface would
    stand still, or go back. There its directions become means of their neighbours'.
    """
    frames = sweep.frames
    steps = np.diff(frames.point, axis=0)
    length = np.linalg.norm(steps, axis=1)
    spray = frames.spray
    for _ in range(SMOOTHINGS):
        gun = steps - distance * np.diff(spray, axis=0)
        bunched = np.einsum("ij,ij->i", gun, steps) < BUNCHED * length**2
        if not bunched.any():
            break
        at = np.flatnonzero(bunched)
        rows = np.unique(np.concatenate([at - 1, at, at + 1, at + 2]))
        rows = rows[(rows > 0) & (rows < len(spray) - 1)]
        if len(rows) == 0:
            break
        mean = 0.5 * spray[rows] + 0.25 * (spray[rows - 1] + spray[rows + 1])
        spray = spray.copy()
        spray[rows] = mean / np.linalg.norm(mean, axis=1, keepdims=True)
    return Sweep(_framed(frames.point, frames.tangent, spray), sweep.feasible)


def _framed(point: FloatArray, ways: FloatArray, spray: FloatArray) -> SprayFrames:
    """Frames with orthogonal unit directions."""
    spray = spray / np.linalg.norm(spray, axis=1, keepdims=True)
    across = ways - np.einsum("ij,ij->i", ways, spray)[:, None] * spray
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return SprayFrames(point, across / np.maximum(length, 1e-12), spray)


def _interpolated(frames: SprayFrames, at: FloatArray, wanted: FloatArray) -> SprayFrames:
    """Frames at other parameters than those at which they are known, in rising order."""
    values = [
        np.stack([np.interp(wanted, at, one[:, k]) for k in range(3)], axis=1) for one in frames
    ]
    return _framed(*values)


def _between(a: SprayFrames, b: SprayFrames) -> SprayFrames:
    """Frames in the middle."""
    return _framed(0.5 * (a.point + b.point), a.tangent + b.tangent, a.spray + b.spray)


def _joined(*frames: SprayFrames) -> SprayFrames:
    return SprayFrames(*(np.concatenate(values) for values in zip(*frames, strict=True)))
