"""RAPID's spelling of numbers.

A ``num`` is an IEEE single ("RAPID Reference Manual", basic elements): a number is written as the
shortest decimal that the controller turns into the single next to it, so that nothing is lost that
the controller could hold, and a text that is read and written again stays the same.
"""

from __future__ import annotations

import numpy as np

from ....core.errors import InputError

_LARGEST = 3.4028235e38


def number(value: float) -> str:
    """A ``num``.

    Raises:
        InputError: the value does not fit in an IEEE single.
    """
    if not abs(value) <= _LARGEST:
        raise InputError(f"RAPID has no number {value:g}: a num is an IEEE single")
    single = np.float32(value)
    if single == 0:
        return "0"
    if 1e-4 <= abs(single) < 1e7:
        return np.format_float_positional(single, trim="-")
    return np.format_float_scientific(single, trim="-", exp_digits=2).upper()
