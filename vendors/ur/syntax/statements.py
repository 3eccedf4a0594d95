"""Tokens → statements."""

from __future__ import annotations

from collections.abc import Callable

from ....core.errors import Note, ParseError
from ....core.source.text.damage import words_in
from ....core.source.text.lexer import NAME, words
from . import tree
from .cursor import Cursor
from .expressions import parse_expression
from .lexer import END, LINE, tokenize
from .missing_ends import with_ends
from .texts import Texts
from .tree import Block, Expression, Statement

_BODY = frozenset({"end"})
_BRANCH = frozenset({"elif", "else", "end"})
_AFTER = frozenset({LINE, ";", END, "end", "else", "elif"})
"""What may follow a statement."""


def parse(texts: Texts, which: int) -> Block:
    """The statements of one of the texts.

    Raises:
        SourceError: the text is no URScript, or is cut off.
    """
    try:
        return _parse(texts, which)
    except ParseError as error:
        raise (error if texts.damage is None else texts.damage.first(error)) from None


def _parse(texts: Texts, which: int) -> Block:
    cursor = Cursor(with_ends(tokenize(texts, which), texts))
    statements: list[Statement] = []
    cursor.skip_lines()
    while cursor.kind != END:
        if cursor.kind in _BRANCH:
            error = cursor.source.error(
                f"this '{cursor.kind}' closes nothing: there is one too many, or a 'def', 'if' or "
                "'while' above it is missing",
                cursor.start,
            )
            if not set(cursor.kinds[cursor.index :]) <= {"end", LINE, ";", END}:
                raise error  # what follows would stand outside of what it belongs to
            cursor.step_over(error, "it is left out")
            break
        statements.append(_mended(cursor))
        cursor.skip_lines()
    return tuple(statements)


def _mended(cursor: Cursor) -> Statement:
    """A statement, or what is none and may be stepped over."""
    begin, depth, loops = cursor.index, cursor.depth, cursor.loops
    try:
        return _statement(cursor)
    except ParseError as error:
        cursor.step_over(error)
        cursor.depth, cursor.loops = depth, loops
        if cursor.index == begin or not cursor.begins_line():
            while cursor.kind not in (LINE, END):
                cursor.index += 1
        start, end = cursor.starts[begin], cursor.ends[max(begin, cursor.index - 1)]
        words = words_in(cursor.source.cut(start, end))
        return tree.Unread(start, end, error.message, words, _target(cursor, begin))


def _target(cursor: Cursor, begin: int) -> tree.Name | None:
    """The variable that a damaged line would set."""
    at = begin + (cursor.kinds[begin] in ("global", "local"))
    sets = cursor.kinds[at + 1] != "(" and "=" in cursor.kinds[at : cursor.index]
    if cursor.kinds[at] != NAME or not sets:
        return None
    start, end = cursor.starts[at], cursor.ends[at]
    return tree.Name(start, end, cursor.source.cut(start, end))


_PYTHON = ("for", "import", "from", "try", "class", "print", "lambda")
"""Words that begin statements of Python."""


def _block(cursor: Cursor, ends: frozenset[str], opening: str) -> Block:
    """Statements up to one of the keywords ``ends``, or the end of the file if it is among them,
    which is left to be read."""
    statements: list[Statement] = []
    with cursor.nested():
        cursor.skip_lines()
        while cursor.kind not in ends:
            if cursor.kind == END:
                raise cursor.torn(f"'end' of {opening}")
            statements.append(_mended(cursor))
            cursor.skip_lines()
    return tuple(statements)


def _statement(cursor: Cursor) -> Statement:
    start, word = cursor.start, cursor.kind
    behind = _BY_KEYWORD.get(word)
    if behind is None:
        statement = _simple(cursor, start)
    else:
        cursor.index += 1
        statement = behind(cursor, start, word)
    if cursor.kind not in _AFTER:
        begins = cursor.source.cut(start, cursor.start).strip()
        if begins in _PYTHON:
            raise cursor.source.error(
                f"URScript has no '{begins}' as Python has: no controller takes this file", start
            )
        raise cursor.unexpected("the end of the line, after a statement,")
    return statement


def _simple(cursor: Cursor, start: int) -> Statement:
    """An assignment, or an expression."""
    expression = parse_expression(cursor)
    if cursor.kind == "=":
        return _assignment(cursor, start, expression, "")
    if cursor.kind == ":" and isinstance(expression, tree.Name):
        raise cursor.source.error(
            f"'{expression.text}' is no statement of URScript", expression.start, expression.end
        )
    return tree.Evaluate(start, cursor.end, expression)


