"""The moves of a parser over tokens, and the messages where a token is not the wanted one."""

from __future__ import annotations

import re
from typing import ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.source.text.cursor import NESTING_LIMIT, TokenCursor
from flyby.core.source.text.files import SourceText
from flyby.core.source.text.lexer import END, END_OF_LINE, NAME, Tokens

KEYWORDS = {"if", "do"}
TOKEN = re.compile(r"(?P<word>\w+)|(?P<line>\n)|(?P<symbol>\S)")


def kind_of(match: re.Match[str]) -> str:
    text = match.group()
    if match.lastgroup == "line":
        return END_OF_LINE
    if match.lastgroup == "symbol" or text in KEYWORDS:
        return text
    return "digits" if text.isdigit() else NAME


class Cursor(TokenCursor[SourceText]):
    """Of a language of words, numbers, symbols and two keywords."""

    keywords: ClassVar = {word: word.upper() for word in KEYWORDS}
    nouns: ClassVar = {"digits": "number"}


def at(text: str, base: int = 0) -> Cursor:
    """The beginning of a text whose first character has the offset ``base``."""
    matches = list(TOKEN.finditer(text))
    tokens = Tokens(
        SourceText("\0" * base + text, "a.txt"),
        text,
        base,
        [*map(kind_of, matches), END],
        [*(base + match.start() for match in matches), base + len(text)],
        [*(base + match.end() for match in matches), base + len(text)],
    )
    return Cursor(tokens)


@given(st.text("ab1if+ \n", max_size=30), st.integers(0, 50))
def test_going_forward_meets_every_token_and_stays_at_the_end(text: str, base: int) -> None:
    cursor = at(text, base)
    met = []
    for match in TOKEN.finditer(text):
        assert cursor.kind == kind_of(match)
        assert cursor.start == base + match.start()
        following = cursor.peek()
        met.append(cursor.text)
        cursor.advance()
        assert cursor.kind == following
        assert cursor.end == base + match.end()
    assert met == [m.group() for m in TOKEN.finditer(text)]
    cursor.advance()
    assert (cursor.kind, cursor.text, cursor.peek(), cursor.peek(9)) == (END, "", END, END)


@given(st.text("ab1if+ \n", max_size=30), st.sampled_from([NAME, "digits", "if", "+"]))
def test_accept_goes_on_exactly_where_expect_does(text: str, kind: str) -> None:
    accepting, expecting = at(text), at(text)
    if accepting.accept(kind):
        expecting.expect(kind, "here")
        assert accepting.index == expecting.index == 1
    else:
        with pytest.raises(SourceError):
            expecting.expect(kind, "here")
        assert accepting.index == expecting.index == 0


def test_a_name_is_returned_as_it_stands() -> None:
    cursor = at("Größe 1")
    assert cursor.name("a target") == "Größe"
    with pytest.raises(SourceError, match="the number 1 stands where a target should"):
        cursor.name("a target")


@pytest.mark.parametrize(
    ("text", "kind", "complaint"),
    [
        ("a", "if", "the name a stands where IF here should"),
        ("if", ")", r"the keyword IF stands where '\)' here should"),
        ("1", NAME, "the number 1 stands where a name here should"),
        ("+", NAME, r"'\+' stands where a name here should"),
        ("\n", NAME, "the line ends where a name here should stand"),
        ("", NAME, "the file ends where a name here should follow: it is cut off"),
        ("a" * 41, "+", rf"the name {'a' * 37}\.\.\. stands"),
    ],
)
def test_what_is_not_expected_is_named(text: str, kind: str, complaint: str) -> None:
    with pytest.raises(SourceError, match=complaint):
        at(text).expect(kind, "here")


def test_an_unexpected_token_is_the_place_of_the_error() -> None:
    cursor = at("a\nb 12", base=7)
    for _ in range(3):
        cursor.advance()
    span = cursor.unexpected("a value").span
    assert span is not None and (span.start, span.end, span.line, span.column) == (11, 13, 2, 3)


@given(st.integers(0, 3 * NESTING_LIMIT))
def test_nesting_ends_at_its_limit(levels: int) -> None:
    def descend(left: int) -> None:
        if left:
            with cursor.nested():
                descend(left - 1)

    cursor = at("a")
    if levels <= NESTING_LIMIT:
        descend(levels)
        assert cursor.depth == 0
    else:
        with pytest.raises(SourceError, match=f"more than {NESTING_LIMIT} brackets and blocks"):
            descend(levels)
