"""The user's callables: checked, counted, timed and scaled."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite
from typing import TypeVar

import numpy as np
from scipy import sparse

from ...arrays import FloatArray
from ..algebra.matrices import SparseMatrix, empty
from .arrays import matrix, numbers, scalar, vector
from .errors import CallableError, NlpError
from .nlp import NLP
from .patterns import Pattern

GRADIENT_SIZE = 100.0
"""Functions are scaled down so that no gradient entry at the start is larger (Wächter and Biegler,
"On the implementation of an interior-point filter line-search algorithm", section 3.8)."""
_LEAST_FACTOR = 1e-8
_NO_SLOPES, _NO_ROWS = np.zeros(0), empty(0)
T = TypeVar("T")
_quiet = np.errstate(all="ignore")
"""What callables do beyond arithmetic shows in their values."""


@dataclass(slots=True)
class Point:
    """Scaled values at x; derivatives once they are asked for.

    Args:
        x: (n,).
        f: objective.
        c: (m,) constraints.
    """

    x: FloatArray
    f: float
    c: FloatArray
    g: FloatArray = field(default_factory=lambda: _NO_SLOPES)
    J: SparseMatrix = field(default_factory=lambda: _NO_ROWS)


class Evaluation:
    """A problem's functions, scaled.

    Args:
        nlp: the problem.
        jacobian, hessian: the patterns of its matrices.

    Attributes:
        hessian_pattern: as given.
        objective_factor: scaled objective / objective.
        constraint_factors: (m,) likewise.
        counts: calls of each callable.
        seconds: spent in them.
    """

    def __init__(self, nlp: NLP, jacobian: Pattern, hessian: Pattern) -> None:
        self.nlp = nlp
        self.objective_factor = 1.0
        self.constraint_factors = np.ones(nlp.m)
        self.counts: dict[str, int] = {}
        self.seconds = 0.0
        self._jacobian = jacobian
        self.hessian_pattern = hessian
        self._slopes: tuple[FloatArray, FloatArray, SparseMatrix] | None = None
        self._residuals: tuple[bytes, FloatArray] | None = None
        self._residual_jacobian: tuple[bytes, sparse.csc_array] | None = None
        self._have_given: set[str] = set()
        self._plain = True

    def scale(self, point: Point) -> None:
        """Choose the factors by the gradients at ``point``, which is scaled too."""
        largest = float(np.abs(point.g).max(initial=0.0))
        if largest > GRADIENT_SIZE:
            self.objective_factor = max(GRADIENT_SIZE / largest, _LEAST_FACTOR)
        if self.nlp.m:
            rows = point.J.row_sizes()
            large = rows > GRADIENT_SIZE
            self.constraint_factors[large] = np.maximum(GRADIENT_SIZE / rows[large], _LEAST_FACTOR)
        self._plain = self.objective_factor == 1.0 and bool((self.constraint_factors == 1.0).all())
        point.f *= self.objective_factor
        point.c = point.c * self.constraint_factors
        point.g = point.g * self.objective_factor
        point.J = self._scaled_rows(point.J)

    # ------------------------------------------------------------------------- values

    @_quiet
    def point(self, x: FloatArray) -> Point:
        """Values at x.

        Raises:
            CallableError: one is not finite.
        """
        f = self._objective(x) * self.objective_factor
        c = self._constraints(x) * self.constraint_factors
        return Point(x, f, c)

    @_quiet
    def differentiate(self, point: Point) -> None:
        """Add the derivatives.

        Raises:
            CallableError: one is not finite.
        """
        g, J = self._gradient(point.x), self._jacobian_at(point.x)
        self._slopes = point.x, g, J
        point.g = g * self.objective_factor
        point.J = self._scaled_rows(J)

    @_quiet
    def unscaled(self, point: Point) -> tuple[float, FloatArray, FloatArray, SparseMatrix]:
        """f, c (m,), ∇f (n,) and J (m, n) as the callables give them, worked out anew; derivatives
        that were worked out last, at this very point, stand where its values come out the same."""
        f, c, known = self._objective(point.x), self._constraints(point.x), self._slopes
        same = f * self.objective_factor == point.f
        same = same and np.array_equal(c * self.constraint_factors, point.c)
        if known is None or known[0] is not point.x or not same:
            return f, c, self._gradient(point.x), self._jacobian_at(point.x)
        return f, c, known[1], known[2]

    def lagrangian_hessian(self, x: FloatArray, multipliers: FloatArray) -> SparseMatrix:
        """Hessian of the scaled Lagrangian; multipliers (m,) are the scaled ones.

        Raises:
            CallableError: an entry is not finite.
        """
        return self._hessian_at(x, self.objective_factor, multipliers)

    def constraint_hessian(self, x: FloatArray, multipliers: FloatArray) -> SparseMatrix:
        """Hessian of multipliers·c, both scaled.

        Raises:
            CallableError: an entry is not finite.
        """
        return self._hessian_at(x, 0.0, multipliers)

    @_quiet
    def _hessian_at(self, x: FloatArray, factor: float, multipliers: FloatArray) -> SparseMatrix:
        hessian = self.nlp.hessian
        assert hessian is not None
        factors = multipliers * self.constraint_factors
        value = self._call("hessian", hessian, x.copy(), factor, factors)
        found = self.hessian_pattern.array(value)
        self._check_finite("hessian", found.data)
        self.hessian_pattern.symmetry.check("hessian", found)
        return found

    @_quiet
    def residual_hessian(self, x: FloatArray) -> sparse.csc_array:
        """The Gauss–Newton Hessian of the scaled objective."""
        J = self._residual_jacobian_at(x)
        return sparse.csc_array(self.objective_factor * (J.T @ J))

    # -------------------------------------------------------------------- the callables

    def _objective(self, x: FloatArray) -> float:
        if self.nlp.residuals is not None:
            r = self._residuals_at(x)
            return 0.5 * float(r @ r)
        if self.nlp.objective is None:
            return 0.0
        number = scalar("objective", self._at("objective", self.nlp.objective, x))
        self._have_given.add("objective")
        if not isfinite(number):
            raise CallableError(f"objective gave {number} (entry 0)")
        return number

    def _gradient(self, x: FloatArray) -> FloatArray:
        if self.nlp.residuals is not None:
            return np.asarray(self._residual_jacobian_at(x).T @ self._residuals_at(x))
        if self.nlp.gradient is None:
            return np.zeros(self.nlp.n)
        return self._vector_at("gradient", self.nlp.gradient, self.nlp.n, x)

    def _constraints(self, x: FloatArray) -> FloatArray:
        if self.nlp.constraints is None:
            return np.zeros(0)
        return self._vector_at("constraints", self.nlp.constraints, self.nlp.m, x)

    def _jacobian_at(self, x: FloatArray) -> SparseMatrix:
        if self.nlp.jacobian is None:
            return empty(self.nlp.n)
        found = self._jacobian.array(self._at("jacobian", self.nlp.jacobian, x))
        self._check_finite("jacobian", found.data)
        return found

    def _residuals_at(self, x: FloatArray) -> FloatArray:
        residuals = self.nlp.residuals
        assert residuals is not None
        key = x.tobytes()
        if self._residuals is None or self._residuals[0] != key:
            value = numbers("residuals", self._at("residuals", residuals, x))
            if value.ndim != 1:
                raise NlpError(f"residuals gave shape {value.shape}, expected one dimension")
            self._check_finite("residuals", value)
            self._residuals = key, value
        return self._residuals[1]

    def _residual_jacobian_at(self, x: FloatArray) -> sparse.csc_array:
        jacobian = self.nlp.residual_jacobian
        assert jacobian is not None
        key = x.tobytes()
        if self._residual_jacobian is None or self._residual_jacobian[0] != key:
            shape = (len(self._residuals_at(x)), self.nlp.n)
            value = self._at("residual_jacobian", jacobian, x)
            found = sparse.csc_array(matrix("residual_jacobian", value, shape))
            self._check_finite("residual_jacobian", found.data)
            self._residual_jacobian = key, found
        return self._residual_jacobian[1]

    def _vector_at(
        self, name: str, function: Callable[[FloatArray], object], size: int, x: FloatArray
    ) -> FloatArray:
        value = vector(name, self._at(name, function, x), size)
        self._check_finite(name, value)
        return value

    def _at(self, name: str, function: Callable[[FloatArray], T], x: FloatArray) -> T:
        """What a callable gives at x, of which it gets a copy that it may do with as it likes."""
        return self._call(name, function, x.copy())

    def _call(self, name: str, function: Callable[..., T], *given: object) -> T:
        """What a callable gives.

        Raises:
            CallableError: it raised an error of arithmetic or, having given values before, one that
                says that a value has no meaning. Others pass, as those of a first call do: they
                are rather mistakes than points outside of a function's domain.
        """
        self.counts[name] = self.counts.get(name, 0) + 1
        begin = time.perf_counter()
        try:
            return function(*given)
        except NlpError:
            raise
        except ArithmeticError as error:
            raise CallableError(f"{name} has no value: {error}") from error
        except ValueError as error:  # LinAlgError is one
            if name not in self._have_given:
                raise
            raise CallableError(f"{name} has no value: {error}") from error
        finally:
            self.seconds += time.perf_counter() - begin

    def _check_finite(self, name: str, values: FloatArray) -> None:
        self._have_given.add(name)
        if isfinite(np.add.reduce(values)):  # one pass where nothing is wrong
            return
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise CallableError(f"{name} gave {values[bad[0]]} (entry {int(bad[0])})")

    def _scaled_rows(self, J: SparseMatrix) -> SparseMatrix:
        if self._plain or not self.nlp.m:
            return J
        return SparseMatrix(J.pattern, J.data * self.constraint_factors[J.pattern.rows])
