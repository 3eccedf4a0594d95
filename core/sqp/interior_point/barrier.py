"""The barrier parameter μ: adaptive while that makes progress, else one problem after the other.

Adaptive: Mehrotra's rule, μ from how far the step for μ = 0 leads. Its steps follow no merit
function, so that the residuals must keep falling; else μ stays until the barrier's problem is
solved, and then falls superlinearly (Nocedal, Wächter and Waltz, "Adaptive barrier update
strategies for nonlinear interior methods", 2009; Fiacco and McCormick).
"""

from __future__ import annotations

from collections import deque
from enum import StrEnum

from .direction import Errors

_FIRST = 0.1
_SOLVED = 10.0
_FALL, _POWER = 0.2, 1.5
_MEMORY = 4
_PROGRESS = 0.9999
_RESTART = 0.8
_LARGEST_SHARE = 10.0


class BarrierKind(StrEnum):
    """How μ is chosen."""

    ADAPTIVE = "adaptive"
    MONOTONE = "monotone"


class Barrier:
    """The barrier parameter of one solution.

    Args:
        kind: how it is chosen.
        least: below which it does not fall.
        first: where it begins.

    Attributes:
        mu: the parameter.
        free: whether it is chosen anew in each iteration.
    """

    def __init__(self, kind: BarrierKind, least: float, first: float = _FIRST) -> None:
        self.mu = first
        self.least = least
        self.free = kind is BarrierKind.ADAPTIVE
        self._adaptive = self.free
        self._seen: deque[float] = deque(maxlen=_MEMORY)
        self._largest = 0.0

    def update(self, errors: Errors) -> bool:
        """Take note of a point; whether μ changed, or is to be chosen."""
        self._largest = self._largest or max(1.0, 1e3 * errors.mean)
        if self._adaptive and self._progresses(errors):
            self._seen.append(errors.total)
            self.free = True
            return True
        if self.free:
            self.free = False
            self.mu = min(max(_RESTART * errors.mean, self.least), self._largest)
            return True
        return self._fall(errors)

    def choose(self, mean: float, after: float) -> None:
        """Mehrotra's rule.

        Args:
            mean: product of multipliers and distances.
            after: what the step for μ = 0 leaves of it.
        """
        share = (max(after, 0.0) / mean) ** 3 if mean > 0 else 0.0
        self.mu = min(max(min(share, _LARGEST_SHARE) * mean, self.least), self._largest)

    def lower(self) -> bool:
        """Go on to the next barrier's problem, whatever the residuals; False if it is the last."""
        self.free = False
        if self.mu <= self.least:
            return False
        self.mu = max(self.least, min(_FALL * self.mu, self.mu**_POWER))
        return True

    def _fall(self, errors: Errors) -> bool:
        before = self.mu
        while self.mu > self.least and barrier_error(errors, self.mu) <= _SOLVED * self.mu:
            self.mu = max(self.least, min(_FALL * self.mu, self.mu**_POWER))
        return self.mu != before

    def _progresses(self, errors: Errors) -> bool:
        return len(self._seen) < _MEMORY or errors.total <= _PROGRESS * max(self._seen)


def barrier_error(errors: Errors, mu: float) -> float:
    """Residual of the barrier's problem."""
    product = max(errors.largest - mu, mu - errors.least) if errors.largest > 0 else 0.0
    return max(errors.dual, errors.primal, product / errors.scale)
