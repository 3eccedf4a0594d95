"""Random sparse NLPs built like discretised trajectories: blocks along a chain, a narrow band."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP

STATES, CONTROLS = 4, 2
BLOCK = STATES + CONTROLS
WAVES = 0.3
RIPPLE = 0.2
EFFORT = 0.1


class Banded:
    """minimise   Σᵢ ½|xᵢ − rᵢ|² + 0.2 Σ cos 3xᵢ + 0.05 |uᵢ|²
    subject to xᵢ₊₁ = A xᵢ + B uᵢ + 0.3 sin xᵢ,   ½|xᵢ|² ≤ 1,   |uᵢ| ≤ 1,   x₀ given

    with random A, B, r: nonconvex, with some of each kind of bound active.

    Args:
        nodes: number of blocks (x, u).
        seed: of the random numbers.
        shift: is added to r, for a problem nearby.
    """

    def __init__(self, nodes: int, seed: int, shift: float = 0.0) -> None:
        random = np.random.default_rng(seed)
        rotation = np.linalg.qr(random.normal(size=(STATES, STATES)))[0]
        self.A = 0.8 * rotation
        self.B = random.normal(size=(STATES, CONTROLS))
        time = np.arange(nodes)[:, None]
        phase = random.uniform(0.0, 2.0 * np.pi, STATES)
        wiggle = random.normal(scale=0.3, size=(nodes, STATES))
        self.reference = 1.2 * np.sin(0.1 * time + phase) + wiggle + shift
        self.first = random.normal(scale=0.5, size=STATES)
        self.nodes = nodes
        self.n = nodes * BLOCK
        self.m = (nodes - 1) * STATES + nodes
        self._J = self._linear_jacobian()
        self._bent = self._J.data.copy()

    def nlp(self) -> NLP:
        """The problem for the solver."""
        block = np.concatenate([np.full(STATES, np.inf), np.ones(CONTROLS)])
        upper = np.tile(block, self.nodes)
        lower = -upper
        lower[:STATES] = upper[:STATES] = self.first
        dynamics = self.m - self.nodes
        c_lower, c_upper = np.zeros(self.m), np.zeros(self.m)
        c_lower[dynamics:], c_upper[dynamics:] = -np.inf, 1.0
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
            c_lower=c_lower,
            c_upper=c_upper,
        )

    def objective(self, w: FloatArray) -> float:
        x, u = self._split(w)
        tracking = 0.5 * np.sum((x - self.reference) ** 2)
        return float(tracking + RIPPLE * np.cos(3.0 * x).sum() + 0.5 * EFFORT * np.sum(u * u))

    def gradient(self, w: FloatArray) -> FloatArray:
        x, u = self._split(w)
        by_x = x - self.reference - 3.0 * RIPPLE * np.sin(3.0 * x)
        return np.hstack([by_x, EFFORT * u]).ravel()

    def constraints(self, w: FloatArray) -> FloatArray:
        x, u = self._split(w)
        driven = x[:-1] @ self.A.T + u[:-1] @ self.B.T + WAVES * np.sin(x[:-1])
        return np.concatenate([(x[1:] - driven).ravel(), 0.5 * np.sum(x * x, axis=1)])

    def jacobian(self, w: FloatArray) -> sparse.csc_array:
        x, _ = self._split(w)
        data = self._bent.copy()
        data[self._waves] -= WAVES * np.cos(x[:-1]).ravel()
        data[self._balls] = x.ravel()
        return sparse.csc_array((data, self._J.indices, self._J.indptr), shape=self._J.shape)

    def hessian(self, w: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        x, u = self._split(w)
        dynamics, balls = np.split(multipliers, [self.m - self.nodes])
        by_x = factor * (1.0 - 9.0 * RIPPLE * np.cos(3.0 * x)) + balls[:, None]
        by_x[:-1] += WAVES * dynamics.reshape(-1, STATES) * np.sin(x[:-1])
        diagonal = np.hstack([by_x, np.full_like(u, factor * EFFORT)]).ravel()
        every = np.arange(self.n + 1, dtype=np.int32)
        return sparse.csc_array((diagonal, every[:-1], every), shape=(self.n, self.n))

    def _split(self, w: FloatArray) -> tuple[FloatArray, FloatArray]:
        blocks = w.reshape(self.nodes, BLOCK)
        return blocks[:, :STATES], blocks[:, STATES:]

    def _linear_jacobian(self) -> sparse.csc_array:
        """The pattern with its constant values, and where the others go."""
        k, s = self.nodes - 1, STATES
        near = np.hstack([-self.A, -self.B])
        rows = s * np.arange(k)[:, None, None] + np.arange(s)[:, None]
        columns = BLOCK * np.arange(k)[:, None, None] + np.arange(BLOCK)
        rows, columns = np.broadcast_arrays(rows, columns)
        after = (BLOCK * np.arange(1, k + 1)[:, None] + np.arange(s)).ravel()
        ball = (BLOCK * np.arange(self.nodes)[:, None] + np.arange(s)).ravel()
        ball_rows = k * s + np.repeat(np.arange(self.nodes), s)
        r = np.concatenate([rows.ravel(), np.arange(k * s), ball_rows])
        c = np.concatenate([columns.ravel(), after, ball])
        values = np.concatenate([np.tile(near, (k, 1, 1)).ravel(), np.ones(k * s), 0.0 * ball])
        J = sparse.csc_array((np.arange(1.0, len(r) + 1), (r, c)), shape=(self.m, self.n))
        order = J.data.astype(int) - 1
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        J.data = values[order]
        diagonal = np.flatnonzero((rows % s == columns % BLOCK).ravel())
        self._waves = place[diagonal]
        self._balls = place[-len(ball) :]
        return J
