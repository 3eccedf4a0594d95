"""The barrier parameter μ: one problem after the other.

μ stays until the barrier's problem is solved, and then falls superlinearly (Fiacco and McCormick;
Wächter and Biegler, equation 7).
"""

from __future__ import annotations

from .direction import Errors

_FIRST = 0.1
_SOLVED = 10.0
_FALL, _POWER = 0.2, 1.5


class Barrier:
    """The barrier parameter of one solution.

    Args:
        least: below which it does not fall.
        first: where it begins.

    Attributes:
        mu: the parameter.
    """

    def __init__(self, least: float, first: float = _FIRST) -> None:
        self.mu = first
        self.least = least

    def update(self, errors: Errors) -> bool:
        """Take note of a point; whether μ changed."""
        before = self.mu
        while barrier_error(errors, self.mu) <= _SOLVED * self.mu and self.lower():
            pass
        return self.mu != before

    def lower(self) -> bool:
        """Go on to the next barrier's problem, whatever the residuals; False if it is the last."""
        if self.mu <= self.least:
            return False
        self.mu = max(self.least, min(_FALL * self.mu, self.mu**_POWER))
        return True


def barrier_error(errors: Errors, mu: float) -> float:
    """Residual of the barrier's problem."""
    product = max(errors.largest - mu, mu - errors.least) if errors.largest > 0 else 0.0
    return max(errors.dual, errors.primal, product / errors.scale)
