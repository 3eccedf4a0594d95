"""Test problems written down as formulas, and the `NLP`s made of them.

A formula takes the variables one by one and gives the objective and the rows of constraints:

    @problem(start=(2, 2), optimum=1)
    def hs22(x1, x2):
        return (x1 - 2) ** 2 + (x2 - 1) ** 2, [at_least(x2 - x1**2, 0), at_most(x1 + x2, 2)]

With jets in the place of numbers it gives all derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP

from .jets import Jet, variables


class Row(NamedTuple):
    """lower ≤ value ≤ upper."""

    value: Jet | float
    lower: float
    upper: float


def at_least(value: Jet | float, lower: float) -> Row:
    return Row(value, lower, np.inf)


def at_most(value: Jet | float, upper: float) -> Row:
    return Row(value, -np.inf, upper)


def between(value: Jet | float, lower: float, upper: float) -> Row:
    return Row(value, lower, upper)


def equal(value: Jet | float, target: float) -> Row:
    return Row(value, target, target)


Formula = Callable[..., tuple[Jet | float, list[Row]]]


@dataclass(frozen=True)
class Problem:
    """A problem with its published start and its optimum."""

    name: str
    formula: Formula
    start: tuple[float, ...]
    optimum: float
    lower: ArrayLike | None
    upper: ArrayLike | None

    def nlp(self) -> NLP:
        return nlp_from(self.formula, len(self.start), self.lower, self.upper)


def problem(
    start: Sequence[float],
    optimum: float,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
) -> Callable[[Formula], Problem]:
    """Make a `Problem` of a formula."""

    def made(formula: Formula) -> Problem:
        return Problem(formula.__name__, formula, tuple(start), optimum, lower, upper)

    return made


def nlp_from(
    formula: Formula, n: int, lower: ArrayLike | None = None, upper: ArrayLike | None = None
) -> NLP:
    """The `NLP` of a formula in n variables, with exact derivatives."""
    functions = _Functions(formula)
    with np.errstate(all="ignore"):
        rows = formula(*np.full(n, 0.7))[1]
    constrained = bool(rows)
    return NLP(
        n=n,
        m=len(rows),
        objective=functions.objective,
        gradient=functions.gradient,
        constraints=functions.constraints if constrained else None,
        jacobian=functions.jacobian if constrained else None,
        hessian=functions.hessian,
        x_lower=lower,
        x_upper=upper,
        c_lower=[row.lower for row in rows] if constrained else None,
        c_upper=[row.upper for row in rows] if constrained else None,
    )


class _Functions:
    """A formula's values and derivatives; those of the last x are kept."""

    def __init__(self, formula: Formula) -> None:
        self._formula = formula
        self._at = b""
        self._f: Jet
        self._c: list[Jet]

    def objective(self, x: FloatArray) -> float:
        value = self._formula(*x)[0]
        return float(value)

    def constraints(self, x: FloatArray) -> FloatArray:
        return np.array([row.value for row in self._formula(*x)[1]], dtype=np.float64)

    def gradient(self, x: FloatArray) -> FloatArray:
        return self._jets(x)[0].gradient

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.array([c.gradient for c in self._jets(x)[1]])

    def hessian(self, x: FloatArray, factor: float, multipliers: FloatArray) -> FloatArray:
        f, c = self._jets(x)
        total = factor * f.hessian
        for multiplier, row in zip(multipliers, c, strict=True):
            total = total + multiplier * row.hessian
        return total

    def _jets(self, x: FloatArray) -> tuple[Jet, list[Jet]]:
        if x.tobytes() != self._at:
            value, rows = self._formula(*variables(x))
            self._f = _as_jet(value, len(x))
            self._c = [_as_jet(row.value, len(x)) for row in rows]
            self._at = x.tobytes()
        return self._f, self._c


def _as_jet(value: Jet | float, n: int) -> Jet:
    return value if isinstance(value, Jet) else Jet(value, np.zeros(n), np.zeros((n, n)))
