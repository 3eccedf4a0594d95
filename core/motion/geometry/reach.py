"""Numbers with sparse derivatives: how far a zone reaches, and what that was made from."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...arrays import FloatArray

Part = tuple[str, int, float | FloatArray]


@dataclass(frozen=True, slots=True)
class Reach:
    """A number and its sparse derivatives: (name of a quantity, its index, derivative)."""

    value: float
    parts: tuple[Part, ...] = ()

    def __mul__(self, other: Reach | float) -> Reach:
        if not isinstance(other, Reach):
            return self.scaled(other)
        parts = [(n, i, p * other.value) for n, i, p in self.parts]
        parts += [(n, i, p * self.value) for n, i, p in other.parts]
        return Reach(self.value * other.value, tuple(parts))

    __rmul__ = __mul__

    def __add__(self, other: Reach | float) -> Reach:
        if not isinstance(other, Reach):
            return Reach(self.value + other, self.parts)
        return Reach(self.value + other.value, self.parts + other.parts)

    __radd__ = __add__

    def __sub__(self, other: Reach | float) -> Reach:
        return self + other * -1.0

    def __rsub__(self, other: float) -> Reach:
        return self.scaled(-1.0) + other

    def __truediv__(self, other: Reach | float) -> Reach:
        return self * other.inverse() if isinstance(other, Reach) else self.scaled(1.0 / other)

    def __rtruediv__(self, other: float) -> Reach:
        return self.inverse().scaled(other)

    def mapped(self, value: float, slope: float) -> Reach:
        """A function of it, with that value and that derivative."""
        return Reach(value, tuple([(n, i, p * slope) for n, i, p in self.parts]))

    def scaled(self, factor: float) -> Reach:
        """A multiple of it."""
        return self.mapped(factor * self.value, factor)

    def root(self) -> Reach:
        """√self, without a derivative at zero."""
        value = math.sqrt(self.value)
        return self.mapped(value, 0.5 / value if value > 0.0 else 0.0)

    def inverse(self) -> Reach:
        """1 / self."""
        return self.mapped(1.0 / self.value, -1.0 / self.value**2)


def least(*reaches: Reach) -> Reach:
    """The smallest of some."""
    smallest = reaches[0]
    for reach in reaches:
        if reach.value < smallest.value:
            smallest = reach
    return smallest
