"""Components of records and elements of arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from ....core.errors import SourceError, Span
from ..syntax.tree import Name
from .errors import NUMBERS, OUT_OF_BOUNDS, ProgramError
from .located import Located
from .scope import Variable
from .types import (
    BUILT_IN,
    Foreign,
    RecordType,
    Scalar,
    Type,
    Unknown,
    Value,
    interpreted,
    mismatch,
)

ARRAY_LIMIT = 100_000
"""Elements of an array; a controller holds fewer."""


def item(value: Value, index: int) -> Value:
    """A component or element by its place from 0; unknown of an unknown value."""
    if isinstance(value, Unknown):
        known = value.nominal
        part = known[index] if isinstance(known, tuple) and index < len(known) else None
        return replace(value, nominal=part)
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
            message = f"index {index} of {name.text} is outside 1 to {size}"
            raise ProgramError(message, name.span, NUMBERS[OUT_OF_BOUNDS])


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


def located_part(
    cell: Variable, value: Value, path: Sequence[str | tuple[int, ...]], name: Name
) -> Located:
    """An element or component of a datum, with the place that it was read from.

    Args:
        value: of all of it, but for the elements that were written of late.

    Raises:
        SourceError: there is no such part.
    """
    source = None if path[0] in cell.overwritten else cell.source
    type_: Type = cell.type
    dimensions = cell.dimensions
    for step in path:
        if isinstance(step, tuple):
            check_index(step, dimensions, name)
            dimensions = ()
            label = "{" + ",".join(str(i) for i in step) + "}"
            for place, index in enumerate(step):
                value = item(value, index - 1)
                shown = label if place == len(step) - 1 else ""
                source = source.part(index - 1, shown) if source else None
            value = cell.elements.get(step, value)
        else:
            position, type_ = component(step, type_, dimensions, name)
            value = item(value, position)
            source = source.part(position, f".{step}") if source else None
    return Located(value, source, cell, type=type_)


def replaced(
    old: Value, cell: Variable, path: list[str | tuple[int, ...]], new: Value, name: Name
) -> Value:
    """``old`` with the part at ``path`` replaced.

    Args:
        old: the value of ``cell``, or of the element that ``path`` begins with.

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
        else:
            position, type_ = component(step, type_, dimensions, name)
            places.append(position)
    wrong = array_mismatch(new, type_, dimensions)
    if wrong is not None:
        raise SourceError(f"{name.text}: {wrong}", name.span)
    return _put(old, places, interpreted(new, type_, name.span))


def element(cell: Variable, index: tuple[int, ...]) -> Value:
    """An element of an array; the index has been checked."""
    if index in cell.elements:
        return cell.elements[index]
    value = cell.value
    assert value is not None
    for place in index:
        value = item(value, place - 1)
    return value


def gathered(value: Value, elements: Mapping[tuple[int, ...], Value]) -> Value:
    """An array with other elements, by index from 1, all at once."""
    if not isinstance(value, tuple):
        return value
    items = list(value)
    rows: dict[int, dict[tuple[int, ...], Value]] = {}
    for (first, *rest), new in elements.items():
        if rest:
            rows.setdefault(first - 1, {})[tuple(rest)] = new
        else:
            items[first - 1] = new
    for place, row in rows.items():
        items[place] = gathered(items[place], row)
    return tuple(items)


def _put(old: Value, places: list[int], new: Value) -> Value:
    if not places:
        return new
    if isinstance(old, Unknown):
        known = old.nominal
        return replace(old, nominal=_put(known, places, new)) if isinstance(known, tuple) else old
    assert isinstance(old, tuple)
    items = list(old)
    items[places[0]] = _put(items[places[0]], places[1:], new)
    return tuple(items)


def written_by_others(
    value: Value, type_: Type, sizes: Sequence[int], name: str, span: Span
) -> tuple[Value, list[str]]:
    """A datum as others may have written it, and the names of its parts of which that holds: what
    stands by itself, as commands do, and not the numbers of targets, tools and their like.

    Args:
        sizes: of an array.
        span: of what reads it.
    """
    if isinstance(value, tuple) and sizes:
        found = [written_by_others(part, type_, sizes[1:], name, span) for part in value]
        return tuple(part for part, _ in found), next((left for _, left in found if left), [])
    if isinstance(type_, Scalar) and not isinstance(value, Unknown):
        return Unknown(f"the value of {name}, which others write", span, nominal=value), [name]
    if not isinstance(value, tuple) or not isinstance(type_, RecordType):
        return value, []
    if type_.name in BUILT_IN:
        return value, []
    parts = zip(value, type_.components.items(), strict=True)
    made = [written_by_others(one, kind, (), f"{name}.{word}", span) for one, (word, kind) in parts]
    return tuple(part for part, _ in made), [word for _, left in made for word in left]


def check_size(name: str, sizes: tuple[int, ...], span: Span) -> None:
    """Raises:
    SourceError: an array is larger than any controller's memory.
    """
    if math.prod(sizes) > ARRAY_LIMIT:
        raise SourceError(f"{name} has more than {ARRAY_LIMIT} elements", span)


def filled(value: Value, sizes: tuple[int, ...]) -> Value:
    """An array with one value in all its elements; the value itself if there are no sizes."""
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
