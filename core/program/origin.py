"""Where the numbers of a move come from in its source."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, overload

from ..errors import Span


class Spans(Sequence[Span | None]):
    """Where numbers stand, looked for when somebody asks: most of a long program's nobody does.

    It equals, and is hashed and stored like, the tuple of them.

    Args:
        find: gives them.
    """

    __slots__ = ("_find", "_found")

    def __init__(self, find: Callable[[], tuple[Span | None, ...]]) -> None:
        self._find = find
        self._found: tuple[Span | None, ...] | None = None

    def _all(self) -> tuple[Span | None, ...]:
        if self._found is None:
            self._found = self._find()
        return self._found

    @overload
    def __getitem__(self, index: int) -> Span | None: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Span | None, ...]: ...
    def __getitem__(self, index: int | slice) -> Span | tuple[Span | None, ...] | None:
        return self._all()[index]

    def __len__(self) -> int:
        return len(self._all())

    def __iter__(self) -> Iterator[Span | None]:
        return iter(self._all())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Spans | tuple):
            return self._all() == tuple(other)
        return NotImplemented

    def __hash__(self) -> int:
        return hash(self._all())

    def __repr__(self) -> str:
        return repr(self._all())

    def __reduce__(self) -> tuple[Any, ...]:
        return tuple, (self._all(),)


class Ownership(StrEnum):
    """Who else reads a datum, and so what may be changed about it."""

    OWNED = "owned"
    """One move alone reads it."""
    SHARED = "shared"
    """Several moves read one datum: one variable in an optimisation."""
    DERIVED = "derived"
    """Computed by the program (an offset, an expression): frozen."""


@dataclass(frozen=True, slots=True)
class Origin:
    """The source of one value (a target, a speed, a zone).

    Args:
        ownership: see `Ownership`.
        span: the expression at the move.
        datum: name of the declared datum read, with its module or routine if needed; None for a
            literal at the move.
        numbers: spans of the literal numbers that make up the value, in the order of the
            vendor's own literal form, None for one that is not written out; empty if the value is
            derived or predefined.
        data: of numbers that come from several literals, name of the datum that each belongs to;
            empty where ``datum`` is the only one, or all stand in one literal.
        base: of a computed target, the name, folded, of a target that it is computed from, where
            somebody has looked for that.
    """

    ownership: Ownership
    span: Span
    datum: str | None = None
    numbers: Sequence[Span | None] = ()
    data: tuple[str | None, ...] = ()
    base: str | None = None

    def datum_of(self, index: int) -> str | None:
        """Name of the datum that a number belongs to; None for a literal where it is used."""
        return self.data[index] if self.data else self.datum


@dataclass(frozen=True, slots=True)
class MoveOrigin:
    """The sources of a move's parts."""

    statement: Span
    target: Origin
    speed: Origin
    zone: Origin
    via: Origin | None = None
