"""Tokens → expressions.

Priorities, lowest first, as the manual's examples imply and as in Python: ``or`` and ``xor``,
``and``, ``not``, comparisons, bits, shifts, sums, products, signs.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from ....core.source.text.operators import Operators
from . import tree
from .cursor import Cursor
from .lexer import LINE, NAME, NUMBER, NUMBERS, POSE, STRING, number_value, numbers_in
from .tree import Expression

_LEVELS: tuple[frozenset[str], ...] = (
    frozenset({"or", "xor"}),
    frozenset({"and"}),
    frozenset({"==", "!=", "<", ">", "<=", ">=", "≟"}),
    frozenset({"|"}),
    frozenset({"^"}),
    frozenset({"&"}),
    frozenset({"<<", ">>"}),
    frozenset({"+", "-"}),
    frozenset({"*", "/", "%"}),
)
_COMPARISON = 2
_CONSTANTS = {"True": True, "False": False, "None": None}
_SIGNS = frozenset({"-", "+", "~"})


def parse_expression(cursor: Cursor) -> Expression:
    """The expression that starts at the cursor.

    Raises:
        SourceError: there is none.
    """
    index, kinds = cursor.index, cursor.kinds
    parse = _PLAIN.get(kinds[index])
    if parse is not None and kinds[index + 1] in _CLOSING:
        return parse(cursor)
    return _operators.read(cursor)


def _operation(
    cursor: Cursor, _: int, first: Expression, rest: tuple[tuple[str, Expression], ...]
) -> Expression:
    return tree.Operation(first.start, cursor.end, first, rest)


def _signed(cursor: Cursor, level: int = 0) -> Expression:
    start, kind = cursor.start, cursor.kind
    if kind != "not" and kind not in _SIGNS:
        return _postfix(cursor)
    cursor.index += 1
    if kind in "-+" and cursor.kind == NUMBER:
        number = _number(cursor)
        return tree.Number(start, number.end, -number.value if kind == "-" else number.value)
    with cursor.nested():
        operand = _operators.read(cursor, _COMPARISON) if kind == "not" else _signed(cursor)
    return tree.Unary(start, cursor.end, kind, operand)


_operators = Operators(_LEVELS, _signed, _operation)


def _postfix(cursor: Cursor) -> Expression:
    base = _primary(cursor)
    while True:
        kind = cursor.kind
        if kind == "[" or kind == NUMBERS:
            indices = _indices(cursor)
            base = tree.Index(base.start, cursor.end, base, indices)
        elif kind == "." and cursor.peek() == NAME:
            cursor.advance()
            name = cursor.name("the name of a part")
            if cursor.kind == "(":
                arguments = parse_arguments(cursor, name)
                base = tree.MethodCall(base.start, cursor.end, base, name, arguments)
            else:
                base = tree.Member(base.start, cursor.end, base, name)
        else:
            return base


def _indices(cursor: Cursor) -> tuple[Expression, ...]:
    """``[i]`` or ``[i, j]`` behind a value."""
    if cursor.kind == NUMBERS:
        listed = _numbers(cursor, pose=False)
        pairs = zip(listed.places, listed.values, strict=True)
        return tuple(tree.Number(start, end, value) for (start, end), value in pairs)
    return _items(cursor, "an index")


def _primary(cursor: Cursor) -> Expression:
    parse = _PRIMARIES.get(cursor.kind)
    if parse is None:
        raise cursor.unexpected("a value")
    return parse(cursor)


def _number(cursor: Cursor) -> tree.Number:
    start, text = cursor.start, cursor.text
    value = number_value(text)
    cursor.advance()
    if math.isinf(value):
        raise cursor.source.error(f"the number {text[:40]} is too large", start, cursor.end)
    return tree.Number(start, cursor.end, value)


def _string(cursor: Cursor) -> tree.Text:
    start, text = cursor.start, cursor.text
    cursor.advance()
    return tree.Text(start, cursor.end, text[1:-1])


def _constant(cursor: Cursor) -> tree.Constant:
    start, kind = cursor.start, cursor.kind
    cursor.advance()
    return tree.Constant(start, cursor.end, _CONSTANTS[kind])


def _list_of_numbers(cursor: Cursor) -> Expression:
    return _numbers(cursor, pose=False)


def _pose_of_numbers(cursor: Cursor) -> Expression:
    start = cursor.start
    numbers = _numbers(cursor, pose=True)
    if len(numbers.values) == 1:  # p[0]: an element of a variable named p
        index = tree.Number(*numbers.places[0], numbers.values[0])
        return tree.Index(start, numbers.end, tree.Name(start, start + 1, "p"), (index,))
    return numbers


def _numbers(cursor: Cursor, *, pose: bool) -> tree.Numbers:
    start, text = cursor.start, cursor.text
    found = numbers_in(text)
    values = tuple([number_value(text[a:b]) for a, b in found])
    places = tuple([(start + a, start + b) for a, b in found])
    cursor.advance()
    if not all(map(math.isfinite, values)):
        raise cursor.source.error("a number in this list is too large", start, cursor.end)
    return tree.Numbers(start, cursor.end, values, places, pose)


def _list(cursor: Cursor) -> Expression:
    start = cursor.start
    items = _items(cursor, "a list", empty=True)
    return tree.Aggregate(start, cursor.end, items, pose=False)


def _items(cursor: Cursor, what: str, empty: bool = False) -> tuple[Expression, ...]:
    opening = cursor.start
    cursor.advance()
    items: list[Expression] = []
    cursor.enter()
    while not (cursor.kind == "]" and (items or empty)):
        if items and not cursor.accept(","):
            raise cursor.unexpected(f"',' or ']' of {what} begun in {cursor.where(opening)}")
        if items and cursor.kind == "]":
            break
        items.append(parse_expression(cursor))
    cursor.depth -= 1
    cursor.advance()
    return tuple(items)


def _named(cursor: Cursor) -> Expression:
    start, text = cursor.start, cursor.text
    cursor.index += 1
    if cursor.kinds[cursor.index] == "(":
        arguments = parse_arguments(cursor, text)
        return tree.Call(start, cursor.end, text, arguments)
    if text == "p" and cursor.kind == "[" and cursor.start == cursor.end:
        items = _items(cursor, "a pose")
        if len(items) == 1:  # p[i]: an element of a variable named p
            return tree.Index(start, cursor.end, tree.Name(start, start + 1, text), items)
        return tree.Aggregate(start, cursor.end, items, pose=True)
    return tree.Name(start, cursor.end, text)


def parse_arguments(cursor: Cursor, name: str) -> tuple[tree.Argument, ...]:
    """``(a, b, c=d)`` behind a name.

    Raises:
        SourceError: it is not closed, or an argument is no expression.
    """
    opening = cursor.start
    cursor.expect("(", f"after {name}")
    arguments: list[tree.Argument] = []
    cursor.enter()
    while not cursor.accept(")"):
        if arguments:
            if not cursor.accept(","):
                raise cursor.unexpected(
                    f"',' or ')' of the call of {name} begun in {cursor.where(opening)}"
                )
            if cursor.accept(")"):
                break
        arguments.append(_argument(cursor))
    cursor.depth -= 1
    return tuple(arguments)


def _argument(cursor: Cursor) -> tree.Argument:
    index, kinds = cursor.index, cursor.kinds
    start = cursor.starts[index]
    name = None
    if kinds[index] == NAME and kinds[index + 1] == "=":
        name = cursor.name("the name of an argument")
        cursor.index += 1
    value = parse_expression(cursor)
    return tree.Argument(start, cursor.end, name, value)


def _bracketed(cursor: Cursor) -> Expression:
    opening = cursor.start
    cursor.advance()
    with cursor.nested():
        inner = parse_expression(cursor)
    if not cursor.accept(")"):
        raise cursor.unexpected(f"')' for the bracket opened in {cursor.where(opening)}")
    return inner


def _run(cursor: Cursor) -> Expression:
    start = cursor.start
    cursor.advance()
    begin = cursor.start
    name = cursor.name("the name of a thread")
    arguments = parse_arguments(cursor, name)
    return tree.StartThread(start, cursor.end, tree.Call(begin, cursor.end, name, arguments))


_CLOSING = frozenset({",", ")", "]", LINE, ";"})
"""Behind these kinds of token no operator goes on."""
_PLAIN: dict[str, Callable[[Cursor], Expression]] = {
    NUMBER: _number,
    STRING: _string,
    NUMBERS: _list_of_numbers,
    POSE: _pose_of_numbers,
    NAME: _named,
}
_PRIMARIES: dict[str, Callable[[Cursor], Expression]] = {
    **_PLAIN,
    "[": _list,
    "(": _bracketed,
    "run": _run,
    "True": _constant,
    "False": _constant,
    "None": _constant,
}
