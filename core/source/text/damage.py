"""Damage in a text: statements that are no statements, stepped over so that the rest is driven.

A controller takes no file that holds one; who has a backup of seventy modules wants to know what
the others drive all the same. Where a text is so damaged that nothing holds it together (a block
that nobody closes), or nothing is left to drive, its first damage is the error.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...errors import Note, ParseError, SourceError

STEPPED_OVER = "it is stepped over, and moves that depend on what it would set are faults"
"""What is done about most damage."""
MOST = 40
"""Statements of a file that are stepped over; a text with more of them is another language's."""
_TOLD = 8
"""Of a file that have a note of their own."""

_WORD = re.compile(r"[^\W\d]\w*")


class Damage:
    """What is wrong in one text.

    Attributes:
        errors: in the order in which they were met.
        characters: by its offset, the message for a character that no token begins with.
        torn: whether a block is not closed, so that nothing can be stepped over.
    """

    def __init__(self) -> None:
        self.errors: list[SourceError] = []
        self.characters: dict[int, str] = {}
        self._mended: list[str] = []
        self.torn = False

    def step_over(self, error: SourceError, then: str = STEPPED_OVER) -> None:
        """Go on behind an error.

        Args:
            error: what is wrong.
            then: what is done about it.

        Raises:
            SourceError: the text is torn, or damaged too often.
        """
        if self.torn or len(self.errors) >= MOST or not isinstance(error, ParseError):
            raise self.first(error) from None
        self.errors.append(error)
        self._mended.append(then)

    def first(self, error: SourceError) -> SourceError:
        """The first of all errors, of which a later one may be a consequence."""
        return self.errors[0] if self.errors else error

    def notes(self) -> tuple[Note, ...]:
        """What is to be said about it."""
        found = [
            Note(f"{error.message}: no controller takes this; {then}", span=error.span, damage=True)
            for error, then in zip(self.errors[:_TOLD], self._mended, strict=False)
        ]
        rest = len(self.errors) - len(found)
        if rest:
            span = self.errors[_TOLD].span
            found.append(Note(f"{rest} further such places in the file", span=span, damage=True))
        return tuple(found)


def words_in(text: str) -> frozenset[str]:
    """The words of a damaged stretch of text."""
    return frozenset(_WORD.findall(text))


def nothing_driven(damages: Sequence[Damage], driven: bool) -> None:
    """Refuse a damaged program of which nothing is left to drive.

    Raises:
        SourceError: the first damage.
    """
    found = next((damage.errors[0] for damage in damages if damage.errors), None)
    if found is not None and not driven:
        raise found
