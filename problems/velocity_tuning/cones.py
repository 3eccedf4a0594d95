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
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from ...core.errors import FlybyError, InputError
from ...core.motion.consumption import Motors, SquaredTorque
from .rows import Knots, Rows, jerk_rows, kinematic_rows, torque_rows
from .task import Task

FloatArray = NDArray[np.float64]

_MOST = 1e4
"""Share of the known motion's x that no knot exceeds."""


class TuningError(FlybyError):
    """A convex program that its solver did not solve."""


@dataclass(frozen=True)
class Shares:
    """What time and energy count: ``time`` per s, ``energy`` per unit of the consumption."""

    time: float
    energy: float = 0.0


class ConeProgram:
    """The convex program of a task.

    Args:
        task: the task.
        unit: (K + 1,), x of a motion that is about as fast as can be; 0 at stops alone.
    """

    def __init__(self, task: Task, unit: FloatArray) -> None:
        self._task = task
        self._unit = unit
        self._knots = Knots(task.path)
        self._fixed = list(kinematic_rows(task, self._knots))
        root = np.sqrt(unit)
        self._steps = 2.0 * task.path.limits.spacing / (root[:-1] + root[1:])
        # y_k + y_{k+1} in units of what it is in the known motion.
        parts = (root[:-1] / (root[:-1] + root[1:]), root[1:] / (root[:-1] + root[1:]))
        self._pace = sp.diags_array(parts, offsets=(0, 1), shape=(len(parts[0]), len(unit)))

    def solve(self, shares: Shares, at: FloatArray) -> FloatArray:
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

    def _rows(self, at: FloatArray) -> Iterable[Rows]:
        yield from self._fixed
        yield from torque_rows(self._task, self._knots, at)
        yield from jerk_rows(self._task, self._knots, at)

    def _linear(self, xi: Any, eta: Any, rows: Iterable[Rows]) -> list[Any]:
        units, roots = sp.diags_array(self._unit), sp.diags_array(np.sqrt(self._unit))
        made = []
        for part in rows:
            value = (part.a_x @ units) @ xi
            if part.a_y is not None and part.a_y.nnz:
                value = value + (part.a_y @ roots) @ eta
            made.append(value <= part.upper)
        return made

    def _energy(self, xi: Any, pace: Any, at: FloatArray) -> tuple[Any, list[Any]]:
        """∫ of the consumption as an expression, and the constraints that make it one."""
        consumption = self._task.objective.consumption
        shape = self._task.torques.a.shape
        if isinstance(consumption, SquaredTorque):
            weights = np.sqrt(consumption.weights(shape[2]))
            return self._squares(self._torque(xi, at, weights), pace, range(2))
        if isinstance(consumption, Motors):
            return self._drawn(xi, pace, at, consumption)
        raise InputError(
            f"velocity tuning knows SquaredTorque and Motors, not {type(consumption).__name__}"
        )

    def _torque(self, xi: Any, at: FloatArray, weight: FloatArray) -> list[list[Any]]:
        """Weighted torques as expressions (K,), by end and by joint; √x by its tangent."""
        torques = self._task.torques
        ends = np.stack([at[:-1], at[1:]], -1)[..., None]
        root = np.sqrt(ends)
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
        """½ Σ h_k Σ τ² at some ends of the intervals."""
        import cvxpy as cp  # takes a second

        scale = self._scale
        root = np.sqrt(0.5 * self._steps / scale)
        parts = [cp.multiply(root, tau) for e in ends for tau in torque[e]]
        if not parts:
            return 0.0, []
        bound = cp.Variable(self._knots.count)
        cone = cp.SOC(bound + pace, cp.vstack([bound - pace, *(2.0 * p for p in parts)]), axis=0)
        return scale * cp.sum(bound), [cone]

    @property
    def _scale(self) -> float:
        """About what one interval takes of squared torques."""
        torques = self._task.torques
        size = np.abs(torques.c).max() + np.abs(torques.a).max() * 1e-12
        size = max(float(size), float(np.abs(self._typical()).max()))
        return max(size**2 * float(self._steps.mean()), 1e-30)

    def _typical(self) -> FloatArray:
        """Torques of the known motion."""
        x = self._unit
        return self._task.torques.at(x, np.diff(x) / (2.0 * self._knots.spacing))

    def _drawn(self, xi: Any, pace: Any, at: FloatArray, motors: Motors) -> tuple[Any, list[Any]]:
        """What the mains give: the larger of p and η p at every end of every interval."""
        import cvxpy as cp  # takes a second

        size = self._task.path.size
        heat = self._torque(xi, at, np.sqrt(motors.losses(size)))
        plain = self._torque(xi, at, np.ones(size))
        constraints: list[Any] = []
        total: Any = 0.0
        for e in range(2):
            way = 0.5 * self._knots.spacing[:, None] * self._task.path.dq[:, e]
            power: Any = 0.0
            for j in range(size):
                power = power + cp.multiply(way[:, j], plain[e][j])
            if heat[e]:
                scale = self._scale * max(motors.copper)
                root = np.sqrt(0.5 * self._steps / scale)
                bound = cp.Variable(self._knots.count)
                parts = [2.0 * cp.multiply(root, tau) for tau in heat[e]]
                constraints.append(cp.SOC(bound + pace, cp.vstack([bound - pace, *parts]), axis=0))
                power = power + scale * bound
            if motors.recuperation == 1.0:
                total = total + cp.sum(power)
                continue
            unit = max(float(np.abs(way * self._typical()[:, e]).max()), 1e-12)
            drawn = cp.Variable(self._knots.count)
            constraints += [power / unit <= drawn, motors.recuperation / unit * power <= drawn]
            total = total + unit * cp.sum(drawn)
        return total, constraints


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
        raise TuningError(f"the convex program of the path could not be solved: {error}") from error
    if problem.status in (cp.INFEASIBLE, cp.INFEASIBLE_INACCURATE):
        raise TuningError(
            "no motion along this path is within all limits; if its duration is bounded, allow more"
        )
    if problem.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
        raise TuningError(
            f"the convex program of the path ended {problem.status}; where slower is always "
            "cheaper, bound the duration"
        )
