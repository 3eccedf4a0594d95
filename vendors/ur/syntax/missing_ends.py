"""Functions whose ``end`` is missing: where the next one begins as far left as they do, they end.

A script is a stretch of blocks that only their words close, so that one missing ``end`` swallows
all that follows. Only what is indented as its blocks are can be mended so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from ....core.errors import ParseError
from .lexer import LINE, Tokens
from .texts import Texts

_FUNCTIONS = frozenset({"def", "sec", "thread"})
_OPENING = _FUNCTIONS | {"if", "while"}
_END = "end"


@dataclass(frozen=True, slots=True)
class _Open:
    """A block that is open.

    Args:
        word: that opens it.
        start: of that, an offset.
        column: of that.
        indented: whether what stands in it is farther right.
    """

    word: str
    start: int
    column: int
    indented: bool


def with_ends(tokens: Tokens, texts: Texts) -> Tokens:
    """The tokens of a damaged text with the ends that it lacks; themselves where it lacks none,
    but for the last of the file, or where its lines do not show where they should be.

    Raises:
        SourceError: the text is damaged too often.
    """
    lacking = sum(kind in _OPENING for kind in tokens.kinds) - tokens.kinds.count(_END)
    if texts.damage is None or lacking < 1:
        return tokens
    places: dict[int, list[_Open]] = {}  # token → functions that end before it
    inserted, stack = 0, list[_Open]()
    for index, kind in enumerate(tokens.kinds):
        if kind == _END and not stack:
            return tokens
        if kind == _END:
            stack.pop()
        elif kind in _OPENING:
            column = _column(tokens, index)
            opened = _Open(kind, tokens.starts[index], column, _inside(tokens, index) > column)
            if kind in _FUNCTIONS and (index == 0 or tokens.kinds[index - 1] == LINE):
                ended = _ended(stack, column)
                if ended:
                    places[index] = ended
                    inserted += len(ended)
            stack.append(opened)
    if lacking - inserted not in (0, 1):
        return tokens
    return _inserted(tokens, texts, places)


def _ended(stack: list[_Open], column: int) -> list[_Open]:
    """Takes the blocks off the stack that a function in a column ends, but for the outermost."""
    for depth, one in enumerate(stack):
        if depth and one.word in _FUNCTIONS and one.indented and one.column >= column:
            ended = stack[depth:]
            del stack[depth:]
            return ended
    return []


def _inside(tokens: Tokens, index: int) -> int:
    """The column of the line behind the one that a token stands in."""
    behind = next((k for k in range(index, len(tokens.kinds)) if tokens.kinds[k] == LINE), None)
    return 0 if behind is None else _column(tokens, behind + 1)


def _column(tokens: Tokens, index: int) -> int:
    at = tokens.starts[index] - tokens.base
    return at - max(tokens.text.rfind("\n", 0, at), tokens.text.rfind("\r", 0, at))


def _inserted(tokens: Tokens, texts: Texts, places: dict[int, list[_Open]]) -> Tokens:
    assert texts.damage is not None
    kinds, starts, ends = list[str](), list[int](), list[int]()
    for index, kind in enumerate(tokens.kinds):
        for one in places.get(index, ()):
            span = texts.span(one.start, one.start + len(one.word))
            texts.damage.step_over(
                ParseError(f"the 'end' of this '{one.word}' is missing", span),
                "it is taken to end before "
                f"line {texts.span(tokens.starts[index], tokens.starts[index]).line}",
            )
            at = tokens.ends[index - 2]  # of the token before the end of line
            kinds += [_END, LINE]
            starts += [at, at]
            ends += [at, at]
        kinds.append(kind)
        starts.append(tokens.starts[index])
        ends.append(tokens.ends[index])
    return replace(tokens, kinds=kinds, starts=starts, ends=ends)
