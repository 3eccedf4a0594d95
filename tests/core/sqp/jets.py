"""Numbers with first and second derivatives: how the test problems are differentiated.

A jet carries a value, its gradient (n,) and its Hessian (n, n) with respect to n variables, or k of
each at once: (k,), (n, k), (n, n, k). Arithmetic and the functions below follow the chain rule. The
functions take plain numbers too, so that one formula serves for values and for derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy import special

from flyby.core.arrays import FloatArray


class Jet:
    """A value with its derivatives."""

    __slots__ = ("gradient", "hessian", "value")
    __array_ufunc__ = None  # numpy's numbers leave the arithmetic to this class

    def __init__(
        self, value: float | FloatArray, gradient: FloatArray, hessian: FloatArray
    ) -> None:
        self.value = value
        self.gradient = gradient
        self.hessian = hessian

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(
                self.value + other.value,
                self.gradient + other.gradient,
                self.hessian + other.hessian,
            )
        return Jet(self.value + other, self.gradient, self.hessian)

    def __mul__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            cross = self.gradient[:, None] * other.gradient[None]
            cross = cross + cross.swapaxes(0, 1)
            return Jet(
                self.value * other.value,
                self.value * other.gradient + other.value * self.gradient,
                self.value * other.hessian + other.value * self.hessian + cross,
            )
        return Jet(self.value * other, self.gradient * other, self.hessian * other)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.gradient, -self.hessian)

    def __pos__(self) -> Jet:
        return self

    def __sub__(self, other: Jet | float) -> Jet:
        return self + -other

    def __truediv__(self, other: Jet | float) -> Jet:
        return self * (other**-1.0 if isinstance(other, Jet) else 1.0 / other)

    def __pow__(self, power: Jet | float) -> Jet:
        if isinstance(power, Jet):
            return _jet(exp(power * log(self)))
        if power == 1:
            return self
        u, p = np.float64(self.value), power
        second = p * (p - 1) * u ** (p - 2) if p != 2 else 2.0
        return _chain(self, u**p, p * u ** (p - 1), second)

    __radd__ = __add__
    __rmul__ = __mul__

    def __rsub__(self, other: float) -> Jet:
        return -self + other

    def __rtruediv__(self, other: float) -> Jet:
        return self**-1.0 * other

    def __rpow__(self, base: float) -> Jet:
        return _jet(exp(self * np.log(base)))


def _jet(value: Any) -> Jet:
    assert isinstance(value, Jet)
    return value


def variables(x: Sequence[float] | FloatArray) -> list[Jet]:
    """The variables themselves at x (n,)."""
    n = len(x)
    flat = np.zeros((n, n))
    return [Jet(float(value), row, flat) for value, row in zip(x, np.eye(n), strict=True)]


def _chain(inner: Jet, value: Any, first: Any, second: Any) -> Jet:
    slope = inner.gradient
    return Jet(
        value, first * slope, first * inner.hessian + second * (slope[:, None] * slope[None])
    )


def _lifted(
    function: Callable[[Any], Any],
    first: Callable[[Any], Any],
    second: Callable[[Any], Any],
    name: str,
) -> Callable[[Any], Any]:
    """A function of jets and of numbers, from its derivatives."""

    def lifted(x: Any) -> Any:
        if isinstance(x, Jet):
            u = np.float64(x.value)
            return _chain(x, function(u), first(u), second(u))
        return function(x)

    lifted.__name__ = name
    return lifted


def _tan_slope(u: Any) -> Any:
    return 1 + np.tan(u) ** 2


def _tanh_slope(u: Any) -> Any:
    return 1 - np.tanh(u) ** 2


def _bell(u: Any) -> Any:
    """Derivative of the error function."""
    return 2 / np.sqrt(np.pi) * np.exp(-(u**2))


exp = _lifted(np.exp, np.exp, np.exp, "exp")
log = _lifted(np.log, lambda u: 1 / u, lambda u: -1 / u**2, "log")
sqrt = _lifted(np.sqrt, lambda u: 0.5 / np.sqrt(u), lambda u: -0.25 / u**1.5, "sqrt")
sin = _lifted(np.sin, np.cos, lambda u: -np.sin(u), "sin")
cos = _lifted(np.cos, lambda u: -np.sin(u), lambda u: -np.cos(u), "cos")
tan = _lifted(np.tan, _tan_slope, lambda u: 2 * np.tan(u) * _tan_slope(u), "tan")
tanh = _lifted(np.tanh, _tanh_slope, lambda u: -2 * np.tanh(u) * _tanh_slope(u), "tanh")
arctan = _lifted(np.arctan, lambda u: 1 / (1 + u**2), lambda u: -2 * u / (1 + u**2) ** 2, "arctan")
erf = _lifted(special.erf, _bell, lambda u: -2 * u * _bell(u), "erf")
