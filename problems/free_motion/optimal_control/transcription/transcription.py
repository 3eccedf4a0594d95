"""A task as a sparse nonlinear program.

Where only time counts the objective is S / 2, which has its minimum where T has and is linear. The
Hessian is a convex one unless an exact one is asked for: what torques and the energy bend the
wrong way is left out (see `sample_rows.convex_part`), and so is the concavity of √S.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from .....core.arrays import FloatArray
from .....core.sqp import NLP
from .....core.sqp.algebra.entries import MatrixEntries
from ..motion.layout import VariableLayout
from ..task.limits import MotionLimits
from ..task.sampled import Plant, TcpSpeed, TorqueField
from ..task.task import MotionTask
from .rows import (
    ConstraintRows,
    DurationRow,
    GivenVelocity,
    MotionRows,
    Stack,
    acceleration_rows,
    jerk_rows,
    link_rows,
    velocity_rows,
)
from .sample_rows import EnergyTerm, TcpSpeedRows, TorqueRows, convex_part, exact

_SHORTEST, _LONGEST = 1e-4, 400.0
"""Least and largest S."""


@dataclass(frozen=True)
class Margins:
    """What is left of limits at samples and nodes, so that they hold between them.

    Args:
        torque: (Z, R) shares of the limits.
        tcp_speed: (Z,) shares of the limit.
        position: (P, n) rad or m.
    """

    torque: FloatArray
    tcp_speed: FloatArray
    position: FloatArray


@dataclass(frozen=True)
class Bounds:
    """Where the configurations may be.

    Args:
        lower, upper: (P, n) rad or m.
    """

    lower: FloatArray
    upper: FloatArray


class Transcription:
    """MotionObjective, constraints and derivatives.

    Args:
        task: what is asked.
        limits: that count.
        layout: the variables.
        scale: T₀, s.
        energy_unit: E₀; None where only time counts.
        plant: equations of motion; None where torques play no part.
        margins: at samples and nodes; None for none.
        indefinite: whether the Hessian is exact.
    """

    def __init__(
        self,
        task: MotionTask,
        limits: MotionLimits,
        layout: VariableLayout,
        scale: float,
        energy_unit: float | None,
        plant: Plant | None,
        margins: Margins | None = None,
        indefinite: bool = False,
    ) -> None:
        self.task, self.limits, self.layout, self.scale = task, limits, layout, scale
        self._field = None if plant is None else TorqueField(plant, scale)
        self._margins = margins
        self._curvature = exact if indefinite else convex_part
        self._blocks: list[ConstraintRows] = self._make_rows()
        self._energy = None
        if energy_unit is not None:
            assert self._field is not None
            width = task.objective.smoothing * energy_unit / scale
            consumption = task.objective.consumption
            self._energy = EnergyTerm(
                layout, self._field, consumption, scale, width, self._curvature
            )
        self._energy_unit = energy_unit or 1.0

    def _make_rows(self) -> list[ConstraintRows]:
        layout, limits, scale = self.layout, self.limits, self.scale
        rows: list[ConstraintRows | None] = [
            link_rows(layout),
            DurationRow(layout) if layout.stretches else None,
            velocity_rows(layout, limits.velocity * scale),
            acceleration_rows(layout, limits.acceleration * scale**2),
            jerk_rows(layout, limits.jerk * scale**3),
        ]
        for point, velocity in ((0, self.task.start_velocity), (-1, self.task.end_velocity)):
            wanted = np.asarray(velocity, dtype=float)[self.task.moving]
            if wanted.any():
                rows.append(GivenVelocity(layout.d[point], wanted * scale))
        if self._field is not None and limits.dynamic:
            torque = TorqueRows(layout, self._field, limits.torques, self._curvature)
            rows.append(torque if self._margins is None else torque.tightened(self._margins.torque))
        if np.isfinite(limits.tcp_speed):
            speed = TcpSpeed(self.task, scale)
            tcp = TcpSpeedRows(layout, speed, limits.tcp_speed, scale, self._curvature)
            rows.append(tcp if self._margins is None else tcp.tightened(self._margins.tcp_speed))
        return [block for block in rows if block is not None]

    # MotionObjective

    def objective(self, x: FloatArray) -> float:
        if self._energy is None:
            return 0.5 * float(x[0])
        weight = self.task.objective.time_weight
        return weight * float(np.sqrt(x[0])) + (1.0 - weight) * self._energy.value(x) / (
            self._energy_unit
        )

    def gradient(self, x: FloatArray) -> FloatArray:
        out = np.zeros(self.layout.size)
        if self._energy is None:
            out[0] = 0.5
            return out
        weight = self.task.objective.time_weight
        out[0] = 0.5 * weight / np.sqrt(x[0])
        return out + (1.0 - weight) / self._energy_unit * self._energy.gradient(x)

    @property
    def bends_root(self) -> bool:
        """Whether the objective has a concave √S that the Hessian shows."""
        return self._energy is not None and self._curvature is exact

    def root_bend(self, x: FloatArray) -> float:
        """Second derivative of the objective's √S."""
        return float(-0.25 * self.task.objective.time_weight * x[0] ** -1.5)

    # The program

    def nlp(self, bounds: Bounds, places: MotionRows | None = None) -> NLP:
        """The nonlinear program within bounds, with linearised distances at places."""
        return _Program(self, self._blocks + ([] if places is None else [places])).nlp(bounds)

    def variable_bounds(self, bounds: Bounds) -> tuple[FloatArray, FloatArray]:
        """Lower and upper bounds of x."""
        layout, task = self.layout, self.task
        lower, upper = np.full(layout.size, -np.inf), np.full(layout.size, np.inf)
        lower[0] = _SHORTEST
        if task.objective.longest is not None:
            upper[0] = (task.objective.longest / self.scale) ** 2
        else:
            upper[0] = _LONGEST
        if layout.stretches:
            lower[1 : 1 + layout.stretches] = self.least_stretch
            upper[1 : 1 + layout.stretches] = self.most_stretch
        lower[layout.q], upper[layout.q] = bounds.lower, bounds.upper
        for point, q, stop in self.fixed_points():
            lower[layout.q[point]] = upper[layout.q[point]] = q[task.moving]
            if stop:
                lower[layout.d[point]] = upper[layout.d[point]] = 0.0
        return lower, upper

    least_stretch, most_stretch = 0.25, 4.0

    def fixed_points(self) -> list[tuple[int, FloatArray, bool]]:
        """Point, configuration (N,) and whether the robot rests there."""
        layout, task = self.layout, self.task
        ends = np.searchsorted(layout.grid.leg, np.arange(1, task.legs))
        found = [
            (int(layout.first[node]), np.asarray(w.q, dtype=float), w.stop)
            for node, w in zip(ends, task.waypoints, strict=True)
        ]
        start, end = np.asarray(task.start), np.asarray(task.end)
        resting = [not np.any(v) for v in (task.start_velocity, task.end_velocity)]
        return [(0, start, resting[0]), *found, (layout.points - 1, end, resting[1])]


