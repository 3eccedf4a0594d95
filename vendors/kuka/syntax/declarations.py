"""Tokens → declarations."""

from __future__ import annotations

from .cursor import Cursor
from .expressions import parse_expression, parse_indices, parse_name
from .lexer import NAME, NEWLINE
from .tree import Declaration, EnumDefinition, SignalDeclaration, StrucDefinition

Declared = tuple[Declaration | SignalDeclaration | StrucDefinition | EnumDefinition, ...]


def parse_declaration(cursor: Cursor) -> Declared:
    """``[GLOBAL] [DECL] [CONST] type a[3], b = 1``; the words in any order."""
    start = cursor.start
    shared = constant = False
    while True:
        if cursor.accept("global"):
            shared = True
        elif cursor.kind == NAME and cursor.text.lower() == "const":
            cursor.advance()
            constant = True
        elif not cursor.accept("decl"):
            break
    if cursor.kind == "struc":
        return (parse_struc(cursor),)
    if cursor.kind == "enum":
        return (parse_enum(cursor),)
    if cursor.kind == "signal":
        return (parse_signal(cursor),)
    type_name = cursor.name("a type").lower()
    found: list[Declaration] = []
    while not found or cursor.accept(","):
        start = start if not found else cursor.start
        text = cursor.word("the name of the datum")
        dimensions = parse_indices(cursor) if cursor.kind == "[" else None
        value = parse_expression(cursor) if cursor.accept("=") else None
        found.append(
            Declaration(
                cursor.span_from(start),
                type_name,
                text.lower(),
                text,
                shared,
                constant,
                (None,) if dimensions == () else dimensions or (),
                value,
            )
        )
    cursor.end_of_line(f"the declaration of {found[-1].text}")
    return tuple(found)


def parse_struc(cursor: Cursor) -> StrucDefinition:
    """``STRUC name REAL A, B, INT C``"""
    start = cursor.start
    cursor.advance()
    name = cursor.word("the name of the structure").lower()
    components: list[tuple[str, str, int]] = []
    type_name = ""
    while not components or cursor.accept(","):
        if cursor.peek() in (NAME, *_SEPARABLE):
            type_name = cursor.word("the type of a component").lower()
        component = cursor.word("the name of a component").lower()
        dimensions = len(parse_indices(cursor)) if cursor.kind == "[" else 0
        components.append((type_name, component, dimensions))
    span = cursor.span_from(start)
    cursor.end_of_line("the structure")
    return StrucDefinition(span, name, tuple(components))


_SEPARABLE = ("step", "default", "end", "to", "exit", "case", "signal", "halt")
"""Keywords that are met as the names of components."""


def parse_enum(cursor: Cursor) -> EnumDefinition:
    """``ENUM name A, B``"""
    start = cursor.start
    cursor.advance()
    name = cursor.word("the name of the enumeration").lower()
    constants = cursor.listed(lambda cursor: cursor.word("a constant").lower())
    span = cursor.span_from(start)
    cursor.end_of_line("the enumeration")
    return EnumDefinition(span, name, constants)


def parse_signal(cursor: Cursor) -> SignalDeclaration:
    """``SIGNAL name $IN[1] TO $IN[4]``"""
    start = cursor.start
    cursor.advance()
    text = cursor.word("the name of the signal")
    first = parse_name(cursor)
    last = parse_name(cursor) if cursor.accept("to") else None
    span = cursor.span_from(start)
    if cursor.kind != NEWLINE:
        cursor.skip_line()
    cursor.accept(NEWLINE)
    return SignalDeclaration(span, text.lower(), text, first, last)
