"""A place in a list of tokens, and the few moves from which the parser is made."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ....core.errors import SourceError
from .lexer import END, KEYWORDS, LINE, NAME, NUMBER, NUMBERS, POSE, STRING, Tokens

NESTING_LIMIT = 60
"""Brackets and blocks inside each other; what goes deeper is damaged or hostile."""


class Cursor:
    """Reads tokens from left to right.

    Args:
        tokens: to be read.

    Attributes:
        depth: brackets and blocks that are open.
        loops: loops that are open in the function that is read.
    """

    def __init__(self, tokens: Tokens) -> None:
        self.texts = tokens.texts
        self.kinds = tokens.kinds
        self.starts = tokens.starts
        self.ends = tokens.ends
        self._text = tokens.text
        self._base = tokens.base
        self.index = 0
        self.depth = 0
        self.loops = 0

    @property
    def kind(self) -> str:
        """Kind of the token that comes next."""
        return self.kinds[self.index]

    @property
    def start(self) -> int:
        """Where the token that comes next begins."""
        return self.starts[self.index]

    @property
    def end(self) -> int:
        """Where the token gone past last ends."""
        return self.ends[self.index - 1]

    @property
    def text(self) -> str:
        """The token that comes next, as it stands."""
        index = self.index
        return self._text[self.starts[index] - self._base : self.ends[index] - self._base]

    def peek(self) -> str:
        """Kind of the token after the next one."""
        return self.kinds[self.index + 1] if self.index + 1 < len(self.kinds) else END

    def advance(self) -> None:
        """Go past the next token (never past the end)."""
        if self.kinds[self.index] != END:
            self.index += 1

    def accept(self, kind: str) -> bool:
        """Go past the next token if it is a ``kind``."""
        if self.kinds[self.index] == kind:
            self.index += 1
            return True
        return False

    def expect(self, kind: str, where: str) -> None:
        """Go past the next token, which must be a ``kind``.

        Raises:
            SourceError: it is something else; ``where`` says what it should follow or end.
        """
        if self.kinds[self.index] != kind:
            raise self.unexpected(f"{_shown(kind)} {where}")
        self.index += 1

    def name(self, what: str) -> str:
        """Go past a name and return it."""
        if self.kinds[self.index] != NAME:
            raise self.unexpected(what)
        text = self.text
        self.index += 1
        return text

    def skip_lines(self) -> None:
        """Go past ends of line and semicolons."""
        while self.kinds[self.index] in (LINE, ";"):
            self.index += 1

    def unexpected(self, wanted: str) -> SourceError:
        """The error that ``wanted`` should stand where the next token is."""
        if self.kind == END:
            message = f"the file ends where {wanted} should follow: it is cut off or incomplete"
        else:
            message = f"{_found(self.kind, self.text)} stands where {wanted} should"
        return self.texts.error(message, self.start, self.ends[self.index])

    def where(self, offset: int) -> str:
        """The line of an offset, for a message."""
        return f"line {self.texts.span(offset, offset).line}"

    @contextmanager
    def nested(self) -> Iterator[None]:
        """Inside one more bracket or block.

        Raises:
            SourceError: more than `NESTING_LIMIT` of them.
        """
        self.enter()
        yield
        self.depth -= 1

    def enter(self) -> None:
        """Go one level deeper; the counterpart is ``depth -= 1``."""
        self.depth += 1
        if self.depth > NESTING_LIMIT:
            raise self.texts.error(
                f"more than {NESTING_LIMIT} brackets and blocks inside each other", self.start
            )


def _shown(kind: str) -> str:
    if kind in KEYWORDS:
        return f"'{kind}'"
    if kind == LINE:
        return "the end of the line"
    return f"'{kind}'" if not kind[:1].isalpha() else f"a {kind}"


def _found(kind: str, text: str) -> str:
    if kind == LINE:
        return "the end of the line"
    short = text if len(text) <= 40 else text[:37] + "..."
    if kind in KEYWORDS:
        return f"the keyword {text}"
    kinds = {NAME: "the name", NUMBER: "the number", STRING: "the string"}
    kinds |= {POSE: "the pose", NUMBERS: "the list"}
    return f"{kinds[kind]} {short}" if kind in kinds else f"'{short}'"
