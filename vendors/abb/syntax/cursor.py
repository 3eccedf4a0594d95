"""A place in a list of RAPID's tokens."""

from __future__ import annotations

from typing import ClassVar

from ....core.source.text.cursor import TokenCursor
from ....core.source.text.files import SourceText
from .lexer import KEYWORDS, LITERAL, Tokens


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
