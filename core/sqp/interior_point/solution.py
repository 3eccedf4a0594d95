"""A solution by the interior point: iterations, restorations, the last digits."""

from __future__ import annotations

import numpy as np

from ..given import Given
from ..problem.evaluation import Point
from .barrier import Barrier
from .functions import UserFunctions
from .last_digits import LastDigits
from .method import InteriorEnding, InteriorPoint
from .newton import Place, SingularError
from .restoration import curvature_of, restored

_TRIED_FROM = 1e-3
_TRIED_AGAIN = 0.1
_LEAST_MU = 1e-3
_RESTORATIONS = 10
_PATIENCE = 100
"""Iterations in a row without smaller residuals after which the method gives up."""
_SHARE = 0.8
"""Of all iterations after which it gives up; the rest is left to the other method."""
_GAP = 10.0
"""Tolerances of the objective that the products of multiplier and distance may come to together."""
_FAR = 1e8
"""By which variables may grow; unbounded problems are left to the other method."""


class InteriorSolution:
    """One solution."""

    def __init__(self, given: Given) -> None:
        self._problem = given.problem
        self._hessian = given.hessian
        self._patterns = given.workspace.saddles
        self._progress = given.progress
        self._tolerance = given.options.tolerance
        self._digits = LastDigits(given)
        self._try_at = _TRIED_FROM
        self._before: Point | None = None
        self._least = np.inf
        self._idle = 0
        self._last = int(_SHARE * given.options.max_iterations)

    def run(self, point: Point) -> None:
        """Begin at a point with derivatives; returns where the method gives up.

        Raises:
            SolutionEnd: when the solution ends.
            CallableError: nothing has a value where it begins, or the Hessian has none.
        """
        self._progress.visit(point, np.zeros(self._problem.nlp.m), 0.0, "", 0.0)
        self._farthest = _FAR * max(1.0, float(np.abs(point.x).max()))
        scale = min(1.0, self._problem.evaluation.objective_factor)
        tolerance = self._tolerance * scale
        method = InteriorPoint(
            UserFunctions(self._problem, self._hessian),
            self._patterns,
            0.1 * tolerance,
            Barrier(_LEAST_MU * tolerance),
            self._seen,
        )
        try:
            method.start(point)
        except SingularError:
            return
        if self._problem.violation(point) <= self._tolerance:
            method.begin_gently()
        for _ in range(_RESTORATIONS):
            outcome = method.run()
            self._progress.trouble = method.search.trouble
            if outcome is InteriorEnding.SMALL:
                self._try(method, last=True)
            if outcome is not InteriorEnding.STUCK or not self._restored(method):
                return

    def _seen(self, method: InteriorPoint, length: float, kind: str) -> bool:
        """Take note of an iteration; try for the last digits where they are near."""
        place, progress = method.place, self._progress
        point, y = place.point, place.at.y
        if kind:
            progress.iterations += 1
            if self._before is not None:
                self._hessian.moved(self._before, point, y)
            progress.visit(point, y, length, kind, method.newton.shift, self._no_gap(place))
        self._before = point
        errors = place.errors
        worst = max(errors.dual, errors.primal, errors.largest / errors.scale)
        if worst > self._try_at:
            return self._hopeless(method, worst)
        self._try_at = _TRIED_AGAIN * worst
        self._try(method, last=False)
        return False

    def _no_gap(self, place: Place) -> bool:
        """Whether the limits' multipliers leave nothing to be gained: each product of multiplier
        and distance may be within the tolerance, and thousands of them together a share of the
        objective."""
        factor = self._problem.evaluation.objective_factor
        return place.errors.total <= _GAP * self._tolerance * max(factor, abs(place.point.f))

    def _try(self, method: InteriorPoint, last: bool) -> None:
        """Try for the last digits.

        Args:
            last: whether the interior point itself gets no further.

        Raises:
            SolutionEnd: there they are.
        """
        place, progress = method.place, self._progress
        found = self._digits.of(place, method.box, method.hessian_here())
        if found is None and last:
            found = self._digits.snapped(place, method.box)
        if found is not None:
            progress.iterations += 1
            progress.visit(found.point, found.multipliers, 1.0, "active_set", 0.0)

    def _hopeless(self, method: InteriorPoint, worst: float) -> bool:
        """Whether to give up: residuals have not got smaller for long, most iterations are used
        up, or the point goes where a solution is not."""
        self._idle = 0 if worst < self._least else self._idle + 1
        self._least = min(self._least, worst)
        far = float(np.abs(method.place.point.x).max()) > self._farthest
        late = self._progress.iterations >= self._last
        return far or late or self._idle > _PATIENCE

    def _restored(self, method: InteriorPoint) -> bool:
        """Whether the method can go on from a less violated point."""
        theta = float(np.abs(method.place.rest).sum())
        if theta <= self._tolerance:
            return False
        found = restored(method, curvature_of(self._problem), self._patterns, self._moved)
        if found is None:
            return False
        method.jump(*found)
        self._before = None
        return True

    def _moved(self, point: Point, length: float) -> None:
        self._progress.iterations += 1
        zero = np.zeros(len(point.c))
        self._progress.visit(point, zero, length, "restoration", 0.0)
