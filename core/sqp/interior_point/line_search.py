"""How much of a step is taken: filter line search with second-order corrections."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from ...arrays import FloatArray
from ..filter import Filter
from ..problem.errors import CallableError
from ..problem.evaluation import Point
from .functions import Functions
from .iterate import InteriorIterate, InteriorLimits, after, longest, merit
from .newton import Newton, Place, SingularError

_HALVINGS = 25
_LEAST_KEPT = 0.99
_CORRECTIONS = 4
_CORRECTED_ENOUGH = 0.99
_ROUNDING = 1e-15


@dataclass(slots=True)
class Taken:
    """A step that was taken.

    Args:
        point: where it leads, with derivatives.
        v: (n + m,) variables and slacks there.
        step: the whole step.
        length: share of it that values and the rows' multipliers take.
        dual: share that the limits' multipliers may take.
        kind: see `Iteration`.
    """

    point: Point
    v: FloatArray
    step: InteriorIterate
    length: float
    dual: float
    kind: str


class LineSearch:
    """Line searches of one solution.

    Args:
        functions: of the problem.
        box: limits.
        newton: gives second-order corrections.

    Attributes:
        filter: which points count as progress; a new one for each μ.
        trouble: of the callables at the shortest step tried last.
    """

    def __init__(self, functions: Functions, box: InteriorLimits, newton: Newton) -> None:
        self._functions = functions
        self._box = box
        self._newton = newton
        self.filter = Filter(np.inf, 0.0)
        self.trouble: CallableError | None = None

    def along(self, place: Place, step: InteriorIterate, slope: float, mu: float) -> Taken | None:
        """As much of a step as the filter takes; None if it takes nothing.

        Args:
            slope: of objective and barrier along the step.
        """
        keep = max(_LEAST_KEPT, 1.0 - mu)
        length, dual = longest(place.at, step, self._box, keep)
        theta, phi = self.measures(place.at.v, place.point, mu)
        size = tiny = 0.0
        for halving in range(_HALVINGS):
            trial = self._trial(place, step, length)
            if trial is not None:
                point, v = trial
                after_it = self.measures(v, point, mu)
                if self._judged((theta, phi), after_it, slope, length, point):
                    return Taken(point, v, step, length, dual, "normal")
                if halving == 0 and after_it[0] >= theta:
                    found = self._corrected(place, point, v, (theta, phi), slope, length, mu)
                    if found is not None:
                        return found
            if halving == 0:
                size = float(np.abs(step.v).max())
                tiny = _ROUNDING * max(1.0, float(np.abs(place.at.v).max()))
            length *= 0.5
            if length * size <= tiny:
                break
        return None

    def measures(self, v: FloatArray, point: Point, mu: float) -> tuple[float, float]:
        """Violation, and objective with barrier."""
        theta, barrier = merit(v, self._box, point.c)
        return theta, point.f + mu * barrier

    def _trial(
        self, place: Place, step: InteriorIterate, length: float
    ) -> tuple[Point, FloatArray] | None:
        v = after(place.at, step, length)
        self.trouble = None
        try:
            point = self._functions.point(v[: len(place.point.x)].copy())
        except CallableError as error:
            self.trouble = error
            return None
        return point, v

    def _judged(
        self,
        before: tuple[float, float],
        after_it: tuple[float, float],
        slope: float,
        length: float,
        point: Point,
    ) -> bool:
        """Whether the filter takes a point, which then has derivatives."""
        if not isfinite(after_it[1]):
            return False
        descends = self.filter.judge(before, after_it, slope, length)
        if descends is None:
            return False
        try:
            self._functions.differentiate(point)
        except CallableError as error:
            self.trouble = error
            return False
        if not descends:
            self.filter.add(*before)
        return True

    def _corrected(
        self,
        place: Place,
        point: Point,
        v: FloatArray,
        before: tuple[float, float],
        slope: float,
        length: float,
        mu: float,
    ) -> Taken | None:
        """Second-order correction: the same system, with the constraints' values after the step."""
        n = len(place.point.x)
        rest, theta = place.rest * length, before[0]
        if not len(rest):
            return None
        for _ in range(_CORRECTIONS):
            rest = rest + (point.c - v[n:])
            try:
                step, _ = self._newton.step(mu, rest)
            except SingularError:
                return None
            share, dual = longest(place.at, step, self._box, max(_LEAST_KEPT, 1.0 - mu))
            trial = self._trial(place, step, share)
            if trial is None:
                return None
            point, v = trial
            after_it = self.measures(v, point, mu)
            if self._judged(before, after_it, slope, length, point):
                return Taken(point, v, step, share, dual, "corrected")
            if after_it[0] > _CORRECTED_ENOUGH * theta:
                return None
            theta = after_it[0]
            rest = rest * share
        return None
