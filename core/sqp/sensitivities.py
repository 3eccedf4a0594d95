"""How a solution changes with parameters of its problem.

The conditions of optimality, with the active constraints as equations, hold for every value of the
parameters near by; their derivative is one linear system, the one that the last digits of the
solution came from (Fiacco, "Introduction to sensitivity and stability analysis in nonlinear
programming", 1983).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import BoolArray, FloatArray
from .algebra.linear import Saddle
from .algebra.matrices import SparseMatrix
from .problem.arrays import numbers
from .problem.errors import NlpError
from .problem.evaluation import Point
from .problem.hessians import HessianKind, choose_kind, make_source
from .problem.nlp import NLP
from .problem.optimality import lagrangian_slope
from .problem.patterns import Pattern
from .problem.scaled import ScaledProblem
from .result import Result

_REGULARISATION = 1e-8
_EXACT = 1e-6
_WEAK = 1e-6


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Derivatives of a solution with respect to k parameters.

    Args:
        x: (n, k) of the point.
        multipliers: (m, k) of the constraints' multipliers.
        objective: (k,) of the optimum.
        weak: whether a constraint that holds as an equality hardly pushes: then the derivatives
            are those to one side.
        solution: that they belong to.
    """

    x: FloatArray
    multipliers: FloatArray
    objective: FloatArray
    weak: bool
    solution: Result

    def predicted(self, change: ArrayLike) -> FloatArray:
        """The point (n,) after a change of the parameters (k,), to first order: where to begin
        again from."""
        return np.asarray(self.solution.x + self.x @ np.atleast_1d(np.asarray(change, np.float64)))


def sensitivities(
    nlp: NLP,
    solution: Result,
    *,
    slope_change: ArrayLike | None = None,
    constraint_change: ArrayLike | None = None,
    bound_change: ArrayLike | None = None,
    objective_change: ArrayLike | None = None,
) -> Sensitivities:
    """Derivatives of a solution with respect to parameters p.

    Args:
        nlp: the problem.
        solution: of it.
        slope_change: (n, k) ∂/∂p of ∇f + Jᵀλ at the solution, x and λ held; None for zero.
        constraint_change: (m, k) ∂c/∂p less that of the limit that holds: -1 where a limit itself
            is the parameter; None for zero.
        bound_change: (n, k) ∂/∂p of the bound that holds a variable; None for zero.
        objective_change: (k,) ∂f/∂p; None for zero.

    Raises:
        NlpError: the result is no solution, an argument has another shape, none is given, or the
            solution does not follow from its active constraints and second derivatives.
    """
    if not solution.success:
        raise NlpError(f"only solutions have sensitivities, not what ended as {solution.status}")
    given = {
        "slope_change": (slope_change, nlp.n),
        "constraint_change": (constraint_change, nlp.m),
        "bound_change": (bound_change, nlp.n),
    }
    changes, count = _changes(given, objective_change)
    slopes, constraints, bounds = (changes[name] for name in given)
    fall = changes["objective_change"][0]
    problem = ScaledProblem(nlp, *_patterns(nlp))
    point = problem.evaluation.point(solution.x)
    problem.evaluation.differentiate(point)
    kind = HessianKind.DIFFERENCES if _unknown(nlp) else choose_kind(nlp, None)
    H = make_source(kind, problem.evaluation).matrix(point, solution.multipliers)
    rows, fixed, weak = _active(nlp, solution, point)
    saddle = Saddle(regularisation=_REGULARISATION)
    x, y = np.zeros((nlp.n, count)), np.zeros((nlp.m, count))
    for j in range(count):
        q, target, values = slopes[:, j], -constraints[:, j], bounds[:, j]
        found = saddle.solve(H, q, point.J, rows, target, fixed, values)
        if found is None or _left(H, point, found, q, target, rows, fixed) > _EXACT:
            raise NlpError(
                "the solution is not isolated, or its active constraints depend on each other: it "
                "has no derivatives"
            )
        x[:, j], y[:, j] = found
    pushed = solution.multipliers @ constraints - solution.bound_multipliers @ bounds
    return Sensitivities(x, y, fall + pushed, weak, solution)


def _patterns(nlp: NLP) -> tuple[Pattern, Pattern]:
    return Pattern("jacobian", (nlp.m, nlp.n)), Pattern("hessian", (nlp.n, nlp.n), growing=True)


def _unknown(nlp: NLP) -> bool:
    return nlp.hessian is None and nlp.residuals is None


def _changes(
    given: dict[str, tuple[ArrayLike | None, int]], objective: ArrayLike | None
) -> tuple[dict[str, FloatArray], int]:
    """All changes as arrays (…, k), and k."""
    wide = {name: (value, height) for name, (value, height) in given.items() if value is not None}
    arrays = {name: numbers(name, value) for name, (value, _) in wide.items()}
    if objective is not None:
        arrays["objective_change"] = np.atleast_1d(numbers("objective_change", objective))[None]
    if not arrays:
        raise NlpError("sensitivities to what? none of the changes is given")
    heights = {**{name: height for name, (_, height) in given.items()}, "objective_change": 1}
    count = next(iter(arrays.values())).shape[-1]
    for name, array in arrays.items():
        if array.shape != (heights[name], count):
            raise NlpError(f"{name} has shape {array.shape}, expected ({heights[name]}, {count})")
    return {
        name: arrays.get(name, np.zeros((height, count))) for name, height in heights.items()
    }, count


def _active(nlp: NLP, solution: Result, point: Point) -> tuple[BoolArray, BoolArray, bool]:
    """Rows (m,) and variables (n,) that hold as equations, and whether one hardly does."""
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    rows, weak_rows = _held(point.c, solution.multipliers, c_lower, c_upper)
    fixed, weak = _held(point.x, solution.bound_multipliers, x_lower, x_upper)
    return rows, fixed, weak_rows or weak


def _held(
    value: FloatArray, multiplier: FloatArray, lower: FloatArray, upper: FloatArray
) -> tuple[BoolArray, bool]:
    gap = np.minimum(np.abs(upper - value), np.abs(value - lower))
    equal = lower == upper
    held = equal | (np.abs(multiplier) > gap)
    near = gap <= _WEAK * np.maximum(1.0, np.abs(value))
    return held, bool((~equal & near & (np.abs(multiplier) <= _WEAK)).any())


def _left(
    H: SparseMatrix,
    point: Point,
    found: tuple[FloatArray, FloatArray],
    q: FloatArray,
    target: FloatArray,
    rows: BoolArray,
    fixed: BoolArray,
) -> float:
    """What is left of the system, beside its right side."""
    d, y = found
    slope = H @ d + lagrangian_slope(q, point.J, y)
    change = point.J @ d - target if len(y) else np.zeros(0)
    parts = (slope[~fixed], change[rows])
    size = max(1.0, float(np.abs(q).max()), float(np.abs(target).max(initial=0.0)))
    return max(float(np.abs(part).max(initial=0.0)) for part in parts) / size
