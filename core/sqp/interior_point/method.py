"""The primal–dual interior-point method with a filter line search.

Wächter and Biegler, "On the implementation of an interior-point filter line-search algorithm for
large-scale nonlinear programming" (2006).
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum, auto

import numpy as np

from ...arrays import FloatArray
from ..algebra.linear import SaddlePatterns
from ..algebra.matrices import SparseMatrix
from ..filter import Filter
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from .barrier import Barrier
from .direction import Errors, barrier_slopes, largest_change
from .functions import Functions
from .iterate import InteriorIterate, InteriorLimits, advance, keep_near, push_inside
from .line_search import LineSearch, Taken
from .newton import Newton, Place, SingularError

_RELAXED = 1e-8
_TINY = 1e-13
_GENTLE, _LEAST_FIRST, _LARGEST_FIRST = 0.1, 1e-6, 1e-2
_JAM, _JAMS = 1e-2, 10
"""Share of a step below which limits leave no way to feasibility, and after how many of them in a
row there is none: the limits were come too near to, and restoration finds another way."""
_LARGEST_FACTOR, _SMALL_FACTOR = 1e4, 1e-4
_SHORT, _SOBER = 0.1, 100.0
"""Share of a step below which it is short, and multiplier, functions being scaled to slopes of
100, beyond which such a step's multipliers have run away."""


class InteriorEnding(Enum):
    """How an interior point ended."""

    SMALL = auto()
    """Its residuals are as small as asked for."""
    STUCK = auto()
    """No step helps."""
    STOPPED = auto()
    """The caller wanted no more."""


