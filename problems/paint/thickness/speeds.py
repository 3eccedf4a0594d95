"""The best speeds along a given path: a convex quadratic program with a certificate.

The thickness is linear in the durations, so the integral of its squared error is a convex quadratic
of them within a box. Whatever point a solver ends at, convexity bounds what could still be gained:
f(y) ≥ f(x) + ∇f(x)·(y − x), whose minimum over the box is in closed form. The bound says what no
profile of speeds along this path can beat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError, Note
from ....core.sqp.algebra.matrices import SparseMatrix, Sparsity, empty
from ....core.sqp.qp.backends import BackendKind, make_backends
from ....core.sqp.qp.problem import QpStatus, QuadraticProgram
from ....core.sqp.qp.subproblems import Subproblems
from ..coating.deposition import Deposition
from ..coating.reach import reach_notes
from ..spray.trajectory import PaintTrajectory

_EXACT = 1e-9
_NO_EFFECT = 1e-14


@dataclass(frozen=True, eq=False)
class SpeedSolution:
    """The best durations found, and how good any could be.

    Args:
        trajectory: the path with these durations.
        objective: ∫ (thickness − target)² dA + time_weight · duration, m⁴.
        bound: no durations within the limits have a lower objective.
        notes: what else a user should know.
    """

    trajectory: PaintTrajectory
    objective: float
    bound: float
    notes: tuple[Note, ...] = ()

    @property
    def duality_gap(self) -> float:
        """Share of the objective by which it may exceed the optimum."""
        return (self.objective - self.bound) / max(self.objective, np.finfo(float).tiny)


def best_speeds(
    deposition: Deposition,
    trajectory: PaintTrajectory,
    target: float,
    slowest: float,
    fastest: float,
    *,
    time_weight: float = 0.0,
) -> SpeedSolution:
    """The durations that minimise the squared error of the thickness.

    Segments that lay no paint keep their duration as far as the limits allow, unless time counts.

    Args:
        target: wanted thickness, m.
        slowest, fastest: limits of the speed of the TCP, m/s.
        time_weight: m⁴/s that a second costs.

    Raises:
        InputError: limits that are no speeds, a segment without length.
    """
    if not 0.0 < slowest < fastest:
        raise InputError(f"speeds: 0 < slowest < fastest is needed, not {slowest}, {fastest} m/s")
    if not target > 0.0:
        raise InputError(f"target: a thickness above zero is needed, not {target!r} m")
    lengths = trajectory.lengths
    if not (lengths > 0.0).all():
        raise InputError(f"segment {int(np.argmin(lengths)) + 1} has no length, hence no speed")
    program = _program(deposition, trajectory, target)
    lower, upper = lengths / fastest, lengths / slowest
    start = np.clip(trajectory.duration, lower, upper)
    durations = _minimised(program, time_weight, start, lower, upper)
    value, slope = program.value(durations, time_weight), program.slope(durations, time_weight)
    bound = value + float(
        np.minimum(slope * (lower - durations), slope * (upper - durations)).sum()
    )
    notes = reach_notes(deposition, trajectory, target, (slowest, fastest))
    best = trajectory.with_durations(durations)
    return SpeedSolution(best, value, max(bound, 0.0), notes)


@dataclass(frozen=True, eq=False)
class _Program:
    """½ τ·Q τ − c·τ + constant: the integral of the squared error.

    Args:
        Q: (S, S) m⁴/s².
        c: (S,) m⁴/s.
        constant: m⁴.
    """

    Q: FloatArray
    c: FloatArray
    constant: float

    def value(self, durations: FloatArray, time_weight: float) -> float:
        quadratic = 0.5 * float(durations @ self.Q @ durations) - float(self.c @ durations)
        return quadratic + self.constant + time_weight * float(durations.sum())

    def slope(self, durations: FloatArray, time_weight: float) -> FloatArray:
        return np.asarray(self.Q @ durations - self.c + time_weight)


def _program(deposition: Deposition, trajectory: PaintTrajectory, target: float) -> _Program:
    areas = deposition.samples.areas
    Q = np.zeros((trajectory.segments, trajectory.segments))
    c = np.zeros(trajectory.segments)
    for rows in deposition.rate_rows(trajectory):
        weighted = np.sqrt(areas[rows.points])[:, None] * rows.values
        Q[np.ix_(rows.segments, rows.segments)] += 2.0 * (weighted.T @ weighted)
        c[rows.segments] += 2.0 * target * (areas[rows.points] @ rows.values)
    return _Program(Q, c, target**2 * float(areas.sum()))


def _minimised(
    program: _Program,
    time_weight: float,
    start: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
) -> FloatArray:
    """The best durations (S,), in units of the start's."""
    effect = np.diagonal(program.Q) * start**2
    idle = effect <= _NO_EFFECT * effect.max(initial=0.0)
    slope = program.slope(start, time_weight) * start
    scale = max(float(np.abs(slope).max()), float(effect.max()))
    if scale == 0.0:
        return start
    n = len(start)
    P = program.Q * np.outer(start, start) / scale
    P[np.diag_indices(n)] += np.where(idle, _EXACT, 0.0)
    pattern = Sparsity((n, n), np.tile(np.arange(n), n), np.arange(n + 1) * n)
    fixed = idle & (time_weight == 0.0)
    qp = QuadraticProgram(
        SparseMatrix(pattern, P.T.flatten()),
        slope / scale,
        empty(n),
        np.zeros(0),
        np.zeros(0),
        np.where(fixed, 0.0, lower / start - 1.0),
        np.where(fixed, 0.0, upper / start - 1.0),
    )
    found = Subproblems(make_backends(BackendKind.CLARABEL, True)).solve(qp)
    if found.status is not QpStatus.SOLVED:
        return start
    return np.clip(start * (1.0 + found.d), lower, upper)
