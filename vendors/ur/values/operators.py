"""URScript's operators on known values.

Arrays and matrices of numbers are added and scaled element by element, and multiplied as
matrices; division gives a float.
Source: "The URScript Programming Language", matrix and array expressions.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import TypeGuard

from .values import (
    Struct,
    ThreadHandle,
    Unknown,
    UrPose,
    Value,
    ValueFault,
    checked,
    describe,
    find_unknown,
    is_number,
    supposed,
)

_BITS: dict[str, Callable[[int, int], int]] = {
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "<<": operator.lshift,
    ">>": operator.rshift,
}
_ORDER: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
_LARGEST_SHIFT = 63


def apply(symbol: str, left: Value, right: Value) -> Value:
    """``left symbol right``; unknown if an operand that matters is.

    Raises:
        ValueFault: the operator has no value for these operands.
    """
    if symbol in ("and", "or", "xor"):
        return _logical(symbol, left, right)
    if isinstance(left, Unknown) or isinstance(right, Unknown):
        unknown = left if isinstance(left, Unknown) else right
        assert isinstance(unknown, Unknown)
        return Unknown(unknown.reason, unknown.span, _held(symbol, left, right), unknown.damaged)
    if symbol in ("==", "!=", "≟"):
        equal = _equal(left, right)
        return equal if isinstance(equal, Unknown) else equal != (symbol == "!=")
    if symbol in _ORDER:
        if not (_real(left) and _real(right)):
            raise _mismatch(symbol, left, right)
        return _ORDER[symbol](left, right)
    if symbol in _BITS:
        return _bits(symbol, left, right)
    return checked(_arithmetic(symbol, left, right))


def _held(symbol: str, left: Value, right: Value) -> Value:
    """What a move takes a sum or product for: an operand that nobody knows counts as zero beside a
    number."""
    if symbol not in ("+", "-", "*", "/"):
        return None
    known = [supposed(value) for value in (left, right)]
    for k, value in enumerate(known):
        if isinstance(value, Unknown) and is_number(known[1 - k]) and symbol != "/":
            known[k] = 0
    if any(find_unknown(value) is not None for value in known):
        return None
    try:
        return apply(symbol, *known)
    except ValueFault:
        return None


def negate(symbol: str, operand: Value) -> Value:
    """``symbol operand`` for ``-``, ``+``, ``~`` and ``not``.

    Raises:
        ValueFault: as `apply`.
    """
    if isinstance(operand, Unknown):
        held = supposed(operand)
        held = negate(symbol, held) if is_number(held) and symbol in "+-" else None
        return Unknown(operand.reason, operand.span, held, operand.damaged)
    if symbol == "not":
        return not truth(operand)
    if symbol == "~":
        if type(operand) is not int:
            raise ValueFault(f"'~' takes an integer, not {describe(operand)}")
        return ~operand
    if _real(operand):
        return -operand if symbol == "-" else operand
    if isinstance(operand, tuple) and not isinstance(operand, UrPose):
        return tuple([negate(symbol, item) for item in operand])
    raise ValueFault(f"'{symbol}' takes a number, not {describe(operand)}")


def truth(value: Value) -> bool:
    """A value as a condition.

    Raises:
        ValueFault: it is neither true nor false.
    """
    if isinstance(value, bool):
        return value
    if is_number(value):
        return value != 0
    if isinstance(value, ThreadHandle):
        return value.number != 0
    raise ValueFault(f"True or False is wanted, not {describe(value)}")


def _logical(symbol: str, left: Value, right: Value) -> Value:
    """Three-valued: ``False and unknown`` is False, ``True or unknown`` is True."""
    known = [truth(v) for v in (left, right) if not isinstance(v, Unknown)]
    if symbol == "xor":
        if len(known) == 2:
            return known[0] != known[1]
    else:
        decisive = symbol == "or"
        if decisive in known:
            return decisive
        if len(known) == 2:
            return not decisive
    return left if isinstance(left, Unknown) else right


def _real(value: Value) -> TypeGuard[float]:
    return type(value) is float or type(value) is int or type(value) is bool


def _mismatch(symbol: str, left: Value, right: Value) -> ValueFault:
    return ValueFault(f"'{symbol}' does not go with {describe(left)} and {describe(right)}")


def _equal(left: Value, right: Value) -> bool | Unknown:
    if isinstance(left, Struct) and isinstance(right, Struct):
        return left.names == right.names and _equal(left.values, right.values)
    if isinstance(left, tuple) and isinstance(right, tuple):
        if len(left) != len(right):
            return False
        results = [apply("==", a, b) for a, b in zip(left, right, strict=True)]
        if False in results:
            return False
        return next((r for r in results if isinstance(r, Unknown)), True)
    if isinstance(left, bool) != isinstance(right, bool) and _real(left) and _real(right):
        return truth(left) == truth(right)
    return left == right


def _bits(symbol: str, left: Value, right: Value) -> int:
    if type(left) is not int or type(right) is not int:
        raise _mismatch(symbol, left, right)
    if symbol in ("<<", ">>") and not 0 <= right <= _LARGEST_SHIFT:
        raise ValueFault(f"a shift by {right} bits: 0 to {_LARGEST_SHIFT} are possible")
    value = checked(_BITS[symbol](left, right))
    assert isinstance(value, int)
    return value


def _arithmetic(symbol: str, left: Value, right: Value) -> Value:
    if _real(left) and _real(right):
        return _numbers(symbol, left, right)
    if symbol == "+" and isinstance(left, str) and isinstance(right, str):
        return left + right
    if isinstance(left, UrPose) or isinstance(right, UrPose):
        hint = "use pose_trans or pose_add for poses, or their elements"
        raise ValueFault(f"'{symbol}' is not defined for a pose: {hint}")
    if isinstance(left, tuple) and isinstance(right, tuple):
        if symbol == "*" and (_is_matrix(left) or _is_matrix(right)):
            return _product(left, right)
        if len(left) != len(right):
            raise ValueFault(f"lists of {len(left)} and {len(right)} do not go with '{symbol}'")
        return tuple([apply(symbol, a, b) for a, b in zip(left, right, strict=True)])
    if isinstance(left, tuple) and _real(right):
        return tuple([apply(symbol, item, right) for item in left])
    if isinstance(right, tuple) and _real(left):
        return tuple([apply(symbol, left, item) for item in right])
    raise _mismatch(symbol, left, right)


def _numbers(symbol: str, left: int | float, right: int | float) -> int | float:
    try:
        if symbol == "+":
            return left + right
        if symbol == "-":
            return left - right
        if symbol == "*":
            return left * right
        if symbol == "/":
            return left / right
        if type(left) is float or type(right) is float:
            return math.fmod(left, right)
        return int(math.fmod(left, right)) if right else left % right
    except ZeroDivisionError:
        raise ValueFault("division by zero") from None
    except (OverflowError, ValueError):
        raise ValueFault("there is no finite result (a division by zero, or too large)") from None


def _is_matrix(value: tuple[Value, ...]) -> bool:
    return bool(value) and isinstance(value[0], tuple)


def _product(left: tuple[Value, ...], right: tuple[Value, ...]) -> Value:
    """Matrix by matrix, matrix by vector, vector by matrix."""
    if not _is_matrix(left):
        (row,) = _rows_times((left,), _columns(right))
        return row
    if not _is_matrix(right):
        return tuple([row[0] for row in _rows_times(left, (right,))])
    return tuple(_rows_times(left, _columns(right)))


def _columns(matrix: tuple[Value, ...]) -> tuple[tuple[Value, ...], ...]:
    rows = [row for row in matrix if isinstance(row, tuple)]
    if len(rows) != len(matrix) or len({len(row) for row in rows}) != 1:
        raise ValueFault("a matrix has rows of one length")
    return tuple(zip(*rows, strict=True))


def _rows_times(
    rows: tuple[Value, ...], columns: tuple[tuple[Value, ...], ...]
) -> list[tuple[Value, ...]]:
    found = []
    for row in rows:
        if not isinstance(row, tuple) or any(len(row) != len(column) for column in columns):
            raise ValueFault("the sizes of the matrices do not go together")
        found.append(tuple([_dot(row, column) for column in columns]))
    return found


def _dot(row: tuple[Value, ...], column: tuple[Value, ...]) -> Value:
    total: Value = 0
    for a, b in zip(row, column, strict=True):
        total = apply("+", total, apply("*", a, b))
    return total
