"""NLPs of formulas in a few variables each, taken at many places at once.

A formula takes its variables one by one and gives a value, or rows of values:

    def moved(x0, v0, x1, v1):
        return [x1 - x0 - 0.1 * (v0 + v1) / 2]

It is called once, with expressions in the place of numbers; they and their derivatives are then
worked out at all places at once. With a computer algebra's symbols it gives that one's.
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
from .expressions import Expression, Graph, slopes
from .tape import Tape

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
    """Terms, recorded once, with the places of their values and derivatives.

    Attributes:
        slope_places, bend_places: rows and columns of the derivatives' entries.
    """

    def __init__(self, terms: Terms, first_row: int) -> None:
        places = np.atleast_2d(terms.places)
        self.count, width = places.shape
        self._from = np.ascontiguousarray(places.T)
        height = max(1, len(terms.lower))
        # rows: all of the first row of the formula, then all of the second
        self.rows = first_row + np.arange(height * self.count).reshape(height, -1)
        graph = Graph(width + height)
        x, weights = graph.variables[:width], graph.variables[width:]
        found = _rows(terms.formula(*x))
        rows = [row if isinstance(row, Expression) else graph.constant(row) for row in found]
        self._values = Tape(graph, rows)
        entries = [(r, j, slope) for r in range(height) for j, slope in _present(rows[r], x)]
        self._slopes = Tape(graph, [slope for *_, slope in entries])
        self.slope_places = self._laid_out(
            [self.rows[r] for r, *_ in entries], [self._from[j] for _, j, _ in entries]
        )
        total = graph.constant(0.0)
        for weight, row in zip(weights, rows, strict=True):
            total = total + weight * row
        bends = [
            (i, j, bend)
            for i, slope in _present(total, x)
            for j, bend in _present(slope, x[: i + 1])
        ]
        self._bends = Tape(graph, [bend for *_, bend in bends])
        self._off = [k for k, (i, j, _) in enumerate(bends) if i != j]
        below = [(self._from[i], self._from[j]) for i, j, _ in bends]
        above = [below[k][::-1] for k in self._off]
        self.bend_places = self._laid_out(*([p[side] for p in below + above] for side in (0, 1)))

    def _laid_out(self, rows: list[IntArray], columns: list[IntArray]) -> tuple[IntArray, IntArray]:
        none = [np.zeros(0, dtype=np.int64)]
        return np.concatenate(none + rows), np.concatenate(none + columns)

    def values(self, x: FloatArray) -> FloatArray:
        """(height, count)."""
        return self._values.values(x[self._from])

    def slopes(self, x: FloatArray) -> FloatArray:
        """First derivatives, flat, as `slope_places` has them."""
        return self._slopes.values(x[self._from]).ravel()

    def bends(self, x: FloatArray, weights: FloatArray) -> FloatArray:
        """Second derivatives of the weighted (height, count) sum, flat, as `bend_places` has
        them."""
        below = self._bends.values(np.concatenate([x[self._from], weights]))
        return np.concatenate([below, below[self._off]]).ravel()


def _present(of: Expression, by: list[Expression]) -> list[tuple[int, Expression]]:
    """The derivatives that are not zero everywhere, with the numbers of their variables."""
    return [(k, slope) for k, slope in enumerate(slopes(of, by)) if slope.number != 0.0]


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
        self._J = _entries([group.slope_places for group in self._groups], (self.m, n))
        self._g = np.concatenate([group.slope_places[1] for group in self._costs])
        both = (*self._costs, *self._groups)
        self._H = _entries([group.bend_places for group in both], (n, n))

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
        values = np.concatenate([group.slopes(x) for group in self._costs])
        return np.asarray(np.bincount(self._g, values, minlength=self.n), np.float64)

    def jacobian(self, x: FloatArray) -> sparse.csc_array:
        return self._J.matrix(np.concatenate([group.slopes(x) for group in self._groups]))

    def hessian(self, x: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        values = [group.bends(x, np.full((1, group.count), factor)) for group in self._costs]
        values += [group.bends(x, multipliers[group.rows]) for group in self._groups]
        return self._H.matrix(np.concatenate(values))


def _rows(found: Any) -> list[Any]:
    return found if isinstance(found, list) else [found]


def _entries(places: list[tuple[IntArray, IntArray]], shape: tuple[int, int]) -> MatrixEntries:
    rows, columns = (np.concatenate(part) for part in zip(*places, strict=True))
    return MatrixEntries(rows, columns, shape)
