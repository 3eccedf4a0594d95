"""Tokens → expressions.

Priorities, highest first: ``NOT B_NOT`` and signs, ``:``, ``* /``, ``+ -``, ``AND B_AND``,
``EXOR B_EXOR``, ``OR B_OR``, and comparisons last (KUKA's table of priorities; the geometric
operator is not in it). So ``A == 1 AND B`` is ``A == (1 AND B)``. Programs that mean ``(A == 1)
AND B`` are met all the same: where both readings differ, both are kept (`Ambiguous`).
"""

from __future__ import annotations

import math

from ....core.source.text.operators import Operators, operation
from . import tree
from .cursor import Cursor
from .lexer import BITS, ENUM, NAME, NUMBER, RECORD, STRING, bits_value
from .tree import Expression

RELATION = frozenset({"==", "<>", "<", ">", "<=", ">="})
OR = frozenset({"or", "b_or"})
EXOR = frozenset({"exor", "b_exor"})
AND = frozenset({"and", "b_and"})
SUM = frozenset({"+", "-"})
PRODUCT = frozenset({"*", "/"})
FRAME = frozenset({":"})
_NEGATIONS = frozenset({"not", "b_not"})
_LOGIC = OR | EXOR | AND
_ALONE = frozenset({NUMBER, RECORD, NAME})
_CONTINUING = RELATION | _LOGIC | SUM | PRODUCT | FRAME | {"(", "[", "."}
"""What may stand behind an operand that is not all of its expression."""
_LARGEST_INT = 2**31


def parse_expression(cursor: Cursor) -> Expression:
    """The expression that starts at the cursor."""
    kinds, index = cursor.kinds, cursor.index
    if kinds[index] in _ALONE and kinds[index + 1] not in _CONTINUING:
        return _primary(cursor)
    start = cursor.index
    manual = _manual.read(cursor)
    if not _is_ambiguous(cursor, start, cursor.index):
        return manual
    after = cursor.index
    cursor.index = start
    usual = _usual.read(cursor)
    cursor.index = after
    return tree.Ambiguous(manual.span, manual, usual)


def _is_ambiguous(cursor: Cursor, start: int, end: int) -> bool:
    """Whether comparisons and logic stand side by side, outside brackets."""
    depth, relation, logic = 0, False, False
    for kind in cursor.kinds[start:end]:
        if kind in "([{":
            depth += 1
        elif kind in ")]}":
            depth -= 1
        elif depth == 0:
            relation = relation or kind in RELATION
            logic = logic or kind in _LOGIC
    return relation and logic


def _primary(cursor: Cursor, level: int = 0) -> Expression:
    kind, start = cursor.kind, cursor.start
    if kind == NUMBER or (kind == "-" and cursor.peek() == NUMBER):
        return _number(cursor)
    if kind == NAME:
        return parse_name_or_call(cursor)
    if kind == RECORD:
        cursor.advance()
        return tree.Flat(cursor.source, start, cursor.end)
    if kind == "{":
        return _aggregate(cursor)
    if kind == ENUM:
        name = cursor.text[1:].strip().lower()
        cursor.advance()
        return tree.Constant(cursor.span_from(start), name)
    if kind == STRING:
        value = cursor.text[1:-1]
        cursor.advance()
        return tree.Text(cursor.span_from(start), value)
    if kind in ("true", "false"):
        cursor.advance()
        return tree.Truth(cursor.span_from(start), kind == "true")
    if kind == BITS:
        return _bits(cursor)
    with cursor.nested():
        if cursor.accept("("):
            inner = parse_expression(cursor)
            cursor.expect(")", "to close the bracket")
            return inner
        if kind in SUM or kind in _NEGATIONS:
            cursor.advance()
            operand = _primary(cursor)
            return tree.Unary(cursor.span_from(start), kind, operand)
    raise cursor.unexpected("a value")


