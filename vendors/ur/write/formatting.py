"""URScript's spelling of numbers, lists and poses."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ....core.errors import InputError
from ....core.source.text.numerals import plain
from ....core.spatial.pose import Pose
from ..values.rotations import lasting_rotation_vector

_INTEGERS = 2**31
"""Whole numbers without a point are 32-bit integers to a controller."""
_SMALLEST = 1e-12
"""m, rad, s and their like: below, a number is the rounding error of zero."""


def number(value: float) -> str:
    """A number: the shortest decimal that is this double, without an exponent.

    Raises:
        InputError: it is not finite.
    """
    if not math.isfinite(value):
        raise InputError(f"URScript has no number {value}")
    text = "0" if abs(value) < _SMALLEST else plain(value)
    return text + ".0" if "." not in text and abs(value) >= _INTEGERS else text


def listing(values: Iterable[float]) -> str:
    """``[a, b, c]``."""
    return f"[{', '.join(map(number, values))}]"


def pose_literal(pose: Pose) -> str:
    """``p[x, y, z, rx, ry, rz]`` in m and rad."""
    return "p" + listing((*pose.position, *lasting_rotation_vector(pose.quaternion)))


def comment(text: str) -> list[str]:
    """Lines that a controller skips; what is not ASCII is escaped."""
    lines = text.splitlines() or [""]
    return [f"# {ascii(line)[1:-1] if not line.isascii() else line}".rstrip() for line in lines]
