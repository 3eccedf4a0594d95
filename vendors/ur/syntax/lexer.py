"""Text → tokens.

One compiled pattern finds every token; blanks, comments and PolyScope's markers (``$ 3 "MoveJ"``)
are part of the pattern in front of it. A list or a pose of nothing but numbers is one token:
exported programs consist of little else.

Sources: "The URScript Programming Language", numbers, variables and types; program label.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ....core.errors import SourceError
from ....core.source.text import cursor
from ....core.source.text.files import unbroken
from ....core.source.text.lexer import UNCLOSED, stray, words
from .texts import Texts

KEYWORDS = words(
    """and break continue def elif else end enter_critical exit_critical False global halt if join
    kill local None not or pass return run sec thread True while xor"""
)
"""Reserved words. Upper and lower case differ."""

END, LINE, NAME = cursor.END, cursor.END_OF_LINE, cursor.NAME
NUMBER, NUMBERS, POSE, STRING = "number", "numbers", "pose", "string"

_DIGITS = r"(?: [0-9]++ (?: \.[0-9]*+ )?+ | \.[0-9]++ ) (?: [eE][+-]?[0-9]++ )?+"
_SIGNED = rf"(?: [-+] [^\S\r\n]*+ )?+ {_DIGITS}"
_LIST = rf"\[ \s*+ {_SIGNED} \s*+ (?: , \s*+ {_SIGNED} \s*+ )*+ \]"
_BLANK = r"""
    (?: [^\S\r\n]++ | [\ufeff\x1a]++ | \#[^\r\n]*+ | \$[^\r\n]*+
      | \\[^\S\r\n]*+(?:\r\n|\r|\n)
    )*+"""
_TOKEN = re.compile(
    rf"""
    {_BLANK}
    (?: (?P<pose> p{_LIST} )
      | (?P<name> [^\W\d]\w*+ )
      | (?P<number> 0[xX][0-9a-fA-F]++ | 0[bB][01]++ | {_DIGITS} )
      | (?P<line> (?: \r\n | \r | \n ) )
      | (?P<numbers> {_LIST} )
      | (?P<string> "[^"\r\n]*+" | '[^'\r\n]*+' )
      | (?P<symbol> == | != | <= | >= | << | >> | [-+*/%=<>()\[\],:.;&|^~≟] )
      | (?P<end> \Z )
    )""",
    re.VERBOSE,
)
_SKIPPED = re.compile(_BLANK, re.VERBOSE)
_NUMBER_IN_LIST = re.compile(_SIGNED, re.VERBOSE)
_OPENING, _CLOSING = ("(", "["), (")", "]")


@dataclass(frozen=True, slots=True)
class Tokens:
    """The tokens of a text, as parallel lists that end with an `END`.

    Ends of line inside brackets are left out, and so are empty lines.

    Args:
        texts: where offsets are looked up.
        text: of this file.
        base: offset of its first character in ``texts``.
        kinds: one of this module's names, or the symbol or keyword itself.
        starts, ends: offsets in ``texts``.
    """

    texts: Texts
    text: str
    base: int
    kinds: list[str]
    starts: list[int]
    ends: list[int]


def tokenize(texts: Texts, which: int) -> Tokens:
    """All tokens of one of the texts.

    Raises:
        SourceError: a character that no token begins with, or a string without an end.
    """
    text, base = unbroken(texts.sources[which].text), texts.bases[which]
    kinds: list[str] = []
    starts: list[int] = []
    ends: list[int] = []
    match = _TOKEN.match
    position = depth = 0
    while True:
        found = match(text, position)
        if found is None:
            raise _stray(texts, text, base, position)
        kind = found.lastgroup or ""
        start, position = found.span(kind)
        if kind == "symbol":
            kind = text[start:position]
            if kind in _OPENING:
                depth += 1
            elif kind in _CLOSING:
                depth = max(depth - 1, 0)
        elif kind == "name":
            word = text[start:position]
            if word in KEYWORDS and kinds[-1:] != ["."]:  # the part `.sec` of a time is a name
                kind = word
        elif kind == "line":
            if depth or not kinds or kinds[-1] == LINE:
                continue
            kind = LINE
        elif kind == "end":
            kind = END
        kinds.append(kind)
        starts.append(start + base)
        ends.append(position + base)
        if kind == END:
            return Tokens(texts, text, base, kinds, starts, ends)


def number_value(literal: str) -> int | float:
    """The value of a number's text, sign included; infinite if it is too large."""
    try:
        if "." in literal:
            return float(literal)
    except ValueError:
        pass  # blanks behind the sign
    text = "".join(literal.split())
    try:
        if text[:1] == "0" and text[1:2] in tuple("xXbB"):
            value = int(text, 0)
            return value if value.bit_length() <= 64 else math.inf
        if not any(c in text for c in ".eE") and len(text) < 16:
            return int(text)
        return float(text)
    except ValueError:  # thousands of digits
        return math.inf


def numbers_in(literal: str) -> list[tuple[int, int]]:
    """Where the numbers stand in the text of a list or pose: start and end, signs included."""
    return [found.span() for found in _NUMBER_IN_LIST.finditer(literal)]


def _stray(texts: Texts, text: str, base: int, position: int) -> SourceError:
    skipped = _SKIPPED.match(text, position)
    start = skipped.end() if skipped else position
    character = text[start]
    at = start + base
    if character in "\"'":
        return texts.error(UNCLOSED, at)
    if character in "{}":
        return texts.error(
            f"'{character}' does not belong in a URScript: is this a template whose placeholders "
            "are still to be filled in? Fill them in and read it again",
            at,
        )
    if character in "“”„‘’«»":
        return texts.error(f"{character} is no quote of URScript: write \" or '", at)
    if character == "<" and text.startswith("<?xml"):
        return texts.error("this is XML and no URScript: export the program as .script", at)
    instead = " (.urp files are compressed: export the program as .script)"
    return texts.error(stray(character, "a URScript", instead), at)