def _number(cursor: Cursor) -> tree.Number:
    start = cursor.start
    negative = cursor.accept("-")
    text = cursor.text
    cursor.advance()
    end = cursor.end
    value = number_value(text)
    if not math.isfinite(value):
        raise cursor.source.error("this number is too large", start, end)
    return tree.Number(cursor.source, start, end, -value if negative else value)


def number_value(text: str) -> int | float:
    """The value of a number's text: an ``int`` if it has no point and no exponent.

    A whole number beyond 32 bits is a REAL.
    """
    if text.isdigit() and len(text) <= 10 and int(text) < _LARGEST_INT:
        return int(text)
    return float(text)


def _bits(cursor: Cursor) -> tree.Number:
    start = cursor.start
    try:
        value = bits_value(cursor.text)
    except ValueError:
        raise cursor.unexpected("a number like 'B0101' or 'H1F'") from None
    end = cursor.ends[cursor.index]
    if value >= 2**32:
        raise cursor.source.error("this number has more than 32 bits", start, end)
    cursor.advance()
    return tree.Number(cursor.source, start, end, value)


def _aggregate(cursor: Cursor) -> tree.Aggregate:
    start = cursor.start
    cursor.enter()
    cursor.advance()
    type_name = None
    if cursor.kind == NAME and cursor.peek() == ":":
        type_name = cursor.name("the type of the aggregate").lower()
        cursor.advance()
    items: list[tuple[str, Expression]] = []
    while not items or cursor.accept(","):
        name = cursor.word("the name of a component").lower()
        if cursor.accept("["):
            cursor.expect("]", "after the name of an array component")
        items.append((name, parse_expression(cursor)))
    cursor.expect("}", "or ',' after this value")
    cursor.depth -= 1
    end = cursor.end
    return tree.Aggregate(cursor.source, start, end, type_name, tuple(items))


def parse_name_or_call(cursor: Cursor) -> tree.Name | tree.Call:
    """``P1.X``, ``ABS(X)``."""
    if cursor.peek() != "(":
        return parse_name(cursor)
    start = cursor.start
    text = cursor.name("a function")
    with cursor.nested():
        cursor.advance()
        arguments = _items(cursor, ")", f"to end the arguments of {text}")
    return tree.Call(cursor.span_from(start), text.lower(), text, arguments)


def _items(cursor: Cursor, closing: str, where: str) -> tuple[Expression | None, ...]:
    """What stands in brackets, such as ``a, , b)``; None for what is left out."""
    if cursor.accept(closing):
        return ()

    def item(cursor: Cursor) -> Expression | None:
        if cursor.kind == ":" and cursor.peek() == NAME:  # a channel: COPEN(:SER_2, HANDLE)
            cursor.advance()
        return None if cursor.kind in (",", closing) else parse_expression(cursor)

    items = cursor.listed(item)
    cursor.expect(closing, where)
    return items


def parse_name(cursor: Cursor) -> tree.Name:
    """A datum with its components and indices."""
    start = cursor.start
    text = cursor.name("a name")
    path: list[str | tuple[Expression | None, ...]] = []
    while True:
        kind = cursor.kind
        if kind == ".":
            cursor.advance()
            path.append(cursor.word("a component's name").lower())
        elif kind == "[":
            path.append(parse_indices(cursor))
        else:
            return tree.Name(cursor.span_from(start), text.lower(), text, tuple(path))


def parse_indices(cursor: Cursor) -> tuple[Expression | None, ...]:
    """``[i,j]``, ``[]``, ``[i,]``"""
    with cursor.nested():
        cursor.expect("[", "before the index")
        return _items(cursor, "]", "to close the index")


_manual = Operators((RELATION, OR, EXOR, AND, SUM, PRODUCT, FRAME), _primary, operation)
"""As KUKA's table has the priorities."""
_usual = Operators((OR, EXOR, AND, RELATION, SUM, PRODUCT, FRAME), _primary, operation)
"""With comparisons before AND, EXOR and OR."""
