"""URScript's spelling of numbers, lists, poses and names."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from itertools import count

from ....core.errors import InputError
from ....core.source.numerals import plain
from ....core.spatial.pose import Pose
from .reserved import RESERVED
from .rotations import lasting_rotation_vector

_INTEGERS = 2**31
"""Whole numbers without a point are 32-bit integers to a controller."""
_SMALLEST = 1e-12
"""m, rad, s and their like: below, a number is the rounding error of zero."""
_LEGAL = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_OTHER = re.compile(r"[^A-Za-z0-9_]+")


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


class Names:
    """The names that a script has given out; upper and lower case differ.

    Args:
        taken: names that are in use.
    """

    def __init__(self, *taken: str) -> None:
        self._taken = set(taken) | RESERVED

    def claim(self, wanted: str, fallback: str) -> str:
        """``wanted`` if it is legal and free, else a legal and free name near to it.

        Args:
            wanted: any text; what may not stand in a name becomes ``_``.
            fallback: a legal name, taken if nothing of ``wanted`` can stand in a name.
        """
        stem = _OTHER.sub("_", wanted)
        if stem != wanted:
            stem = stem.strip("_")
        stem = stem or fallback
        if not _LEGAL.fullmatch(stem):
            stem = f"{fallback}_{stem}"
        return self._first_free(stem)

    def _first_free(self, stem: str) -> str:
        for name in _numbered(stem):
            if name not in self._taken:
                self._taken.add(name)
                return name
        raise AssertionError("numbers do not end")


def _numbered(stem: str) -> Iterator[str]:
    yield stem
    yield from (f"{stem}_{k}" for k in count(2))
