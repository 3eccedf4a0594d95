"""The thickness of the coat that a trajectory leaves, and its exact derivatives.

Each segment is a fixed number of sub-points, each of which stands for its share of the segment's
duration: the coat is exactly linear in the durations, and a smooth function of the waypoints.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeVar

import numpy as np
from scipy import sparse

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.errors import InputError
from ..spray.footprint import Footprint
from ..spray.trajectory import PaintTrajectory
from ..surface.samples import SurfaceSamples
from .kernels import Brush, Cone, Guns, Surface
from .loops import add_adjoint, add_block, add_coat, fill_jacobian, fill_rates, live_segments
from .surface_blocks import grouped

T = TypeVar("T")

SUBPOINTS = 4
"""Of a segment; enough where segments are not longer than half the footprint's radius."""
WORKERS = min(4, os.cpu_count() or 1)
_CHUNK = 512
_NONE = np.zeros((0, 0), dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class CoatGradient:
    """Derivatives of a number by what a trajectory consists of.

    Args:
        position: (W, 3).
        nozzle: (W, 3) by the directions as free vectors; square to them, since only turning counts.
        duration, flow: (W-1,).
    """

    position: FloatArray
    nozzle: FloatArray
    duration: FloatArray
    flow: FloatArray


@dataclass(frozen=True, eq=False)
class RateRows:
    """Some rows of the matrix of `Deposition.rates`.

    Args:
        points: (b,) index of the points.
        segments: (c,) the segments that may reach them.
        values: (b, c) m/s.
    """

    points: IntArray
    segments: IntArray
    values: FloatArray


class Deposition:
    """Lays paint on a surface.

    Args:
        samples: the surface.
        footprint: what leaves the gun.
        subpoints: of each segment.
        visible: (V, S) which points each segment sees; None where nothing stands in the way.

    Raises:
        InputError: fewer than one sub-point, or a mask of another shape.
    """

    def __init__(
        self,
        samples: SurfaceSamples,
        footprint: Footprint,
        subpoints: int = SUBPOINTS,
        visible: BoolArray | None = None,
    ) -> None:
        if subpoints < 1:
            raise InputError(f"subpoints: a whole number >= 1 is needed, not {subpoints}")
        self.samples = samples
        self.footprint = footprint
        self.subpoints = subpoints
        blocks, self._order = grouped(samples)
        self._surface = Surface(_brush(footprint), blocks, self._mask(visible))

    def with_footprint(self, footprint: Footprint) -> Deposition:
        """The same surface under another gun."""
        made = copy(self)
        made.footprint, made._surface = footprint, self._surface._replace(brush=_brush(footprint))
        return made

    def with_visible(self, visible: BoolArray | None) -> Deposition:
        """The same with another mask (V, S), or none."""
        made = copy(self)
        made._surface = self._surface._replace(visible=self._mask(visible))
        return made

    # ------------------------------------------------------------------------------- the coat

    def thickness(self, trajectory: PaintTrajectory) -> FloatArray:
        """Thickness of the coat at every point (V,), m."""
        guns = self._guns(trajectory)
        amount = trajectory.duration * trajectory.flow
        coat = np.zeros(self.samples.size)

        def lay(first: int, last: int) -> None:
            add_coat(self._surface, guns, amount, first, last, coat)

        self._shared(lay)
        return self._scattered(coat)

    def rates(self, trajectory: PaintTrajectory) -> sparse.csr_array:
        """What each segment lays on each point in a second (V, W-1), m/s; times the durations it is
        the thickness."""
        shape = (self.samples.size, trajectory.segments)
        pieces = [
            (piece.points[at], piece.segments[to], piece.values[at, to])
            for piece in self.rate_rows(trajectory)
            for at, to in [np.nonzero(piece.values)]
        ]
        points, segments, values = map(np.concatenate, zip(*pieces, strict=True))
        return sparse.csr_array((values, (points, segments)), shape=shape)

    def rate_rows(self, trajectory: PaintTrajectory) -> Iterator[RateRows]:
        """The matrix of `rates` in compact pieces, each point once."""
        guns = self._guns(trajectory)

        def fill(first: int, last: int) -> RateRows:
            live = self._live(guns, trajectory.flow, first, last)
            points = self._order[self._points(first, last)]
            values = np.zeros((len(points), len(live)))
            column = np.full(trajectory.segments, -1)
            column[live] = np.arange(len(live))
            fill_rates(self._surface, guns, column, first, last, values)
            values *= trajectory.flow[live]
            return RateRows(points, live, values)

        return self._pieces(fill)

    # ------------------------------------------------------------------------- derivatives

    def gradient(self, trajectory: PaintTrajectory, adjoint: FloatArray) -> CoatGradient:
        """Derivatives of adjoint·thickness.

        Args:
            adjoint: (V,).
        """
        guns = self._guns(trajectory)
        amount = trajectory.duration * trajectory.flow
        weights = np.ascontiguousarray(adjoint[self._order])
        waypoints = len(trajectory.position)

        def pull(first: int, last: int) -> tuple[FloatArray, FloatArray, FloatArray]:
            parts = np.zeros((waypoints, 3)), np.zeros((waypoints, 3)), np.zeros(len(amount))
            add_adjoint(self._surface, guns, amount, weights, first, last, *parts)
            return parts

        parts = zip(*self._shared(pull), strict=True)
        position, nozzle, by_amount = (np.sum(part, axis=0) for part in parts)
        return CoatGradient(
            position, nozzle, by_amount * trajectory.flow, by_amount * trajectory.duration
        )

    def normal_matrix(
        self, trajectory: PaintTrajectory, turns: FloatArray, weights: FloatArray
    ) -> FloatArray:
        """Jᵀ diag(weights) J of the thickness (5 W + S, 5 W + S): by position and two angles of
        each waypoint, then by durations.

        Args:
            turns: (W, 2, 3) derivatives of each waypoint's direction by its angles.
            weights: (V,) of the points, >= 0.
        """
        guns = self._guns(trajectory)
        amount = trajectory.duration * trajectory.flow
        turns = np.ascontiguousarray(turns)
        roots = np.sqrt(weights)
        waypoints = len(trajectory.position)

        def squared(first: int, last: int) -> tuple[IntArray, FloatArray]:
            """The columns that some points have entries in, and their product."""
            live = self._live(guns, trajectory.flow, first, last)
            near = np.union1d(live, live + 1)
            place, row = np.full(waypoints, -1), np.full(trajectory.segments, -1)
            place[near] = 5 * np.arange(len(near))
            row[live] = 5 * len(near) + np.arange(len(live))
            points = self._order[self._points(first, last)]
            rows = np.zeros((5 * len(near) + len(live), len(points)))
            fill_jacobian(self._surface, guns, amount, turns, place, row, first, last, rows)
            rows[5 * len(near) :] *= trajectory.flow[live, None]
            rows *= roots[points]
            columns = (5 * near[:, None] + np.arange(5)).ravel()
            return np.concatenate((columns, 5 * waypoints + live)), rows @ rows.T

        found = np.zeros((5 * waypoints + trajectory.segments,) * 2)
        for columns, product in self._pieces(squared):
            add_block(columns, product, found)
        return found

    # ------------------------------------------------------------------------------ parts

    @cached_property
    def _chunks(self) -> list[tuple[int, int]]:
        """Ranges of groups of about as many points as a matrix product likes."""
        starts = self._surface.blocks.starts
        ends = np.searchsorted(starts, np.arange(_CHUNK, starts[-1] + _CHUNK, _CHUNK), side="left")
        limits = np.unique(np.concatenate(([0], np.minimum(ends, len(starts) - 1))))
        return [(int(a), int(b)) for a, b in pairwise(limits)]

    def _mask(self, visible: BoolArray | None) -> BoolArray:
        if visible is None:
            return _NONE
        if visible.ndim != 2 or len(visible) != self.samples.size:
            raise InputError(
                f"visible: expected ({self.samples.size}, segments), not {visible.shape}"
            )
        return np.ascontiguousarray(visible[self._order])

    def _guns(self, trajectory: PaintTrajectory) -> Guns:
        if (trajectory.fan is None) and self.footprint.aspect != 1.0:
            raise InputError("an elliptic footprint needs the fan's direction at every waypoint")
        visible = self._surface.visible
        if len(visible) and visible.shape[1] != trajectory.segments:
            raise InputError(
                f"the mask is of {visible.shape[1]} segments, the trajectory has "
                f"{trajectory.segments}"
            )
        return guns_along(trajectory, self.subpoints, self.footprint.aspect != 1.0)

    def _live(self, guns: Guns, flow: FloatArray, first: int, last: int) -> IntArray:
        live = np.zeros(len(flow), dtype=np.bool_)
        live_segments(self._surface, guns, first, last, live)
        return np.flatnonzero(live & (flow > 0.0))

    def _points(self, first: int, last: int) -> slice:
        return slice(
            int(self._surface.blocks.starts[first]), int(self._surface.blocks.starts[last])
        )

    def _scattered(self, values: FloatArray) -> FloatArray:
        found = np.empty_like(values)
        found[self._order] = values
        return found

    def _shared(self, work: Callable[[int, int], T]) -> list[T]:
        """The work on all groups, in as many parts as there are workers."""
        groups = len(self._surface.blocks.radii)
        limits = np.unique(np.linspace(0, groups, 4 * WORKERS + 1).astype(np.int64))
        ranges = [(int(a), int(b)) for a, b in pairwise(limits)]
        if WORKERS == 1:
            return [work(*part) for part in ranges]
        return list(_pool().map(lambda part: work(*part), ranges))

    def _pieces(self, fill: Callable[[int, int], T]) -> Iterator[T]:
        """The work on all chunks, a few ahead of whoever takes it."""
        ahead = 2 * WORKERS
        for k in range(0, len(self._chunks), ahead):
            yield from _pool().map(lambda part: fill(*part), self._chunks[k : k + ahead])


def guns_along(trajectory: PaintTrajectory, subpoints: int, with_fan: bool) -> Guns:
    """Where the gun is at the middles of ``subpoints`` equal parts of each segment."""
    shares = (np.arange(subpoints) + 0.5) / subpoints
    segment = np.repeat(np.arange(trajectory.segments), subpoints)
    share = np.tile(shares, trajectory.segments)
    nozzle = _between(trajectory.nozzle, segment, share)
    length = np.linalg.norm(nozzle, axis=1)
    fan = np.zeros((0, 3))
    if with_fan and trajectory.fan is not None:
        fan = _between(trajectory.fan, segment, share)
        fan /= np.linalg.norm(fan, axis=1, keepdims=True)
    return Guns(
        _between(trajectory.position, segment, share),
        nozzle / length[:, None],
        fan,
        segment,
        share,
        np.full(len(segment), 1.0 / subpoints),
        length,
    )


def _between(values: FloatArray, index: IntArray, share: FloatArray) -> FloatArray:
    return np.asarray(values[index] + share[:, None] * (values[index + 1] - values[index]))


def _brush(footprint: Footprint) -> Brush:
    opening = footprint.radius / footprint.reach
    cone = Cone(
        footprint.source_distance, footprint.reach, footprint.aspect**2, opening, opening**2
    )
    return Brush(footprint.knots, footprint.coefficients, cone)


_POOL: list[ThreadPoolExecutor] = []


def _pool() -> ThreadPoolExecutor:
    """Threads for kernels that hold no lock; made once, at first use."""
    if not _POOL:
        _POOL.append(ThreadPoolExecutor(WORKERS, thread_name_prefix="paint"))
    return _POOL[0]
