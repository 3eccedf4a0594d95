"""Text → tokens.

One compiled pattern finds every token; blanks, ends of line and comments are part of the pattern
in front of it. Written by hand rather than with a parser generator because source files hold
hundreds of thousands of numbers: see `parser` for the measurement. For the same reason brackets
with nothing but numbers in them, as robtargets are, come as one token (`LITERAL`), which the
standard library's JSON scanner turns into a value.

Sources: "RAPID Reference Manual", basic elements: identifiers, numbers (decimal; 0x, 0o, 0b),
strings (``""`` for a quote, ``\\xx`` for a character code, ``\\\\`` for a backslash), ``!``
comments; upper and lower case are the same.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass

from ....core.source.text import lexer
from ....core.source.text.files import SourceText
from ....core.source.text.lexer import UNCLOSED, Lexicon, stray, words

KEYWORDS = words(
    """alias and backward case connect const default div do else elseif endfor endfunc endif
    endmodule endproc endrecord endtest endtrap endwhile error exit false for from func goto if
    inout local mod module not or pers proc raise record retry return step task test then to trap
    true trynext undo var while with xor"""
)
"""Reserved words (the attributes of a module are not: they may be used as names)."""

END, NAME = lexer.END, lexer.NAME
NUMBER, STRING, LITERAL = "number", "string", "literal"

_LEAF = r"-?+[0-9][0-9.eE+-]*+\s*+"
_ROW = rf"\[\s*+{_LEAF}(?:,\s*+{_LEAF})*+\]\s*+"
_ITEM = rf"(?:{_LEAF}|{_ROW})"

_TOKEN = re.compile(
    r"""
    (?: [\s\ufeff\x1a]++ | ![^\r\n]*+ )*+
    (?: (?P<name> [^\W\d_]\w*+ )
      | (?P<number> 0[xX][0-9a-fA-F]++ | 0[oO][0-7]++ | 0[bB][01]++
                  | (?: [0-9]++ (?: \.[0-9]*+ )? | \.[0-9]++ ) (?: [eE][+-]?[0-9]++ )? )
      | (?P<string> " (?: [^"\r\n]++ | "" )*+ " )
      | (?P<literal> """
    rf"\[\s*+{_ITEM}(?:,\s*+{_ITEM})*+\]"
    r""" )
      | (?P<symbol> := | <> | <= | >= | [-+*/=<>()\[\]{},;:.\\?|%] )
      | (?P<end> \Z )
    )""",
    re.VERBOSE,
)
_FOREIGN = ("/", "\\")
_LINE_END = re.compile(r"[\r\n]")
_BLANK = re.compile(r"(?:[\s\ufeff\x1a]++|![^\r\n]*+)*+")
_HEADER = re.compile(r"[\s\ufeff]*%%%.*?%%%", re.DOTALL)
_ESCAPE = re.compile(r'""|\\\\|\\([0-9a-fA-F]{2})')


Row = tuple[float | tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class Tokens(lexer.Tokens[SourceText]):
    """The tokens of a text.

    Args:
        values: of the tokens that are a `LITERAL`, by index.
    """

    values: dict[int, Row]


def tokenize(source: SourceText) -> Tokens:
    """All tokens of a text.

    Raises:
        SourceError: a character that no token begins with, or a string without an end.
    """
    text = source.text
    values: dict[int, Row] = {}

    def literal(kinds: list[str], start: int, end: int) -> tuple[str, int]:
        value = _literal_value(text[start:end])
        if value is None:
            return "[", start + 1
        values[len(kinds)] = value
        return LITERAL, end

    header = _HEADER.match(text)
    start = header.end() if header else 0
    found = _LEXICON.tokens(source, text, start=start, special={LITERAL: literal})
    tokens = Tokens(source, text, 0, found.kinds, found.starts, found.ends, values)
    if source.damage is not None and ("//" in text or "\\\\" in text):
        return _without_foreign_comments(tokens)
    return tokens


def _without_foreign_comments(tokens: Tokens) -> Tokens:
    """A damaged text without what follows ``//`` or ``\\\\``, with which other languages comment
    and no expression goes on: none of its lines has anything but a comment behind it."""
    source, text, damage = tokens.source, tokens.text, tokens.source.damage
    kept: list[int] = []
    over, said = -1, False
    for index, (kind, start) in enumerate(zip(tokens.kinds, tokens.starts, strict=True)):
        if start < over:
            continue
        if kind in _FOREIGN and text.startswith(kind, start + 1):
            end = _LINE_END.search(text, start)
            over = len(text) if end is None else end.start()
            if damage is not None and not said:
                said = True
                error = source.error(f"{kind}{kind} begins no comment in RAPID, as ! does", start)
                damage.step_over(error, "what follows on its line is read as one")
            continue
        kept.append(index)
    new = {old: index for index, old in enumerate(kept)}
    kinds = [tokens.kinds[i] for i in kept]
    starts = [tokens.starts[i] for i in kept]
    ends = [tokens.ends[i] for i in kept]
    values = {new[old]: value for old, value in tokens.values.items() if old in new}
    return Tokens(source, text, 0, kinds, starts, ends, values)


_decode = json.JSONDecoder(parse_int=float).decode
_HUGE = re.compile(r"[eE]\+?[0-9]{3}|[0-9]{300}")


def _literal_value(text: str) -> Row | None:
    """Numbers in brackets; None if not written as JSON writes them, or too large."""
    if _HUGE.search(text):
        return None
    try:
        rows = _decode(text)
    except ValueError:
        return None
    return tuple([tuple(row) if type(row) is list else row for row in rows])


def number_value(literal: str) -> float:
    """The value of a number's text."""
    if literal[:1] == "0" and literal[1:2] in tuple("xXoObB"):
        try:
            return float(int(literal, 0))
        except OverflowError:
            return float("inf")
    return float(literal)


def string_value(literal: str) -> str:
    """The value of a string's text, quotes included."""

    def unescape(found: re.Match[str]) -> str:
        if found[1] is not None:
            return chr(int(found[1], 16))
        return found[0][0]

    return _ESCAPE.sub(unescape, literal[1:-1])


def _stray(text: str, at: int) -> str:
    if text[at] == "'":
        return f'{text[at]!r} does not belong here: strings stand in "'
    return UNCLOSED if text[at] == '"' else stray(text[at], "a RAPID text")


_LEXICON = Lexicon(_TOKEN, _BLANK, KEYWORDS, _stray)
