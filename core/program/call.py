"""A routine that was entered: only what its body does is left among a program's statements."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Span


@dataclass(frozen=True, slots=True)
class Call:
    """A call of one of the program's own routines, as it was carried out.

    Args:
        text: the call as it stands in the source, with its arguments.
        before: how many of the program's statements come before it.
        span: where in the source.
    """

    text: str
    before: int
    span: Span
