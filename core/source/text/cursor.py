"""A place in a list of tokens, and the few moves from which every language's parser is made."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import ClassVar, Generic, Self, TypeVar

from ...errors import ParseError, SourceError, Span
from .damage import STEPPED_OVER
from .lexer import END, END_OF_LINE, NAME, STRAY, Source, Tokens
from .nodes import Block, jumps_nowhere, no_label

Item = TypeVar("Item")

NESTING_LIMIT = 60
"""Brackets and blocks inside each other; what goes deeper is damaged or hostile."""

_SHOWN = 40
"""Characters of a token that a message repeats."""


class TokenCursor(Generic[Source]):
    """Reads tokens from left to right; a language's own cursor derives from it.

    Attributes:
        keywords: kinds that are keywords, and how a message writes them.
        nouns: what a message calls tokens of the kinds that do not name themselves well.
        index: of the token that comes next.
        depth: brackets and blocks that are open.
        jumps: whether a jump was read since `check_jumps`.
    """

    keywords: ClassVar[Mapping[str, str]]
    nouns: ClassVar[Mapping[str, str]]

    def __init__(self, tokens: Tokens[Source]) -> None:
        self.source = tokens.source
        self.kinds = tokens.kinds
        self.starts = tokens.starts
        self.ends = tokens.ends
        self._text = tokens.text
        self._base = tokens.base
        self.index = 0
        self.depth = 0
        self.jumps = False

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
        index, base = self.index, self._base
        return self._text[self.starts[index] - base : self.ends[index] - base]

    def span_from(self, start: int) -> Span:
        """From an offset to the end of the token gone past last, ends of line left out."""
        index = self.index - 1
        while index > 0 and self.kinds[index] == END_OF_LINE:
            index -= 1
        return self.source.span(start, max(start, self.ends[index] if self.index else start))

    def peek(self, ahead: int = 1) -> str:
        """Kind of the token ``ahead`` places after the next one."""
        index = self.index + ahead
        return self.kinds[index] if index < len(self.kinds) else END

    def advance(self) -> None:
        """Go past the next token (never past the end)."""
        if self.kinds[self.index] != END:
            self.index += 1

    def accept(self, kind: str) -> bool:
        """Go past the next token if it is a ``kind``, which is not `END`."""
        if self.kinds[self.index] == kind:
            self.index += 1
            return True
        return False

    def expect(self, kind: str, where: str) -> None:
        """Go past the next token, which must be a ``kind`` and not `END`.

        Raises:
            SourceError: it is something else; ``where`` says what it should follow or end.
        """
        if self.kinds[self.index] != kind:
            raise self.unexpected(f"{self._wanted(kind)} {where}")
        self.index += 1

    def name(self, what: str) -> str:
        """Go past a name and return it as it stands.

        Raises:
            SourceError: there is none where ``what`` should stand.
        """
        if self.kinds[self.index] != NAME:
            raise self.unexpected(what)
        text = self.text
        self.index += 1
        return text

    def listed(self, item: Callable[[Self], Item]) -> tuple[Item, ...]:
        """What ``item`` reads, once or more, with commas between."""
        items = [item(self)]
        while self.accept(","):
            items.append(item(self))
        return tuple(items)

    def unexpected(self, wanted: str) -> SourceError:
        """The error that ``wanted`` should stand where the next token is."""
        if self.kind == END:
            message = f"the file ends where {wanted} should follow: it is cut off or incomplete"
        elif self.kind == STRAY:
            damage = self.source.damage
            message = "" if damage is None else damage.characters[self.start]
        elif self.kind == END_OF_LINE:
            message = f"the line ends where {wanted} should stand"
        else:
            message = f"{self._found()} stands where {wanted} should"
        return self.source.error(message, self.start, self.ends[self.index])

    def torn(self, wanted: str) -> SourceError:
        """The error that a block is not closed, behind which nothing can be read."""
        if self.source.damage is not None:
            self.source.damage.torn = True
        return self.unexpected(wanted)

    def step_over(self, error: SourceError, then: str = STEPPED_OVER) -> None:
        """Go on behind a statement that is none.

        Args:
            error: what is wrong.
            then: what is done about it.

        Raises:
            SourceError: that cannot be done, or may not in this text.
        """
        if self.source.damage is None:
            raise error
        self.source.damage.step_over(error, then)

    def check_jumps(self, body: Block, around: frozenset[str] = frozenset()) -> None:
        """Refuse jumps that lead nowhere, as controllers do when they load a program.

        Args:
            body: of the routine that was read.
            around: names of further labels that its jumps may lead to.

        Raises:
            SourceError: there is one, and programs are read as a whole or not at all.
        """
        for jump in jumps_nowhere(body, around) if self.jumps else ():
            error = ParseError(no_label(jump).message, jump.span)
            self.step_over(error, "the program ends where it is carried out")

    def begins_line(self) -> bool:
        """Whether the next token is the first of its line, which the last token does not share."""
        if self.index == 0:
            return True
        if self.kinds[self.index - 1] == END_OF_LINE or self.kind == END:
            return True
        between = self._text[self.ends[self.index - 1] - self._base : self.start - self._base]
        return "\n" in between or "\r" in between

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
        """Go one level deeper; the counterpart is ``depth -= 1``.

        Raises:
            SourceError: more than `NESTING_LIMIT` levels.
        """
        self.depth += 1
        if self.depth > NESTING_LIMIT:
            raise self.source.error(
                f"more than {NESTING_LIMIT} brackets and blocks inside each other", self.start
            )

    def _wanted(self, kind: str) -> str:
        if kind in self.keywords:
            return self.keywords[kind]
        return f"a {kind}" if kind[:1].isalpha() else f"'{kind}'"

    def _found(self) -> str:
        kind, text = self.kind, self.text
        if kind in self.keywords:
            return f"the keyword {self.keywords[kind]}"
        short = text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."
        return f"the {self.nouns.get(kind, kind)} {short}" if kind[:1].isalpha() else f"'{short}'"
