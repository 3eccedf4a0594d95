"""Values at run time.

INT is ``int``, REAL ``float``, BOOL ``bool``, a CHAR array ``str``; constants of enumerations,
structures and arrays have classes of their own. A number that was read from a literal and not
computed with remembers it (`Whole`, `Real`): arithmetic gives plain numbers, assignment keeps the
literal. So every number of a target, speed or zone knows whether it may be changed in the text.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from ....core.door import spelt
from ....core.errors import LeftOpenError, LostError, Span
from ....core.files.toml_text import key_text
from ....core.program.tool import Load, Tool, WorkObject
from ....core.source.text.files import SourceText
from ..syntax.tree import Expression


class Root:
    """A literal at its place in the text: a `Source` of `core.source.provenance`.

    Args:
        start, end: offsets of the literal.
        datum: the datum that it is, or belongs to; None for a literal at the place of use.
        leaves: where its numbers stand, by lower-case component (``cm.x``); "" for a number alone.
    """

    __slots__ = ("_place", "_source", "datum", "end", "leaves", "start")

    def __init__(self, source: SourceText, start: int, end: int, datum: str | None) -> None:
        self._source = source
        self._place: Span | None = None
        self.start = start
        self.end = end
        self.datum = datum
        self.leaves: dict[str, tuple[int, int]] = {}

    @property
    def span(self) -> Span:
        """Where the literal stands."""
        place = self._place
        if place is None:
            place = self._place = self._source.span(self.start, self.end)
        return place

    def part(self, component: str) -> Span | None:
        """Where the number of a component stands; a literal stands on one line."""
        found = self.leaves.get(component)
        if found is None:
            return None
        start, end = found
        whole = self.span
        return Span(whole.file, whole.line, whole.column + start - self.start, start, end)


class Leaf:
    """A number of a literal; see `Root`."""

    __slots__ = ("component", "root")

    def __init__(self, root: Root, component: str) -> None:
        self.root = root
        self.component = component


class Real(float):
    """A REAL as it stands in the text."""

    __slots__ = ("leaf",)
    leaf: Leaf

    @classmethod
    def at(cls, value: float, leaf: Leaf) -> Real:
        """The number of a leaf."""
        number = cls(value)
        number.leaf = leaf
        return number


class Whole(int):
    """An INT as it stands in the text."""

    leaf: Leaf

    @classmethod
    def at(cls, value: int, leaf: Leaf) -> Whole:
        """The number of a leaf."""
        number = cls(value)
        number.leaf = leaf
        return number


def leaf_of(value: object) -> Leaf | None:
    """The place that a number was read from; None for a computed one."""
    return value.leaf if isinstance(value, _PLACED) else None


_PLACED = (Real, Whole)


@dataclass(frozen=True, slots=True)
class Choice:
    """A constant of an enumeration, lower case, without its sign."""

    name: str


@dataclass(slots=True)
class Struct:
    """A structure; components that were never set are absent.

    Args:
        type: lower-case name; "" of an aggregate without one.
        fields: values by lower-case name.
        label: the datum that holds it, as ``TOOL_DATA[1]``; None if it is in none.
        shipped: it is what the configuration that comes with this package says, and not the
            user's own.
        moved_by: of a frame: the external axis that carries it.
    """

    type: str
    fields: dict[str, Value] = field(default_factory=dict)
    label: str | None = None
    shipped: bool = False
    moved_by: str | None = None

    def copy(self) -> Struct:
        """A structure of its own with the same values."""
        fields = {k: copied(v) for k, v in self.fields.items()}
        return Struct(self.type, fields, self.label, self.shipped, self.moved_by)


@dataclass(slots=True)
class Array:
    """An array.

    Args:
        type: lower-case name of the items' type.
        sizes: of the dimensions; None for one left open.
        items: values by index (from 1); items that were never set are absent.
    """

    type: str
    sizes: tuple[int | None, ...]
    items: dict[tuple[int, ...], Value | Pending] = field(default_factory=dict)

    def copy(self) -> Array:
        """An array of its own with the same values."""
        items = {k: v if isinstance(v, Pending) else copied(v) for k, v in self.items.items()}
        return Array(self.type, self.sizes, items)


@dataclass(frozen=True, slots=True)
class Placement:
    """Tool, work object and payload of a move.

    Args:
        supposed: what tool and work object depend on that the text does not say.
    """

    tool: Tool
    work_object: WorkObject
    load: Load | None
    supposed: str = ""


@dataclass(frozen=True, slots=True)
class Unknown:
    """A value that only the running controller has.

    Args:
        reason: what it is, for the refusal: ``the value of $IN[3]``.
        span: where it was read.
        here: it is where the robot stood after this many moves; of a pose, with the placement
            that it was asked in.
        held: what motion takes it for: the value before others wrote it, or what was computed
            with zero in its place; None if there is no such value.
        key: under which the user may answer it.
        damaged: a line that is no statement would have set it: motion takes it for nothing.
        others: others may have written it since: it is asked for.
    """

    reason: str
    span: Span
    here: tuple[int, Placement | None] | None = None
    held: Value | None = None
    key: str = ""
    damaged: bool = False
    others: bool = False

    @property
    def answerable(self) -> str:
        """How the user may answer it, to stand at the end of a message."""
        if not self.key:
            return f"answer it in a file ({spelt('answers')}; `flyby ask` writes one)"
        return f"answer it in a file ({spelt('answers')}): [values] {key_text(self.key)} = …"


@dataclass(frozen=True, slots=True)
class Pending:
    """An initial value that is evaluated when it is asked for.

    Args:
        home: stem of the module whose names it uses.
    """

    expression: Expression
    home: str


Value = bool | int | float | str | Choice | Struct | Array | Unknown


def copied(value: Value) -> Value:
    """The value, apart from the datum that it was read from."""
    return value.copy() if isinstance(value, Struct | Array) else value


def unplaced(value: Value) -> Value:
    """The value without the places of its numbers in the text."""
    if isinstance(value, Struct):
        fields = {k: unplaced(v) for k, v in value.fields.items()}
        return Struct(value.type, fields, value.label, value.shipped, value.moved_by)
    if isinstance(value, Real):
        return float(value)
    return int(value) if isinstance(value, Whole) else value


def find_unknown(value: Value | Pending) -> Unknown | None:
    """The first unknown in a value."""
    if isinstance(value, Unknown):
        return value
    if isinstance(value, Struct):
        for part in value.fields.values():
            if isinstance(part, _HOLDING):  # few are
                found = find_unknown(part)
                if found is not None:
                    return found
    return None


_HOLDING = (Unknown, Struct)


def left_open(what: str, unknown: Unknown, span: Span) -> LeftOpenError:
    """The error that something depends on a value that is not known."""
    if unknown.damaged:
        return LostError(f"{what} depends on {unknown.reason}: mend that line", span)
    where = f" (read at line {unknown.span.line})" if unknown.span.line != span.line else ""
    return LeftOpenError(
        f"{what} depends on {unknown.reason}{where}, which the text does not say: name the file "
        f"that says it, or {unknown.answerable}",
        span,
    )


def supposed(value: Value) -> Value:
    """The value that motion takes one for that is not known, as far as there is one."""
    while isinstance(value, Unknown) and value.held is not None and not value.damaged:
        value = value.held
    if isinstance(value, Struct) and any(isinstance(v, Unknown) for v in value.fields.values()):
        fields = {name: supposed(part) for name, part in value.fields.items()}
        return Struct(value.type, fields, value.label, value.shipped, value.moved_by)
    return value


def leaves_in(value: Value, prefix: str = "") -> Iterator[tuple[str, Leaf]]:
    """Every number of a value that stands in the text, with its component's path."""
    if isinstance(value, Struct):
        for name, part in value.fields.items():
            yield from leaves_in(part, f"{prefix}{name}.")
    else:
        leaf = leaf_of(value)
        if leaf is not None:
            yield prefix[:-1], leaf


def shown(value: Value) -> str:
    """A value in a message."""
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, int | float):
        return f"{value:g}" if math.isfinite(value) else "an infinite number"
    if isinstance(value, Choice):
        return f"#{value.name.upper()}"
    if isinstance(value, str):
        return f'the text "{value}"'
    if isinstance(value, Struct):
        return f"a structure {value.type.upper()}".rstrip()
    return "an array" if isinstance(value, Array) else value.reason
