"""What the routines and loops of a source have made of a program's statements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ..errors import Span


@dataclass(frozen=True, slots=True)
class Section:
    """One call of a routine, or one execution of a loop.

    Args:
        name: of the routine; of a loop what the text calls it, ``WHILE TRUE``.
        begin, end: indices of its statements, ``end`` behind the last.
        span: where it is called, or where the loop stands.
        passes: index of the first statement of each pass of a loop; empty for a routine.
        endless: whether production runs in the loop: nothing known ends it.
        tested: whether the loop has a condition.
    """

    name: str
    begin: int
    end: int
    span: Span
    passes: tuple[int, ...] = ()
    endless: bool = False
    tested: bool = False

    @property
    def bodies(self) -> tuple[tuple[int, int], ...]:
        """Begin and end of what is carried out each time: of every pass, or of the call."""
        if not self.passes:
            return ((self.begin, self.end),)
        return tuple(zip(self.passes, (*self.passes[1:], self.end), strict=True))


def moved(sections: Sequence[Section], places: Sequence[int]) -> tuple[Section, ...]:
    """The sections of a program whose statements have other places now.

    Args:
        places: (n + 1,) for each of the n old statements, and behind the last, the index at which
            what has become of it begins.
    """
    return tuple(
        replace(
            section,
            begin=places[section.begin],
            end=places[section.end],
            passes=tuple(places[index] for index in section.passes),
        )
        for section in sections
    )
