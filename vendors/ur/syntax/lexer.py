"""Text → tokens.

One compiled pattern finds every token; blanks, comments and PolyScope's markers (``$ 3 "MoveJ"``)
are part of the pattern in front of it. A list or a pose of nothing but numbers is one token:
exported programs consist of little else.

Sources: "The URScript Programming Language", numbers, variables and types; program label.
"""

from __future__ import annotations

import math
import re

from ....core.source.text import lexer
from ....core.source.text.files import unbroken
from ....core.source.text.lexer import UNCLOSED, Lexicon, stray, words
from .texts import Texts

KEYWORDS = words(
    """and break continue def elif else end enter_critical exit_critical False global halt if join
    kill local None not or pass return run sec thread True while xor"""
)
"""Reserved words. Upper and lower case differ."""

END, LINE, NAME = lexer.END, lexer.END_OF_LINE, lexer.NAME
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
      | (?P<bracket> [()\[\]] )
      | (?P<symbol> == | != | <= | >= | << | >> | [-+*/%=<>,:.;&|^~≟] )
      | (?P<end> \Z )
    )""",
    re.VERBOSE,
)
_SKIPPED = re.compile(_BLANK, re.VERBOSE)
_NUMBER_IN_LIST = re.compile(_SIGNED, re.VERBOSE)
Tokens = lexer.Tokens[Texts]


def tokenize(texts: Texts, which: int) -> Tokens:
    """All tokens of one of the texts; ends of line inside brackets and empty lines are left out.

    Raises:
        SourceError: a character that no token begins with, or a string without an end.
    """
    text = unbroken(texts.sources[which].text)
    depth = 0

    def bracket(_: list[str], start: int, end: int) -> tuple[str, int]:
        nonlocal depth
        depth = max(depth + (1 if text[start] in "([" else -1), 0)
        return text[start], end

    def line(kinds: list[str], _: int, end: int) -> tuple[str, int]:
        nonlocal depth
        if depth and texts.damage is not None and _begins_statement(kinds, text, end):
            depth = 0  # a bracket that nobody closes
        return "" if depth or kinds[-1:] in ([], [LINE]) else LINE, end

    special = {"bracket": bracket, "line": line}
    found = _LEXICON.tokens(texts, text, base=texts.bases[which], special=special)
    kinds = found.kinds
    for index, kind in enumerate(kinds):
        if kind == "." and kinds[index + 1] in KEYWORDS:  # the part `.sec` of a time is a name
            kinds[index + 1] = NAME
    return found


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


_OPEN = frozenset({*"([,+-*/%=<>&|^~.:", "==", "!=", "<=", ">=", "and", "or", "xor", "not"})
"""Kinds of token behind which a line goes on."""
_STATEMENT = re.compile(
    r"\s*(?:(?:end|if|while|def|thread|else|elif|return|global|local|halt)\b|\w+\s*[(=])"
)


def _begins_statement(kinds: list[str], text: str, end: int) -> bool:
    """Whether a new statement begins behind an end of line inside brackets."""
    return bool(kinds) and kinds[-1] not in _OPEN and _STATEMENT.match(text, end) is not None


def _stray(text: str, at: int) -> str:
    character = text[at]
    if character in "\"'":
        return UNCLOSED
    if character in "{}":
        return (
            f"'{character}' does not belong in a URScript: is this a template whose placeholders "
            "are still to be filled in? Fill them in and read it again"
        )
    if character in "“”„‘’«»":
        return f"{character} is no quote of URScript: write \" or '"
    if character == "<" and text.startswith("<?xml"):
        return "this is XML and no URScript: export the program as .script"
    instead = " (.urp files are compressed: export the program as .script)"
    return stray(character, "a URScript", instead)


_LEXICON = Lexicon(_TOKEN, _SKIPPED, KEYWORDS, _stray, fold=str)
