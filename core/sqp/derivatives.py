"""Derivatives of a problem held against differences of its values."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .options import start_point
from .problem.arrays import matrix, numbers, scalar, vector
from .problem.nlp import NLP

_STEP = 6e-6
"""About the cube root of the rounding unit: best for central differences."""
_LEAST_SIZE = 1e-3
"""Share of a value below which its derivatives count as small: differences of rounded values
scatter so much."""

Function = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, slots=True)
class Mismatch:
    """The worst entry of one derivative.

    Args:
        derivative: ``gradient``, ``jacobian``, ``hessian`` or ``residual_jacobian``.
        row, column: of the entry; a gradient has row 0.
        claimed: by the callable.
        differences: of the values.
        error: their difference, relative to the largest entry of the row, claimed or by
            differences; but at least to 1e-3 of the value that is differentiated, or 1e-3.
    """

    derivative: str
    row: int
    column: int
    claimed: float
    differences: float
    error: float


@dataclass(frozen=True, slots=True)
class DerivativeCheck:
    """Outcome of `check_derivatives`.

    Args:
        worst: the worst entry of each derivative that the problem has.
        tolerance: relative.
    """

    worst: tuple[Mismatch, ...]
    tolerance: float

    @property
    def passed(self) -> bool:
        """Whether all derivatives agree with differences."""
        return all(m.error <= self.tolerance for m in self.worst)

    def __str__(self) -> str:
        lines = [
            f"{m.derivative}[{m.row}, {m.column}]: {m.claimed:.8g}, by differences "
            f"{m.differences:.8g} (error {m.error:.1e}"
            f"{', too large' if m.error > self.tolerance else ''})"
            for m in self.worst
        ]
        return "\n".join(lines)


def check_derivatives(nlp: NLP, x: ArrayLike, tolerance: float = 1e-5) -> DerivativeCheck:
    """Hold every derivative of a problem at x (n,) against differences of second order.

    x is moved into the bounds, and differences stay within them. A variable that they fix is left
    out. The Hessian is checked for the objective and all constraints together, with multipliers
    between 1 and 2.

    Raises:
        NlpError: x is no point, or a callable gives what `solve` would not take.
    """
    x_lower, x_upper, *_ = nlp.bounds
    differences = _Differences(np.clip(start_point("x", nlp, x), x_lower, x_upper), nlp)
    return DerivativeCheck(tuple(_checks(nlp, differences)), scalar("tolerance", tolerance))


def _checks(nlp: NLP, differences: _Differences) -> Iterator[Mismatch]:
    """The worst entry of each derivative."""
    at, n, m = differences.at, nlp.n, nlp.m
    objective, gradient = nlp.objective, nlp.gradient
    if objective is not None and gradient is not None:
        claimed = vector("gradient", gradient(at.copy()), n)[None, :]
        yield differences.worst("gradient", claimed, lambda p: _one(objective(p)))
    constraints, jacobian = nlp.constraints, nlp.jacobian
    if constraints is not None and jacobian is not None:
        claimed = _dense("jacobian", jacobian(at.copy()), (m, n))
        yield differences.worst(
            "jacobian", claimed, lambda p: vector("constraints", constraints(p), m)
        )
    residuals, slopes = nlp.residuals, nlp.residual_jacobian
    if residuals is not None and slopes is not None:
        size = numbers("residuals", residuals(at.copy())).size
        claimed = _dense("residual_jacobian", slopes(at.copy()), (size, n))
        yield differences.worst(
            "residual_jacobian", claimed, lambda p: vector("residuals", residuals(p), size)
        )
    if nlp.hessian is not None:
        factor, multipliers = 1.5, 1.0 + np.arange(m) / max(1, m)
        claimed = _dense("hessian", nlp.hessian(at.copy(), factor, multipliers), (n, n))
        yield differences.worst("hessian", claimed, _slope(nlp, factor, multipliers.copy()))


def _slope(nlp: NLP, factor: float, multipliers: FloatArray) -> Function:
    """The gradient of the Lagrangian, as the problem's own derivatives have it."""

    def slope(x: FloatArray) -> FloatArray:
        total = np.zeros(nlp.n)
        if nlp.gradient is not None:
            total = total + factor * vector("gradient", nlp.gradient(x.copy()), nlp.n)
        if nlp.jacobian is not None:
            J = _dense("jacobian", nlp.jacobian(x.copy()), (nlp.m, nlp.n))
            total = total + J.T @ multipliers
        return total

    return slope


class _Differences:
    """Differences at a point that stay within bounds.

    Args:
        at: (n,) within the bounds.
        nlp: whose bounds.
    """

    def __init__(self, at: FloatArray, nlp: NLP) -> None:
        self.at = at
        self._lower, self._upper, *_ = nlp.bounds

    def worst(self, name: str, claimed: FloatArray, function: Function) -> Mismatch:
        """The worst entry of a derivative (k, n) of a function into (k,)."""
        value = function(self.at.copy())
        found = claimed.copy()  # of variables that cannot move
        for j in np.flatnonzero(self._upper > self._lower):
            found[:, j] = self._column(function, value, int(j))
        rows = np.maximum(np.abs(claimed), np.abs(found)).max(axis=1, initial=0.0)
        size = np.maximum(rows, _LEAST_SIZE * np.maximum(1.0, np.abs(value)))
        error = np.abs(claimed - found) / size[:, None]
        error = np.where(np.isnan(error), np.inf, error)
        row, column = (int(i) for i in np.unravel_index(int(np.argmax(error)), error.shape))
        at = row, column
        return Mismatch(name, row, column, float(claimed[at]), float(found[at]), float(error[at]))

    def _column(self, function: Function, value: FloatArray, j: int) -> FloatArray:
        """The derivative (k,) by one variable: central, or from one side near a bound."""
        x = float(self.at[j])
        step = _STEP * max(1.0, abs(x))
        above, below = self._upper[j] - x, x - self._lower[j]
        if above >= step and below >= step:
            ahead, behind = self._moved(j, step), self._moved(j, -step)
            change = function(ahead) - function(behind)
            return np.asarray(change / (ahead[j] - behind[j]))
        side = min(step, 0.5 * above) if above >= below else -min(step, 0.5 * below)
        near, far = self._moved(j, side), self._moved(j, 2.0 * side)
        change = 4.0 * (function(near) - value) - (function(far) - value)
        return np.asarray(change / (2.0 * (near[j] - x)))

    def _moved(self, j: int, step: float) -> FloatArray:
        x = self.at.copy()
        x[j] += step
        return x


def _one(value: object) -> FloatArray:
    return np.array([scalar("objective", value)])


def _dense(name: str, value: object, shape: tuple[int, int]) -> FloatArray:
    found = matrix(name, value, shape)
    return found if isinstance(found, np.ndarray) else found.toarray()
