"""Text → tokens.

One compiled pattern finds every token. A line is a statement in KRL, so ends of line are tokens;
blank lines, comments (``;``, folds are comments too) and header lines (``&ACCESS RVP``) between
two statements belong to the one end of line. A flat aggregate, ``{X 10.0,Y 0,S 2}``, is one token:
point files consist of little else, and most points of a file are never asked for.

Sources: KUKA "Quickguide KRL-Syntax" (names, numbers), published programs (header lines, ``'B…'``
and ``'H…'`` literals, ``{E6POS: X …}``).
"""

from __future__ import annotations

import re

from ....core.source.text import lexer
from ....core.source.text.files import SourceText, unbroken
from ....core.source.text.lexer import UNCLOSED, Lexicon, stray, words

KEYWORDS = words(
    """and anin anout b_and b_exor b_not b_or brake case circ circ_rel continue decl def default
    defdat deffct digin else end enddat endfct endfor endif endloop endspline endswitch endwhile
    enum exit exor ext extfct false for global goto halt if import interrupt lin lin_rel loop not
    or ptp ptp_rel ptp_spline repeat resume return scirc scirc_rel signal slin slin_rel spl spl_rel
    spline sptp sptp_rel step struc switch then to trigger true until wait while"""
)
"""Words that a statement or a part of one begins with; other words are names."""

END, NEWLINE, NAME = lexer.END, lexer.END_OF_LINE, lexer.NAME
NUMBER, STRING, BITS, ENUM, RECORD = "number", "string", "bits", "enum", "record"

_NUMBER = r"(?: [0-9]++ (?: \.[0-9]*+ )? | \.[0-9]++ ) (?: [eE][+-]?[0-9]++ )?"
_BITS = r"' [ \t]* [bBhHoO]? [ \t]* [0-9a-fA-F]++ [ \t]* '"
_NAME = r"(?: [^\W\d] | \$ ) [\w$]*+"
_ITEM_VALUE = rf"""
    (?: (?P<number> [+-]? [ \t]* {_NUMBER} ) | (?P<bits> {_BITS} ) | \# [ \t]* (?P<enum> {_NAME} )
      | "(?P<string> [^"\r\n]*+ )" | (?P<truth> true | false ) )"""
_FLAT_VALUE = re.sub(r"\?P<\w+>", "?:", _ITEM_VALUE)
_FLAT_ITEM = rf"{_NAME} (?: [ \t]* \[ [ \t]* \] )? [ \t]* {_FLAT_VALUE} [ \t]*+"
_BLANK = r"[ \t\f\v\xa0\ufeff\x1a]"

CLOSED = "closed fold"
MOTION_WORDS = r"(?: S?PTP | S?LIN | S?CIRC )"
_CLOSED = rf"""
    (?: {MOTION_WORDS} [ \t]++ [^;={{\r\n]{{0,80}}? (?<![$\w.]) Vel [ \t]*+ = [ \t]*+ [.\d]
        [^\r\n;]*+
      | ARC_? (?: ON | SWI | OFF ) [ \t]++ \w++ [ \t]++ {MOTION_WORDS} [ \t]++ [^\r\n;]*+
      | WAIT [ \t]++ FOR [ \t(]++ [^;\r\n]*?
        \b (?: IN | OUT | FLAG | CYCFLAG | TIMER ) [ \t]++ \d++ [ \t]*+ ' [^\r\n;]*+
      | (?: OUT | SYN | PULSE | SET | CHK | WAIT ) [ \t]++ (?: [^;=(\r\n]{{0,80}}? (?<![$\w.]) )?
        (?: State | Time ) [ \t]*+ = [^\r\n;]*+ )"""
"""A line as the teach pendant shows a fold that is closed, see `closed_folds`."""

_TOKENS = rf"""
    (?: {_BLANK}++ | ;[^\r\n]*+ )*+
    (?: %s (?P<name> {_NAME} )
      | (?P<newline> [\r\n]++ (?: {_BLANK}++ | [\r\n]++ | ;[^\r\n]*+ | &[^\r\n]*+ )*+ )
      | (?P<number> {_NUMBER} )
      | (?P<record> \{{ [ \t]*+ (?: {_NAME} [ \t]* : [ \t]*+ )?
            {_FLAT_ITEM} (?: , [ \t]*+ {_FLAT_ITEM} )*+ \}} )
      | (?P<string> " [^"\r\n]*+ " )
      | (?P<bits> {_BITS} )
      | (?P<enum> \# {_BLANK}*+ {_NAME} )
      | (?P<symbol> == | <> | <= | >= | [-+*/=<>()\[\]{{}},:.?!] )
      | (?P<end> \Z )
    )"""
_TOKEN, _TOKEN_OR_CLOSED = (
    re.compile(_TOKENS % first, re.VERBOSE | re.IGNORECASE)
    for first in ("", f"(?P<closed> {_CLOSED} ) |")
)
_ANY_CLOSED = re.compile(rf"^[ \t]*+ {_CLOSED}", re.VERBOSE | re.IGNORECASE | re.MULTILINE)
ITEM = re.compile(
    rf"(?P<name> {_NAME} ) (?: [ \t]* \[ [ \t]* \] )? [ \t]* {_ITEM_VALUE} [ \t]*+ [,}}]",
    re.VERBOSE | re.IGNORECASE,
)
"""One item of a flat aggregate, with the comma or brace behind it."""
RECORD_TYPE = re.compile(rf"\{{ [ \t]* (?P<type> {_NAME} ) [ \t]* :", re.VERBOSE)
_HEADER = re.compile(rf"(?: {_BLANK}++ | [\r\n]++ | ;[^\r\n]*+ | &[^\r\n]*+ )*+", re.VERBOSE)


Tokens = lexer.Tokens[SourceText]


def tokenize(source: SourceText) -> Tokens:
    """All tokens of a text.

    Raises:
        SourceError: a character that no token begins with, or a string without an end.
    """
    header = _HEADER.match(unbroken(source.text))
    start = header.end() if header else 0
    # Few texts hold closed folds, and all others are read without a look for them at every word.
    lexicon = _LEXICON if _ANY_CLOSED.search(source.text) is None else _LEXICON_OF_CLOSED
    return lexicon.tokens(source, source.text, start=start, special=_SPECIAL)


def bits_value(literal: str) -> int:
    """The value of ``'B0101'``, ``'HFF'``, ``'O17'`` or ``'12'``, quotes included.

    Raises:
        ValueError: a digit that the base has not.
    """
    text = literal[1:-1].replace(" ", "").replace("\t", "")
    base = {"b": 2, "h": 16, "o": 8}.get(text[:1].lower())
    # 'B' is also a hexadecimal digit, but a literal without its base is decimal.
    return int(text[1:], base) if base is not None else int(text)


def _stray(text: str, at: int) -> str:
    if text[at] == '"':
        return UNCLOSED
    if text[at] == "'":
        return "this is no number in quotes: 'B0101' and 'H1F' are"
    return stray(text[at], "a KRL text")


_SKIPPED = re.compile(rf"(?:{_BLANK}++|;[^\r\n]*+)*+")
_LEXICON = Lexicon(_TOKEN, _SKIPPED, KEYWORDS, _stray)
_LEXICON_OF_CLOSED = Lexicon(_TOKEN_OR_CLOSED, _SKIPPED, KEYWORDS, _stray)
_SPECIAL: dict[str, lexer.Special] = {
    "newline": lambda kinds, start, end: (NEWLINE, end),
    "closed": lambda kinds, start, end: (CLOSED, end),
}
