"""Newton's steps for the barrier's problems: inertia corrected, one factorisation as a rule."""

from __future__ import annotations

from math import isfinite

import numpy as np

from ...arrays import BoolArray, FloatArray
from ..algebra.linear import SaddlePatterns
from ..algebra.matrices import SparseMatrix, Sparsity
from ..problem.evaluation import Point
from .direction import Errors, FirstDerivatives, errors_at, largest_change
from .iterate import InteriorIterate, InteriorLimits
from .system import BarrierSystem, SystemWeights

_FIRST_SHIFT, _LEAST_SHIFT, _LARGEST_SHIFT = 1e-4, 1e-20, 1e40
_FAST, _GROW, _SHRINK = 100.0, 8.0, 1.0 / 3.0
_CREEP, _CREEPS = 0.1, 5
"""Largest change of a variable, in its size, below which a step of a shifted system may creep, and
how many of them in a row do."""
_LEAP, _SHORTENING, _SHORTER = 100.0, 1e-2, 0.1
"""Largest change of a variable, in its size, from which on the first step leaps, the shift that may
shorten it, and to which share it has to."""
_DEPENDENT = 1e-8
_BAD = 1e-6
_LARGEST_FIRST = 1e3


class SingularError(ArithmeticError):
    """No shift gives the system the right inertia."""


class Place:
    """A point of the interior with all that is known of it.

    Args:
        at: variables, slacks, multipliers.
        point: values and derivatives.
        rest: (m,) c − s.

    Attributes:
        derivatives: as compiled code takes them.
        slopes: (n + m,) of the Lagrangian, once `measure` has been called.
        errors: how far it is from a solution of the problem itself, μ = 0; likewise.
    """

    __slots__ = ("at", "derivatives", "errors", "point", "rest", "slopes")

    def __init__(self, at: InteriorIterate, point: Point, rest: FloatArray) -> None:
        self.at = at
        self.point = point
        self.rest = rest
        J = point.J
        self.derivatives = FirstDerivatives(point.g, J.pattern.starts, J.pattern.rows, J.data)
        self.slopes: FloatArray
        self.errors: Errors

    def measure(self, box: InteriorLimits) -> Place:
        """Work out slopes and errors, the multipliers being final."""
        self.slopes, *errors = errors_at(self.at, box, self.derivatives, self.rest)
        self.errors = Errors(*errors)
        return self


