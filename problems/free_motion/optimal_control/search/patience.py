"""When a nonlinear program is left before its last digits.

Among obstacles its linearised distances are right near one motion only, and the next program is
another one: what it gains in small steps, the next one gains as well.
"""

from __future__ import annotations

from dataclasses import replace

from .....core.sqp import Iteration, Result

_SLOW = 2
"""Iterations in a row that may gain less."""
_AHEAD = 5
"""Iterations within which it has to be better, at its pace, than the motion that there is."""
_FEASIBLE = 3.0
"""Tolerances within which a point counts as feasible."""


class Patience:
    """A callback of the SQP solver that ends it.

    Args:
        tolerance: of constraints.
        iterations: at most.
        pace: share of the objective that an iteration has to gain.
        beat: objective of the motion that there is; None if it does not count.

    Attributes:
        ended: whether it has ended the solver.
    """

    def __init__(self, tolerance: float, iterations: int, pace: float, beat: float | None) -> None:
        self._tolerance = tolerance
        self._iterations = iterations
        self._pace = pace
        self._beat = beat
        self._last: Iteration | None = None
        self._slow = 0
        self.ended = False

    def __call__(self, seen: Iteration) -> bool:
        last, self._last = self._last, seen
        if last is not None and self._feasible(last) and self._feasible(seen):
            gain = last.objective - seen.objective
            self._slow = self._slow + 1 if gain < self._pace * abs(seen.objective) else 0
            hopeless = self._beat is not None and seen.objective - self._beat > _AHEAD * gain
            self.ended = self._slow >= _SLOW or hopeless
        self.ended = self.ended or seen.number >= self._iterations
        return self.ended

    def _feasible(self, seen: Iteration) -> bool:
        return seen.constraint_violation <= _FEASIBLE * self._tolerance

    def outcome(self, result: Result) -> Result:
        """What came of it: the last point, where the solver was ended here."""
        if not self.ended or self._last is None:
            return result
        return replace(
            result,
            x=self._last.x,
            objective=self._last.objective,
            constraint_violation=self._last.constraint_violation,
        )
