"""What a script does with names: which it defines, and which it only uses."""

from __future__ import annotations

from collections.abc import Iterator

from ....core.dialect import Mention
from ....core.errors import SourceError
from ....core.source.text.files import SourceFile
from .lexer import NAME, Tokens, tokenize
from .texts import Texts

_DEFINING = ("def", "sec", "thread", "global", "local")


def mentions(text: str) -> Iterator[tuple[str, Mention]]:
    """Names in order; names of arguments are left out. None of a text of another language."""
    try:
        names = list(_names(SourceFile("kept", text)))
    except SourceError:
        return
    for name, defines in names:
        yield name, Mention.DECLARED if defines else Mention.USED


def _names(file: SourceFile) -> Iterator[tuple[str, bool]]:
    """Names in order, and whether each is defined there."""
    tokens = tokenize(Texts([file]), 0)
    kinds = tokens.kinds
    depth = head = 0
    for index, kind in enumerate(kinds):
        if kind in ("(", "["):
            depth += 1
        elif kind in (")", "]"):
            depth -= 1
            head = min(head, depth)
        elif kind == NAME:
            before = kinds[index - 1] if index else ""
            assigned = kinds[index + 1] == "="
            if before in _DEFINING:
                head = depth + 1 if before in _DEFINING[:3] else head
                yield _text(tokens, index), True
            elif head and depth == head:
                yield _text(tokens, index), before in ("(", ",")  # a parameter
            elif depth == 0 or not assigned:
                yield _text(tokens, index), assigned


def _text(tokens: Tokens, index: int) -> str:
    return tokens.text[tokens.starts[index] - tokens.base : tokens.ends[index] - tokens.base]
