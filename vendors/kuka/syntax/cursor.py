"""A place in a list of KRL's tokens, where words may be names and lines end statements."""

from __future__ import annotations

from typing import ClassVar

from ....core.source.text.cursor import TokenCursor
from ....core.source.text.files import SourceText
from .lexer import BITS, END, ENUM, KEYWORDS, NAME, NEWLINE, RECORD


class Cursor(TokenCursor[SourceText]):
    """Reads tokens from left to right."""

    keywords: ClassVar = {word: word.upper() for word in KEYWORDS}
    nouns: ClassVar = {BITS: "number", ENUM: "constant", RECORD: "aggregate"}

    @property
    def at_end_of_line(self) -> bool:
        """Whether the statement ends here."""
        return self.kinds[self.index] in (NEWLINE, END)

    def accept_word(self, word: str) -> bool:
        """Go past the next token if it is this name, whatever its case."""
        if self.kinds[self.index] == NAME and self.text.lower() == word:
            self.index += 1
            return True
        return False

    def expect_word(self, word: str, where: str) -> None:
        """Go past the next token, which must be this name or keyword.

        Raises:
            SourceError: it is something else.
        """
        if self.kinds[self.index] != word and not (
            self.kinds[self.index] == NAME and self.text.lower() == word
        ):
            raise self.unexpected(f"{word.upper()} {where}")
        self.index += 1

    def word(self, what: str) -> str:
        """Go past a name or a keyword that stands for a name, and return it as it stands."""
        kind = self.kinds[self.index]
        if kind != NAME and kind not in KEYWORDS:
            raise self.unexpected(what)
        text = self.text
        self.index += 1
        return text

    def end_of_line(self, statement: str, closing: frozenset[str] = frozenset()) -> None:
        """Go past the end of the line; a keyword of ``closing`` may stand there too.

        Raises:
            SourceError: something else follows.
        """
        kind = self.kinds[self.index]
        if kind == NEWLINE:
            self.index += 1
        elif kind != END and kind not in closing:
            raise self.unexpected(f"the end of the line, after {statement},")

    def skip_line(self) -> None:
        """Go to the end of the line."""
        while self.kinds[self.index] not in (NEWLINE, END):
            self.index += 1
