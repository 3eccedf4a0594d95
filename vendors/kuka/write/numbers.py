"""KRL's spelling of numbers: plain decimals without an exponent, twelve digits at most.

A ``REAL`` is an IEEE single ("Quickguide KRL-Syntax": ±1.1E-38 to ±3.4E+38), of which the
controller keeps seven digits. The text has more where the program has: so a program that is read
and written keeps its numbers to a nanometre, whoever reads them.
"""

from __future__ import annotations

from ....core.errors import InputError
from ....core.source.text.numerals import plain

_LARGEST = 3.4e38
_SMALLEST = 1e-10
"""mm, degrees, percent: below, a number is the rounding error of zero."""
_DIGITS = 12


def number(value: float) -> str:
    """A ``REAL``; whole numbers without a point.

    Raises:
        InputError: the value does not fit in an IEEE single.
    """
    if not abs(value) <= _LARGEST:
        raise InputError(f"KRL has no number {value:g}: a REAL is an IEEE single")
    return "0" if abs(value) < _SMALLEST else plain(float(f"{value:.{_DIGITS}g}"))