def _assignment(cursor: Cursor, start: int, target: Expression, storage: str) -> tree.Assign:
    if not isinstance(target, tree.Name | tree.Index | tree.Member):
        raise cursor.source.error(
            "only a variable, an element of a list or a part of a struct can be assigned",
            target.start,
            target.end,
        )
    cursor.expect("=", "after the variable")
    value = parse_expression(cursor)
    return tree.Assign(start, cursor.end, target, value, storage)


def _declaration(cursor: Cursor, start: int, storage: str) -> Statement:
    """``global name = value`` or ``local name = value``"""
    begin = cursor.start
    name = cursor.name(f"the name of a variable after '{storage}'")
    target = tree.Name(begin, cursor.end, name)
    if cursor.kind == "=":
        return _assignment(cursor, start, target, storage)
    return tree.Assign(
        start, cursor.end, target, tree.Constant(cursor.end, cursor.end, None), storage
    )


def _define(cursor: Cursor, start: int, kind: str) -> Statement:
    name = cursor.name(f"a name after '{kind}'")
    opening = f"'{kind} {name}' in {cursor.where(start)}"
    parameters = _parameters(cursor, name)
    cursor.expect(":", f"after '{kind} {name}(…)'")
    loops, cursor.loops = cursor.loops, 0
    outermost = cursor.depth == 0
    body = _block(cursor, _BODY | {END} if outermost else _BODY, opening)
    cursor.loops = loops
    if cursor.kind == END and outermost:
        cursor.source.notes.append(
            Note(
                f"the file ends without the 'end' of {opening}: is it all there?",
                span=cursor.source.span(start, start),
            )
        )
    else:
        cursor.expect("end", f"to close {opening}")
    return tree.Define(start, cursor.end, kind, name, parameters, body)


def _parameters(cursor: Cursor, name: str) -> tuple[tree.Parameter, ...]:
    cursor.expect("(", f"after {name}")
    parameters: list[tree.Parameter] = []
    while not cursor.accept(")"):
        if parameters:
            cursor.expect(",", f"or ')' between the parameters of {name}")
        word = cursor.name(f"a parameter of {name}")
        default = parse_expression(cursor) if cursor.accept("=") else None
        parameters.append(tree.Parameter(word, default))
    return tuple(parameters)


def _if(cursor: Cursor, start: int, _: str) -> Statement:
    opening = f"'if' in {cursor.where(start)}"
    branches = [_branch(cursor, opening)]
    while cursor.accept("elif"):
        branches.append(_branch(cursor, opening))
    otherwise = None
    if cursor.accept("else"):
        cursor.expect(":", "after 'else'")
        otherwise = _block(cursor, _BODY, opening)
    cursor.expect("end", f"to close {opening}")
    return tree.If(start, cursor.end, tuple(branches), otherwise)


def _branch(cursor: Cursor, opening: str) -> tree.Branch:
    condition = parse_expression(cursor)
    cursor.expect(":", "after the condition")
    return tree.Branch(condition, _block(cursor, _BRANCH, opening))


def _while(cursor: Cursor, start: int, _: str) -> Statement:
    opening = f"'while' in {cursor.where(start)}"
    condition = parse_expression(cursor)
    cursor.expect(":", "after the condition")
    cursor.loops += 1
    body = _block(cursor, _BODY, opening)
    cursor.loops -= 1
    cursor.expect("end", f"to close {opening}")
    return tree.While(start, cursor.end, condition, body)


def _return(cursor: Cursor, start: int, _: str) -> Statement:
    value = None if cursor.kind in _AFTER else parse_expression(cursor)
    return tree.Return(start, cursor.end, value)


def _word(cursor: Cursor, start: int, word: str) -> Statement:
    if word in ("break", "continue") and not cursor.loops:
        raise cursor.source.error(f"'{word}' stands outside of a loop", start, cursor.end)
    if word == "halt" and cursor.accept("("):
        cursor.expect(")", "after 'halt('")
    return tree.Keyword(start, cursor.end, word)


def _thread_end(cursor: Cursor, start: int, word: str) -> Statement:
    handle = parse_expression(cursor)
    return tree.ThreadEnd(start, cursor.end, word, handle)


_BY_KEYWORD: dict[str, Callable[[Cursor, int, str], Statement]] = {
    "if": _if,
    "while": _while,
    "return": _return,
    **dict.fromkeys(("def", "sec", "thread"), _define),
    **dict.fromkeys(("global", "local"), _declaration),
    **dict.fromkeys(("join", "kill"), _thread_end),
    **dict.fromkeys(words("break continue halt pass enter_critical exit_critical"), _word),
}
