"""Values that only painting takes: as they are, or as a user types them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.errors import OptionError
from ..options import texts

if TYPE_CHECKING:
    from ...problems.paint.thickness.robust import PaintErrors

_LENGTH = re.compile(r"\s*([0-9.eE+-]+)\s*(um|µm|μm|mm)\s*")
_UNITS = {"um": 1e-6, "µm": 1e-6, "μm": 1e-6, "mm": 1e-3}
_THICKEST = 0.01
"""m."""


def thickness(given: str | float, name: str) -> float:
    """A thickness in m; typed with its unit: ``50um``, ``0.05mm``.

    Raises:
        InputError: it is none.
    """
    value = math.nan
    try:
        if isinstance(given, str):
            found = _LENGTH.fullmatch(given)
            value = float(found[1]) * _UNITS[found[2]] if found else math.nan
        else:
            value = float(given)
    except (TypeError, ValueError):
        pass
    if not 0.0 < value < _THICKEST:
        bare = "" if isinstance(given, str) else "; a number is in m, below 0.01"
        raise OptionError(
            f"{name} {given}: a thickness with its unit, such as 50um or 0.05mm{bare}"
        )
    return value


def box(given: str | Sequence[float], name: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Least and largest coordinates of a box in m, from two opposite corners; typed in mm.

    Raises:
        InputError: there are not six numbers.
    """
    found = texts.several(given, name, 1e-3)
    if len(found) != 6:
        unit = "mm" if isinstance(given, str) else "m"
        raise OptionError(f"{name} {given}: two corners of a box in {unit}, x,y,z,x,y,z")
    sides = [sorted(pair) for pair in zip(found[:3], found[3:], strict=True)]
    low, high = zip(*sides, strict=True)
    return low, high


def speed_range(given: str | Sequence[float], name: str) -> tuple[float, float]:
    """Least and largest speed in m/s; typed in mm/s.

    Raises:
        InputError: they are not two rising numbers above zero.
    """
    found = texts.several(given, name, 1e-3)
    if len(found) != 2 or not 0.0 < found[0] < found[1]:
        wanted = "mm/s, such as 50,800" if isinstance(given, str) else "m/s, such as 0.05, 0.8"
        raise OptionError(f"{name} {given}: least and largest in {wanted}")
    return found[0], found[1]


def coat_errors(given: str | Sequence[float] | None, name: str) -> PaintErrors:
    """Errors that a coat shall stand: of the height in m and the radius as a share; none if unset.

    They are typed in mm and per cent.

    Raises:
        InputError: they are not two numbers from 0 on.
    """
    from ...problems.paint.thickness.robust import NO_ERRORS, PaintErrors

    if given is None:
        return NO_ERRORS
    height, radius = 1.0, 1.0
    if isinstance(given, str):
        height, radius = 1e-3, 1e-2
    found = texts.several(given, name)
    if len(found) != 2 or not (0.0 <= found[0] < math.inf and 0.0 <= found[1] * radius < 0.5):
        wanted = "mm and radius in %, such as 3,2"
        if not isinstance(given, str):
            wanted = "m and radius as a share, such as 0.003, 0.02"
        raise OptionError(f"{name} {given}: height in {wanted}")
    return PaintErrors(height * found[0], radius * found[1])
