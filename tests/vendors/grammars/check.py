"""Independent eyes on written sources: would the controller load them?

Each language has a grammar written from its manual (``*.lark``) and a checker beside it for what
a grammar cannot say: declared names, types, shapes, arguments. None of them knows the readers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

HERE = Path(__file__).parent


class Refused(Exception):
    """The controller would not load the text."""


def refuse(where: Tree | Token | str, why: str) -> Refused:
    """The refusal of a place, to be raised."""
    if isinstance(where, Token):
        place = f"line {where.line}, {where.value!r}"
    elif isinstance(where, Tree):
        place = f"line {getattr(where.meta, 'line', '?')}"
    else:
        place = where
    return Refused(f"{place}: {why}")


@cache
def parser(grammar: str) -> Lark:
    """The parser of ``<grammar>.lark``; its lexer knows every reserved word everywhere."""
    return Lark(
        (HERE / f"{grammar}.lark").read_text("utf-8"),
        parser="lalr",
        lexer="basic",
        propagate_positions=True,
    )


def parse(grammar: str, file: str, text: str) -> Tree:
    """The tree of a source text.

    Raises:
        Refused: it is none of the language.
    """
    try:
        return parser(grammar).parse(text)
    except UnexpectedInput as error:
        where = f"{file}:{error.line}:{error.column}"
        raise Refused(f"{where}: {error.get_context(text)}\n{error}") from None


def plain(file: str, text: str, longest: int) -> None:
    """Nothing but printable ASCII, and no line that is too long for the controller's editor.

    Raises:
        Refused: a character or a line is not so.
    """
    for number, line in enumerate(text.split("\n"), 1):
        line = line.removesuffix("\r")
        if len(line) > longest:
            raise Refused(f"{file}:{number}: {len(line)} characters in a line, {longest} at most")
        for character in line:
            if character != "\t" and not " " <= character <= "~":
                raise Refused(f"{file}:{number}: {character!r} is no printable ASCII")


def texts_of(sources: Mapping[str, str], suffix: str) -> dict[str, str]:
    """The sources with a suffix."""
    return {file: text for file, text in sources.items() if file.lower().endswith(suffix)}


def checks() -> dict[str, Callable[[Mapping[str, str]], None]]:
    """The checker of each built-in vendor's sources."""
    from .krl import check_krl
    from .rapid import check_rapid
    from .urscript import check_urscript

    return {"abb": check_rapid, "kuka": check_krl, "ur": check_urscript}
