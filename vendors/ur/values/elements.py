"""Elements of lists, poses and structs."""

from __future__ import annotations

from collections.abc import Sequence

from .values import Struct, UrPose, Value, ValueFault, checked, describe


def whole(index: Value) -> int:
    """An index as an int.

    Raises:
        ValueFault: it is no whole number.
    """
    if type(index) is int:
        return index
    if isinstance(index, bool) or not isinstance(index, int | float) or index != int(index):
        raise ValueFault(f"an index is a whole number, not {describe(index)}")
    return int(index)


def element(value: Value, index: Value) -> Value:
    """The element of a list, pose or struct at an index from 0.

    Raises:
        ValueFault: there is none.
    """
    parts = value.values if isinstance(value, Struct) else value
    if not isinstance(parts, tuple):
        raise ValueFault(f"only lists, poses and structs have elements, not {describe(value)}")
    place = whole(index)
    if not 0 <= place < len(parts):
        raise ValueFault(
            f"{describe(value)} has elements 0 to {len(parts) - 1}, and none {place}"
            if parts
            else f"the list is empty: it has no element {place}"
        )
    return parts[place]


def replaced(value: Value, indices: Sequence[Value], new: Value) -> Value:
    """A value with one element changed.

    Raises:
        ValueFault: there is no such element.
    """
    first, *rest = indices
    old = element(value, first)
    part = replaced(old, rest, new) if rest else new
    place = whole(first)
    if isinstance(value, Struct):
        return value.with_part(value.names[place], part)
    assert isinstance(value, tuple)
    parts = list(value)
    parts[place] = part
    return UrPose(*parts) if isinstance(value, UrPose) else checked(tuple(parts))