class Newton:
    """Steps of one solution.

    Args:
        patterns: keeps symbolic factorisations.
        box: limits.

    Shifts are equal for all variables, as long as they let steps get anywhere: where variables are
    large, slopes are small beside any shift, and steps creep. From then on shifts count in the
    variables' sizes.

    Attributes:
        shift: by which the last Hessian's diagonal was raised.
        creeps: number of short steps of shifted systems in a row.
    """

    def __init__(self, patterns: SaddlePatterns, box: InteriorLimits) -> None:
        self._patterns = patterns
        self._box = box
        self._known: tuple[Sparsity, Sparsity, BarrierSystem] | None = None
        self._last_shift = 0.0
        self.shift = 0.0
        self.creeps = 0
        self._relative = False
        self._begun = False

    def _system_of(self, H: Sparsity, A: Sparsity) -> BarrierSystem:
        if self._known is None or self._known[0] is not H or self._known[1] is not A:
            held: BoolArray = self._box.held[: H.shape[0]]
            self._known = H, A, BarrierSystem(self._patterns.of(H, A), H, A, held)
        return self._known[2]

    def direction(self, place: Place, H: SparseMatrix, mu: float) -> tuple[InteriorIterate, float]:
        """Factorise at a place, and `step`.

        Raises:
            SingularError: see `factorise`.
        """
        self.factorise(place, H)
        step, slope = self.step(mu)
        if not self._begun:
            self._begun = True
            step, slope = self._shortened(place, mu, step, slope)
        if self._relative or self.shift == 0.0:
            self.creeps = 0
            return step, slope
        size = largest_change(step.v, place.at.v)
        self.creeps = self.creeps + 1 if size < _CREEP else 0
        if self.creeps < _CREEPS:
            return step, slope
        self._relative = True
        self.factorise(place, H)
        return self.step(mu)

    def _shortened(
        self, place: Place, mu: float, step: InteriorIterate, slope: float
    ) -> tuple[InteriorIterate, float]:
        """The first step, or a shifted one where that is far shorter: as long as multipliers are a
        guess, nothing may curve along what the rows leave free, and rounding decides how far
        Newton's step leaps there. A leap that the rows ask for no shift shortens."""
        x, shift = place.point.x, self.shift
        size = largest_change(step.v, x)
        if size <= _LEAP or shift >= _SHORTENING:
            return step, slope
        if self._again(_SHORTENING):
            found, along = self.step(mu)
            if largest_change(found.v, x) <= _SHORTER * size:
                return found, along
        self._again(shift)
        return step, slope

    def factorise(self, place: Place, H: SparseMatrix) -> None:
        """Factorise with the least shift, of a growing sequence, that gives the right inertia
        (Wächter and Biegler, section 3.1).

        Raises:
            SingularError: none does.
        """
        self._place = place
        J, n = place.point.J, len(place.point.x)
        self._system = self._system_of(H.pattern, J.pattern)
        self._dependent = 0.0

        def right(shift: float) -> bool:
            found = self._system.factorise(
                H, J, place.at, self._box, shift, self._dependent, self._relative
            )
            if found == n:
                self.shift = shift
            return found == n

        self._again = right
        if right(0.0):
            return
        shift = self._last_shift * _SHRINK if self._last_shift else _FIRST_SHIFT
        shift = max(shift, _LEAST_SHIFT)
        while not right(shift):
            shift *= _GROW if self._last_shift else _FAST
            if shift > _LARGEST_SHIFT:
                raise SingularError("no shift makes the system definite")
        self._last_shift = shift

    def step(self, mu: float, rest: FloatArray | None = None) -> tuple[InteriorIterate, float]:
        """The step for μ, and the slope of objective and barrier along it.

        Args:
            rest: (m,) what is to be taken away of c − s; None for all of it.
        """
        place = self._place
        wanted = place.rest if rest is None else rest
        given = place.at, self._box, place.derivatives, place.slopes, wanted, mu
        step, along, left = self._system.step(*given)
        if left > _BAD and self._dependent == 0.0:
            self._dependent = _DEPENDENT
            if self._again(self.shift):
                step, along, left = self._system.step(*given)
        if not isfinite(left):
            raise SingularError("the system has no finite solution")
        return step, along

    def first_multipliers(self, place: Place, H: SparseMatrix) -> FloatArray:
        """Multipliers (m,) of the rows that leave least of the slopes, in least squares; zeros
        where they are large (section 3.6).

        Args:
            H: gives the pattern.
        """
        box, at, J = self._box, place.at, place.point.J
        n, m = len(place.point.x), len(at.y)
        if not m:
            return np.zeros(0)
        system = self._system_of(H.pattern, J.pattern)
        ends = np.isfinite(box.lower[n:]) | np.isfinite(box.upper[n:])
        exact = np.ones(n + m)
        exact[n:] = np.where(box.held[n:], 0.0, -1.0)
        weights = SystemWeights(np.ones(n + m), ends.astype(np.float64), exact)
        zero = SparseMatrix(H.pattern, np.zeros(H.pattern.size))
        if system.factorise_weighted(zero, J, weights) != n:
            return np.zeros(m)
        slope = np.concatenate([place.point.g, np.zeros(m)]) - at.low + at.high
        found, left = system.solve(slope, np.zeros(m), box)
        y = found[n:]
        good = left < _BAD and float(np.abs(y).max()) <= _LARGEST_FIRST
        return y.copy() if good else np.zeros(m)
