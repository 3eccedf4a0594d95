"""Tokens → statements."""

from __future__ import annotations

from collections.abc import Callable

from ....core.errors import ParseError, SourceError
from ....core.source.text.damage import words_in
from . import tree
from .cursor import Cursor
from .expressions import parse_arguments, parse_expression, parse_name
from .lexer import END, NAME
from .tree import Block, Statement

CLOSING = frozenset(
    {"else", "elseif", "endif", "endfor", "endwhile", "case", "default", "endtest"}
    | {"endproc", "endfunc", "endtrap", "endmodule", "proc", "func", "trap", END}
    | {"error", "undo", "backward"}
)
"""What ends a block, or begins what no block holds."""


def parse_block(cursor: Cursor, ends: frozenset[str], opened_by: str, start: int) -> Block:
    """Statements up to one of the keywords ``ends``, which is left to be read.

    Args:
        cursor: at the first statement.
        ends: one of them begins with ``end``.
        opened_by: what the block belongs to, for messages.
        start: where that begins.

    Raises:
        SourceError: another block's end, or the end of the file, comes first.
    """
    statements: list[Statement] = []
    with cursor.nested():
        while (kind := cursor.kind) not in ends:
            if kind in CLOSING:
                (closing,) = (end.upper() for end in ends if end.startswith("end"))
                line = cursor.source.span(start, start).line
                raise cursor.torn(f"{closing}, to close {opened_by} of line {line},")
            if cursor.accept(";"):  # one too many does no harm
                continue
            begin, depth = cursor.index, cursor.depth
            try:
                statements.append(parse_statement(cursor))
            except ParseError as error:
                statements.append(_unread(cursor, begin, depth, error))
    return Block(tuple(statements))


def _unread(cursor: Cursor, begin: int, depth: int, error: SourceError) -> tree.Unread:
    """What is no statement, in a text that is read all the same.

    Raises:
        SourceError: it is not.
    """
    cursor.step_over(error, "it is stepped over, and what it would set is not known from there on")
    cursor.depth = depth
    cursor.skip_statement(begin, _BEGINNING)
    span = cursor.source.span(cursor.starts[begin], cursor.end)
    words = words_in(cursor.source.text[span.start : span.end].lower())
    target = None
    if cursor.kinds[begin] == NAME and ":=" in cursor.kinds[begin : cursor.index]:
        first = cursor.source.span(cursor.starts[begin], cursor.ends[begin])
        text = cursor.source.text[first.start : first.end]
        target = tree.Name(first, text.lower(), text)
    return tree.Unread(span, error.message, words, target)


def parse_statement(cursor: Cursor) -> Statement:
    """The statement that starts at the cursor."""
    kind, start = cursor.kind, cursor.start
    if kind == NAME:
        return _name_statement(cursor, start)
    parse = _BY_KEYWORD.get(kind)
    if parse is None:
        raise cursor.unexpected("a statement")
    cursor.index += 1
    return parse(cursor, start)


def _name_statement(cursor: Cursor, start: int) -> Statement:
    following = cursor.peek()
    if following == ":":
        name = cursor.name("a label").lower()
        cursor.advance()
        return tree.Label(cursor.span_from(start), name)
    if following in (":=", ".", "{"):
        return _assignment(cursor, start)
    text = cursor.name("an instruction")
    arguments = parse_arguments(cursor, ";")
    cursor.expect(";", "at the end of the statement")
    return tree.Invoke(cursor.span_from(start), text.lower(), text, arguments)


def _assignment(cursor: Cursor, start: int) -> tree.Assign:
    target = parse_name(cursor)
    cursor.expect(":=", f"after {target.text}")
    value = parse_expression(cursor)
    cursor.expect(";", "at the end of the assignment")
    return tree.Assign(cursor.span_from(start), target, value)


def _late_call(cursor: Cursor, start: int) -> tree.LateInvoke:
    routine = parse_expression(cursor)
    cursor.expect("%", "to end the name of the routine")
    arguments = parse_arguments(cursor, ";")
    cursor.expect(";", "at the end of the statement")
    return tree.LateInvoke(cursor.span_from(start), routine, arguments)


