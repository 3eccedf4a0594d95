"""Whether stretches of path keep their clearance while a zone grows through a range of sizes.

A *cell* is an interval of σ at one waypoint, together with a range of sizes. The path is known at
the range's two ends and in its middle. Its configurations at five places of each stand for the
cell: no body moves further from where it is in the cell's middle than it does to one of these
fifteen, but for what the path bends between them (`MARGIN`). A pair of bodies is clear in the
whole cell if its distance in the middle is the clearance and that much more; or, for convex
bodies, if its separation along the normal in the middle stays that large, which is the better
test where bodies pass each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import BoolArray, FloatArray, IntArray
from ....core.collision.proof.certificate import TOLERANCE
from ....core.collision.proof.verdict import CONTACT
from ....core.collision.scene.scene import CollisionScene
from .displacement import Placed, deviated, moved, placed, planar_gaps
from .neighbourhood import CornerPath

MARGIN = 1.1
"""On sampled displacements. A bend that is quadratic in the cell exceeds samples at five places
by a sixteenth of itself at most; the certificate that ends every run trusts no sample."""
PLACES = 5
MIDDLE = PLACES // 2
SLACK = 5e-6
"""m by which a clearance may be missed: half of what the certificate grants."""
LEAST = CONTACT + TOLERANCE
"""m that are kept even where no clearance is asked for, so that the certificate can be given."""
EVEN = 0.6
"""Share of the displacement that must come from σ, not from the size, for a cell to be cut in σ."""


@dataclass(frozen=True)
class PathCells:
    """C intervals of σ on one side of a waypoint, and the pairs of bodies that are not clear yet.

    Args:
        begin, end: (C,), σ from the waypoint.
        open: (C, P) bool, pairs of the scene.
    """

    begin: FloatArray
    end: FloatArray
    open: BoolArray

    def __len__(self) -> int:
        return len(self.begin)

    def rows(self, which: BoolArray) -> PathCells:
        """Some of the cells, by (C,) bool."""
        return PathCells(self.begin[which], self.end[which], self.open[which])

    def halves(self) -> PathCells:
        """All cells cut in σ."""
        middle = 0.5 * (self.begin + self.end)
        begin, end = np.concatenate([self.begin, middle]), np.concatenate([middle, self.end])
        return PathCells(begin, end, np.concatenate([self.open, self.open]))

    def clipped(self, lower: float, upper: float) -> PathCells:
        """The parts of the cells between two σ."""
        begin, end = np.maximum(self.begin, lower), np.minimum(self.end, upper)
        return PathCells(begin, end, self.open).rows(begin < end)


def joined(parts: Sequence[PathCells]) -> PathCells:
    """Cells of one scene together."""
    return PathCells(
        np.concatenate([part.begin for part in parts]),
        np.concatenate([part.end for part in parts]),
        np.concatenate([part.open for part in parts]),
    )


@dataclass(frozen=True, slots=True)
class Shortfall:
    """A place at which the clearance is not kept.

    Args:
        distance: m, signed.
        wanted: m.
        names: of the two bodies.
        sigma: of the place, from the waypoint.
        touching: whether these bodies may touch at an end of the move: zones have to leave the
            place alone, smaller ones do.
    """

    distance: float
    wanted: float
    names: tuple[str, str]
    sigma: float
    touching: bool = False


@dataclass(frozen=True)
class Look:
    """What one look at cells found.

    Args:
        left: the cells that are not clear, with the pairs that are not.
        by_sigma: (C,) bool, of those: whether cutting in σ does more than cutting in size.
        shortfall: the worst place at which a cell's middle does not keep the clearance.
    """

    left: PathCells
    by_sigma: BoolArray
    shortfall: Shortfall | None


class Clearing:
    """Looks at cells in a scene.

    Args:
        scene: cell and tool. Pairs that are left out there, as they touch at an end of the move,
            are looked at, too: where they do, the path is not to change.
        clearance: m to be kept.
        deviation: (N,) rad or m by which the links may deviate from the path.
        residual: m by which the real robot may deviate from the emulated one.
    """

    def __init__(
        self,
        scene: CollisionScene,
        clearance: float,
        deviation: FloatArray | None = None,
        residual: float = 0.0,
    ) -> None:
        self._scene = scene.whole
        self._touching = frozenset(
            touching.scene.pair_names(k)
            for touching in scene.left_out
            for k in range(len(touching.scene.pairs))
        )
        self._wanted = max(clearance, LEAST) + residual
        deviations = deviation is not None and bool(np.any(deviation > 0.0))
        self._deviation = deviation if deviations else None
        self._outlines = scene.outlines

    def whole(self, begin: float, end: float) -> PathCells:
        """One cell with all pairs."""
        pairs = np.ones((1, len(self._scene.pairs)), dtype=bool)
        return PathCells(np.array([begin]), np.array([end]), pairs)

    def look(self, cells: PathCells, paths: Sequence[CornerPath], middle: CornerPath) -> Look:
        """What is known of cells after one look.

        Args:
            cells: at least one.
            paths: at the ends of the range of sizes, beside ``middle``; none for one size alone.
            middle: the path in the middle of the range.
        """
        at = np.linspace(cells.begin, cells.end, PLACES, axis=1)
        sampled = [path.at(at.ravel()).reshape(*at.shape, -1) for path in (middle, *paths)]
        q = np.ascontiguousarray(sampled[0][:, MIDDLE])
        centre = placed(self._scene.frames, q)
        along = self._around(sampled[:1])
        around = self._around(sampled) if paths else along
        travel = moved(self._outlines, centre, around)
        by_sigma = moved(self._outlines, centre, along) if paths else travel
        wanted = self._wanted + self._deviated(centre)
        needed = wanted + MARGIN * self._both(travel)
        cell, pair = np.nonzero(cells.open)
        distance, normal = self._scene.chosen_distances(q, (cell, pair), needed[cell, pair])
        near = distance < needed[cell, pair] - SLACK
        cell, pair, distance, normal = cell[near], pair[near], distance[near], normal[near]
        wanted = wanted[cell, pair]
        shortfall = self._shortfall(distance, wanted, pair, at[cell, MIDDLE])
        if shortfall is None:
            near = self._near_along(normal, cell, pair, centre, around, wanted)
            cell, pair = cell[near], pair[near]
        left = np.zeros_like(cells.open)
        left[cell, pair] = True
        rows: BoolArray = np.asarray(left.any(axis=1))
        share = np.where(left, self._both(by_sigma), 0.0).max(axis=1, initial=0.0)
        most = np.where(left, self._both(travel), 0.0).max(axis=1, initial=0.0)
        kept = PathCells(cells.begin, cells.end, left).rows(rows)
        return Look(kept, (share > EVEN * most)[rows], shortfall)

    def _around(self, sampled: Sequence[FloatArray]) -> Placed:
        q = np.concatenate(sampled, axis=1)
        return placed(self._scene.frames, q.reshape(-1, q.shape[2]))

    def _both(self, of_body: FloatArray) -> FloatArray:
        """(C, P), the sum for the two bodies of each pair."""
        pairs = self._scene.pairs
        return np.asarray(of_body[:, pairs[:, 0]] + of_body[:, pairs[:, 1]])

    def _deviated(self, centre: Placed) -> FloatArray:
        """(C, P) m."""
        scene = self._scene
        if self._deviation is None:
            return np.zeros((len(centre.position), len(scene.pairs)))
        return np.asarray(
            deviated(scene.frames, self._outlines, scene.pairs, centre, self._deviation)
        )

    def _shortfall(
        self, distance: FloatArray, wanted: FloatArray, pair: IntArray, sigma: FloatArray
    ) -> Shortfall | None:
        """The worst of F places, if it does not keep what is wanted."""
        short = distance - wanted
        if not short.min(initial=np.inf) < -SLACK:
            return None
        worst = int(np.argmin(short))
        names = self._scene.pair_names(int(pair[worst]))
        return Shortfall(
            float(distance[worst]),
            float(wanted[worst]),
            names,
            float(sigma[worst]),
            names in self._touching,
        )

    def _near_along(
        self,
        normal: FloatArray,
        cell: IntArray,
        pair: IntArray,
        centre: Placed,
        around: Placed,
        wanted: FloatArray,
    ) -> BoolArray:
        """Which of F pairs come too near along their normals."""
        here, least = planar_gaps(
            self._outlines, centre, around, cell, self._scene.pairs[pair], normal
        )
        return np.asarray(here - MARGIN * (here - least) < wanted - SLACK)
