"""The cycle of a program that runs in a loop without an end, as production does."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Span


@dataclass(frozen=True, slots=True)
class Cycle:
    """The last cycle that was read of a loop which nothing known ends: a pass, or the passes after
    which the data that decide about its motion are what they were.

    Args:
        begin: index of its first move.
        end: index behind its last move.
        passes: that were read of the loop.
        span: of the loop.
        length: how many of them the cycle has.
    """

    begin: int
    end: int
    passes: int
    span: Span
    length: int = 1
