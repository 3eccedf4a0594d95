"""What users hand over, checked: messages name the argument."""

from __future__ import annotations

import math
from numbers import Real
from types import UnionType
from typing import TypeGuard

from ..core.errors import InputError


def of_kind(name: str, value: object, kind: type | UnionType) -> None:
    """Refuse a value of another type.

    Raises:
        InputError: it is one.
    """
    if not isinstance(value, kind):
        raise InputError(f"{name} is of type {_said(kind)}, not {value!r}")


def all_of_kind(name: str, values: object, kind: type | UnionType) -> None:
    """Refuse what is no tuple or list of values of a type.

    Raises:
        InputError: it is something else.
    """
    if not isinstance(values, tuple | list):
        raise InputError(f"{name} is a tuple of {_said(kind)} values, not {values!r}")
    for k, value in enumerate(values, 1):
        of_kind(f"{name}, number {k}", value, kind)


def within(name: str, value: object, least: float, most: float) -> None:
    """Refuse what is no number from least to most, both included.

    Raises:
        InputError: it is none.
    """
    if not _is_number(value) or not least <= value <= most:
        raise InputError(f"{name} is a number from {least:g} to {most:g}, not {value!r}")


def positive(name: str, value: object) -> None:
    """Refuse what is no finite number above zero.

    Raises:
        InputError: it is none.
    """
    if not _is_number(value) or not 0.0 < value < math.inf:
        raise InputError(f"{name} is a finite number above zero, not {value!r}")


def not_negative(name: str, value: object) -> None:
    """Refuse what is no finite number, zero or more.

    Raises:
        InputError: it is none.
    """
    if not _is_number(value) or not 0.0 <= value < math.inf:
        raise InputError(f"{name} is a finite number, zero or more, not {value!r}")


def whole(name: str, value: object, least: int, most: int | None = None) -> None:
    """Refuse what is no whole number in a range.

    Raises:
        InputError: it is none.
    """
    top = math.inf if most is None else most
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= top:
        reach = f"{least} or more" if most is None else f"from {least} to {most}"
        raise InputError(f"{name} is a whole number, {reach}, not {value!r}")


def _said(kind: type | UnionType) -> str:
    kinds = kind.__args__ if isinstance(kind, UnionType) else (kind,)
    return " or ".join("None" if part is type(None) else part.__name__ for part in kinds)


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, Real) and not isinstance(value, bool)
