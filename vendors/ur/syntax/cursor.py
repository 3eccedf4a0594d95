"""A place in a list of URScript's tokens."""

from __future__ import annotations

from typing import ClassVar

from ....core.source.text.cursor import TokenCursor
from .lexer import KEYWORDS, LINE, NUMBERS, Tokens
from .texts import Texts


class Cursor(TokenCursor[Texts]):
    """Reads tokens from left to right.

    Args:
        tokens: to be read.

    Attributes:
        loops: loops that are open in the function that is read.
    """

    keywords: ClassVar = {word: f"'{word}'" for word in KEYWORDS}
    nouns: ClassVar = {NUMBERS: "list"}

    def __init__(self, tokens: Tokens) -> None:
        super().__init__(tokens)
        self.loops = 0

    def skip_lines(self) -> None:
        """Go past ends of line and semicolons."""
        while self.kinds[self.index] in (LINE, ";"):
            self.index += 1

    def where(self, offset: int) -> str:
        """The line of an offset, for a message."""
        return f"line {self.source.span(offset, offset).line}"
