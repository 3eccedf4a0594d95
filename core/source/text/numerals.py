"""Numbers as text that is read back unchanged."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

_DIGITS = 16
"""Decimals of so many digits lie further apart than doubles, or nearly so; there are few to try."""
_NEIGHBOURS = 3


def shortest(value: float, guess: float, convert: Callable[[float], float]) -> str:
    """The shortest decimal that a reader converts to exactly ``value``.

    A language's units (mm, degrees) are converted with rounding, so that the inverse of the
    conversion need not give a number that comes back to the last bit.

    Args:
        value: what is to be read.
        guess: the same in the language's unit.
        convert: from the language's unit, as its reader does it.

    Returns:
        A decimal without exponent; the nearest one where none comes back exactly.
    """
    for digits in range(1, _DIGITS + 1):
        candidate = float(f"{guess:.{digits}g}")
        if convert(candidate) == value:
            return plain(candidate)
    exact = [plain(candidate) for candidate in _around(guess) if convert(candidate) == value]
    return min(exact, key=len, default=plain(guess))


def _around(guess: float) -> Iterator[float]:
    """The double itself, and the nearest ones on both sides."""
    yield guess
    lower = upper = guess
    for _ in range(_NEIGHBOURS):
        lower, upper = math.nextafter(lower, -math.inf), math.nextafter(upper, math.inf)
        yield lower
        yield upper


def plain(value: float) -> str:
    """The shortest decimal without exponent that is this double; whole numbers without a point."""
    return "0" if value == 0 else str(np.format_float_positional(value, trim="-"))


def nine_decimals(value: float) -> str:
    """A decimal of nine digits behind the point at most: a nanometre of m, a picometre of mm."""
    return plain(round(value, 9))
