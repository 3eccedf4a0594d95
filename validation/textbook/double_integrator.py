"""The double integrator in minimum time (thesis, equations 2.14 to 2.18).

    minimise T   subject to   ẋ₁ = x₂,   ẋ₂ = u,   |u| ≤ 1,   x(0) = (4, 1),   x(T) = (0, 0)

The exact answer (`minimum_time`) pushes one way and then the other with full force, and switches
where it meets the curve x₁ = −x₂|x₂|/2.

On N nodes, N − 1 intervals of length h = T/(N − 1), the problem is a sparse NLP in
w = [T, x₁[0], x₂[0], u[0], …, x₁[N−1], x₂[N−1], u[N−1]] with one of

- `Scheme.TRAPEZOIDAL`: the thesis's (2.18f, g),
      x₁[i+1] = x₁[i] + h (x₂[i] + x₂[i+1])/2
      x₂[i+1] = x₂[i] + h (u[i] + u[i+1])/2
- `Scheme.CONSTANT_FORCE`: u[i] acts over all of interval i (the last one has no effect),
      x₁[i+1] = x₁[i] + h (x₂[i] + x₂[i+1])/2
      x₂[i+1] = x₂[i] + h u[i]

Both converge. With a constant force over an interval the row of x₁ is exact: `CONSTANT_FORCE`
solves the continuous problem for forces that change at nodes only, and `TRAPEZOIDAL` does so with
the mean of two nodes' forces, of which it can choose less freely. So the exact time ≤ that of
`CONSTANT_FORCE` ≤ that of `TRAPEZOIDAL`, and what is lost is the cost of spreading the switch over
one or two intervals, O(h²).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.sqp import NLP
from ...core.sqp.algebra.entries import MatrixEntries
from .ranges import check_force, check_nodes


class Scheme(StrEnum):
    """How the force acts between nodes."""

    TRAPEZOIDAL = "trapezoidal"
    CONSTANT_FORCE = "constant_force"


@dataclass(frozen=True, slots=True)
class Exact:
    """The continuous optimum.

    Args:
        time: from the start to rest.
        switch: when the force changes its sign.
        first_force: before the switch.
        start: (x₁, x₂).
    """

    time: float
    switch: float
    first_force: float
    start: tuple[float, float]

    def state(self, t: FloatArray) -> FloatArray:
        """x₁, x₂ and u at times (k,): (k, 3)."""
        x1, x2 = self.start
        u = self.first_force
        early = np.minimum(t, self.switch)
        late = np.maximum(t - self.switch, 0.0)
        speed = x2 + u * early
        place = x1 + x2 * early + u * early**2 / 2.0 + speed * late - u * late**2 / 2.0
        return np.column_stack([place, speed - u * late, np.where(t < self.switch, u, -u)])


def minimum_time(x1: float, x2: float, force: float = 1.0) -> Exact:
    """Time to rest at the origin by the switching curve (2.17), and the switch itself.

    The first force points away from the side of the curve x₁ = −x₂|x₂|/(2 force) on which the start
    lies; by symmetry let it be −force. With the speed at the switch −v, the way back to rest takes
    v/force and covers v²/(2 force), and v² = force x₁ + x₂²/2.

    Raises:
        InputError: the force is not above zero.
    """
    check_force(force)
    side = 1.0 if x1 + x2 * abs(x2) / (2.0 * force) >= 0.0 else -1.0
    v = np.sqrt(max(0.0, force * side * x1 + x2 * x2 / 2.0))
    switch = max(0.0, (v + side * x2) / force)
    return Exact(float(switch + v / force), float(switch), -side * force, (x1, x2))


class DoubleIntegrator:
    """The discretised problem; see the module.

    Args:
        nodes: N, at least 2.
        scheme: of the force.
        start: (x₁, x₂).
        force: greatest |u|, above zero.

    Raises:
        InputError: an argument is out of its range.
    """

    def __init__(
        self,
        nodes: int,
        scheme: Scheme = Scheme.TRAPEZOIDAL,
        start: tuple[float, float] = (4.0, 1.0),
        force: float = 1.0,
    ) -> None:
        check_nodes(nodes, 2)
        check_force(force)
        if not np.isfinite(start).all():
            raise InputError(f"start is two finite numbers, not {start}")
        self.nodes = nodes
        self.scheme = Scheme(scheme)
        self.start = start
        self.force = force
        self.n, self.m = 1 + 3 * nodes, 2 * (nodes - 1)
        # c and f are linear but for T times these weights of speeds and forces.
        forces = (0.5, 0.5) if self.scheme is Scheme.TRAPEZOIDAL else (1.0, 0.0)
        self._weights = np.array([0.5, 0.5, *forces]) / (nodes - 1)
        self._gradient = np.zeros(self.n)
        self._gradient[0] = 1.0
        self._jacobian = self._jacobian_entries()
        self._hessian = self._hessian_entries()

    def nlp(self) -> NLP:
        """The problem for the solver."""
        lower, upper = np.full(self.n, -np.inf), np.full(self.n, np.inf)
        lower[0] = 1e-3
        lower[3::3], upper[3::3] = -self.force, self.force
        lower[1:3] = upper[1:3] = self.start
        lower[-3:-1] = upper[-3:-1] = 0.0
        if self.scheme is Scheme.CONSTANT_FORCE:
            lower[-1] = upper[-1] = 0.0
        return NLP(
            n=self.n,
            m=self.m,
            objective=self.objective,
            gradient=self.gradient,
            constraints=self.constraints,
            jacobian=self.jacobian,
            hessian=self.hessian,
            x_lower=lower,
            x_upper=upper,
            c_lower=0.0,
            c_upper=0.0,
        )

    def initial_guess(self) -> FloatArray:
        """Places on the straight line to the origin, neither speed nor force, and a time that is
        rather long: what the distance takes from rest to rest, and twice what it takes to stop."""
        w = np.zeros(self.n)
        fade = np.linspace(1.0, 0.0, self.nodes)
        place, speed = np.abs(self.start)
        w[0] = 2.0 * np.sqrt(place / self.force) + 2.0 * speed / self.force
        w[1::3] = self.start[0] * fade
        return w

    def trajectory(self, w: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Times (N,), and x₁, x₂ and u there (N, 3)."""
        return np.linspace(0.0, float(w[0]), self.nodes), w[1:].reshape(self.nodes, 3)

    # -------------------------------------------------------------------------- callables

    def objective(self, w: FloatArray) -> float:
        """T."""
        return float(w[0])

    def gradient(self, w: FloatArray) -> FloatArray:
        """∇T (n,)."""
        return self._gradient

    def constraints(self, w: FloatArray) -> FloatArray:
        """What is missing in each interval: of x₁ (N − 1,), then of x₂ (N − 1,)."""
        moved = np.concatenate([np.diff(w[1::3]), np.diff(w[2::3])])
        return np.asarray(moved - w[0] * self._rates(w))

    def jacobian(self, w: FloatArray) -> sparse.csc_array:
        """∂c/∂w (m, n)."""
        linear = np.ones(self.m)
        falls = np.repeat(-w[0] * self._weights, self.nodes - 1)
        return self._jacobian.matrix(np.concatenate([-linear, linear, falls, -self._rates(w)]))

    def hessian(self, w: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        """∇²(factor T + multipliers·c) (n, n): T meets speeds and forces."""
        pulls = -multipliers.reshape(2, 1, -1) * self._weights.reshape(2, 2, 1)
        return self._hessian.matrix(np.concatenate([pulls.ravel(), pulls.ravel()]))

    def _rates(self, w: FloatArray) -> FloatArray:
        """Change of x₁ and of x₂ in each interval by unit of T (m,)."""
        speeds, forces, a = w[2::3], w[3::3], self._weights
        return np.concatenate(
            [
                a[0] * speeds[:-1] + a[1] * speeds[1:],
                a[2] * forces[:-1] + a[3] * forces[1:],
            ]
        )

    # ---------------------------------------------------------------------------- patterns

    def _driving_columns(self) -> NDArray[np.int64]:
        """Columns of the two speeds and the two forces of each interval (4 (N − 1),)."""
        i = 3 * np.arange(self.nodes - 1)
        return np.concatenate([2 + i, 5 + i, 3 + i, 6 + i])

    def _jacobian_entries(self) -> MatrixEntries:
        every = np.arange(self.m)
        first, second = np.split(every, 2)
        i = 3 * np.arange(self.nodes - 1)
        rows = [every, every, first, first, second, second, every]
        columns = [1 + i, 2 + i, 4 + i, 5 + i, self._driving_columns(), np.zeros(self.m, int)]
        return MatrixEntries(np.concatenate(rows), np.concatenate(columns), (self.m, self.n))

    def _hessian_entries(self) -> MatrixEntries:
        columns = self._driving_columns()
        time = np.zeros(len(columns), int)
        rows = np.concatenate([columns, time])
        return MatrixEntries(rows, np.concatenate([time, columns]), (self.n, self.n))
