"""Random nonlinear programs built round a point that satisfies the conditions of optimality."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP


@dataclass(frozen=True)
class KnownPoint:
    """Quadratic constraints and a quartic objective with a strict local optimum.

    With d = x − x*: f = g·d + ½ dᵀQd + ¼ Σ d⁴ and c = c* + A d + ½ dᵀCd, where
    g = −(Aᵀλ + ν) and Q + Σ λᵢCᵢ is positive definite. Active rows are independent, their
    multipliers at least 0.2.
    """

    x: FloatArray
    multipliers: FloatArray
    bound_multipliers: FloatArray
    g: FloatArray
    Q: FloatArray
    values: FloatArray
    A: FloatArray
    C: FloatArray
    bounds: tuple[FloatArray, FloatArray, FloatArray, FloatArray]

    def nlp(self, *, as_sparse: bool = False) -> NLP:
        kind = sparse.csc_array if as_sparse else np.array
        x_lower, x_upper, c_lower, c_upper = self.bounds
        return NLP(
            n=len(self.x),
            m=len(self.values),
            objective=self.objective,
            gradient=self.gradient,
            constraints=self.constraints,
            jacobian=lambda x: kind(self.jacobian(x)),
            hessian=lambda x, factor, y: kind(self.hessian(x, factor, y)),
            x_lower=x_lower,
            x_upper=x_upper,
            c_lower=c_lower,
            c_upper=c_upper,
        )

    def objective(self, x: FloatArray) -> float:
        d = x - self.x
        return float(self.g @ d + 0.5 * d @ self.Q @ d + 0.25 * np.sum(d**4))

    def gradient(self, x: FloatArray) -> FloatArray:
        d = x - self.x
        return self.g + self.Q @ d + d**3

    def constraints(self, x: FloatArray) -> FloatArray:
        d = x - self.x
        return self.values + self.A @ d + 0.5 * np.einsum("i,kij,j->k", d, self.C, d)

    def jacobian(self, x: FloatArray) -> FloatArray:
        return self.A + np.einsum("kij,j->ki", self.C, x - self.x)

    def hessian(self, x: FloatArray, factor: float, multipliers: FloatArray) -> FloatArray:
        own = self.Q + np.diag(3.0 * (x - self.x) ** 2)
        return factor * own + np.einsum("k,kij->ij", multipliers, self.C)

    def start(self, distance: float, seed: int = 0) -> FloatArray:
        return self.x + distance * np.random.default_rng(seed).standard_normal(len(self.x))


def known_point(seed: int, n: int, m: int) -> KnownPoint:
    """A problem with n variables and m constraints, at most n − 1 of all active."""
    random = np.random.default_rng(seed)
    x = random.standard_normal(n)
    values = random.standard_normal(m)
    # Where each row and each variable stands: at its lower or upper side, on both, or between.
    sides = random.permutation(n + m)
    active = np.zeros(n + m, dtype=bool)
    active[sides[: random.integers(0, n)]] = True
    pushes = np.where(active, (0.2 + random.random(n + m)) * random.choice((-1.0, 1.0), n + m), 0.0)
    multipliers, bound_multipliers = pushes[:m], pushes[m:]
    c_lower, c_upper = _sides(values, multipliers, random)
    x_lower, x_upper = _sides(x, bound_multipliers, random)
    equal = (multipliers != 0) & (random.random(m) < 0.5)
    c_lower[equal] = c_upper[equal] = values[equal]
    A = random.standard_normal((m, n))
    C = np.array([_symmetric(random, n) for _ in range(m)]).reshape(m, n, n) * 0.3
    root = random.standard_normal((n, n))
    P = root @ root.T / n + 0.3 * np.eye(n)
    Q = P - np.einsum("k,kij->ij", multipliers, C)
    g = -(A.T @ multipliers + bound_multipliers)
    bounds = (x_lower, x_upper, c_lower, c_upper)
    return KnownPoint(x, multipliers, bound_multipliers, g, Q, values, A, C, bounds)


def _sides(
    value: FloatArray, push: FloatArray, random: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Bounds that hold where a multiplier pushes; elsewhere at a distance, or none."""
    away = 0.5 + random.random((2, len(value)))
    away[random.random((2, len(value))) < 0.3] = np.inf
    lower = np.where(push < 0, value, value - away[0])
    upper = np.where(push > 0, value, value + away[1])
    return lower, upper


def _symmetric(random: np.random.Generator, n: int) -> FloatArray:
    square = random.standard_normal((n, n))
    return 0.5 * (square + square.T)
