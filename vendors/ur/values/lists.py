"""Methods of lists.

Source: "The URScript Programming Language", lists (PolyScope 5.15 and later).
"""

from __future__ import annotations

from collections.abc import Callable

from .elements import whole
from .values import LONGEST, UrPose, Value, ValueFault, checked, describe, shown

Items = tuple[Value, ...]
Result = tuple[Items | None, Value]
"""The list afterwards, None if it stays, and the value of the call."""


def _place(items: Items, index: Value, end: int) -> int:
    place = whole(index)
    if not 0 <= place < end:
        raise ValueFault(f"there is no place {place} in a list of {len(items)}")
    return place


def _made(items: Items) -> Items:
    made = checked(items)
    assert isinstance(made, tuple)
    return made


def _append(items: Items, value: Value) -> Result:
    return _made((*items, value)), None


def _extend(items: Items, other: Value) -> Result:
    if not isinstance(other, tuple) or isinstance(other, UrPose):
        raise ValueFault(f"a list is wanted, not {describe(other)}")
    return _made((*items, *other)), None


def _insert(items: Items, index: Value, value: Value) -> Result:
    place = _place(items, index, len(items) + 1)
    return _made((*items[:place], value, *items[place:])), None


def _remove(items: Items, index: Value) -> Result:
    place = _place(items, index, len(items))
    return (*items[:place], *items[place + 1 :]), None


def _pop(items: Items) -> Result:
    if not items:
        raise ValueFault("the list is empty")
    return items[:-1], items[-1]


def _slice(items: Items, begin: Value, end: Value) -> Result:
    first = _place(items, begin, len(items) + 1)
    return None, items[first : _place(items, end, len(items) + 1)]


METHODS: dict[str, Callable[..., Result]] = {
    "append": _append,
    "extend": _extend,
    "insert": _insert,
    "remove": _remove,
    "pop": _pop,
    "slice": _slice,
    "clear": lambda items: ((), None),
    "length": lambda items: (None, len(items)),
    "capacity": lambda items: (None, LONGEST),
    "excess_capacity": lambda items: (None, LONGEST - len(items)),
    "to_string": lambda items: (None, shown(items)),
}
