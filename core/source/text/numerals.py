"""Numbers as text that is read back unchanged."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator

import numpy as np

_DIGITS = 16
"""Decimals of so many digits lie further apart than doubles, or nearly so; there are few to try."""
_NEIGHBOURS = 3
_PLAIN = re.compile(r"[-+]?\d*(?:\.(\d*))?")


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


def with_decimals_of(before: str, number: str) -> str:
    """A number with no fewer decimals than the one whose place it takes: ``0`` for ``450.040`` is
    ``0.000``. What has more of them, or an exponent, stays as it is."""
    old, new = re.fullmatch(_PLAIN, before.strip()), re.fullmatch(_PLAIN, number)
    if old is None or new is None:
        return number
    missing = len(old[1] or "") - len(new[1] or "")
    point = "" if missing <= 0 or "." in number else "."
    return number + point + "0" * missing


def in_proportion(text: str, before: float, value: float) -> float:
    """What a number in a text becomes, of which ``before`` was made and ``value`` is to be: an
    override, or a unit, is on it."""
    try:
        stated = float(text)
    except ValueError:
        return value
    if stated == 0 or before == 0 or math.isclose(stated, before, rel_tol=1e-9):
        return value
    return stated * (value / before)