class _Program:
    """The callables of one nonlinear program."""

    def __init__(self, owner: Transcription, blocks: list[ConstraintRows]) -> None:
        self._owner, self._rows = owner, Stack(blocks)

    @cached_property
    def _jacobian_entries(self) -> MatrixEntries:
        shape = len(self._rows.lower), self._owner.layout.size
        return MatrixEntries(*self._rows.jacobian_places, shape)

    @cached_property
    def _hessian_entries(self) -> MatrixEntries:
        places = [self._rows.hessian_places]
        if self._owner._energy is not None:
            places.append(self._owner._energy.hessian_places)
        if self._owner.bends_root:
            places.append((np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)))
        rows, columns = (np.concatenate([p[i] for p in places]) for i in (0, 1))
        size = self._owner.layout.size
        return MatrixEntries(rows, columns, (size, size))

    def jacobian(self, x: FloatArray) -> sparse.csc_array:
        return self._jacobian_entries.matrix(self._rows.jacobian(x))

    def hessian(self, x: FloatArray, factor: float, y: FloatArray) -> sparse.csc_array:
        parts, owner = [self._rows.hessian(x, y)], self._owner
        if owner._energy is not None:
            part = (1.0 - owner.task.objective.time_weight) / owner._energy_unit * factor
            parts.append(owner._energy.hessian(x, part))
        if owner.bends_root:
            parts.append(np.array([factor * owner.root_bend(x)]))
        return self._hessian_entries.matrix(np.concatenate(parts))

    def nlp(self, bounds: Bounds) -> NLP:
        lower, upper = self._owner.variable_bounds(bounds)
        return NLP(
            n=self._owner.layout.size,
            m=len(self._rows.lower),
            objective=self._owner.objective,
            gradient=self._owner.gradient,
            constraints=self._rows.values,
            jacobian=self.jacobian,
            hessian=self.hessian,
            x_lower=lower,
            x_upper=upper,
            c_lower=self._rows.lower,
            c_upper=self._rows.upper,
        )
