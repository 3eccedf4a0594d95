"""Derivatives of a problem held against differences of its values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from .nlp import NLP, FloatArray, Matrix, NlpError

_STEP = 6e-6
"""About the cube root of the rounding unit: best for central differences."""


@dataclass(frozen=True, slots=True)
class Mismatch:
    """The worst entry of one derivative.

    Args:
        derivative: ``gradient``, ``jacobian``, ``hessian`` or ``residual_jacobian``.
        row, column: of the entry; a gradient has row 0.
        claimed: by the callable.
        differences: of the values.
        error: their difference, relative to the larger of the two and 1.
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
    """Hold every derivative of a problem at x (n,) against central differences.

    The Hessian is checked for the objective and all constraints together, with multipliers between
    1 and 2.

    Raises:
        NlpError: x has the wrong size.
    """
    at = np.array(x, dtype=np.float64)
    if at.shape != (nlp.n,):
        raise NlpError(f"x has shape {at.shape}, expected ({nlp.n},)")
    found: list[Mismatch] = []
    objective, gradient = nlp.objective, nlp.gradient
    if objective is not None and gradient is not None:
        slope = _differences(lambda p: np.array([float(objective(p))]), at)
        found.append(_worst("gradient", np.atleast_2d(gradient(at)), slope))
    pairs = (
        ("jacobian", nlp.constraints, nlp.jacobian),
        ("residual_jacobian", nlp.residuals, nlp.residual_jacobian),
    )
    for name, values, derivative in pairs:
        if values is not None and derivative is not None:
            found.append(_worst(name, _dense(derivative(at)), _differences(values, at)))
    if nlp.hessian is not None:
        found.append(_worst("hessian", *_hessians(nlp, at)))
    return DerivativeCheck(tuple(found), tolerance)


def _hessians(nlp: NLP, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The Lagrangian's Hessian as claimed, and by differences of its gradient."""
    multipliers = 1.0 + np.arange(nlp.m) / max(1, nlp.m)
    factor = 1.5

    def slope(x: FloatArray) -> FloatArray:
        total = np.zeros(nlp.n)
        if nlp.gradient is not None:
            total = total + factor * np.asarray(nlp.gradient(x), dtype=np.float64)
        if nlp.jacobian is not None:
            total = total + _dense(nlp.jacobian(x)).T @ multipliers
        return total

    assert nlp.hessian is not None
    return _dense(nlp.hessian(at, factor, multipliers)), _differences(slope, at)


def _differences(function, at: FloatArray) -> FloatArray:  # type: ignore[no-untyped-def]
    """Central differences (k, n) of a function into (k,)."""
    columns = []
    for j in range(len(at)):
        step = _STEP * max(1.0, abs(float(at[j])))
        ahead, behind = at.copy(), at.copy()
        ahead[j] += step
        behind[j] -= step
        change = np.array(function(ahead), dtype=np.float64) - np.array(function(behind))
        columns.append(change / (ahead[j] - behind[j]))
    return np.array(columns).T


def _dense(matrix: Matrix) -> FloatArray:
    if isinstance(matrix, sparse.sparray | sparse.spmatrix):
        return np.array(sparse.csc_array(matrix, dtype=np.float64).toarray())
    return np.array(matrix, dtype=np.float64)


def _worst(name: str, claimed: FloatArray, differences: FloatArray) -> Mismatch:
    if claimed.shape != differences.shape:
        raise NlpError(f"{name} gave shape {claimed.shape}, expected {differences.shape}")
    size = np.maximum(1.0, np.maximum(np.abs(claimed), np.abs(differences)))
    error = np.abs(claimed - differences) / size
    error = np.where(np.isnan(error), np.inf, error)
    row, column = (int(i) for i in np.unravel_index(int(np.argmax(error)), error.shape))
    return Mismatch(
        name,
        row,
        column,
        float(claimed[row, column]),
        float(differences[row, column]),
        float(error[row, column]),
    )
