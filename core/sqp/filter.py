"""The filter: which trade-offs between objective and violation count as progress.

Fletcher and Leyffer, "Nonlinear programming without a penalty function" (2002); the switching
condition and constants after Wächter and Biegler (2005, 2006).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import log

GAMMA_VIOLATION = 1e-5
GAMMA_OBJECTIVE = 1e-5
ARMIJO = 1e-4
SWITCH_VIOLATION = 1.1
SWITCH_OBJECTIVE = 2.3
NO_VIOLATION = 1e-13
_ROUNDING = 1e-14


@dataclass(slots=True)
class Filter:
    """Pairs of violation and objective that no later point may be dominated by.

    Args:
        largest: violation that no point may pass.
        small: violation below which steps that lower the objective must do so by Armijo's rule.
    """

    largest: float
    small: float
    entries: list[tuple[float, float]] = field(default_factory=list)

    def admits(self, violation: float, objective: float) -> bool:
        """Whether a point is dominated by no entry."""
        if not violation <= self.largest:
            return False
        slack = _ROUNDING * max(1.0, abs(objective))
        return all(violation < v or objective - slack <= f for v, f in self.entries)

    def add(self, violation: float, objective: float) -> None:
        """Remember a point that was left."""
        entry = (
            (1.0 - GAMMA_VIOLATION) * violation,
            objective - GAMMA_OBJECTIVE * violation,
        )  # with the margins by which a later point must be better
        self.entries = [e for e in self.entries if e[0] < entry[0] or e[1] < entry[1]]
        self.entries.append(entry)

    def judge(
        self,
        before: tuple[float, float],
        after: tuple[float, float],
        slope: float,
        length: float,
    ) -> bool | None:
        """Whether a step is taken.

        Args:
            before, after: violation and objective.
            slope: directional derivative of the objective along the whole step.
            length: share of the step.

        Returns:
            None if it is refused; else whether it lowers the objective (so that the filter stays).
        """
        (v, f), (v_new, f_new) = before, after
        if not self.admits(v_new, f_new):
            return None
        slack = _ROUNDING * max(1.0, abs(f))
        descends = slope < 0 and _outweighs(length, -slope, v)
        if descends and v <= self.small:
            return True if f_new - f - slack <= ARMIJO * length * slope else None
        better = v > NO_VIOLATION and v_new <= (1.0 - GAMMA_VIOLATION) * v
        if better or f_new - slack <= f - GAMMA_OBJECTIVE * v:
            return False
        return None


def _outweighs(length: float, fall: float, violation: float) -> bool:
    """The switching condition, length fall^2.3 > violation^1.1, whose powers may overflow."""
    if violation == 0.0:
        return True
    return log(length) + SWITCH_OBJECTIVE * log(fall) > SWITCH_VIOLATION * log(violation)
