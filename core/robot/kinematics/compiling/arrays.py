"""Elements and rows of arrays, in few instructions, and where arrays are described.

Kernels hand on where arrays and tuples of them are described. As nothing ever changes a
description, it is read where it is needed, once in each stretch of code without a branch.

It builds on the inside of one version of numba; see `linked`.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant, IntType, Undefined
from numba import types
from numba.core.cgutils import alloca_once

ITEMS, SHAPE = 2, 5
"""Where numba's description of an array holds how many elements there are, and how many along each
axis."""
_ITEM_BYTES, _DATA, _STRIDES = 3, 4, 6
"""Where it holds the size of an element, the address of the first, and bytes from one to the next
along each axis."""
_INDEX = IntType(32)


def is_described(kind: Any) -> bool:
    """Whether values are arrays or tuples that may hold some."""
    return isinstance(kind, types.Array | types.NamedTuple | types.NamedUniTuple)


def read(builder: Any, place: Any) -> Any:
    """What stands at a place that does not change."""
    value = builder.load(place)
    _known(builder, "flyby_places")[id(value)] = value, place
    return value


def place_of(builder: Any, value: Any) -> Any:
    """Where a value stands, or from now on does."""
    known = _known(builder, "flyby_places").get(id(value))
    if known is not None:
        return known[1]
    place = alloca_once(builder, value.type)
    builder.store(value, place)
    return place


def part(builder: Any, whole: Any, *path: int) -> Any:
    """A part of a description, read from where it stands."""
    known = _known(builder, "flyby_places").get(id(whole))
    if known is None:
        return builder.extract_value(whole, path)
    parts, key = _known(builder, "flyby_parts"), (id(builder.block), id(whole), path)
    if key not in parts:
        steps = [_INDEX(0), *map(_INDEX, path)]
        # With what the key is made of, which thereby lives on.
        parts[key] = (
            read(builder, builder.gep(known[1], steps, inbounds=True)),
            builder.block,
            whole,
        )
    return parts[key][0]


def _known(builder: Any, name: str) -> dict[Any, Any]:
    """What is remembered of the code that a builder makes."""
    if not hasattr(builder, name):
        setattr(builder, name, {})
    found: dict[Any, Any] = getattr(builder, name)
    return found


def element(builder: Any, whole: Any, indices: list[tuple[Any, bool]]) -> Any:
    """The address of an element, or of the first of a row, of a compact array.

    Args:
        builder: makes the code.
        whole: the array's description.
        indices: along the first axes; and whether each is known not to be negative.
    """
    offset, axes = None, len(whole.type.elements[SHAPE])
    for d in range(max(axes, len(indices))):
        at, from_start = indices[d] if d < len(indices) else (None, True)
        if d > 0 or not from_start:
            size = part(builder, whole, SHAPE, d)
        if at is not None and not from_start:
            negative = builder.icmp_signed("<", at, at.type(0))
            at = builder.select(negative, builder.add(at, size), at)
        if offset is not None:
            offset = offset if _is(offset, 0) else builder.mul(offset, size, flags=("nsw",))
        if offset is None or _is(offset, 0):
            offset = at if at is not None else offset
        elif at is not None and not _is(at, 0):
            offset = builder.add(offset, at, flags=("nsw",))
    first = part(builder, whole, _DATA)
    return first if _is(offset, 0) else builder.gep(first, [offset])


def row(builder: Any, whole: Any, indices: list[tuple[Any, bool]], kind: Any) -> Any:
    """The description of what is left of a compact array behind its first axes' indices.

    Args:
        builder, whole, indices: as in `element`.
        kind: how numba describes such an array.
    """
    count = len(indices)
    shape = [part(builder, whole, SHAPE, d) for d in range(count, len(whole.type.elements[SHAPE]))]
    items = shape[0]
    for size in shape[1:]:
        items = builder.mul(items, size, flags=("nsw",))
    made = Constant(kind, Undefined)
    for at in range(2):
        made = builder.insert_value(made, Constant(kind.elements[at], None), at)
    made = builder.insert_value(made, items, ITEMS)
    made = builder.insert_value(made, part(builder, whole, _ITEM_BYTES), _ITEM_BYTES)
    made = builder.insert_value(made, element(builder, whole, indices), _DATA)
    for k, size in enumerate(shape):
        stride = part(builder, whole, _STRIDES, count + k)
        made = builder.insert_value(made, size, (SHAPE, k))
        made = builder.insert_value(made, stride, (_STRIDES, k))
    return made


def _is(value: Any, number: int) -> bool:
    return isinstance(value, Constant) and value.constant == number
