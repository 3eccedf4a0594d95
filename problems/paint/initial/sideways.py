"""Sweeps walked sideways over the surface: the modified method, section IV-C.

One projected sweep is carried to both sides in small steps, each laid on the surface anew, so that
the distance between sweeps is that on the surface, whatever its slope. Where the paper takes any
stable sweep, that with the least bending in the surface is taken here (its discussion names why:
bends grow as sweeps are carried on), shifted so that as much is left over on both sides.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....core.arrays import BoolArray, FloatArray
from .projection import Projector, SprayFrames
from .raster import sweep_count
from .sweep import Sweep, directed, fit

STEPS = 9
"""Steps of a walk over one sweep width."""
CORRECTIONS = 4
"""Further steps by which a walk's length is met."""
LONG = 0.8
"""Share of the longest sweep's length that a sweep to start from must have."""
FARTHEST = 2.0
"""How far sweeps are carried, by the surface's size: half round a ball it is 0.9 times."""


class Walked(NamedTuple):
    """Points carried sideways.

    Args:
        frames: where they are; those that are not feasible go straight on.
        feasible: (M,).
        inside: (M,) whether they lie on the surface.
        extent: (M,) m after which each point came to the surface's edge; inf if it did not.
    """

    frames: SprayFrames
    feasible: BoolArray
    inside: BoolArray
    extent: FloatArray


def sideways(projector: Projector, candidates: list[Sweep]) -> list[Sweep]:
    """Sweeps over the surface, from one side to the other, all in one direction.

    Args:
        projector: onto the surface.
        candidates: sweeps of the raster, one or more.
    """
    width = projector.plan.sweep_width
    start = straightest(candidates)
    left, right = (_extent(projector, start, sign) for sign in (-1.0, 1.0))
    count = sweep_count(left + right, width)
    places = -left + 0.5 * (left + right - (count - 1) * width) + width * np.arange(count)
    first = int(np.argmin(np.abs(places)))
    moved = _carried(projector, start, float(places[first]))
    start = start if moved is None else moved
    before = _chain(projector, start, -width, first)
    after = _chain(projector, start, width, count - 1 - first)
    return [*before[::-1], start, *after]


def straightest(candidates: list[Sweep]) -> Sweep:
    """Of the long sweeps that which bends least in the surface; in the middle among equals."""
    longest = max(sweep.length for sweep in candidates)
    middle = 0.5 * (len(candidates) - 1)

    def cost(k: int) -> tuple[float, float]:
        return round(_bending(candidates[k]), 3), abs(k - middle)

    long = [k for k, sweep in enumerate(candidates) if sweep.length >= LONG * longest]
    return candidates[min(long, key=cost)]


def _bending(sweep: Sweep) -> float:
    """rad by which a sweep turns within the surface, all in all."""
    steps = np.diff(sweep.frames.point, axis=0)
    steps /= np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-12)
    spray = sweep.frames.spray[1:-1]
    turn = np.einsum("ij,ij->i", np.cross(steps[:-1], steps[1:]), spray)
    return float(np.abs(np.arcsin(np.clip(turn, -1.0, 1.0))).sum())


def walk(projector: Projector, sweep: Sweep, distance: float) -> Walked:
    """All points of a sweep carried by a distance (m, with sign) along b = n × t.

    Lengths are measured on the surface, as the sum of the steps.
    """
    frames = directed(sweep).frames
    side = frames.side * np.sign(distance)
    n = len(side)
    left = np.full(n, abs(distance))
    gone = np.zeros(n)
    extent = np.full(n, np.inf)
    feasible = np.ones(n, dtype=bool)
    inside = projector.guide.meet(frames.point, frames.spray, projector.reach).found
    extent[~inside] = 0.0
    longest = projector.plan.sweep_width / STEPS
    for _ in range(int(np.ceil(abs(distance) / longest)) + CORRECTIONS):
        if np.abs(left).max() <= 1e-6:
            break
        step = np.clip(left, -longest, longest)
        frames, side, feasible, moved, now = _step(projector, frames, side, step)
        leaving = inside & ~now & np.isinf(extent)
        if leaving.any():
            back = projector.beyond(frames.at(leaving), side[leaving], 2.0 * longest)
            extent[leaving] = gone[leaving] + moved[leaving] - np.clip(back, 0.0, moved[leaving])
        inside &= now
        gone += np.sign(step) * moved
        left = abs(distance) - gone
    return Walked(frames, feasible, inside, extent)


def _step(
    projector: Projector, frames: SprayFrames, side: FloatArray, step: FloatArray
) -> tuple[SprayFrames, FloatArray, BoolArray, FloatArray, BoolArray]:
    """Points carried by one step; the side's direction is turned with the surface."""
    ahead = SprayFrames(frames.point + step[:, None] * side, frames.tangent, frames.spray)
    projected = projector.project(ahead)
    new = projected.frames
    moved = np.linalg.norm(new.point - frames.point, axis=1)
    side = side - np.einsum("ij,ij->i", side, new.spray)[:, None] * new.spray
    side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-12)
    tangent = np.cross(side, new.spray)
    tangent *= np.sign(np.einsum("ij,ij->i", tangent, new.tangent))[:, None]
    new = SprayFrames(new.point, tangent, new.spray)
    return new, side, projected.feasible, moved, projected.inside


def _extent(projector: Projector, sweep: Sweep, sign: float) -> float:
    """m from a sweep to the surface's edge on one side, where that is farthest.

    Walked one sweep width after the other, so that the sweep gets new points where it widens.
    """
    width = projector.plan.sweep_width
    total = 0.0
    while total < FARTHEST * projector.guide.size:
        walked = walk(projector, sweep, sign * width)
        if not np.isinf(walked.extent).any():
            return total + float(walked.extent.max())
        total += width
        moved = _refitted(projector, walked)
        if moved is None:
            return total
        sweep = moved
    return total


def _carried(projector: Projector, sweep: Sweep, distance: float) -> Sweep | None:
    """The sweep at a distance from another; None where there is no surface."""
    if abs(distance) <= 1e-6:
        return sweep
    return _refitted(projector, walk(projector, sweep, distance))


def _refitted(projector: Projector, walked: Walked) -> Sweep | None:
    """The sweep through points carried to a new place."""
    # What hangs over at the ends is laid anew by step 3b: carried along, it would drift.
    rows = np.flatnonzero(walked.inside)
    if len(rows) < 2:
        return fit(projector, walked.frames)
    return fit(projector, walked.frames.at(slice(rows[0], rows[-1] + 1)))


def _chain(projector: Projector, sweep: Sweep, width: float, count: int) -> list[Sweep]:
    """Sweeps one after the other, each from the one before."""
    found: list[Sweep] = []
    for _ in range(count):
        carried = _carried(projector, sweep, width)
        if carried is None:
            break
        found.append(carried)
        sweep = carried
    return found
