"""Velocity tuning as a second-order cone program.

Over x and y ≤ √x at the knots and θ for the time of each interval,

    y_k² ≤ x_k,     θ_k (y_k + y_{k+1}) ≥ 2 Δ_k,     rows of x (and of y),

minimising Σ θ; torques are affine in x, so that ∫ τ² dt adds cones |τ|² Δ_k ≤ ε_k (y_k + y_{k+1}),
and ∫ τ q̇ dt = ∫ τ q' dσ is linear (Verscheure et al., "Time-optimal path tracking for robots: a
convex optimization approach", IEEE Transactions on Automatic Control 54(10), 2009). All variables
are in units of a motion that is known.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.arrays import FloatArray
from ....core.errors import FlybyError
from .path import at_ends
from .rows import Knots, LinearRows, jerk_rows, kinematic_rows, torque_rows
from .task import TuningTask

_MOST = 1e4
"""Share of the known motion's x that no knot exceeds."""


class TuningError(FlybyError):
    """A convex program that its solver did not solve."""


@dataclass(frozen=True)
class CostShares:
    """What time and energy count: ``time`` per s, ``energy`` per unit of the consumption."""

    time: float
    energy: float = 0.0


class ConeProgram:
    """The convex program of a task.

    Args:
        task: the task.
        unit: (K + 1,), x of a motion that is about as fast as can be; 0 at stops alone.
    """

    def __init__(self, task: TuningTask, unit: FloatArray) -> None:
        self._task = task
        self._unit = unit
        self._knots = Knots(task.path)
        self._fixed = list(kinematic_rows(task, self._knots))
        root = np.sqrt(unit)
        self._steps = task.path.steps(unit)
        # y_k + y_{k+1} in units of what it is in the known motion.
        parts = (root[:-1] / (root[:-1] + root[1:]), root[1:] / (root[:-1] + root[1:]))
        self._pace = sp.diags_array(parts, offsets=(0, 1), shape=(len(parts[0]), len(unit)))

    def solve(self, shares: CostShares, at: FloatArray) -> FloatArray:
        """x (K + 1,) of the best motion within rows that are tangent at ``at``.

        Raises:
            TuningError: the solver failed.
        """
        import cvxpy as cp  # takes a second

        count = len(self._unit)
        xi, eta = cp.Variable(count, nonneg=True), cp.Variable(count, nonneg=True)
        theta = cp.Variable(count - 1)
        pace = self._pace @ eta
        constraints = [
            xi <= self._caps(),
            cp.SOC(xi + 1.0, cp.vstack([2.0 * eta, xi - 1.0]), axis=0),
            cp.SOC(theta + pace, cp.vstack([theta - pace, np.full(count - 1, 2.0)]), axis=0),
            *self._linear(xi, eta, self._rows(at)),
        ]
        time = self._steps @ theta
        cost = shares.time * time
        if shares.energy > 0.0:
            energy, more = self._energy(xi, pace, at)
            cost = cost + shares.energy * energy
            constraints += more
        if self._task.objective.duration is not None:
            constraints.append(time / self._task.objective.duration <= 1.0)
        problem = cp.Problem(cp.Minimize(cost), constraints)
        _solve(problem)
        return np.asarray(np.clip(xi.value, 0.0, None) * self._unit)

    def _caps(self) -> FloatArray:
        """(K + 1,), the ceilings in units of the known motion; 0 at stops."""
        ceiling = self._task.path.limits.ceiling
        stops = self._task.path.stops
        caps = np.minimum(ceiling / np.where(stops, 1.0, self._unit), _MOST)
        return np.where(stops, 0.0, caps)

    def _rows(self, at: FloatArray) -> Iterable[LinearRows]:
        yield from self._fixed
        yield from torque_rows(self._task, self._knots, at)
        yield from jerk_rows(self._task, self._knots, at)

    def _linear(self, xi: Any, eta: Any, rows: Iterable[LinearRows]) -> list[Any]:
        units, roots = sp.diags_array(self._unit), sp.diags_array(np.sqrt(self._unit))
        made = []
        for part in rows:
            value = (part.a_x @ units) @ xi
            if part.a_y is not None and part.a_y.nnz:
                value = value + (part.a_y @ roots) @ eta
            made.append(value <= part.upper)
        return made

    def _energy(self, xi: Any, pace: Any, at: FloatArray) -> tuple[Any, list[Any]]:
        """∫ of the consumption as an expression, and the constraints that make it one.

        The power p is convex, heat by cones and mechanical power linear, and so is the larger of
        p and η p, as η ≤ 1. With η = 1 nothing is cut off, and the ends of an interval add up.
        """
        import cvxpy as cp  # takes a second

        returned = self._task.objective.consumption.returned
        total: Any = 0.0
        constraints: list[Any] = []
        for ends in [(0, 1)] if returned == 1.0 else [(0,), (1,)]:
            power, cones = self._power(xi, pace, at, ends)
            constraints += cones
            if returned < 1.0:
                unit = max(self._scale, self._typical_work)
                drawn = cp.Variable(self._knots.count)
                constraints += [power / unit <= drawn, returned / unit * power <= drawn]
                power = unit * drawn
            total = total + cp.sum(power)
        return total, constraints

    def _power(
        self, xi: Any, pace: Any, at: FloatArray, ends: Iterable[int]
    ) -> tuple[Any, list[Any]]:
        """½ Σ h p at some ends of the intervals, (K,), and the cones that bound it."""
        consumption, size = self._task.objective.consumption, self._task.path.size
        heat = self._torque(xi, at, np.sqrt(consumption.squares(size)))
        power, cones = self._squares(heat, pace, ends)
        if consumption.mechanical > 0.0:
            power = power + self._work(self._torque(xi, at, np.ones(size)), ends)
        return power, cones

    def _torque(self, xi: Any, at: FloatArray, weight: FloatArray) -> list[list[Any]]:
        """Weighted torques as expressions (K,), by end and by joint; √x by its tangent."""
        torques = self._task.torques
        root = np.sqrt(at_ends(at))
        slope = np.where(root > 0.0, 0.5 * torques.v / np.where(root > 0.0, root, 1.0), 0.0)
        height = torques.c + 0.5 * torques.v * root
        units = sp.diags_array(self._unit)
        matrix = self._knots.combination(torques.a, torques.b + slope) @ units
        size = torques.a.shape[2]
        rows = np.arange(self._knots.count) * 2 * size
        return [
            [
                weight[j] * (sp.csr_array(matrix[rows + e * size + j]) @ xi + height[:, e, j])
                for j in np.flatnonzero(weight > 0.0)
            ]
            for e in range(2)
        ]

    def _squares(
        self, torque: list[list[Any]], pace: Any, ends: Iterable[int]
    ) -> tuple[Any, list[Any]]:
        """½ h Σ τ² of weighted torques at some ends of the intervals, (K,), and its cone."""
        import cvxpy as cp  # takes a second

        scale = self._scale
        root = np.sqrt(0.5 * self._steps / scale)
        parts = [cp.multiply(root, tau) for e in ends for tau in torque[e]]
        if not parts:
            return np.zeros(self._knots.count), []
        bound = cp.Variable(self._knots.count)
        cone = cp.SOC(bound + pace, cp.vstack([bound - pace, *(2.0 * p for p in parts)]), axis=0)
        return scale * bound, [cone]

    def _work(self, torque: list[list[Any]], ends: Iterable[int]) -> Any:
        """½ Δ τ q′ at some ends of the intervals, (K,): half of ∫ τ q̇ dt = ∫ τ q′ dσ each.

        The rule over the path, which is linear in x, stands for that over time: both ends together
        differ by terms of the second order in the interval's width.
        """
        import cvxpy as cp  # takes a second

        way = 0.5 * self._knots.spacing[:, None, None] * self._task.path.dq
        return sum(cp.multiply(way[:, e, j], tau) for e in ends for j, tau in enumerate(torque[e]))

    @cached_property
    def _scale(self) -> float:
        """About what an interval takes of weighted squared torques."""
        torques, squares = self._task.torques, self._task.objective.consumption.squares
        size = max(np.abs(torques.c).max(), np.abs(self._typical).max())
        most = float(squares(self._task.path.size).max()) * float(size) ** 2
        return max(most * float(self._steps.mean()), 1e-30)

    @cached_property
    def _typical_work(self) -> float:
        """About the most that an interval takes of mechanical power."""
        way = 0.5 * self._knots.spacing[:, None, None] * self._task.path.dq
        mechanical = self._task.objective.consumption.mechanical
        return mechanical * float(np.abs(way * self._typical).max())

    @cached_property
    def _typical(self) -> FloatArray:
        """(K, 2, N), torques of the known motion."""
        x = self._unit
        return self._task.torques.at(x, self._task.path.u(x))


def _solve(problem: Any) -> None:
    """Solve by Clarabel.

    Raises:
        TuningError: it failed.
    """
    import cvxpy as cp

    try:
        with warnings.catch_warnings():
            # An inaccurate solution says so by its status, too.
            warnings.filterwarnings("ignore", "Solution may be inaccurate")
            problem.solve(solver=cp.CLARABEL)
    except cp.SolverError as error:
        raise TuningError(
            f"the best speeds of this path could not be worked out: {error}"
        ) from error
    if problem.status in (cp.INFEASIBLE, cp.INFEASIBLE_INACCURATE):
        raise TuningError(
            "no motion along this path is within all limits; if its duration is bounded, allow more"
        )
    if problem.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
        raise TuningError(
            f"the best speeds of this path could not be worked out ({problem.status}); where "
            "slower is always cheaper, bound the duration"
        )
