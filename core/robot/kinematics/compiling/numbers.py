"""Operations on two numbers, in one instruction each.

numba looks for an operation three times, with what is written as a literal and without, before it
takes the one of the types at hand.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from numba import types

FLOAT: dict[Any, str] = {
    operator.add: "fadd",
    operator.sub: "fsub",
    operator.mul: "fmul",
    operator.truediv: "fdiv",
}
INTEGER: dict[Any, str] = {operator.add: "add", operator.sub: "sub", operator.mul: "mul"}
COMPARED: dict[Any, str] = {
    operator.lt: "<",
    operator.le: "<=",
    operator.gt: ">",
    operator.ge: ">=",
    operator.eq: "==",
    operator.ne: "!=",
}
_MOST = 8
"""The highest power that is multiplied out here."""


def operation(fn: Any, kinds: Any, right: Any) -> Callable[[Any, Any, Any], Any] | None:
    """What makes the code of an operation, of a builder and two values; None for others.

    Args:
        fn: of Python's `operator`.
        kinds: both types that the values have there, and that of the result.
        right: the type of the value on the right as it is written.
    """
    plain = {types.float64: FLOAT, types.intp: INTEGER}
    left, other, result = kinds
    if fn is operator.pow:
        return _power(right) if left == result == types.float64 else None
    if left != other or left not in plain:
        return None
    if result == types.boolean and fn in COMPARED:
        return _comparison(fn, left)
    name = plain[left].get(fn) if result == left else None
    return None if name is None else lambda builder, a, b: getattr(builder, name)(a, b)


def _comparison(fn: Any, kind: Any) -> Callable[[Any, Any, Any], Any]:
    sign = COMPARED[fn]
    if kind == types.intp:
        return lambda builder, a, b: builder.icmp_signed(sign, a, b)
    # What is no number is unequal to all, and in no other relation.
    name = "fcmp_unordered" if fn is operator.ne else "fcmp_ordered"
    return lambda builder, a, b: getattr(builder, name)(sign, a, b)


def _power(kind: Any) -> Callable[[Any, Any, Any], Any] | None:
    exponent = kind.literal_value if isinstance(kind, types.IntegerLiteral) else 0
    return _multiplied(exponent) if 0 < exponent <= _MOST else None


def _multiplied(exponent: int) -> Callable[[Any, Any, Any], Any]:
    def made(builder: Any, base: Any, _: Any) -> Any:
        found, power, left = None, base, exponent
        while left:
            if left & 1:
                found = power if found is None else builder.fmul(found, power)
            left >>= 1
            power = builder.fmul(power, power) if left else power
        return found

    return made
