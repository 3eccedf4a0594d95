"""Where the numbers of a move come from in its source."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from ..errors import Span


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
    """

    ownership: Ownership
    span: Span
    datum: str | None = None
    numbers: tuple[Span | None, ...] = ()


@dataclass(frozen=True, slots=True)
class MoveOrigin:
    """The sources of a move's parts."""

    statement: Span
    target: Origin
    speed: Origin
    zone: Origin
    via: Origin | None = None
