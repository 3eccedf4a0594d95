"""Components of records and elements of arrays."""

from __future__ import annotations

from ....core.errors import SourceError
from .scope import Cell
from .syntax import Declaration, Name
from .types import Foreign, RecordType, Scalar, Type, Unknown, Value, interpreted, mismatch

ARRAY_LIMIT = 1_000_000
"""Elements of an array; a controller holds fewer."""


def item(value: Value, index: int) -> Value:
    """A component or element by its place from 0; unknown of an unknown value."""
    if isinstance(value, Unknown):
        return value
    assert isinstance(value, tuple)
    item: Value = value[index]
    return item


def check_index(step: tuple[int, ...], dimensions: tuple[int, ...], name: Name) -> None:
    """Raises:
    SourceError: there are too many or too few indices, or one is outside the array.
    """
    if len(step) != len(dimensions):
        raise SourceError(
            f"{name.text} has {len(dimensions)} dimensions, and {len(step)} indices are given",
            name.span,
        )
    for index, size in zip(step, dimensions, strict=True):
        if not 1 <= index <= size:
            raise SourceError(f"index {index} of {name.text} is outside 1 to {size}", name.span)


def component(step: str, type_: Type, dimensions: tuple[int, ...], name: Name) -> tuple[int, Type]:
    """Place from 0 and type of a component.

    Raises:
        SourceError: there is none of that name.
    """
    if isinstance(type_, Foreign):
        return 0, type_
    if dimensions:
        raise SourceError(f"{name.text} is an array: an index must come before .{step}", name.span)
    if isinstance(type_, Scalar) or step not in type_.components:
        what = (
            f"a {type_.name} has no components"
            if isinstance(type_, Scalar)
            else f"the components of a {type_.name} are {', '.join(type_.components)}"
        )
        raise SourceError(f"{name.text} has no component '{step}': {what}", name.span)
    return list(type_.components).index(step), type_.components[step]


def replaced(
    old: Value, cell: Cell, path: list[str | tuple[int, ...]], new: Value, name: Name
) -> Value:
    """``old``, the value of ``cell``, with the part at ``path`` replaced.

    Raises:
        SourceError: there is no such part, or ``new`` is of another type.
    """
    places: list[int] = []
    type_: Type = cell.type
    dimensions = cell.dimensions
    for step in path:
        if isinstance(step, tuple):
            check_index(step, dimensions, name)
            dimensions = ()
            places += [i - 1 for i in step]
        else:
            position, type_ = component(step, type_, dimensions, name)
            places.append(position)
    wrong = array_mismatch(new, type_, dimensions)
    if wrong is not None:
        raise SourceError(f"{name.text}: {wrong}", name.span)
    return _put(old, places, interpreted(new, type_, name.span))


def _put(old: Value, places: list[int], new: Value) -> Value:
    if not places:
        return new
    if isinstance(old, Unknown):
        return old
    assert isinstance(old, tuple)
    items = list(old)
    items[places[0]] = _put(items[places[0]], places[1:], new)
    return tuple(items)


def default_value(
    declaration: Declaration, type_: Scalar | RecordType, sizes: tuple[int, ...]
) -> Value:
    """The value of a variable without an initial value."""
    count = 1
    for size in sizes:
        count *= size
        if count > ARRAY_LIMIT:
            raise SourceError(
                f"{declaration.text} has more than {ARRAY_LIMIT} elements", declaration.span
            )
    value: Value = type_.default
    for size in reversed(sizes):
        value = (value,) * size
    return value


def array_mismatch(value: Value, type_: Type, sizes: tuple[int, ...]) -> str | None:
    """What keeps a value from being of a type, or an array of it; see `mismatch`."""
    if not sizes or isinstance(value, Unknown):
        return mismatch(value, type_)
    if not isinstance(value, tuple) or len(value) != sizes[0]:
        found = f"{len(value)}" if isinstance(value, tuple) else "one value"
        return f"an array of {sizes[0]} elements is wanted, not {found}"
    for number, item in enumerate(value):
        wrong = array_mismatch(item, type_, sizes[1:])
        if wrong is not None:
            return f"element {number + 1}: {wrong}"
    return None
