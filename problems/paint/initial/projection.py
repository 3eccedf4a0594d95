"""Pseudo-projection: points laid on the surface or on its extension, with a stable normal.

Section IV-B of D. Gleeson et al. 2022. The point moves along the line of projection onto the
tangent plane at the place where the normal was taken; the paper's p + d ñ would leave that
line wherever the surface slopes. The tangent is brought to unit length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....core.arrays import BoolArray, FloatArray, IntArray
from .guide import Guide
from .plan import SweepPlan

TOLERANCE = 1e-5
"""m by which a point may lie farther out than the overhang."""
SETTLED = 1e-6
"""m: shifts to the inside that are smaller have come to an end."""
SHIFTS = 4
"""How often a point is shifted to the inside of the surface."""
SAMPLES = 8
"""Points round the inner point at which normals are taken (section IV-B)."""
ALIKE = np.cos(np.deg2rad(30.0))
"""Normals whose product is larger belong to one cluster."""
STEEPEST = np.cos(np.deg2rad(80.0))
"""Least product of the old and the new direction; below, the line of projection grazes."""
BEHIND = np.cos(np.deg2rad(110.0))
"""Least product of the gun's direction and the view, smoothing and extension allowed for."""


class SprayFrames(NamedTuple):
    """Points with the direction of the sweep and of the spray.

    Args:
        point: (N, 3) m, on the surface or its extension.
        tangent: (N, 3) unit vectors along the sweep.
        spray: (N, 3) unit vectors from the gun to the surface; the paper's n.
    """

    point: FloatArray
    tangent: FloatArray
    spray: FloatArray

    def at(self, rows: slice | list[int] | BoolArray | IntArray) -> SprayFrames:
        """Some of them."""
        return SprayFrames(self.point[rows], self.tangent[rows], self.spray[rows])

    @property
    def side(self) -> FloatArray:
        """(N, 3) unit vectors b = n × t."""
        return np.cross(self.spray, self.tangent)


class Projected(NamedTuple):
    """Frames after pseudo-projection.

    Args:
        frames: the new ones; the old ones where not feasible.
        feasible: (N,) whether the point lies on the surface or not farther out than the overhang.
        inside: (N,) whether it lies on the surface.
    """

    frames: SprayFrames
    feasible: BoolArray
    inside: BoolArray


