"""Functions of the language whose values follow from their arguments alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ....core.errors import InputError
from ....core.source.text.arguments import wrong_count
from .frames import frame_of, pose_of
from .operators import OperandError
from .types import POSES
from .values import Struct, Value, shown


@dataclass(frozen=True, slots=True)
class Computed:
    """A function.

    Args:
        wants: one letter for each argument: ``n`` a number, ``s`` a text, ``f`` a frame.
        value: from the arguments; `ValueError` where there is none.
    """

    wants: str
    value: Callable[..., Value]


def _invert(frame: Struct) -> Struct:
    return frame_of(pose_of(frame.fields).inverse(), frame.type or "frame")


COMPUTED: dict[str, Computed] = {
    "abs": Computed("n", abs),
    "sqrt": Computed("n", math.sqrt),
    "sin": Computed("n", lambda v: math.sin(math.radians(v))),
    "cos": Computed("n", lambda v: math.cos(math.radians(v))),
    "tan": Computed("n", lambda v: math.tan(math.radians(v))),
    "acos": Computed("n", lambda v: math.degrees(math.acos(v))),
    "asin": Computed("n", lambda v: math.degrees(math.asin(v))),
    "atan2": Computed("nn", lambda y, x: math.degrees(math.atan2(y, x)) % 360.0),
    "inv_pos": Computed("f", _invert),
    "strlen": Computed("s", len),
    "strdecllen": Computed("s", len),
    "strcomp": Computed("ssa", lambda a, b, sense: _same(a, b, sense)),
}
"""name → function. ARCSIN has no function in KRL; ASIN is met in programs all the same."""


def computed(name: str, arguments: list[Value]) -> Value:
    """The value of a function of `COMPUTED` for known arguments.

    Raises:
        OperandError: their number or kinds are wrong, or there is no finite value.
    """
    function = COMPUTED[name]
    if len(arguments) != len(function.wants):
        raise OperandError(f"it {wrong_count(len(function.wants), len(arguments))}")
    for argument, kind in zip(arguments, function.wants, strict=True):
        _check(argument, kind)
    try:
        value = function.value(*arguments)
    except (ValueError, ArithmeticError, InputError):
        raise OperandError("there is no finite value for these arguments", stops=True) from None
    if isinstance(value, float) and not math.isfinite(value):
        raise OperandError("there is no finite value for these arguments", stops=True)
    return value


def _check(argument: Value, kind: str) -> None:
    number = isinstance(argument, int | float) and not isinstance(argument, bool)
    fits = {
        "n": number,
        "s": isinstance(argument, str),
        "f": isinstance(argument, Struct) and (argument.type in POSES or argument.type == ""),
        "a": True,
    }
    if not fits[kind]:
        wanted = {"n": "a number", "s": "a text", "f": "a frame"}[kind]
        raise OperandError(f"{wanted} is wanted, not {shown(argument)}")


def _same(first: str, second: str, sense: Value) -> bool:
    if getattr(sense, "name", "") == "not_case_sens":
        return first.lower() == second.lower()
    return first == second
