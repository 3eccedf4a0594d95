"""The problem that the solver takes: callables and bounds, checked once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from ...arrays import FloatArray, IntArray
from .arrays import numbers, whole_number
from .errors import NlpError

_ROUNDING = 1e-14
"""Share of its size by which a bound that was worked out may be off."""

Matrix = FloatArray | sparse.sparray | sparse.spmatrix

Objective = Callable[[FloatArray], float]
Vector = Callable[[FloatArray], FloatArray]
MatrixOf = Callable[[FloatArray], Matrix]
Hessian = Callable[[FloatArray, float, FloatArray], Matrix]


@dataclass(frozen=True, eq=False)
class NLP:
    """Minimise f(x) subject to c_lower ≤ c(x) ≤ c_upper and x_lower ≤ x ≤ x_upper.

    With ``residuals`` r and their Jacobian in the place of an objective, f = ½ r·r, and the
    Gauss–Newton Hessian is at hand.

    Args:
        n: number of variables.
        m: number of constraints.
        objective: x (n,) → f; None asks for any feasible point.
        gradient: x → ∇f (n,).
        constraints: x → c (m,); None if there are none.
        jacobian: x → J (m, n), dense or sparse. The pattern of the first sparse one is kept: later
            ones may have zeros in it, but no entry outside of it.
        hessian: x, objective_factor, multipliers (m,) → ∇²(factor f + multipliers·c) (n, n), both
            triangles, dense or sparse; None for an approximation.
        x_lower, x_upper: (n,) or a number; None for none. Equal bounds fix a variable, as do such
            that cross by rounding alone.
        c_lower, c_upper: (m,) or a number; None for none. Equal bounds make an equality.
        residuals: x → r (k,).
        residual_jacobian: x → ∂r/∂x (k, n).

    Raises:
        NlpError: a wrong size, a bound that is NaN or an infinity of the wrong sign, a lower bound
            above the upper one by more than rounding, a callable without its partner.
    """

    n: int
    m: int = 0
    objective: Objective | None = None
    gradient: Vector | None = None
    constraints: Vector | None = None
    jacobian: MatrixOf | None = None
    hessian: Hessian | None = None
    x_lower: ArrayLike | None = field(default=None, repr=False)
    x_upper: ArrayLike | None = field(default=None, repr=False)
    c_lower: ArrayLike | None = field(default=None, repr=False)
    c_upper: ArrayLike | None = field(default=None, repr=False)
    residuals: Vector | None = None
    residual_jacobian: MatrixOf | None = None

    def __post_init__(self) -> None:
        whole_number("n", self.n, 1)
        whole_number("m", self.m, 0)
        _check_partners(self)
        for kind, size in (("x", self.n), ("c", self.m)):
            lower = _bound(getattr(self, f"{kind}_lower"), f"{kind}_lower", size, -np.inf)
            upper = _bound(getattr(self, f"{kind}_upper"), f"{kind}_upper", size, np.inf)
            crossed = np.flatnonzero(lower > upper)
            if len(crossed):
                lower = _uncrossed(lower, upper, crossed, kind)
            object.__setattr__(self, f"{kind}_lower", lower)
            object.__setattr__(self, f"{kind}_upper", upper)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """x_lower, x_upper (n,), c_lower, c_upper (m,) as arrays."""
        arrays = (self.x_lower, self.x_upper, self.c_lower, self.c_upper)
        x_lower, x_upper, c_lower, c_upper = (np.asarray(a, dtype=np.float64) for a in arrays)
        return x_lower, x_upper, c_lower, c_upper


def _check_partners(nlp: NLP) -> None:
    pairs = (
        ("objective", "gradient"),
        ("constraints", "jacobian"),
        ("residuals", "residual_jacobian"),
    )
    for first, second in pairs:
        if (getattr(nlp, first) is None) != (getattr(nlp, second) is None):
            raise NlpError(f"{first} and {second} come together or not at all")
    for name in (*(name for pair in pairs for name in pair), "hessian"):
        value = getattr(nlp, name)
        if value is not None and not callable(value):
            raise NlpError(f"{name} is a callable, not {value!r}")
    if (nlp.constraints is None) != (nlp.m == 0):
        raise NlpError(f"m = {nlp.m}, but constraints is {nlp.constraints!r}")
    if nlp.objective is not None and nlp.residuals is not None:
        raise NlpError("objective and residuals exclude each other")
    if nlp.hessian is not None and nlp.residuals is not None:
        raise NlpError("hessian goes with an objective; residuals have the Gauss–Newton Hessian")


def _uncrossed(lower: FloatArray, upper: FloatArray, crossed: IntArray, kind: str) -> FloatArray:
    """Lower bounds that are not above upper ones, where they are so by rounding alone.

    Raises:
        NlpError: by more.
    """
    below, above = upper[crossed], lower[crossed]
    far = above - below > _ROUNDING * np.maximum(np.abs(above), np.abs(below))
    if far.any():
        i = int(crossed[np.argmax(far)])
        raise NlpError(
            f"{kind}_lower[{i}] = {lower[i]:.12g} is above {kind}_upper[{i}] = {upper[i]:.12g}"
        )
    mended = np.minimum(lower, upper)
    mended.flags.writeable = False
    return mended


def _bound(value: ArrayLike | None, name: str, size: int, missing: float) -> FloatArray:
    array = numbers(name, missing if value is None else value)
    if array.ndim == 0:
        array = np.full(size, float(array))
    if array.shape != (size,):
        raise NlpError(f"{name} has shape {array.shape}, expected ({size},)")
    if np.isnan(array).any():
        raise NlpError(f"{name}[{int(np.flatnonzero(np.isnan(array))[0])}] is NaN")
    wrong = np.flatnonzero(array == -missing)
    if len(wrong):
        raise NlpError(f"{name}[{int(wrong[0])}] is {-missing}: nothing can satisfy it")
    array.flags.writeable = False
    return array
