"""What is done where no model's step is taken from an infeasible point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ..filter import Filter
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from ..problem.scaled import ScaledProblem
from .model import Model
from .restoration import Limits, Restoration, RestorationOutcome, Restored
from .search import FilterStep, Search

_RESTARTS = 3
_ASIDE = 1e-3
_ATTEMPTS = 2
_LESS = 1e-6
_LARGEST_DENSE = 400
_CURVED = 1e-6


class NowhereError(Exception):
    """Feasibility cannot be restored.

    Args:
        found: where restoration ended.
    """

    def __init__(self, found: Restored) -> None:
        super().__init__(found.outcome)
        self.found = found


class Feasibility:
    """Finds a way on for one solution.

    Args:
        problem: the problem.
        model, search, filter_: of the main iteration.
        restoration: lowers the violation.
        limits: x (n,) → lower and upper limits (n,) of a step, the user's box included.
        moved: called after every move that is no step of a model; see `Restoration`.
        tolerance: violation that counts as none.
    """

    def __init__(
        self,
        problem: ScaledProblem,
        model: Model,
        search: Search,
        filter_: Filter,
        restoration: Restoration,
        limits: Callable[[FloatArray], Limits],
        moved: Callable[[Point, float], None],
        tolerance: float,
    ) -> None:
        self._problem = problem
        self._model = model
        self._search = search
        self._filter = filter_
        self._restoration = restoration
        self._limits = limits
        self._moved = moved
        self._tolerance = tolerance
        self._restarts = 0

    def restored(self, point: Point) -> FilterStep:
        """A step to where the main iteration can go on.

        Args:
            point: with derivatives; it is left for good.

        Raises:
            NowhereError: there is none.
        """
        self._filter.add(self._problem.theta(point.c), point.f)
        found = self._lowered(point)
        step = self._onward(found)
        if step is not None:
            return step
        if found.outcome is RestorationOutcome.STATIONARY and found.point is point:
            aside = self._sideways(point)
            if aside is not None:
                return aside
        return self._escaped(found)

    def _lowered(self, point: Point) -> Restored:
        return self._restoration.run(point, lambda p, theta: self._filter.admits(theta, p.f))

    def _onward(self, found: Restored) -> FilterStep | None:
        """The step if the main iteration can go on from there."""
        nothing = np.zeros(len(found.point.c))
        if found.outcome is RestorationOutcome.RESTORED:
            self._model.forget()
            return FilterStep(found.point, 1.0, nothing, "restoration")
        if self._problem.violation(found.point) > self._tolerance:
            return None
        # Feasible, but the filter wants a better objective, which no step here gives.
        self._filter.entries.clear()
        self._restarts += 1
        if self._restarts > _RESTARTS:
            raise NowhereError(found)
        return FilterStep(found.point, 1.0, nothing, "restoration")

    def _sideways(self, point: Point) -> FilterStep | None:
        """A step that lowers the objective at a point where the violation is stationary: its
        gradient may only be zero by chance there."""
        found = self._model.sideways()
        return None if found is None else self._search.along(point, found, found.y, "elastic")

    def _escaped(self, found: Restored) -> FilterStep:
        """A step away from where the violation is stationary but no minimum.

        Raises:
            NowhereError: nothing near by is less violated.
        """
        least = found
        directions = (
            self._directions(found) if found.outcome is RestorationOutcome.STATIONARY else []
        )
        for direction in directions:
            start = self._aside(found.point, direction)
            if start is None:
                continue
            self._moved(start, 1.0)
            found = self._lowered(start)
            step = self._onward(found)
            if step is not None:
                return step
            if self._theta(found) < (1.0 - _LESS) * self._theta(least):
                least = found
            if found.outcome is not RestorationOutcome.STATIONARY:
                break
        raise NowhereError(least)

    def _theta(self, found: Restored) -> float:
        return self._problem.theta(found.point.c)

    def _aside(self, point: Point, direction: FloatArray) -> Point | None:
        """The point, with derivatives, that is a small share of the variables' sizes away; None
        where nothing has a value, or nothing can move."""
        problem = self._problem
        lower, upper = self._limits(point.x)
        d = np.clip(_ASIDE * _sizes(point.x) * direction, lower, upper)
        x = np.clip(point.x + d, problem.x_lower, problem.x_upper)
        if np.array_equal(x, point.x):
            return None
        try:
            moved = problem.evaluation.point(x)
            problem.evaluation.differentiate(moved)
        except CallableError:
            return None
        return moved

    def _directions(self, stationary: Restored) -> list[FloatArray]:
        """Where to look, (n,) in the variables' sizes: along the most negative curvature of the
        violation, if the problem's Hessian shows any, and at random."""
        random = np.random.default_rng(0)
        scattered = [random.standard_normal(len(stationary.point.x)) for _ in range(_ATTEMPTS)]
        return self._downward(stationary) + scattered

    def _downward(self, stationary: Restored) -> list[FloatArray]:
        """The directions of the most negative curvature of μ·c."""
        evaluation, sizes = self._problem.evaluation, _sizes(stationary.point.x)
        if evaluation.nlp.hessian is None or len(sizes) > _LARGEST_DENSE:
            return []
        try:
            H = evaluation.constraint_hessian(stationary.point.x, stationary.multipliers)
        except CallableError:
            return []
        values, vectors = np.linalg.eigh(H.scipy().toarray() * np.outer(sizes, sizes))
        if not values[0] < -_CURVED * float(np.abs(values).max()):
            return []
        return [vectors[:, 0], -vectors[:, 0]]


def _sizes(x: FloatArray) -> FloatArray:
    return np.maximum(1.0, np.abs(x))
