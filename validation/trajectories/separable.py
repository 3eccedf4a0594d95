"""NLPs of formulas in a few variables each, taken at many places at once.

A formula takes its variables one by one and gives a value, or rows of values:

    def moved(x0, v0, x1, v1):
        return [x1 - x0 - 0.1 * (v0 + v1) / 2]

With arrays in the place of numbers it is worked out at all places at once, with jets in their place
it gives all derivatives, and with a computer algebra's symbols its expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from ...core.arrays import FloatArray, IntArray
from ...core.sqp import NLP
from ...core.sqp.algebra.entries import MatrixEntries
from .jets import Jet

Formula = Callable[..., Any]


@dataclass(frozen=True)
class Terms:
    """A formula at places.

    Args:
        formula: takes d variables; gives a list of rows, or one value for an objective.
        places: (k, d) which variables each time.
        lower, upper: limits of each row; not of an objective.
    """

    formula: Formula
    places: IntArray
    lower: Sequence[float] = ()
    upper: Sequence[float] = ()


class _Group:
    """Terms with the places of their derivatives."""

    def __init__(self, terms: Terms, first_row: int) -> None:
        self.formula, self.places = terms.formula, np.atleast_2d(terms.places)
        self.count, self.width = self.places.shape
        self.height = max(1, len(terms.lower))
        # rows: all of the first row of the formula, then all of the second
        self.rows = first_row + np.arange(self.height * self.count).reshape(self.height, -1)
        self._flat = np.zeros((self.width, self.width, 1))
        self._units = np.eye(self.width)[:, :, None]

    def values(self, x: FloatArray) -> FloatArray:
        """(height, count)."""
        found = _rows(self.formula(*x[self.places].T))
        return np.array([np.broadcast_to(np.asarray(row, float), self.count) for row in found])

    def jets(self, x: FloatArray) -> list[Jet]:
        wide = (self.width, self.width, self.count)
        ones = np.ones(self.count)
        given = [
            Jet(x[self.places[:, j]], self._units[j] * ones, self._flat) for j in range(self.width)
        ]
        found = []
        for row in _rows(self.formula(*given)):
            jet = row if isinstance(row, Jet) else Jet(row * ones, self._units[0] * 0, self._flat)
            found.append(
                Jet(
                    jet.value,
                    np.broadcast_to(jet.gradient, wide[1:]),
                    np.broadcast_to(jet.hessian, wide),
                )
            )
        return found


class Separable:
    """A problem.

    Args:
        n: number of variables.
        objective: terms whose values are summed up.
        rows: terms that are constraints.
        x_lower, x_upper: (n,) or a number.

    Attributes:
        m: number of constraints.
    """

    def __init__(
        self,
        n: int,
        objective: Sequence[Terms],
        rows: Sequence[Terms],
        x_lower: ArrayLike,
        x_upper: ArrayLike,
    ) -> None:
        self.n = n
        self.objective_terms, self.row_terms = tuple(objective), tuple(rows)
        self.x_lower, self.x_upper = x_lower, x_upper
        self._costs = [_Group(terms, 0) for terms in objective]
        self._groups: list[_Group] = []
        self.m = 0
        for terms in rows:
            self._groups.append(_Group(terms, self.m))
            self.m += self._groups[-1].rows.size
        self._at = b""
        J_places = [
            (np.repeat(group.rows[r], group.width), group.places.ravel())
            for group in self._groups
            for r in range(group.height)
        ]
        self._J = _entries(J_places, (self.m, n))
        H_places = [
            (
                np.repeat(group.places, group.width, axis=1).ravel(),
                np.tile(group.places, (1, group.width)).ravel(),
            )
            for group in (*self._costs, *self._groups)
        ]
        self._H = _entries(H_places, (n, n))

    def nlp(self) -> NLP:
        """The problem for the solver."""
        counts = [group.count for group in self._groups]
        lower = [np.repeat(t.lower, k) for t, k in zip(self.row_terms, counts, strict=True)]
        upper = [np.repeat(t.upper, k) for t, k in zip(self.row_terms, counts, strict=True)]
        return NLP(
            n=self.n,
            m=self.m,
            objective=self.objective,
            gradient=self.gradient,
            constraints=self.constraints,
            jacobian=self.jacobian,
            hessian=self.hessian,
            x_lower=self.x_lower,
            x_upper=self.x_upper,
            c_lower=np.concatenate(lower),
            c_upper=np.concatenate(upper),
        )

    def objective(self, x: FloatArray) -> float:
        return float(sum(group.values(x).sum() for group in self._costs))

    def constraints(self, x: FloatArray) -> FloatArray:
        return np.concatenate([group.values(x).ravel() for group in self._groups])

    def gradient(self, x: FloatArray) -> FloatArray:
        self._differentiate(x)
        found = np.zeros(self.n)
        for group, (jet,) in zip(self._costs, self._cost_jets, strict=True):
            np.add.at(found, group.places, jet.gradient.T)
        return found

    def jacobian(self, x: FloatArray) -> sparse.csc_array:
        self._differentiate(x)
        values = [jet.gradient.T.ravel() for jets in self._row_jets for jet in jets]
        return self._J.matrix(np.concatenate(values))

    def hessian(self, x: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        self._differentiate(x)
        values = [factor * jet.hessian for (jet,) in self._cost_jets]
        for group, jets in zip(self._groups, self._row_jets, strict=True):
            weights = multipliers[group.rows]
            values.append(sum(w * jet.hessian for w, jet in zip(weights, jets, strict=True)))
        return self._H.matrix(np.concatenate([v.transpose(2, 0, 1).ravel() for v in values]))

    def _differentiate(self, x: FloatArray) -> None:
        """Jets at x, of which those of the last one are kept."""
        if x.tobytes() != self._at:
            self._cost_jets = [group.jets(x) for group in self._costs]
            self._row_jets = [group.jets(x) for group in self._groups]
            self._at = x.tobytes()


def _rows(found: Any) -> list[Any]:
    return found if isinstance(found, list) else [found]


def _entries(places: list[tuple[IntArray, IntArray]], shape: tuple[int, int]) -> MatrixEntries:
    rows, columns = (np.concatenate(part) for part in zip(*places, strict=True))
    return MatrixEntries(rows, columns, shape)