@dataclass(frozen=True)
class Projector:
    """Pseudo-projection onto a surface.

    Args:
        guide: the surface.
        plan: the sweeps' parameters.
        view: (3,) unit vector along which the gun looks at the part as a whole.
    """

    guide: Guide
    plan: SweepPlan
    view: FloatArray

    @property
    def reach(self) -> float:
        """m along the line of projection within which a point near the surface looks for it."""
        return 0.5 * max(self.plan.longest_segment, self.plan.sweep_width)

    def project(self, frames: SprayFrames, reach: float | None = None) -> Projected:
        """Pseudo-projection of frames (N).

        Args:
            frames: with orthogonal directions.
            reach: as in `Guide.meet`; None for that of points near the surface.
        """
        reach = self.reach if reach is None else reach
        met = self.guide.meet(frames.point, frames.spray, reach)
        inner, feasible = self._inner_points(frames, met.found, reach)
        base = self.guide.meet(inner, frames.spray, reach)
        feasible &= base.found
        rows = np.flatnonzero(feasible)
        spray = frames.spray.copy()
        spray[rows] = self._spray(frames.at(rows), inner[rows], base.point[rows], reach)
        along = np.einsum("ij,ij->i", frames.spray, spray)
        feasible &= (along > STEEPEST) & (spray @ self.view > BEHIND)
        # Onto the tangent plane at the base, along the line of projection.
        height = np.einsum("ij,ij->i", base.point - frames.point, spray) / np.where(
            feasible, along, 1.0
        )
        point = frames.point + height[:, None] * frames.spray
        feasible &= np.abs(np.where(feasible, height, 0.0)) <= reach
        stayed = met.found & (np.linalg.norm(inner - frames.point, axis=1) <= SETTLED)
        point = np.where(stayed[:, None], met.point, point)
        tangent = frames.tangent - _dot(frames.tangent, spray) * spray
        length = np.linalg.norm(tangent, axis=1, keepdims=True)
        feasible &= length[:, 0] > 1e-6
        keep = feasible[:, None]
        return Projected(
            SprayFrames(
                np.where(keep, point, frames.point),
                np.where(keep, tangent / np.maximum(length, 1e-12), frames.tangent),
                np.where(keep, spray, frames.spray),
            ),
            feasible,
            met.found & feasible,
        )

    def beyond(self, frames: SprayFrames, ways: FloatArray, farthest: float) -> FloatArray:
        """How far (N,) m points lie beyond the edge along ways (N, 3): negative on the surface.

        -inf where no edge is found within ``farthest`` m ahead of a point on the surface, inf where
        none is found behind one outside.
        """
        inside = self.guide.meet(frames.point, frames.spray, self.reach).found
        ways = np.where(inside[:, None], ways, -ways)
        edge = self.guide.edge_distances(
            frames.point, frames.spray, ways[:, None], inside, farthest, self.reach
        )[:, 0]
        return np.where(inside, -edge, edge)

    def _inner_points(
        self, frames: SprayFrames, inside: BoolArray, reach: float
    ) -> tuple[FloatArray, BoolArray]:
        """Points (N, 3) off the edge by d_edgeOffset, and which are feasible.

        Where the surface is too narrow for it they lie in its middle.
        """
        plan = self.plan
        inner, feasible = frames.point.copy(), inside.copy()
        ways = np.stack([frames.tangent, -frames.tangent, frames.side, -frames.side], axis=1)
        out = np.flatnonzero(~inside)
        if len(out) and plan.overhang > 0.0:
            edge = self.guide.edge_distances(
                frames.point[out],
                frames.spray[out],
                ways[out],
                inside[out],
                plan.overhang + TOLERANCE,
                reach,
            )
            nearest = np.argmin(edge, axis=1)
            length = edge[np.arange(len(out)), nearest]
            feasible[out] = np.isfinite(length)
            # A hair beyond the edge, to be on the surface.
            step = np.where(np.isfinite(length), length + SETTLED, 0.0)
            inner[out] += step[:, None] * ways[out, nearest]
        moving = np.flatnonzero(feasible)
        for _ in range(SHIFTS):
            if len(moving) == 0 or plan.offset == 0.0:
                break
            shift = self._inward(inner[moving], frames.at(moving), ways[moving], reach)
            moved = inner[moving] + shift
            there = self.guide.meet(moved, frames.spray[moving], reach).found
            inner[moving[there]] = moved[there]
            moving = moving[there & (np.linalg.norm(shift, axis=1) > SETTLED)]
        return inner, feasible

    def _inward(
        self, points: FloatArray, frames: SprayFrames, ways: FloatArray, reach: float
    ) -> FloatArray:
        """Shifts (N, 3) of points on the surface away from edges that are too near."""
        offset = self.plan.offset
        on = np.ones(len(points), dtype=bool)
        edge = self.guide.edge_distances(points, frames.spray, ways, on, 2.0 * offset, reach)
        shift = np.zeros_like(points)
        for ahead, behind in ((0, 1), (2, 3)):
            front, back = edge[:, ahead], edge[:, behind]
            wanted = np.maximum(offset - back, 0.0) - np.maximum(offset - front, 0.0)
            with np.errstate(invalid="ignore"):
                middle = 0.5 * (front - back)
            narrow = front + back < 2.0 * offset
            shift += np.where(narrow, middle, wanted)[:, None] * ways[:, ahead]
        return shift

    def _spray(
        self, frames: SprayFrames, inner: FloatArray, base: FloatArray, reach: float
    ) -> FloatArray:
        """Smoothed directions (N, 3) into the surface at inner points above their bases."""
        n = len(inner)
        if n == 0:
            return np.empty((0, 3))
        turn = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
        ring = (
            np.cos(turn)[:, None] * frames.tangent[:, None]
            + np.sin(turn)[:, None] * frames.side[:, None]
        )
        around = inner[:, None] + self.plan.smoothing * ring
        points = np.concatenate([inner[:, None], around], axis=1).reshape(-1, 3)
        look = np.repeat(frames.spray, SAMPLES + 1, axis=0)
        met = self.guide.meet(points, look, reach)
        count = met.found.reshape(n, -1)
        used = count & self._off_edge(frames, points.reshape(n, -1, 3), reach)
        used[:, 0] = True
        normals = np.where(met.found[:, None], np.nan_to_num(met.normal), 0.0).reshape(
            n, SAMPLES + 1, 3
        )
        return -cluster_mean(normals, used)

    def _off_edge(self, frames: SprayFrames, points: FloatArray, reach: float) -> BoolArray:
        """(N, K) whether points (N, K, 3) are off the edge by d_edgeOffset, all four ways."""
        n, k = points.shape[:2]
        off = np.ones((n, k), dtype=bool)
        look = np.repeat(frames.spray, k, axis=0)
        for way in (frames.tangent, -frames.tangent, frames.side, -frames.side):
            probe = (points + self.plan.offset * (1.0 - 1e-6) * way[:, None]).reshape(-1, 3)
            off &= self.guide.meet(probe, look, reach).found.reshape(n, k)
        return off


def cluster_mean(normals: FloatArray, used: BoolArray) -> FloatArray:
    """Mean directions (N, 3) of clusters of unit normals (N, K, 3).

    A cluster is a normal with all those within 30° of it. That of the first normal, in the middle,
    is taken if it holds a quarter of all (on a bend it has no majority, and following majorities
    there would make the gun nod); else the middle is an outlier, and the largest is taken.

    Args:
        normals: (N, K, 3).
        used: (N, K) those that count; the first always does.
    """
    near = np.einsum("nki,nmi->nkm", normals, normals) >= ALIKE
    near &= used[:, None, :] & used[:, :, None]
    size = near.sum(axis=2)
    chosen = np.where(4 * size[:, 0] >= used.sum(axis=1), 0, np.argmax(size, axis=1))
    members = np.take_along_axis(near, chosen[:, None, None], axis=1)[:, 0]
    members[~members.any(axis=1), 0] = True
    mean = np.einsum("nk,nki->ni", members, normals)
    return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b)[:, None])
