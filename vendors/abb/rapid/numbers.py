"""RAPID's spelling of numbers.

A ``num`` is an IEEE single ("RAPID Reference Manual", basic elements): a number is written as the
shortest decimal that the controller turns into the single next to it, so that nothing is lost that
the controller could hold, and a text that is read and written again stays the same.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from ....core.errors import InputError
from ....core.spatial.pose import Quaternion

_LARGEST = float(np.finfo(np.float32).max)
_STEPS = sorted(product(range(-3, 4), repeat=4), key=lambda steps: sum(n * n for n in steps))


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


def settled(quaternion: Quaternion) -> Quaternion:
    """The nearest quaternion whose text stays the same when it is read, normalised and written.

    Rounding leaves a length that is off by up to 6e-8; scaled to unit length and rounded again, a
    component may come out one step further, and the next time another. Some combination of steps
    of at most three units in the last place has a length that leaves it where it is.
    """
    rounded = np.array([float(number(v)) for v in quaternion], dtype=np.float32)
    unit = np.where(rounded == 0, np.float32(0), np.spacing(rounded))
    for steps in _STEPS:
        w, x, y, z = (float(number(v)) for v in rounded + unit * np.float32(steps))
        if _stays((w, x, y, z)):
            return (w, x, y, z)
    w, x, y, z = (float(v) for v in rounded)
    return (w, x, y, z)


def _stays(values: Quaternion) -> bool:
    length = math.sqrt(sum(v * v for v in values))
    return all(float(number(v / length)) == v for v in values)
