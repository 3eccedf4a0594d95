"""URScript's functions that compute a value of their arguments and nothing else.

Names, parameters and meaning: "The URScript Programming Language", modules urmath and internals.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass

from .poses import (
    interpolate_pose,
    point_dist,
    pose_add,
    pose_inv,
    pose_sub,
    pose_trans,
    rotvec2rpy,
    rpy2rotvec,
)
from .values import LONGEST, UrPose, Value, ValueFault, checked, describe, is_number, numbers, shown

_BITS = 32


@dataclass(frozen=True, slots=True)
class Computed:
    """A function that computes.

    Args:
        function: of the values; raises `ValueFault`, ValueError or ArithmeticError.
        parameters: names, in order.
        optional: how many of the last ones may be left out.
        cost: as many elements of a list are copied in the time that it takes.
    """

    function: Callable[..., Value]
    parameters: tuple[str, ...]
    optional: int = 0
    cost: int = 100

    def __call__(self, *values: Value) -> Value:
        """The value.

        Raises:
            ValueFault, ValueError, ArithmeticError: there is none.
        """
        return checked(self.function(*values))


SHAPES = frozenset({"length", "size", "get_list_length"})
"""Functions that need not know every element."""


def _number(value: Value) -> float:
    if is_number(value) or isinstance(value, bool):
        return value
    raise ValueFault(f"a number is wanted, not {describe(value)}")


def _whole(value: Value) -> int:
    number = _number(value)
    if number != int(number):
        raise ValueFault(f"a whole number is wanted, not {number:g}")
    return int(number)


def _text(value: Value) -> str:
    if not isinstance(value, str):
        raise ValueFault(f"a string is wanted, not {describe(value)}")
    return value


def _list(value: Value) -> tuple[Value, ...]:
    if not isinstance(value, tuple):
        raise ValueFault(f"a list is wanted, not {describe(value)}")
    return value


def _matrix(value: Value) -> list[list[float]]:
    rows = [numbers(row) for row in _list(value)]
    found = [row for row in rows if row]
    if not found or len(found) != len(rows) or len({len(row) for row in found}) != 1:
        raise ValueFault("a matrix of numbers is wanted")
    return found


def _of_numbers(function: Callable[..., float]) -> Callable[..., Value]:
    return lambda *values: function(*map(_number, values))


def _logarithm(base: Value, number: Value) -> Value:
    """``log(b, f)``: logarithm of f to base b."""
    return math.log(_number(number)) / math.log(_number(base))


def _sign(value: Value) -> Value:
    number = _number(value)
    return (number > 0) - (number < 0)


def _norm(value: Value) -> Value:
    """Of a number, a list or a pose: the square root of the sum of squares."""
    if isinstance(value, tuple):
        found = numbers(value)
        if found is None:
            raise ValueFault("a list of numbers is wanted")
        return math.hypot(*found)
    return abs(_number(value))


def _size(value: Value) -> Value:
    """Rows and columns of a matrix, or elements of a list."""
    found = _list(value)
    if found and isinstance(found[0], tuple) and not isinstance(found[0], UrPose):
        return len(found), len(found[0])
    return len(found)


def _transpose(value: Value) -> Value:
    return tuple(zip(*_matrix(value), strict=True))


def _inverse(value: Value) -> Value:
    """Of a matrix, or of a pose."""
    if isinstance(value, UrPose):
        return pose_inv(value)
    import numpy as np

    rows = _matrix(value)
    if len(rows) != len(rows[0]) or len(rows) > _BITS:
        raise ValueFault("only a square matrix has an inverse")
    try:
        found = np.linalg.inv(np.array(rows))
    except np.linalg.LinAlgError:
        raise ValueFault("the matrix has no inverse") from None
    return tuple(tuple(float(x) for x in row) for row in found)


def _length(value: Value) -> Value:
    if isinstance(value, str | tuple):
        return len(value)
    raise ValueFault(f"a list or a string is wanted, not {describe(value)}")


def _make_list(length: Value, initial: Value, capacity: Value = 0) -> Value:
    count = _whole(length)
    if not 0 <= count <= LONGEST or _whole(capacity) > LONGEST:
        raise ValueFault(f"a list has 0 to {LONGEST} elements")
    return (initial,) * count


def _dot(a: Value, b: Value) -> Value:
    one, two = numbers(a), numbers(b)
    if one is None or two is None or len(one) != len(two):
        raise ValueFault("two lists of numbers of one length are wanted")
    return math.fsum(x * y for x, y in zip(one, two, strict=True))


def _cross(a: Value, b: Value) -> Value:
    one, two = numbers(a, 3), numbers(b, 3)
    if one is None or two is None:
        raise ValueFault("two lists of three numbers are wanted")
    (a1, a2, a3), (b1, b2, b3) = one, two
    return a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1


def _normalize(value: Value) -> Value:
    found = numbers(value)
    length = math.hypot(*found) if found else 0.0
    if found is None or length == 0:
        raise ValueFault("a vector that is not zero is wanted")
    return tuple(x / length for x in found)


def _mean(values: Value) -> Value:
    found = numbers(values)
    if not found:
        raise ValueFault("a list of numbers is wanted")
    return statistics.fmean(found)


# --------------------------------------------------------------------------- bits and strings


def _to_bits(value: Value) -> Value:
    """An integer as a list of 32 booleans, the lowest bit first."""
    number = _whole(value)
    return tuple(bool(number >> k & 1) for k in range(_BITS))


def _from_bits(value: Value) -> Value:
    """The inverse of `_to_bits`."""
    bits = _list(value)
    if len(bits) > _BITS or not all(isinstance(b, bool) for b in bits):
        raise ValueFault(f"a list of at most {_BITS} booleans is wanted")
    return sum(1 << k for k, bit in enumerate(bits) if bit)


def _str_cat(op1: Value, op2: Value) -> Value:
    return shown(op1) + shown(op2)


def _str_at(src: Value, index: Value) -> Value:
    text, at = _text(src), _whole(index)
    if not 0 <= at < len(text):
        raise ValueFault(f"the string has {len(text)} characters, and none at {at}")
    return text[at]


def _str_sub(src: Value, index: Value, length: Value = None) -> Value:
    text, at = _text(src), _whole(index)
    if not 0 <= at <= len(text):
        raise ValueFault(f"the string has {len(text)} characters, and none at {at}")
    return text[at:] if length is None else text[at : at + max(_whole(length), 0)]


def _str_find(src: Value, target: Value, start_from: Value = 0) -> Value:
    return _text(src).find(_text(target), max(_whole(start_from), 0))


def _to_num(value: Value) -> Value:
    text = _text(value).strip()
    try:
        return int(text) if text.lstrip("+-").isdecimal() and len(text) < 16 else float(text)
    except ValueError:
        raise ValueFault(f"{describe(value)} is no number") from None


def _is_number_text(value: Value) -> Value:
    try:
        _to_num(value)
    except ValueFault:
        return False
    return True


def _functions() -> dict[str, Computed]:
    one: dict[str, Callable[..., float]] = {
        "sin": math.sin,
        "cos": math.cos,
        "tan": math.tan,
        "asin": math.asin,
        "acos": math.acos,
        "atan": math.atan,
        "sqrt": math.sqrt,
        "ceil": math.ceil,
        "floor": math.floor,
        "d2r": math.radians,
        "r2d": math.degrees,
        "abs": abs,
        "exp": math.exp,
        "round": round,
    }
    table = {name: Computed(_of_numbers(function), ("f",)) for name, function in one.items()}
    two: dict[str, Callable[..., float]] = {
        "pow": math.pow,
        "atan2": math.atan2,
        "min": min,
        "max": max,
    }
    pairs = {"pow": ("base", "exponent"), "atan2": ("x", "y")}
    for name, function in two.items():
        table[name] = Computed(_of_numbers(function), pairs.get(name, ("a", "b")))
    return table


COMPUTED: dict[str, Computed] = {
    **_functions(),
    "log": Computed(_logarithm, ("b", "f")),
    "sign": Computed(_sign, ("x",)),
    "norm": Computed(_norm, ("a",)),
    "normalize": Computed(_normalize, ("v",)),
    "mean": Computed(_mean, ("v",)),
    "dot": Computed(_dot, ("a", "b")),
    "cross": Computed(_cross, ("a", "b")),
    "size": Computed(_size, ("v",)),
    "length": Computed(_length, ("v",)),
    "get_list_length": Computed(_length, ("v",)),
    "make_list": Computed(_make_list, ("length", "initial_value", "capacity"), 1),
    "inv": Computed(_inverse, ("m",), cost=2000),
    "transpose": Computed(_transpose, ("m",)),
    "pose_trans": Computed(pose_trans, ("p_from", "p_from_to")),
    "pose_inv": Computed(pose_inv, ("p_from",)),
    "pose_add": Computed(pose_add, ("p_1", "p_2")),
    "pose_sub": Computed(pose_sub, ("p_to", "p_from")),
    "point_dist": Computed(point_dist, ("p_from", "p_to")),
    "interpolate_pose": Computed(interpolate_pose, ("p_from", "p_to", "alpha")),
    "rpy2rotvec": Computed(rpy2rotvec, ("rpy",)),
    "rotvec2rpy": Computed(rotvec2rpy, ("rotation_vector",)),
    "integer_to_binary_list": Computed(_to_bits, ("x",)),
    "binary_list_to_integer": Computed(_from_bits, ("l",)),
    "str_at": Computed(_str_at, ("src", "index")),
    "str_cat": Computed(_str_cat, ("op1", "op2")),
    "str_concat": Computed(_str_cat, ("op1", "op2")),
    "str_empty": Computed(lambda text: _text(text) == "", ("str",)),
    "str_find": Computed(_str_find, ("src", "target", "start_from"), 1),
    "str_len": Computed(lambda text: len(_text(text)), ("str",)),
    "str_sub": Computed(_str_sub, ("src", "index", "len"), 1),
    "to_num": Computed(_to_num, ("str",)),
    "to_str": Computed(shown, ("val",)),
    "is_number": Computed(_is_number_text, ("str",)),
}
"""name → function. ``random`` and the like are not here: their value is not in the text."""
