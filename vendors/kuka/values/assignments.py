"""Assignments: a value into a datum, a component, an item or a character."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from ....core.errors import SourceError, Span
from ..syntax.tree import Name
from .data import Data
from .elements import Names
from .predefined import OUTPUTS
from .scope import Path, Scope, Variable, spelled
from .types import no_component
from .values import Array, Pending, Struct, Unknown, Value, copied, shown

_CODES = 256
"""Of characters."""
_POSE, _ARM = ("x", "y", "z", "a", "b", "c"), ("a1", "a2", "a3", "a4", "a5", "a6")
_WHOLE = {"frame": _POSE, "pos": _POSE, "e6pos": _POSE, "axis": _ARM, "e6axis": _ARM}
"""What a position has at least."""


class Assignment:
    """Assigns."""

    def __init__(self, data: Data, names: Names) -> None:
        self._data = data
        self._names = names

    def assign(
        self, target: Name, value: Value, scope: Scope, span: Span, path: Path | None = None
    ) -> Variable:
        """Give a datum, or a part of it, a value.

        Args:
            path: of the part, if its indices have been evaluated.

        Raises:
            SourceError: it is a constant, or of another type.
        """
        cell = self._data.find(target.name, scope) or self._data.implicit(target)
        if cell.constant:
            raise SourceError(f"{cell.name} is a constant", target.span)
        path = self._names.path(target, scope) if path is None else path
        if cell.signal is not None or target.name in OUTPUTS:
            places = self._names.outputs(target, scope) if cell.signal is not None else None
            self._write_outputs(
                [spelled(OUTPUTS[target.name], path)] if places is None else places, value
            )
            return cell
        self._names.settled(cell)
        cell.assigned = True
        cell.awaited = False
        label = None if self._data.is_system(target.name) else spelled(cell.name, path)
        path = tuple(step for step in path if step != ())
        self._names.course.sets(cell, whole=not path)
        if not path:
            self._assign_whole(cell, value, label, span)
            return cell
        kind = cell.type or _kind_with(path[0])
        if isinstance(cell.value, Unknown) and kind in _WHOLE and isinstance(path[0], str):
            cell.value = _opened(cell.value, kind)
        elif cell.value is None or isinstance(cell.value, Unknown | Pending):
            cell.value = _empty(path[0], cell.type)
        self._assign_part(cell, path, value, label, target, span)
        return cell

    def _write_outputs(self, places: list[str], value: Value) -> None:
        """One output, or the bits of several, the lowest first."""
        known = isinstance(value, bool | int | float)
        for k, place in enumerate(places):
            part: bool | float | None = None
            if known and len(places) == 1:
                part = value if isinstance(value, bool) else float(value)  # type: ignore[arg-type]
            elif isinstance(value, int) and not isinstance(value, bool):
                part = bool(value >> k & 1)
            self._data.outputs.write(place, part)

    def _assign_whole(self, cell: Variable, value: Value, label: str | None, span: Span) -> None:
        if isinstance(cell.value, Array):
            if not isinstance(value, Array | Unknown):
                raise SourceError(
                    f"{cell.name} is an array and takes no {shown(value)}: give an index", span
                )
            cell.value = copied(value)
            return
        if isinstance(value, Array):
            raise SourceError(f"{cell.name} is no array", span)
        made = self._names.converted(value, cell.type, label, False, span)
        anonymous = isinstance(value, Struct) and value.type == "" and label is None
        if anonymous and isinstance(made, Struct) and isinstance(cell.value, Struct):
            # An aggregate names what it changes; $VEL={CP 1} leaves the rest alone.
            made.fields = {**cell.value.fields, **made.fields}
        cell.value = made

    def _assign_part(
        self, cell: Variable, path: Path, value: Value, label: str | None, target: Name, span: Span
    ) -> None:
        holder = cell.value
        for step, following in pairwise(path):
            assert holder is not None and not isinstance(holder, Pending)
            part = (
                None
                if isinstance(holder, Unknown)
                else self._names.part(holder, step, target, cell)
            )
            if part is None or isinstance(part, Unknown):
                inner = holder.type if isinstance(holder, Array) else ""
                part = _empty(following, self._component_type(holder, step) or inner)
                self._put(holder, step, part, target)
            holder = part
        last = path[-1]
        if isinstance(holder, Unknown):
            return
        if isinstance(holder, str):
            self._put_character(cell, holder, last, value, target)
            return
        wanted = self._component_type(holder, last)
        assert holder is not None and not isinstance(holder, Pending)
        made = self._names.converted(value, wanted, label, False, span)
        self._put(holder, last, made, target)

    def _component_type(self, holder: object, step: str | tuple[int, ...]) -> str:
        if isinstance(holder, Array):
            return holder.type
        if isinstance(holder, Struct) and isinstance(step, str):
            return self._data.types.get(holder.type, {}).get(step, "")
        return ""

    def _put(self, holder: Value, step: str | tuple[int, ...], value: Value, target: Name) -> None:
        if isinstance(step, str):
            if not isinstance(holder, Struct):
                raise SourceError(f"{target.text} has no components", target.span)
            fields = self._data.types.get(holder.type)
            if fields is not None and step not in fields:
                raise SourceError(str(no_component(holder.type, step, fields)), target.span)
            holder.fields[step] = value
            return
        if not isinstance(holder, Array):
            raise SourceError(f"{target.text} is no array", target.span)
        self._names.check_index(holder, step, target)
        holder.items[step] = value

    @staticmethod
    def _put_character(
        cell: Variable, text: str, step: str | tuple[int, ...], value: Value, target: Name
    ) -> None:
        if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < _CODES:
            value = chr(value)
        if isinstance(value, Unknown):
            return
        if isinstance(step, str) or not isinstance(value, str) or len(step) != 1:
            raise SourceError(
                f"{target.text} takes characters, or their codes from 0 to 255", target.span
            )
        index = step[0] - 1
        if not 0 <= index < 1000:
            raise SourceError(f"index {index + 1} of {target.text} is no place in it", target.span)
        padded = text.ljust(index)
        cell.value = padded[:index] + value[:1] + padded[index + 1 :]


def _kind_with(step: str | tuple[int, ...]) -> str:
    """What is declared in no file at hand, by a component that is written of it."""
    if step in _POSE:
        return "e6pos"
    return "e6axis" if step in _ARM else ""


def _opened(unknown: Unknown, type_name: str) -> Struct:
    """A position of which a component is written, and of the others nobody knows what they are."""
    held = unknown.held.fields if isinstance(unknown.held, Struct) else {}
    names = _WHOLE[type_name]
    return Struct(type_name, {name: replace(unknown, held=held.get(name)) for name in names})


def _empty(step: str | tuple[int, ...], type_name: str) -> Value:
    """What is made where a part is assigned of something that was never set."""
    if isinstance(step, str):
        return Struct(type_name)
    return "" if type_name == "char" else Array(type_name, (None,) * max(1, len(step)))
