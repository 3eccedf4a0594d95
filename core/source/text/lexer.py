"""Text → tokens, as the lexers of all languages do it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from ...errors import SourceError, Span
from .damage import Damage
from .files import unbroken

END, END_OF_LINE, NAME = "end of file", "end of line", "name"
STRAY = "character"
"""What no token begins with, in a damaged text that is read all the same."""
"""Kinds of token that languages have in common."""
UNCLOSED = "this string has no closing quote on its line"


class Places(Protocol):
    """A text whose offsets are places, such as `core.source.text.SourceText`."""

    def span(self, start: int, end: int) -> Span:
        """The stretch from ``start`` to before ``end``."""

    def error(self, message: str, start: int, end: int | None = None) -> SourceError:
        """An error at ``start``, to be raised."""

    @property
    def damage(self) -> Damage | None:
        """What is wrong in it and stepped over; None where an error ends its reading."""


Source = TypeVar("Source", bound=Places)
Special = Callable[[list[str], int, int], tuple[str, int]]
"""Kind and end of a token: of the kinds before it and of the offsets between which it was found;
without a kind it is left out."""


@dataclass(frozen=True, slots=True)
class Tokens(Generic[Source]):
    """The tokens of a text, as parallel lists that end with an `END`.

    Args:
        source: what the offsets count in.
        text: what the tokens were found in.
        base: offset of its first character.
        kinds: a kind that has a name, or the symbol or keyword itself.
        starts, ends: offsets.
    """

    source: Source
    text: str
    base: int
    kinds: list[str]
    starts: list[int]
    ends: list[int]


@dataclass(frozen=True, slots=True)
class Lexicon:
    """What the tokens of a language look like.

    Args:
        token: finds a token and what may stand in front of it; its groups are ``name``, ``symbol``,
            ``end``, and other kinds of token.
        blank: what may stand in front of a token.
        keywords: names that are kinds of their own.
        stray: the message for what no token begins with, of a text and an offset.
        fold: makes a name of a keyword as it is listed.
    """

    token: re.Pattern[str]
    blank: re.Pattern[str]
    keywords: frozenset[str]
    stray: Callable[[str, int], str]
    fold: Callable[[str], str] = str.lower

    def tokens(
        self,
        source: Source,
        text: str,
        *,
        start: int = 0,
        base: int = 0,
        special: Mapping[str, Special] | None = None,
    ) -> Tokens[Source]:
        """All tokens of a text from an offset on.

        Args:
            source, text, base: see `Tokens`.
            start: offset in ``text``.
            special: groups that a function looks at, for kind and end; others are kinds.

        Raises:
            SourceError: a character that no token begins with.
        """
        kinds: list[str] = []
        starts: list[int] = []
        ends: list[int] = []
        looks = {} if special is None else special
        fold, keywords, position = self.fold, self.keywords, start
        seen = unbroken(text)
        groups = {number: group for group, number in self.token.groupindex.items()}
        follow = self.token.scanner  # type: ignore[attr-defined]  # as `re.Scanner` uses it
        match = follow(seen, position).match  # each goes on where the last one ended
        while True:
            found = match()
            if found is None:
                blank = self.blank.match(seen, position)
                at = position if blank is None else blank.end()
                if source.damage is None:
                    raise source.error(self.stray(seen, at), at + base)
                source.damage.characters[at + base] = self.stray(seen, at)
                position = _behind_stray(seen, at)
                match = follow(seen, position).match
                kinds.append(STRAY)
                starts.append(at + base)
                ends.append(position + base)
                continue
            group = found.lastindex or 0
            kind = groups[group]
            start, position = found.span(group)
            if kind == "symbol":
                kind = seen[start:position]
            elif kind == "name":
                word = fold(seen[start:position])
                if word in keywords:
                    kind = word
            elif kind in looks:
                kind, end = looks[kind](kinds, start, position)
                if end != position:
                    position = end
                    match = follow(seen, position).match
                if not kind:
                    continue
            elif kind == "end":
                kind = END
            kinds.append(kind)
            starts.append(start + base)
            ends.append(position + base)
            if kind == END:
                return Tokens(source, text, base, kinds, starts, ends)


def _behind_stray(text: str, at: int) -> int:
    """Where a text goes on behind what no token begins with: of a string that is not closed, at
    the end of its line."""
    if text[at] not in "\"'":
        return at + 1
    rest = _REST.match(text, at)
    return at + 1 if rest is None else rest.end()


_REST = re.compile(r"[^\r\n]*")


def words(text: str) -> frozenset[str]:
    """The words of a text, for tables of names."""
    return frozenset(text.split())


def stray(character: str, text: str, instead: str = "") -> str:
    """The message for a character that no token begins with.

    Args:
        character: as it stands in the file.
        text: what the file should be: "a RAPID text".
        instead: what may help with a file that is binary.
    """
    if character == "\0" or not character.isprintable():
        where = f"character {ord(character):#04x} does not belong in {text}"
        return f"{where}: the file is binary or damaged{instead}"
    return f"{character!r} does not belong here"
