"""Literals → values that know where they stand."""

from __future__ import annotations

from ..syntax.expressions import number_value
from ..syntax.lexer import ITEM, RECORD_TYPE, bits_value
from ..syntax.tree import Flat, Number
from .values import Choice, Leaf, Real, Root, Struct, Value, Whole


def number_literal(node: Number, datum: str | None) -> Value:
    """A number that is the whole of a literal."""
    root = Root(node.source, node.start, node.end, datum)
    return numeral(node.value, Leaf(root, ""))


def numeral(value: int | float, leaf: Leaf) -> Value:
    """A number at its place."""
    return Whole.at(value, leaf) if isinstance(value, int) else Real.at(value, leaf)


def flat_literal(
    node: Flat, datum: str | None, inside: Root | None = None, prefix: str = ""
) -> Struct:
    """The structure that a flat aggregate is.

    Args:
        datum: what it becomes the value of.
        inside: the larger literal that it is part of, with the path of its components in it.

    Raises:
        SourceError: a number in it is too large.
    """
    text = node.source.text
    root = inside or Root(node.source, node.start, node.end, datum)
    type_name = RECORD_TYPE.match(text, node.start, node.end)
    made: dict[str, Value] = {}
    leaves = root.leaves
    for found in ITEM.finditer(text, node.start, node.end):
        name, kind = found[1].lower(), found.lastgroup
        start, end = found.span(found.lastindex or 0)
        item = text[start:end]
        if kind == "number":
            path = prefix + name
            leaves[path] = (start, end)
            made[name] = numeral(_signed(node, item, start, end), Leaf(root, path))
        elif kind == "enum":
            made[name] = Choice(item.lower())
        elif kind == "string":
            made[name] = item
        elif kind == "truth":
            made[name] = item.lower() == "true"
        else:
            made[name] = _bits(node, item, start, end)
    return Struct(type_name["type"].lower() if type_name else "", made)


def _signed(node: Flat, item: str, start: int, end: int) -> int | float:
    signed = item[0] in "+-"
    value = number_value(item[1:].strip() if signed else item)
    if value - value != 0:
        raise node.source.error("this number is too large", start, end)
    return -value if item[0] == "-" else value


def _bits(node: Flat, item: str, start: int, end: int) -> int:
    try:
        return bits_value(item)
    except ValueError:
        raise node.source.error(f"{item} is no number: 'B0101' and 'H1F' are", start, end) from None
