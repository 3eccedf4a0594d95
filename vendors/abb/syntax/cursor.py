"""A place in a list of RAPID's tokens."""

from __future__ import annotations

from collections.abc import Container
from typing import ClassVar

from ....core.source.text.cursor import TokenCursor
from ....core.source.text.files import SourceText
from ....core.source.text.lexer import STRAY
from .lexer import END, KEYWORDS, LITERAL, Tokens


class Cursor(TokenCursor[SourceText]):
    """Reads tokens from left to right.

    Args:
        tokens: to be read.

    Attributes:
        values: of the tokens that are a `LITERAL`, by index.
    """

    keywords: ClassVar = {word: word.upper() for word in KEYWORDS}
    nouns: ClassVar = {LITERAL: "value"}

    def __init__(self, tokens: Tokens) -> None:
        super().__init__(tokens)
        self.values = tokens.values

    def expect(self, kind: str, where: str) -> None:
        """See `TokenCursor.expect`; in a damaged text a line may end without its semicolon."""
        if kind == ";" and self.ends_without_semicolon:
            error = self.source.error(f"the line ends without ';' {where}", self.end)
            self.step_over(error, "it is read as if it stood there")
        else:
            super().expect(kind, where)

    @property
    def ends_without_semicolon(self) -> bool:
        """Whether a statement ends with its line, in a damaged text."""
        if self.source.damage is None or self.kind in (";", ",", "\\"):
            return False
        return self.begins_line()

    def skip_statement(self, begin: int, beginning: Container[str]) -> None:
        """Go behind a damaged statement: its semicolon, or what begins another line.

        Args:
            begin: index of its first token.
            beginning: words that begin statements.
        """
        if self.index > begin and self.begins_line():
            return
        self.index = max(self.index, begin + 1)
        while self.kind != END and not self.accept(";"):
            unclosed = self.kinds[self.index - 1] == STRAY  # a string, and the semicolon in it
            if self.begins_line() and (unclosed or self.kind in beginning):
                return
            self.index += 1
