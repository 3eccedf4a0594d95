"""Operators on values: num, bool, string, pos (triples) and orient (quadruples).

"RAPID Reference Manual", expressions: ``pos * pos`` is the vector product, ``orient * orient``
the product of quaternions, ``DIV`` and ``MOD`` the integer quotient and remainder (truncated),
``+`` joins strings; ``=`` and ``<>`` compare any two values of one type.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

from ....core.errors import SourceError, Span
from .defaults import beside, carried, nominal
from .errors import DIVISION_BY_ZERO, NUMBERS, TOO_LONG, ProgramError
from .types import BOOL, NUM, STRING, Type, Unknown, Value, describe, find_unknown

STRING_LIMIT = 80
"""Characters that a RAPID string holds."""

_ANY = ("and", "or", "xor", "=", "<>")
"""Operators that take more than nums."""

COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}


class OperandError(Exception):
    """Operands that an operator or function does not take; the caller knows the place.

    Args:
        error: name of the error that it is to a running program; empty if it never comes to run.
    """

    def __init__(self, message: str, error: str = "") -> None:
        super().__init__(message)
        self.error = error

    def at(self, span: Span, use: str = "") -> SourceError:
        """The error at its place, to be raised.

        Args:
            use: what does not take the operands, to stand at the beginning of the message.
        """
        message = f"{use}: {self}" if use else str(self)
        if self.error:
            return ProgramError(message, span, NUMBERS[self.error])
        return SourceError(message, span)


def apply(symbol: str, left: Value, right: Value) -> Value:
    """``left symbol right``.

    Raises:
        OperandError: the operands do not fit the operator, or the result is no finite number.
    """
    if type(left) is float and type(right) is float and symbol not in _ANY:
        return _numbers(symbol, left, right)
    if symbol in ("and", "or", "xor"):
        return _logic(symbol, left, right)
    unknown = find_unknown((left, right))
    if unknown is not None:
        return carried(unknown, lambda: _of_defaults(symbol, left, right))
    if symbol in ("=", "<>"):
        return _equal(left, right) == (symbol == "=")
    if isinstance(left, str) and isinstance(right, str) and symbol == "+":
        return _join(left, right)
    result = _vectors(symbol, left, right)
    if result is None:
        raise OperandError(
            f"'{symbol.upper()}' does not take {describe(left)} and {describe(right)}"
        )
    return result


def _of_defaults(symbol: str, left: Value, right: Value) -> Value | None:
    """The same with everything that is not known at its default."""
    a, b = nominal(left), nominal(right)
    a = beside(right if b is None else b) if a is None else a
    b = beside(left if a is None else a) if b is None else b
    if a is None or b is None:
        return None
    try:
        return apply(symbol, a, b)
    except OperandError:
        return None


def operand_type(symbol: str, other: Value) -> Type | None:
    """The type of what stands beside another operand; None if nobody can say."""
    if symbol in ("and", "or", "xor"):
        return BOOL
    return next((t for t in (NUM, BOOL, STRING) if type(other) is t.python), None)


def negate(symbol: str, value: Value) -> Value:
    """``symbol value`` for ``+``, ``-`` and ``not``."""
    unknown = find_unknown(value)
    if unknown is not None:
        known = nominal(value)
        if known is None or (symbol == "not") != isinstance(known, bool):
            return unknown
        return carried(unknown, lambda: negate(symbol, known))
    if symbol == "not":
        if isinstance(value, bool):
            return not value
        raise OperandError(f"NOT takes a bool, not {describe(value)}")
    if type(value) is float:
        return -value if symbol == "-" else value
    if isinstance(value, tuple) and is_vector(value, 3):
        return value if symbol == "+" else tuple(-v for v in value)
    raise OperandError(f"'{symbol}' takes a num or a pos, not {describe(value)}")


def is_vector(value: Value, length: int) -> bool:
    """Whether a value is that many numbers, all known."""
    return (
        isinstance(value, tuple) and len(value) == length and all(type(v) is float for v in value)
    )


def cross(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    """The vector product of triples."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def hamilton(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    """The product of quaternions w, x, y, z: the turn ``b`` in the frame that ``a`` gives."""
    w, x, y, z = a
    s, i, j, k = b
    return (
        w * s - x * i - y * j - z * k,
        w * i + x * s + y * k - z * j,
        w * j - x * k + y * s + z * i,
        w * k + x * j - y * i + z * s,
    )


def _logic(symbol: str, left: Value, right: Value) -> Value:
    for value in (left, right):
        if not isinstance(value, bool | Unknown):
            raise OperandError(f"{symbol.upper()} takes bools, not {describe(value)}")
    known = [v for v in (left, right) if isinstance(v, bool)]
    if symbol == "and" and False in known:
        return False
    if symbol == "or" and True in known:
        return True
    unknown = find_unknown((left, right))
    if unknown is not None:
        return unknown
    return left != right if symbol == "xor" else symbol == "and"


def _equal(left: Value, right: Value) -> bool:
    if type(left) is not type(right):
        raise OperandError(f"{describe(left)} and {describe(right)} cannot be compared")
    return left == right


def _numbers(symbol: str, a: float, b: float) -> Value:
    if symbol in COMPARISONS:
        return COMPARISONS[symbol](a, b)
    if symbol in ("/", "div", "mod") and b == 0:
        raise OperandError("division by zero", DIVISION_BY_ZERO)
    if symbol == "+":
        return finite(a + b)
    if symbol == "-":
        return finite(a - b)
    if symbol == "*":
        return finite(a * b)
    if symbol == "/":
        return finite(a / b)
    if symbol == "div":
        return finite(float(math.trunc(finite(a / b))))
    return math.fmod(a, b)


def finite(value: float) -> float:
    """The value itself, which must be finite."""
    if not math.isfinite(value):
        raise OperandError("the result is too large for a num")
    return value


def _join(left: str, right: str) -> str:
    if len(left) + len(right) > STRING_LIMIT:
        raise OperandError(f"a string holds at most {STRING_LIMIT} characters", TOO_LONG)
    return left + right


def _vectors(symbol: str, left: Value, right: Value) -> Value | None:
    if isinstance(left, tuple) and isinstance(right, tuple):
        if is_vector(left, 3) and is_vector(right, 3):
            if symbol == "*":
                return _finite_all(cross(left, right))
            if symbol in ("+", "-"):
                sign = 1.0 if symbol == "+" else -1.0
                return _finite_all(tuple(a + sign * b for a, b in zip(left, right, strict=True)))
        if is_vector(left, 4) and is_vector(right, 4) and symbol == "*":
            return _finite_all(hamilton(left, right))
    for vector, factor in ((left, right), (right, left)):
        if not isinstance(vector, tuple) or not is_vector(vector, 3) or type(factor) is not float:
            continue
        if symbol == "*":
            return _finite_all(tuple(v * factor for v in vector))
        if symbol == "/" and vector is left and factor != 0:
            return _finite_all(tuple(v / factor for v in vector))
    return None


def _finite_all(values: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(finite(v) for v in values)
