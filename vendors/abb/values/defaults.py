"""What is taken where a value is not known, and of data that nothing sets.

A program is driven with everything unknown at its default: numbers are 0, flags FALSE, texts empty,
tools and work objects the controller's own. Of a target there is none: a move to it is left out.
What depends on such a value carries along what it would be (`Unknown.nominal`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ....core.errors import Span
from .predefined import RECORDS
from .records import LOAD0, UNUSED_AXIS
from .types import (
    BOOL,
    DNUM,
    EXTJOINT,
    JOINTTARGET,
    LOADDATA,
    NUM,
    ORIENT,
    ROBJOINT,
    ROBTARGET,
    SPEEDDATA,
    STRING,
    TOOLDATA,
    WOBJDATA,
    ZONEDATA,
    Foreign,
    RecordType,
    Scalar,
    Type,
    Unknown,
    Value,
    find_unknown,
    mismatch,
)

_TAKEN: dict[str, Value] = {
    ORIENT.name: (1.0, 0.0, 0.0, 0.0),
    EXTJOINT.name: (UNUSED_AXIS,) * 6,
    LOADDATA.name: LOAD0,
    TOOLDATA.name: RECORDS["tooldata"]["tool0"],
    WOBJDATA.name: RECORDS["wobjdata"]["wobj0"],
    SPEEDDATA.name: RECORDS["speeddata"]["v1000"],
    ZONEDATA.name: RECORDS["zonedata"]["fine"],
}
"""Of records whose zeros mean nothing: those that RobotStudio writes into a new move."""
_NONE = (ROBTARGET.name, JOINTTARGET.name, ROBJOINT.name)


def default_of(type_: Type | None) -> Value | None:
    """What is taken for a value of a type; None if nothing can be."""
    if isinstance(type_, Scalar):
        return type_.default
    if not isinstance(type_, RecordType) or type_.name in _NONE:
        return None
    if type_.name in _TAKEN:
        return _TAKEN[type_.name]
    parts = [default_of(component) for component in type_.components.values()]
    return None if None in parts else tuple(parts)


def nominal(value: Value, type_: Type | None = None) -> Value | None:
    """A value with defaults where it is not known; None if there is none.

    Args:
        type_: of the value, None if it is not known.
    """
    if isinstance(value, Unknown):
        if value.lost:
            return None
        known = value.nominal
        if known is not None and (type_ is None or mismatch(known, type_) is None):
            return known
        return default_of(type_)
    if not isinstance(value, tuple) or find_unknown(value) is None:
        return value
    kinds: list[Type | None] = [None] * len(value)
    if isinstance(type_, RecordType):
        kinds = [*type_.components.values()]
        if type_ is ROBTARGET and _points_anywhere(value[1]):
            return None
    parts = [nominal(part, kind) for part, kind in zip(value, kinds, strict=False)]
    return None if None in parts else tuple(parts)


def _points_anywhere(turn: Value) -> bool:
    """Whether nobody knows how a tool is turned: of one that is turned by what is not known, from
    how it points otherwise, that is known well enough."""
    if find_unknown(turn) is None:
        return False
    return not isinstance(turn, Unknown) or turn.nominal in (None, _TAKEN["orient"])


def carried(unknown: Unknown, compute: Callable[[], Value | None]) -> Unknown:
    """What depends on a value that is not known.

    Args:
        compute: gives it of the defaults.
    """
    if unknown.lost:
        return unknown
    try:
        value = compute()
    except (ArithmeticError, ValueError, TypeError):
        value = None
    return replace(unknown, nominal=None if isinstance(value, Unknown) else value)


def unset(type_: Type, name: str, where: Span, *, shared: bool = False) -> Value:
    """The value of a datum that is declared without one: zeros, but where these mean nothing.

    Args:
        name: of the datum.
        where: it is declared.
        shared: a ``PERS``: the task that declares it with a value has it.
    """
    if shared and isinstance(type_, Scalar):
        declared = f"line {where.line} of {where.file} declares it as PERS without one"
        reason = f"the value of '{name}', which another task has: {declared}"
        return Unknown(reason, where, name, type_.default)
    place = f"which nothing sets: line {where.line} of {where.file} declares it without a value"

    def missing(what: str, taken: Value) -> Unknown:
        return Unknown(f"{what} of '{name}', {place}", where, name, taken)

    def value(type_: Type) -> Value:
        if isinstance(type_, Foreign):
            return Unknown(f"'{name}', a {type_.name}", where, name)
        if isinstance(type_, Scalar):
            return type_.default
        if type_ is ORIENT:
            return missing("the orientation", (1.0, 0.0, 0.0, 0.0))
        parts = {part: value(kind) for part, kind in type_.components.items()}
        if type_ is SPEEDDATA:
            tcp, orientation, *_ = RECORDS["speeddata"]["v1000"]
            parts |= {"v_tcp": missing("the speed", tcp), "v_ori": missing("v_ori", orientation)}
        elif type_ is TOOLDATA:
            parts |= {"robhold": missing("robhold", True)}
        elif type_ is WOBJDATA:
            parts |= {"ufprog": missing("ufprog", True)}
        elif type_ is ROBJOINT:
            parts = {axis: missing(axis, 0.0) for axis in parts}
        elif type_ is LOADDATA:
            parts |= {"mass": missing("the mass", LOAD0[0])}
        return tuple(parts.values())

    return value(type_)


def beside(other: Value) -> Value | None:
    """What is taken for an operand of which nothing is known, beside another one."""
    for kind in (NUM, BOOL, STRING, DNUM):
        if type(other) is kind.python:
            return kind.default
    return NUM.default if isinstance(other, Unknown) else None
