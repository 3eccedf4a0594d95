"""The papers' transcription as a nonlinear program (paper C, equations 2 to 8)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...core.arrays import FloatArray, IntArray
from ...core.sqp import NLP
from ...core.sqp.algebra.entries import MatrixEntries
from .capsule_box import Clearances
from .curves import BlendCurve, Curve, Line
from .field_rows import AtPoints, FieldRows
from .layout import Grid, Layout
from .motion_rows import Acceleration, MotionRows, Nodes, StraightAcceleration, Velocity
from .rows import Quadratic, Rows, SpeedMatch
from .task import Overlap, TranscriptionTask

LEAST_RADIUS = 1e-3
"""m; a via point without a zone would be a stop, which no trajectory of this form passes."""
LEAST_LINE = 0.01
"""Share of each leg that stays a line: an empty line has no direction in time."""
_LEAST_CUT, _LEAST_TIME = 1e-4, 1e-4


class Transcription:
    """Minimum time over via points, zones and the timing along them.

    Args:
        task: what moves where.
        grid: intervals of time.
        freedom: rad (m) by which each joint of a via point may differ from the task's; 0 leaves the
            zones only (paper B's question).
        margin: m that is added to the cell's clearance, for what happens between nodes.
        pairs: which of the task's pairs of capsule and box get rows; None for all.
    """

    def __init__(
        self,
        task: TranscriptionTask,
        grid: Grid | None = None,
        freedom: float = np.inf,
        margin: float = 0.0,
        pairs: Sequence[int] | None = None,
    ) -> None:
        self.task, self.freedom, self.margin = task, freedom, margin
        chosen = range(task.clearances.size) if pairs is None else pairs
        self.pairs = tuple(chosen)
        self.grid = Grid() if grid is None else grid
        self.layout = Layout(len(task.points) - 1, len(task.free), self.grid)
        self.blend = BlendCurve(task.blend.alpha)
        self._blocks = self._all_rows()
        sizes = [len(block.lower) for block in self._blocks]
        self._bounds = np.cumsum([0, *sizes])
        self.n, self.m = self.layout.size, int(self._bounds[-1])
        self._jacobian = self._entries("jacobian_places", (self.m, self.n))
        self._hessian = self._entries("hessian_places", (self.n, self.n))
        self._gradient = np.zeros(self.n)
        self._gradient[self.layout.time] = 1.0

    def nlp(self) -> NLP:
        """The problem for a solver."""
        lower, upper = self._variable_bounds()
        return NLP(
            n=self.n,
            m=self.m,
            objective=self.objective,
            gradient=lambda x: self._gradient,
            constraints=self.constraints,
            jacobian=self.jacobian,
            hessian=self.hessian,
            x_lower=lower,
            x_upper=upper,
            c_lower=np.concatenate([block.lower for block in self._blocks]),
            c_upper=np.concatenate([block.upper for block in self._blocks]),
        )

    # ------------------------------------------------------------------------- callables

    def objective(self, x: FloatArray) -> float:
        """The duration, s."""
        return float(x[self.layout.time].sum())

    def constraints(self, x: FloatArray) -> FloatArray:
        """All rows (m,)."""
        return np.concatenate([block.values(x) for block in self._blocks])

    def jacobian(self, x: FloatArray) -> sparse.csc_array:
        """(m, n)."""
        return self._jacobian.matrix(np.concatenate([block.slopes(x) for block in self._blocks]))

    def hessian(self, x: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        """Of factor × duration + multipliers·rows (n, n); the duration is linear."""
        parts = [
            block.curvatures(x, multipliers[first:last])
            for block, first, last in zip(
                self._blocks, self._bounds, self._bounds[1:], strict=False
            )
        ]
        return self._hessian.matrix(np.concatenate(parts))

    @property
    def clearance_rows(self) -> slice:
        """Those that keep the clearance; they come last."""
        count = sum(len(b.lower) for b in self._blocks if b in self._clearances)
        return slice(self.m - count, self.m)

    def worst_shares(self, x: FloatArray) -> tuple[float, float]:
        """Largest share of a velocity's and of an acceleration's limit at any node."""
        shares = [
            max(float(np.abs(block.values(x)).max()) for block in blocks)
            for blocks in (self._velocities, self._accelerations)
        ]
        return shares[0], shares[1]

    # ------------------------------------------------------------------------------ rows

    def _all_rows(self) -> list[Rows]:
        velocity, acceleration = self.task.limits()
        lines, blends = self._lines(), self._blends()
        layout = self.layout
        blocks: list[Rows] = [self._quadratic_rows(), self._speed_matches()]
        inner = self._inner_nodes(lines)
        line_times, blend_times = self._at_nodes(0), self._at_nodes(1)
        self._velocities = (
            MotionRows(lines.only(inner), line_times[inner][:, [0, 2]], Velocity(), velocity),
            MotionRows(blends, blend_times[:, [0, 2]], Velocity(), velocity),
        )
        self._accelerations = (
            MotionRows(lines, line_times[:, [1, 2]], StraightAcceleration(), acceleration),
            MotionRows(blends, blend_times, Acceleration(), acceleration),
        )
        blocks += [
            *self._velocities,
            *self._accelerations,
            FieldRows(AtPoints(layout.points[1:-1]), self.task.tcp, 0.0, 0.0, layout.tcp[1:-1]),
            FieldRows(
                blends.only(self._blend_ends()),
                self.task.tcp,
                0.0,
                0.0,
                layout.edge.reshape(-1, 3),
            ),
        ]
        self._clearances: tuple[Rows, ...] = ()
        if self.pairs:
            field = Clearances(tuple(self.task.clearances.pairs[k] for k in self.pairs))
            least = self.task.cell.clearance + self.margin
            self._clearances = tuple(
                FieldRows(nodes, field, least, np.inf) for nodes in (lines.only(inner), blends)
            )
        return [*blocks, *self._clearances]

    def _quadratic_rows(self) -> Rows:
        rows, layout = Quadratic(), self.layout
        self._add_timing(rows)
        legs = layout.legs
        length = rows.add(legs, 0.0, 0.0)  # (6)
        rows.distance(length, layout.points[:-1], layout.points[1:])
        rows.product(length, layout.length, layout.length, -1.0)
        line = rows.add(legs, 0.0, np.inf)
        rows.linear(line, layout.length, 1.0 - LEAST_LINE)
        rows.linear(line[:, None], layout.cut, -1.0)
        sphere = rows.add(2 * layout.vias, 0.0, 0.0)  # (7)
        middle = np.repeat(layout.tcp[1:-1], 2, axis=0)
        rows.distance(sphere, middle, layout.edge.reshape(-1, 3))
        radius = np.repeat(layout.radius, 2)
        rows.product(sphere, radius, radius, -1.0)
        self._add_overlaps(rows)
        return rows.finish()

    def _add_timing(self, rows: Quadratic) -> None:
        """s̈ is linear over each interval, of length h in τ, and s a cubic:

        w[i+1] − w[i] = t h (z[i] + z[i+1]) / 2
        s[i+1] − s[i] = h (w[i] + w[i+1]) / 2 − t h² (z[i+1] − z[i]) / 12
        """
        layout = self.layout
        for k in range(layout.segments):
            s, w, z = layout.s[k], layout.rate[k], layout.push[k]
            t, h = layout.time[k], np.diff(layout.tau[k])
            rate, path = rows.add(len(h), 0.0, 0.0), rows.add(len(h), 0.0, 0.0)
            for last, sign in ((slice(1, None), 1.0), (slice(-1), -1.0)):
                rows.linear(rate, w[last], sign)
                rows.product(rate, z[last], t, -0.5 * h)
                rows.linear(path, s[last], sign)
                rows.linear(path, w[last], -0.5 * h)
                rows.product(path, z[last], t, sign * h**2 / 12.0)

    def _add_overlaps(self, rows: Quadratic) -> None:
        """The squared form of r ≤ d/2, or of r + r' ≤ d (printed: r² ≤ d²)."""
        layout = self.layout
        for leg in range(layout.legs):
            ends = [v for v in (leg - 1, leg) if 0 <= v < layout.vias]
            groups = [ends] if self.task.overlap is Overlap.TOUCH else [[v, v] for v in ends]
            for group in groups:
                radii = layout.radius[group]
                row = rows.add(1, 0.0, np.inf)
                rows.distance(row, layout.tcp[leg : leg + 1], layout.tcp[leg + 1 : leg + 2])
                rows.product(row, radii[:, None], radii[None], -1.0)

    def _speed_matches(self) -> Rows:
        layout = self.layout
        sides = [
            (via, leg, side, end, slope)
            for via in range(layout.vias)
            for leg, side, end, slope in (
                (via, 1, -1, self.blend.entry_slope),
                (via + 1, 0, 0, self.blend.exit_slope),
            )
        ]
        legs = [leg for _, leg, *_ in sides]
        lines = [(layout.rate[2 * leg][end], layout.time[2 * leg]) for _, leg, _, end, _ in sides]
        blends = [
            (layout.rate[2 * via + 1][-1 - end], layout.time[2 * via + 1])
            for via, _, _, end, _ in sides
        ]
        return SpeedMatch(
            layout.length[legs],
            layout.cut[legs],
            layout.cut[legs, [side for _, _, side, *_ in sides]],
            np.array(lines),
            np.array(blends),
            np.array([slope for *_, slope in sides]),
        )

    # ----------------------------------------------------------------------------- nodes

    def _lines(self) -> Nodes:
        layout = self.layout
        points = [layout.points[[k, k + 1]] for k in range(layout.legs)]
        cuts = [
            (layout.cut[k, 0], layout.length[k], layout.cut[k, 1], layout.length[k])
            for k in range(layout.legs)
        ]
        return self._nodes(Line(), 0, points, cuts)

    def _blends(self) -> Nodes:
        layout = self.layout
        points = [layout.points[[k, k + 1, k + 2]] for k in range(layout.vias)]
        cuts = [
            (layout.cut[k, 1], layout.length[k], layout.cut[k + 1, 0], layout.length[k + 1])
            for k in range(layout.vias)
        ]
        return self._nodes(self.blend, 1, points, cuts)

    def _nodes(
        self, curve: Curve, first: int, points: list[IntArray], cuts: Sequence[tuple[int, ...]]
    ) -> Nodes:
        """All nodes of the segments first, first + 2, …"""
        s = self.layout.s[first::2]
        counts = [len(own) for own in s]
        theta = np.column_stack(
            [np.concatenate(s), np.repeat(np.array(cuts, dtype=np.int64), counts, axis=0)]
        )
        return Nodes(curve, np.repeat(np.array(points), counts, axis=0), theta)

    def _at_nodes(self, first: int) -> IntArray:
        """Indices (R, 3) of w, z and t at the nodes of the segments first, first + 2, …"""
        layout = self.layout
        parts = [
            np.column_stack([w, z, np.full(len(w), t)])
            for w, z, t in zip(layout.rate, layout.push, layout.time, strict=True)
        ]
        return np.concatenate(parts[first::2])

    def _inner_nodes(self, lines: Nodes) -> IntArray:
        """Of lines; those at their ends are nodes of blends too, or stand still."""
        count = self.grid.line + 1
        every = np.arange(len(lines.points))
        inner = (every % count != 0) & (every % count != count - 1)
        return np.asarray(every[inner])

    def _blend_ends(self) -> IntArray:
        """First and last node of each blend."""
        count = self.grid.blend + 1
        return np.concatenate([[k * count, (k + 1) * count - 1] for k in range(self.layout.vias)])

    # ---------------------------------------------------------------------------- bounds

    def _variable_bounds(self) -> tuple[FloatArray, FloatArray]:
        layout, task = self.layout, self.task
        lower, upper = np.full(self.n, -np.inf), np.full(self.n, np.inf)
        lower[layout.time], lower[layout.length] = _LEAST_TIME, LEAST_RADIUS
        lower[layout.cut], lower[layout.radius] = _LEAST_CUT, LEAST_RADIUS
        lowest, highest = task.ranges()
        lower[layout.points] = np.maximum(lowest, task.points - self.freedom)
        upper[layout.points] = np.minimum(highest, task.points + self.freedom)
        for s, w in zip(layout.s, layout.rate, strict=True):
            lower[s], upper[s], lower[w] = 0.0, 1.0, 0.0
        for index, value in self._fixed():
            lower[index] = upper[index] = value
        return lower, upper

    def _fixed(self) -> list[tuple[NDArray[np.int64], FloatArray | float]]:
        """Variables that have one value only."""
        layout, ends = self.layout, self.task.points[[0, -1]]
        fixed: list[tuple[IntArray, FloatArray | float]] = [
            (layout.points[[0, -1]], ends),
            (layout.tcp[[0, -1]], self.task.tcp.values(ends)),
            (np.array([layout.cut[0, 0], layout.cut[-1, 1]]), 0.0),
            (np.array([layout.rate[0][0], layout.rate[-1][-1]]), 0.0),
            (np.array([s[0] for s in layout.s]), 0.0),
            (np.array([s[-1] for s in layout.s]), 1.0),
        ]
        if self.freedom == 0.0:
            fixed.append((layout.points, self.task.points))
        return fixed

    def _entries(self, places: str, shape: tuple[int, int]) -> MatrixEntries:
        rows, columns = [], []
        for block, first in zip(self._blocks, self._bounds, strict=False):
            row, column = getattr(block, places)
            rows.append(row + (first if places == "jacobian_places" else 0))
            columns.append(column)
        return MatrixEntries(np.concatenate(rows), np.concatenate(columns), shape)