def _if(cursor: Cursor, start: int) -> tree.If:
    condition = parse_expression(cursor)
    if not cursor.accept("then"):
        with cursor.nested():
            compact = Block((parse_statement(cursor),))
        return tree.If(cursor.span_from(start), (tree.Branch(condition, compact),), None)
    ends = frozenset({"elseif", "else", "endif"})
    branches = [tree.Branch(condition, parse_block(cursor, ends, "the IF", start))]
    while cursor.accept("elseif"):
        condition = parse_expression(cursor)
        cursor.expect("then", "after the condition")
        branches.append(tree.Branch(condition, parse_block(cursor, ends, "the IF", start)))
    otherwise = None
    if cursor.accept("else"):
        otherwise = parse_block(cursor, frozenset({"endif"}), "the IF", start)
    _end(cursor, "endif")
    return tree.If(cursor.span_from(start), tuple(branches), otherwise)


def _for(cursor: Cursor, start: int) -> tree.For:
    name = cursor.name("the name of the loop variable").lower()
    cursor.expect("from", "after the loop variable")
    first = parse_expression(cursor)
    cursor.expect("to", "after the start value")
    last = parse_expression(cursor)
    step = parse_expression(cursor) if cursor.accept("step") else None
    cursor.expect("do", "at the head of the loop")
    body = parse_block(cursor, frozenset({"endfor"}), "the FOR", start)
    _end(cursor, "endfor")
    return tree.For(cursor.span_from(start), body, name, first, last, step)


def _while(cursor: Cursor, start: int) -> tree.While:
    condition = parse_expression(cursor)
    cursor.expect("do", "after the condition")
    body = parse_block(cursor, frozenset({"endwhile"}), "the WHILE", start)
    _end(cursor, "endwhile")
    return tree.While(cursor.span_from(start), body, condition)


def _test(cursor: Cursor, start: int) -> tree.Test:
    subject = parse_expression(cursor)
    cursor.accept(";")
    ends = frozenset({"case", "default", "endtest"})
    cases = []
    while cursor.accept("case"):
        values = cursor.listed(parse_expression)
        cursor.expect(":", "after the values of the case")
        cases.append(tree.Case(values, parse_block(cursor, ends, "the TEST", start)))
    otherwise = None
    if cursor.accept("default"):
        cursor.expect(":", "after DEFAULT")
        otherwise = parse_block(cursor, frozenset({"endtest"}), "the TEST", start)
    _end(cursor, "endtest")
    return tree.Test(cursor.span_from(start), subject, tuple(cases), otherwise)


def _goto(cursor: Cursor, start: int) -> tree.Goto:
    name = cursor.name("a label").lower()
    cursor.expect(";", "after the label")
    cursor.jumps = True
    return tree.Goto(cursor.span_from(start), name)


def _return(cursor: Cursor, start: int) -> tree.Return:
    value = None if cursor.kind == ";" else parse_expression(cursor)
    cursor.expect(";", "after RETURN")
    return tree.Return(cursor.span_from(start), value)


def _word(cursor: Cursor, start: int) -> tree.Keyword:
    """``EXIT;``, ``RETRY;``, ``TRYNEXT;`` and ``RAISE`` with or without a number."""
    word = cursor.kinds[cursor.index - 1]
    value = parse_expression(cursor) if word == "raise" and cursor.kind != ";" else None
    cursor.expect(";", f"after {word.upper()}")
    return tree.Keyword(cursor.span_from(start), word, value=value)


def _connect(cursor: Cursor, start: int) -> tree.Keyword:
    parse_name(cursor)
    cursor.expect("with", "after the interrupt")
    name = cursor.name("the name of a trap routine").lower()
    cursor.expect(";", "at the end of CONNECT")
    return tree.Keyword(cursor.span_from(start), "connect", name)


def _placeholder(cursor: Cursor, start: int) -> tree.Keyword:
    """``<SMT>``, which an editor leaves where a statement is still to be filled in."""
    cursor.name("a statement")
    cursor.expect(">", "to close the placeholder")
    cursor.accept(";")
    return tree.Keyword(cursor.span_from(start), "placeholder")


def _end(cursor: Cursor, keyword: str) -> None:
    cursor.expect(keyword, "to close the statement")
    cursor.accept(";")


_BY_KEYWORD: dict[str, Callable[[Cursor, int], Statement]] = {
    "%": _late_call,
    "if": _if,
    "for": _for,
    "while": _while,
    "test": _test,
    "goto": _goto,
    "return": _return,
    **dict.fromkeys(("exit", "raise", "retry", "trynext"), _word),
    "connect": _connect,
    "<": _placeholder,
}
_BEGINNING = CLOSING | _BY_KEYWORD.keys()
"""Words at the beginning of a line with which what stands before them is over."""
