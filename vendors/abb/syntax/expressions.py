"""Tokens → expressions.

Priorities from the "RAPID Reference Manual", expressions: ``* / DIV MOD``, then ``+ -``, then
``< > <> <= >= =``, then ``AND``, and last ``XOR OR NOT``; equal ones from left to right. So
``NOT a AND b`` is ``NOT (a AND b)``. A ``NOT`` behind an ``AND``, which the manual's grammar does
not have, applies to the comparison that follows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from .cursor import Cursor
from .lexer import LITERAL, NAME, NUMBER, STRING, number_value, string_value
from .tree import (
    Aggregate,
    Argument,
    Call,
    Expression,
    Name,
    Number,
    Operation,
    Packed,
    Star,
    Text,
    Truth,
    Unary,
)

PRODUCT = frozenset({"*", "/", "div", "mod"})
SUM = frozenset({"+", "-"})
RELATION = frozenset({"<", ">", "<>", "<=", ">=", "="})
AND = frozenset({"and"})
OR = frozenset({"or", "xor"})
_CLOSING = frozenset({",", "]", ")", ";", "}"})
_ENDING = _CLOSING | {"\\"}


def parse_expression(cursor: Cursor) -> Expression:
    """The expression that starts at the cursor."""
    quick = _lone_value(cursor)
    if quick is not None:
        return quick
    return _chain(cursor, OR, _negatable_term)


def _lone_value(cursor: Cursor) -> Expression | None:
    """A number or literal, or a plain name, that is the whole expression: most of any text."""
    kinds, index = cursor.kinds, cursor.index
    if kinds[index] == NAME and kinds[index + 1] in _ENDING:
        text = cursor.text
        start, end = cursor.starts[index], cursor.ends[index]
        cursor.index += 1
        return Name(cursor.source.span(start, end), text.lower(), text)
    if kinds[index] == LITERAL and kinds[index + 1] in _ENDING:
        return _packed(cursor)
    signed = kinds[index] == "-"
    if kinds[index + signed] != NUMBER or kinds[index + signed + 1] not in _CLOSING:
        return None
    return _number(cursor)


def _negatable_term(cursor: Cursor) -> Expression:
    start = cursor.start
    if not cursor.accept("not"):
        return _term(cursor)
    with cursor.nested():
        operand = _negatable_term(cursor)
    return Unary(cursor.span_from(start), "not", operand)


def _term(cursor: Cursor) -> Expression:
    return _chain(cursor, AND, _negatable_relation)


def _negatable_relation(cursor: Cursor) -> Expression:
    start = cursor.start
    if not cursor.accept("not"):
        return _chain(cursor, RELATION, _sum)
    with cursor.nested():
        operand = _negatable_relation(cursor)
    return Unary(cursor.span_from(start), "not", operand)


def _sum(cursor: Cursor) -> Expression:
    return _chain(cursor, SUM, _product)


def _product(cursor: Cursor) -> Expression:
    return _chain(cursor, PRODUCT, _primary)


def _chain(
    cursor: Cursor, operators: frozenset[str], operand: Callable[[Cursor], Expression]
) -> Expression:
    """Operands with operators of one priority between them."""
    start = cursor.start
    first = operand(cursor)
    if cursor.kind not in operators:
        return first
    rest = []
    while (operator := cursor.kind) in operators:
        cursor.advance()
        rest.append((operator, operand(cursor)))
    return Operation(cursor.span_from(start), first, tuple(rest))


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
        return Text(cursor.span_from(start), value)
    if kind in ("true", "false"):
        cursor.advance()
        return Truth(cursor.span_from(start), kind == "true")
    if kind == "*":
        cursor.advance()
        return Star(cursor.span_from(start))
    with cursor.nested():
        if cursor.accept("("):
            inner = parse_expression(cursor)
            cursor.expect(")", "to close the bracket")
            return inner
        if kind in SUM:
            cursor.advance()
            operand = _primary(cursor)
            return Unary(cursor.span_from(start), kind, operand)
    raise cursor.unexpected("a value")


def _number(cursor: Cursor) -> Number:
    start = cursor.start
    negative = cursor.accept("-")
    value = number_value(cursor.text)
    cursor.advance()
    span = cursor.span_from(start)
    if not math.isfinite(value):
        raise cursor.source.error("this number is too large", span.start, span.end)
    return Number(span, -value if negative else value)


def _packed(cursor: Cursor) -> Packed:
    start, text, value = cursor.start, cursor.text, cursor.values[cursor.index]
    cursor.index += 1
    return Packed(cursor.source.span(start, start + len(text)), value, text)


def _aggregate(cursor: Cursor) -> Aggregate:
    start = cursor.start
    cursor.enter()
    cursor.advance()
    items = [parse_expression(cursor)]
    while cursor.accept(","):
        items.append(parse_expression(cursor))
    cursor.expect("]", "or ',' after this value")
    cursor.depth -= 1
    return Aggregate(cursor.span_from(start), tuple(items))


def _name_or_call(cursor: Cursor) -> Expression:
    if cursor.peek() != "(":
        return parse_name(cursor)
    start = cursor.start
    text = cursor.name("a function")
    with cursor.nested():
        cursor.advance()
        arguments = parse_arguments(cursor, ")")
        cursor.expect(")", f"to end the arguments of {text}")
    return Call(cursor.span_from(start), text.lower(), text, arguments)


def parse_name(cursor: Cursor) -> Name:
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
            return Name(cursor.span_from(start), text.lower(), text, tuple(path))


def parse_braces(cursor: Cursor) -> tuple[Expression, ...]:
    """``{a, b}``: indices or dimensions."""
    with cursor.nested():
        cursor.expect("{", "before the index")
        items = [parse_expression(cursor)]
        while cursor.accept(","):
            items.append(parse_expression(cursor))
        cursor.expect("}", "to close the index")
    return tuple(items)


def parse_arguments(cursor: Cursor, end: str) -> tuple[Argument, ...]:
    """The arguments of a call up to the token ``end``: ``a, b:=c\\Option:=d, \\Switch``."""
    arguments: list[Argument] = []
    while cursor.kind != end:
        if arguments and not cursor.accept(",") and cursor.kind != "\\":
            raise cursor.unexpected(f"',' or '{end}'")
        arguments.append(_argument(cursor))
    return tuple(arguments)


def _argument(cursor: Cursor) -> Argument:
    start = cursor.start
    if not cursor.accept("\\"):
        named = cursor.kind == NAME and cursor.peek() == ":="
        name = cursor.name("an argument's name").lower() if named else None
        if named:
            cursor.advance()
        value = parse_expression(cursor)
        return Argument(value.span, value, parameter=name)
    option = cursor.name("the name of an optional argument").lower()
    if cursor.accept(":="):
        given: Expression | None = parse_expression(cursor)
        return Argument(cursor.span_from(start), given, option)
    if cursor.accept("?"):
        parameter = parse_name(cursor)
        return Argument(cursor.span_from(start), parameter, option, conditional=True)
    return Argument(cursor.span_from(start), None, option)