class InteriorPoint:
    """One solution.

    Args:
        functions: of the problem.
        patterns: keeps symbolic factorisations.
        tolerance: of the residuals, scaled.
        barrier: how μ falls.
        seen: called with the place after each iteration, the step's length and its kind; True ends
            the solution.

    Attributes:
        place: where it is.
        outcome: how it ended.
    """

    def __init__(
        self,
        functions: Functions,
        patterns: SaddlePatterns,
        tolerance: float,
        barrier: Barrier,
        seen: Callable[[InteriorPoint, float, str], bool],
    ) -> None:
        self.functions = functions
        self.tolerance = tolerance
        self.barrier = barrier
        self._seen = seen
        self.box = make_box(functions, tolerance)
        self.newton = Newton(patterns, self.box)
        self.search = LineSearch(functions, self.box, self.newton)
        self.hessian: SparseMatrix
        self._of: Place | None = None

    def start(self, point: Point, theta: float = 1.0) -> None:
        """Begin at a point with derivatives.

        Args:
            theta: what violations are measured by at least.

        Raises:
            CallableError: nothing has a value where the limits are pushed away from.
        """
        n = len(point.x)
        at, moved = self._inside(point)
        self.hessian = self.functions.hessian(moved, at.y)
        self.place = Place(at, moved, moved.c - at.v[n:])
        at.y[:] = self.newton.first_multipliers(self.place, self.hessian)
        self.place.measure(self.box)
        self._start_theta = max(1.0, theta, float(np.abs(self.place.rest).sum()))
        self._new_filter()

    def _inside(self, point: Point) -> tuple[InteriorIterate, Point]:
        """The start in the interior; nearer to its bounds where callables have no values inside."""
        box, n, m = self.box, len(point.x), len(point.c)
        for share in (1.0, 1e-3, 1e-6):
            v = np.concatenate([point.x, point.c])
            push_inside(v, box, share)
            try:
                moved = self._moved(point, v[:n].copy())
                break
            except CallableError:
                if share == 1e-6:
                    raise
        v[n:] = moved.c
        push_inside(v, box, share)
        low = np.where(np.isfinite(box.lower) & ~box.held, 1.0, 0.0)
        high = np.where(np.isfinite(box.upper) & ~box.held, 1.0, 0.0)
        return InteriorIterate(v, np.zeros(m), low, high), moved

    def _moved(self, point: Point, x: FloatArray) -> Point:
        if np.array_equal(x, point.x):
            return point
        moved = self.functions.point(x)
        self.functions.differentiate(moved)
        return moved

    def begin_gently(self) -> None:
        """Begin with a μ by which the limits push less than the objective pulls: a start that keeps
        all limits is worth staying near to, and many limits together drive it far away."""
        place, n = self.place, len(self.place.point.x)
        away = barrier_slopes(np.zeros(len(place.at.v)), place.at, self.box, 1.0)
        push = float(np.abs(away[:n] + place.point.J.transposed_times(away[n:])).max())
        pull = float(np.abs(place.point.g).max())
        if push > 0.0 and pull > 0.0:
            self.barrier.mu = min(max(_GENTLE * pull / push, _LEAST_FIRST), _LARGEST_FIRST)

    def _new_filter(self) -> None:
        self.search.filter = Filter(
            _LARGEST_FACTOR * self._start_theta, _SMALL_FACTOR * self._start_theta
        )

    def run(self) -> InteriorEnding:
        """InteriorIterate until the end.

        Raises:
            CallableError: the Hessian has no value.
        """
        length, kind, tiny, jams = 0.0, "", 0, 0
        while True:
            if self._seen(self, length, kind):
                return InteriorEnding.STOPPED
            errors = self.place.errors
            if self._small(errors):
                return InteriorEnding.SMALL
            # A short step of a shifted system hides that the barrier's problem is not solved.
            if self.newton.creeps != 1 and self.barrier.update(errors):
                self._new_filter()
            taken = self._step()
            if taken is None:
                return InteriorEnding.STUCK
            length, kind = taken.length, taken.kind
            size = largest_change(taken.step.v, self.place.at.v)
            self._advance(taken)
            jammed = length < _JAM and self.place.errors.primal > self.tolerance
            jams = jams + 1 if jammed else 0
            tiny = tiny + 1 if size * length < _TINY else 0
            if jams == _JAMS or (tiny and not self.barrier.lower() and tiny > 1):
                return InteriorEnding.STUCK

    def _small(self, errors: Errors) -> bool:
        worst = max(errors.dual, errors.primal, errors.largest / errors.scale)
        return worst <= self.tolerance

    def _step(self) -> Taken | None:
        """The next step that is taken; None where none helps."""
        place, barrier = self.place, self.barrier
        try:
            step, slope = self.newton.direction(place, self.hessian_here(), barrier.mu)
            return self.search.along(place, step, slope, barrier.mu)
        except SingularError:
            return None

    def hessian_here(self) -> SparseMatrix:
        """Of the Lagrangian, worked out once for a place.

        Raises:
            CallableError: it has no value.
        """
        if self._of is not self.place:
            self.hessian = self.functions.hessian(self.place.point, self.place.at.y)
            self._of = self.place
        return self.hessian

    def _advance(self, taken: Taken) -> None:
        at = self.place.at
        advance(at, taken.step, self.box, taken.v, taken.length, taken.dual, self.barrier.mu)
        n = len(taken.point.x)
        self.place = Place(at, taken.point, taken.point.c - taken.v[n:])
        if self.newton.shift > 0.0 and taken.length < _SHORT:
            self._sober()
        self.place.measure(self.box)

    def _sober(self) -> None:
        """Multipliers of least squares where those of a short step of a shifted system have run
        away: they grow with the shift, curvature grows with them, and with it the next shift."""
        y = self.place.at.y
        size = float(np.abs(y).max(initial=0.0))
        if size <= _SOBER:
            return
        found = self.newton.first_multipliers(self.place, self.hessian)
        if float(np.abs(found).max()) < size:
            y[:] = found

    def jump(self, point: Point, slacks: FloatArray) -> None:
        """Go on from a point with derivatives, its multipliers chosen anew."""
        box, n = self.box, len(point.x)
        v = np.concatenate([point.x, slacks])
        old = self.place.at
        at = InteriorIterate(
            v, np.zeros(len(point.c)), np.minimum(old.low, 1e3), np.minimum(old.high, 1e3)
        )
        keep_near(at, box, self.barrier.mu, 10.0)
        self.place = Place(at, point, point.c - v[n:])
        at.y[:] = self.newton.first_multipliers(self.place, self.hessian)
        self.place.measure(box)


def make_box(functions: Functions, tolerance: float) -> InteriorLimits:
    """Limits of variables and slacks. Those of slacks are a little wider than asked for, so that
    there is an interior; the variables' are not: beyond them functions may have no value."""
    fixed = functions.x_lower == functions.x_upper
    equal = functions.c_lower == functions.c_upper
    wider = min(_RELAXED, 1e-2 * tolerance)
    lower = functions.c_lower - np.where(
        equal, 0.0, wider * np.maximum(1.0, np.abs(functions.c_lower))
    )
    upper = functions.c_upper + np.where(
        equal, 0.0, wider * np.maximum(1.0, np.abs(functions.c_upper))
    )
    return InteriorLimits(
        np.concatenate([functions.x_lower, lower]),
        np.concatenate([functions.x_upper, upper]),
        np.concatenate([fixed, equal]),
    )
