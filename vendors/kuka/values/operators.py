"""Operators on values.

INT with INT gives INT, division without its remainder; anything with a REAL gives REAL (KUKA
"Quickguide KRL-Syntax"). ``a : b`` is frame b taken from a into the frame of a, of the type of b.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeGuard

from ....core.errors import InputError, SourceError, Span, StopError
from .frames import frame_of, null_frame, pose_of
from .types import AXES, POSES
from .values import Choice, Struct, Unknown, Value, find_unknown, shown, supposed

_COMPONENTS = frozenset("xyzabc")


class OperandError(Exception):
    """An operator cannot be applied; the message says why.

    Attributes:
        stops: whether the operands are of the right kind, and only their values have no result:
            what a controller finds when it comes there.
    """

    def __init__(self, message: str, stops: bool = False) -> None:
        super().__init__(message)
        self.stops = stops

    def at(self, span: Span, of: str = "") -> SourceError:
        """The error of a program, to be raised; ``of`` is the function that was called."""
        return (StopError if self.stops else SourceError)(f"{of}{self}", span)


def apply(symbol: str, left: Value, right: Value) -> Value:
    """The value of ``left symbol right``.

    Raises:
        OperandError: the operands are of the wrong kind, or there is no finite value.
    """
    if isinstance(left, Unknown) or isinstance(right, Unknown):
        return _with_unknown(symbol, left, right)
    if symbol == ":":
        return chained(left, right)
    if symbol in _COMPARISONS:
        return _compared(symbol, left, right)
    if symbol in _LOGIC:
        return _logic(symbol, left, right)
    if symbol in _BITWISE:
        if _is_int(left) and _is_int(right):
            return _BITWISE[symbol](left, right)
        raise _wrong(symbol, "whole numbers", left, right)
    return _arithmetic(symbol, left, right)


def negate(symbol: str, operand: Value) -> Value:
    """The value of ``-``, ``+``, ``not`` or ``b_not`` before an operand.

    Raises:
        OperandError: it is of the wrong kind.
    """
    if isinstance(operand, Unknown):
        held = supposed(operand)
        known = _is_number(held) and symbol in "+-"
        return replace(operand, here=None, held=negate(symbol, held) if known else None)
    if symbol == "not":
        if not isinstance(operand, bool):
            raise OperandError(f"NOT wants a BOOL, not {shown(operand)}")
        return not operand
    if symbol == "b_not":
        if not _is_int(operand):
            raise OperandError(f"B_NOT wants a whole number, not {shown(operand)}")
        return ~operand
    if not _is_number(operand):
        raise OperandError(f"'{symbol}' wants a number, not {shown(operand)}")
    return -operand if symbol == "-" else +operand


def chained(left: Value, right: Value) -> Struct | Unknown:
    """``left : right``; not known where a component of one is not.

    Raises:
        OperandError: they are no frames or positions.
    """
    for value in (left, right):
        if not _is_frame(value):
            raise OperandError(f"':' wants frames or positions, not {shown(value)}")
        assert isinstance(value, Struct)
    assert isinstance(left, Struct) and isinstance(right, Struct)
    unknown = find_unknown(left) or find_unknown(right)
    if unknown is not None:
        return replace(unknown, here=None, held=chained(_zeroed(left), _zeroed(right)))
    try:
        made = frame_of(pose_of(left.fields) @ pose_of(right.fields), right.type or "frame")
    except InputError as error:
        raise OperandError(str(error)) from None
    kept = {k: v for k, v in right.fields.items() if k not in _COMPONENTS}
    return Struct(made.type, {**made.fields, **kept}, moved_by=left.moved_by)


def _zeroed(frame: Struct) -> Struct:
    """A frame whose components that nobody knows are what motion takes them for, or zero."""
    fields = {name: supposed(part) for name, part in frame.fields.items()}
    known: dict[str, Value] = {k: 0.0 if isinstance(v, Unknown) else v for k, v in fields.items()}
    return Struct(frame.type, known, frame.label, frame.shipped, frame.moved_by)


def _is_frame(value: Value) -> bool:
    if not isinstance(value, Struct) or value.type in AXES:
        return False
    return value.type in POSES or (value.type == "" and bool(_COMPONENTS & value.fields.keys()))


def _only_shifts(frame: Value) -> bool:
    """Whether a frame turns nothing: behind a place that nobody knows, it leads away from there and
    is no place itself."""
    assert isinstance(frame, Struct)
    return frame.type not in ("pos", "e6pos") and not any(map(frame.fields.get, "abc"))


def _with_unknown(symbol: str, left: Value, right: Value) -> Value:
    """What can be said although one operand is not known."""
    for known in (left, right):
        if symbol == "and" and known is False:
            return False
        if symbol == "or" and known is True:
            return True
    unknown = left if isinstance(left, Unknown) else right
    assert isinstance(unknown, Unknown)
    if isinstance(right, Unknown) and right.damaged:
        unknown = right
    return replace(unknown, here=None, held=_held(symbol, left, right))


def _held(symbol: str, left: Value, right: Value) -> Value | None:
    """What motion takes a result for: an operand that nobody knows counts as zero, or as the frame
    of zeros, beside one that is known."""
    known = [supposed(value) for value in (left, right)]
    for k, value in enumerate(known):
        if isinstance(value, Unknown):
            other = known[1 - k]
            if _is_number(other) and symbol in "+-*":
                known[k] = 0
            elif _is_frame(other) and symbol == ":" and not (k == 0 and _only_shifts(other)):
                known[k] = null_frame()
    if any(isinstance(value, Unknown) for value in known) or symbol not in _HOLDING:
        return None
    try:
        return apply(symbol, *known)
    except OperandError:
        return None


_HOLDING = frozenset("+-*/:")


_COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "==": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}


def _compared(symbol: str, left: Value, right: Value) -> bool:
    if _is_number(left) and _is_number(right):
        return _COMPARISONS[symbol](left, right)
    alike = any(isinstance(left, kind) and isinstance(right, kind) for kind in (bool, str, Choice))
    if alike and symbol in ("==", "<>"):
        return (left == right) == (symbol == "==")
    first, second = (ord(v) if isinstance(v, str) and len(v) == 1 else v for v in (left, right))
    if _is_number(first) and _is_number(second):
        return _COMPARISONS[symbol](first, second)
    raise _wrong(symbol, "two values of one type", left, right)


_LOGIC: dict[str, Callable[[bool, bool], bool]] = {
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "exor": lambda a, b: a != b,
}
_BITWISE: dict[str, Callable[[int, int], int]] = {
    "b_and": lambda a, b: a & b,
    "b_or": lambda a, b: a | b,
    "b_exor": lambda a, b: a ^ b,
}


def _logic(symbol: str, left: Value, right: Value) -> bool:
    if not (isinstance(left, bool) and isinstance(right, bool)):
        raise _wrong(symbol, "BOOLs", left, right)
    return _LOGIC[symbol](left, right)


def _arithmetic(symbol: str, left: Value, right: Value) -> Value:
    if not (_is_number(left) and _is_number(right)):
        raise _wrong(symbol, "numbers", left, right)
    assert isinstance(left, int | float) and isinstance(right, int | float)
    whole = isinstance(left, int) and isinstance(right, int)
    if symbol == "/":
        if right == 0:
            raise OperandError("division by zero", stops=True)
        value: int | float = math.trunc(left / right) if whole else left / right
    elif symbol == "*":
        value = left * right
    else:
        value = left + right if symbol == "+" else left - right
    if whole and abs(value) >= 2**31:
        raise OperandError("the result is too large for an INT", stops=True)
    # $VEL_MA and $ACC_MA, the machine's own maxima, count as infinite; so may half of them.
    if not math.isfinite(value) and math.isfinite(left) and math.isfinite(right):
        raise OperandError("the result is no finite number", stops=True)
    if math.isnan(value):
        raise OperandError("the result is no number", stops=True)
    return value


def _is_number(value: Value) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_int(value: Value) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def _wrong(symbol: str, wanted: str, left: Value, right: Value) -> OperandError:
    return OperandError(f"'{symbol.upper()}' wants {wanted}, not {shown(left)} and {shown(right)}")
