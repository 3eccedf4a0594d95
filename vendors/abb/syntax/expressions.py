"""Tokens → expressions.

Priorities from the "RAPID Reference Manual", expressions: ``* / DIV MOD``, then ``+ -``, then
``< > <> <= >= =``, then ``AND``, and last ``XOR OR NOT``; equal ones from left to right. So
``NOT a AND b`` is ``NOT (a AND b)``. A ``NOT`` behind an ``AND``, which the manual's grammar does
not have, applies to the comparison that follows it.
"""

from __future__ import annotations

import math

from ....core.source.text.operators import Operators, operation
from . import tree
from .cursor import Cursor
from .lexer import LITERAL, NAME, NUMBER, STRING, number_value, string_value
from .tree import Expression

SUM = frozenset({"+", "-"})
_LEVELS = (
    frozenset({"or", "xor"}),
    frozenset({"and"}),
    frozenset({"<", ">", "<>", "<=", ">=", "="}),
    SUM,
    frozenset({"*", "/", "div", "mod"}),
)
_AND, _RELATION = 1, 2
_CLOSING = frozenset({",", "]", ")", ";", "}"})
_ENDING = _CLOSING | {"\\"}


def parse_expression(cursor: Cursor) -> Expression:
    """The expression that starts at the cursor."""
    quick = _lone_value(cursor)
    if quick is not None:
        return quick
    return _operators.read(cursor)


def _lone_value(cursor: Cursor) -> Expression | None:
    """A number or literal, or a plain name, that is the whole expression: most of any text."""
    kinds, index = cursor.kinds, cursor.index
    if kinds[index] == NAME and kinds[index + 1] in _ENDING:
        text = cursor.text
        start, end = cursor.starts[index], cursor.ends[index]
        cursor.index += 1
        return tree.Name(cursor.source.span(start, end), text.lower(), text)
    if kinds[index] == LITERAL and kinds[index + 1] in _ENDING:
        return _packed(cursor)
    signed = kinds[index] == "-"
    if kinds[index + signed] != NUMBER or kinds[index + signed + 1] not in _CLOSING:
        return None
    return _number(cursor)


def _operand(cursor: Cursor, level: int) -> Expression:
    start = cursor.start
    if level > _RELATION or not cursor.accept("not"):
        return _primary(cursor)
    with cursor.nested():
        operand = _operators.read(cursor, max(level, _AND))
    return tree.Unary(cursor.span_from(start), "not", operand)


_operators = Operators(_LEVELS, _operand, operation)


def _primary(cursor: Cursor) -> Expression:
    kind, start = cursor.kind, cursor.start
    if kind == NUMBER or (kind == "-" and cursor.peek() == NUMBER):
        return _number(cursor)
    if kind == NAME:
        return _name_or_call(cursor)
    if kind == LITERAL:
        return _packed(cursor)
    if kind == "[":
        return _aggregate(cursor)
    if kind == STRING:
        value = string_value(cursor.text)
        cursor.advance()
        return tree.Text(cursor.span_from(start), value)
    if kind in ("true", "false"):
        cursor.advance()
        return tree.Truth(cursor.span_from(start), kind == "true")
    if kind == "*":
        cursor.advance()
        return tree.Star(cursor.span_from(start))
    with cursor.nested():
        if cursor.accept("("):
            inner = parse_expression(cursor)
            cursor.expect(")", "to close the bracket")
            return inner
        if kind in SUM:
            cursor.advance()
            operand = _primary(cursor)
            return tree.Unary(cursor.span_from(start), kind, operand)
    raise cursor.unexpected("a value")


def _number(cursor: Cursor) -> tree.Number:
    start = cursor.start
    negative = cursor.accept("-")
    value = number_value(cursor.text)
    cursor.advance()
    span = cursor.span_from(start)
    if not math.isfinite(value):
        raise cursor.source.error("this number is too large", span.start, span.end)
    return tree.Number(span, -value if negative else value)


def _packed(cursor: Cursor) -> tree.Packed:
    start, text, value = cursor.start, cursor.text, cursor.values[cursor.index]
    cursor.index += 1
    return tree.Packed(cursor.source.span(start, start + len(text)), value, text)


def _aggregate(cursor: Cursor) -> tree.Aggregate:
    start = cursor.start
    cursor.enter()
    cursor.advance()
    items = cursor.listed(parse_expression)
    cursor.expect("]", "or ',' after this value")
    cursor.depth -= 1
    return tree.Aggregate(cursor.span_from(start), items)


def _name_or_call(cursor: Cursor) -> Expression:
    if cursor.peek() != "(":
        return parse_name(cursor)
    start = cursor.start
    text = cursor.name("a function")
    with cursor.nested():
        cursor.advance()
        arguments = parse_arguments(cursor, ")")
        cursor.expect(")", f"to end the arguments of {text}")
    return tree.Call(cursor.span_from(start), text.lower(), text, arguments)


def parse_name(cursor: Cursor) -> tree.Name:
    """A datum with its components and indices."""
    start = cursor.start
    text = cursor.name("a name")
    path: list[str | tuple[Expression, ...]] = []
    while True:
        if cursor.accept("."):
            path.append(cursor.name("a component's name").lower())
        elif cursor.kind == "{":
            path.append(parse_braces(cursor))
        else:
            return tree.Name(cursor.span_from(start), text.lower(), text, tuple(path))


def parse_braces(cursor: Cursor) -> tuple[Expression, ...]:
    """``{a, b}``: indices or dimensions."""
    with cursor.nested():
        cursor.expect("{", "before the index")
        items = cursor.listed(parse_expression)
        cursor.expect("}", "to close the index")
    return items


def parse_arguments(cursor: Cursor, end: str) -> tuple[tree.Argument, ...]:
    """The arguments of a call up to the token ``end``: ``a, b:=c\\Option:=d, \\Switch``."""
    arguments: list[tree.Argument] = []
    kinds = cursor.kinds
    while (kind := kinds[cursor.index]) != end:
        if kind == "," and arguments:
            cursor.index += 1
        elif arguments and kind != "\\":
            if end == ";" and cursor.ends_without_semicolon:
                break
            raise cursor.unexpected(f"',' or '{end}'")
        arguments.append(_argument(cursor))
    return tuple(arguments)


def _argument(cursor: Cursor) -> tree.Argument:
    kinds, index = cursor.kinds, cursor.index
    if kinds[index] != "\\":
        name = None
        if kinds[index] == NAME and kinds[index + 1] == ":=":
            name = cursor.name("an argument's name").lower()
            cursor.advance()
        value = parse_expression(cursor)
        return tree.Argument(value.span, value, None, False, name)
    start = cursor.start
    cursor.index += 1
    option = cursor.name("the name of an optional argument").lower()
    if cursor.accept(":="):
        given: Expression | None = parse_expression(cursor)
        return tree.Argument(cursor.span_from(start), given, option)
    if cursor.accept("?"):
        parameter = parse_name(cursor)
        return tree.Argument(cursor.span_from(start), parameter, option, conditional=True)
    return tree.Argument(cursor.span_from(start), None, option)
