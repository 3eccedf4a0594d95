"""Creep: full steps of a shifted model, one like the other, each of which gains as little.

A Hessian that is raised to be convex everywhere shortens steps along directions in which the
problem curves little, or downwards, where constraints let it. The line search takes such steps
whole, and nothing here would ever make them longer.
"""

from __future__ import annotations

_ALIKE = 0.1
_STEPS = 10


class CreepError(RuntimeError):
    """Steps creep."""


class Creep:
    """Watches the steps of one solution."""

    def __init__(self) -> None:
        self._before = (0.0, 0.0)
        self._count = 0

    def seen(self, size: float, gain: float, whole: bool) -> bool:
        """Take note of a step; whether steps creep.

        Args:
            size: largest change of a variable.
            gain: by which the objective fell.
            whole: whether it was a whole step of a shifted model.
        """
        now = (size, gain)
        pairs = zip(now, self._before, strict=True)
        alike = all(abs(new - old) <= _ALIKE * old for new, old in pairs)
        self._count = self._count + 1 if whole and alike else 0
        self._before = now
        return self._count >= _STEPS
