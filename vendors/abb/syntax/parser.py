"""Source text → syntax tree.

A descent by hand over the tokens of `lexer`; `statements` and `expressions` hold the rest. A LALR
parser that lark makes of a grammar of declarations and calls alone takes 1.7 times as long for
its untyped tree (0.23 s against 0.13 s for 900 lines with 500 robtargets, 6.7 s against 4.0 s for
19 800 lines; one shared core, Python 3.11). The other reason is messages: each says what should
stand in the place, and not which of thirty terminals would be accepted there.
"""

from __future__ import annotations

import re
from pathlib import PurePath

from ....core.errors import ParseError
from ....core.source.text.files import SourceText
from .cursor import Cursor
from .expressions import parse_braces, parse_expression
from .lexer import END, NAME, NUMBER, tokenize
from .statements import CLOSING, parse_block
from .tree import (
    AliasDefinition,
    Declaration,
    Expression,
    Handler,
    Module,
    Parameter,
    RecordDefinition,
    Routine,
    Unreadable,
)

_WORD = re.compile(r"\w+")
STORAGE = ("const", "var", "pers")
HANDLERS = ("error", "undo", "backward")
ROUTINES = ("proc", "func", "trap")
_PARTS = (*STORAGE, *ROUTINES, "local", "task", "record", "alias")
"""Words that begin what stands in a module."""


def parse(source: SourceText) -> tuple[Module, ...]:
    """The modules of a source text.

    Raises:
        SourceError: the text is no RAPID, or is cut off.
    """
    try:
        return _parse(source)
    except ParseError as error:
        raise (error if source.damage is None else source.damage.first(error)) from None


def _parse(source: SourceText) -> tuple[Module, ...]:
    cursor = Cursor(tokenize(source))
    if cursor.kind == END:
        raise source.error("the file holds no module", cursor.start)
    modules = []
    while cursor.kind != END:
        modules.append(_module(cursor))
    return tuple(modules)


def _module(cursor: Cursor) -> Module:
    start = cursor.start
    damage = cursor.source.damage
    if cursor.kind in _PARTS and damage is not None and start == cursor.starts[0]:
        text = re.sub(r"\W", "_", PurePath(cursor.source.file.replace("\\", "/")).stem)
        part = cursor.source.error("this is a part of a module, without MODULE and its name", start)
        damage.step_over(part, f"it is read as MODULE {text}")
        return _content(cursor, start, text, (), END)
    if cursor.kind in _PARTS:
        raise cursor.source.error(
            "this is a part of a module, which begins with MODULE and its name: put MODULE Part "
            "before it and ENDMODULE behind it",
            start,
        )
    cursor.expect("module", "at the beginning of the file")
    text = _module_name(cursor)
    return _content(cursor, start, text, _attributes(cursor), "endmodule")


def _module_name(cursor: Cursor) -> str:
    """A module's name; of a damaged text also one that begins with a digit."""
    damage, start = cursor.source.damage, cursor.start
    word = _WORD.match(cursor.source.text, start)
    if cursor.kind != NUMBER or damage is None or word is None:
        return cursor.name("the module's name")
    while cursor.kind != END and cursor.start < word.end():
        cursor.advance()
    text = word[0]
    error = cursor.source.error(f"the module's name {text} begins with a digit", start)
    damage.step_over(error, "it is read all the same")
    return text


def _content(
    cursor: Cursor, start: int, text: str, attributes: tuple[str, ...], end: str
) -> Module:
    """What stands in a module.

    Args:
        start: where it begins.
        text: its name.
        end: kind of the token that ends it.
    """
    damage = cursor.source.damage
    types: list[RecordDefinition | AliasDefinition] = []
    declarations: list[Declaration] = []
    routines: list[Routine] = []
    while cursor.kind != end:
        if cursor.kind == END and damage is not None:
            missing = cursor.source.error(
                f"ENDMODULE is missing, to end MODULE {text}", cursor.start
            )
            damage.step_over(missing, "the module is taken to end with the file")
            break
        begin = cursor.start
        local = cursor.accept("local")
        if not local:
            cursor.accept("task")
        kind = cursor.kind
        if kind in STORAGE:
            declarations += _mended(cursor, begin, local)
        elif kind in ROUTINES:
            routines.append(_routine(cursor, begin, local))
        elif kind == "record":
            types.append(_record(cursor, begin, local))
        elif kind == "alias":
            types.append(_alias(cursor, begin, local))
        else:
            declarations += _stray(cursor, begin, local)
    cursor.advance()
    return Module(
        cursor.span_from(start),
        text.lower(),
        text,
        attributes,
        tuple(types),
        tuple(declarations),
        tuple(routines),
    )


def _attributes(cursor: Cursor) -> tuple[str, ...]:
    attributes: list[str] = []
    if cursor.accept("("):
        while not cursor.accept(")"):
            if attributes:
                cursor.expect(",", "between the attributes of a module")
            attributes.append(cursor.name("an attribute of the module").lower())
    return tuple(attributes)


def _mended(cursor: Cursor, start: int, local: bool = False) -> list[Declaration]:
    """A declaration; without what it declares where it is damaged and may be stepped over."""
    begin, depth = cursor.index, cursor.depth
    try:
        return [_declaration(cursor, start, local)]
    except ParseError as error:
        cursor.step_over(error, "it is stepped over, and what it declares is not known")
        found = _declared(cursor, begin, start, local, error.message)
        cursor.depth = depth
        cursor.skip_statement(begin, (*_PARTS, *CLOSING))
        return found


def _stray(cursor: Cursor, start: int, local: bool) -> list[Declaration]:
    """What stands in a module and begins no part of it, as a misspelt CONST does.

    Raises:
        ParseError: it may not be stepped over.
    """
    begin = cursor.index
    error = cursor.unexpected("a declaration, PROC, FUNC, TRAP or ENDMODULE")
    cursor.step_over(error, "it is stepped over, and what it declares is not known")
    found = []
    if cursor.kinds[begin : begin + 3] == [NAME] * 3:
        found = _declared(cursor, begin, start, local, error.message)
    cursor.skip_statement(begin, (*_PARTS, *CLOSING))
    return found


def _declared(
    cursor: Cursor, begin: int, start: int, local: bool, message: str
) -> list[Declaration]:
    """The datum of a damaged declaration, with a value that nobody can read: another datum of its
    name is not meant."""
    stopped, cursor.index = cursor.index, begin + 1
    try:
        type_name = cursor.name("a type").lower()
        text = cursor.name("the name of the datum")
        dimensions = parse_braces(cursor) if cursor.kind == "{" else ()
    except ParseError:
        return []
    finally:
        cursor.index = stopped
    span = cursor.source.span(start, max(start, cursor.end))
    value = Unreadable(span, message)
    kind = cursor.kinds[begin] if cursor.kinds[begin] in STORAGE else "var"
    return [Declaration(span, kind, type_name, text.lower(), text, dimensions, value, local)]


def _declaration(cursor: Cursor, start: int, local: bool = False) -> Declaration:
    kind = cursor.kind
    cursor.advance()
    type_name = cursor.name("a type").lower()
    text = cursor.name("the name of the datum")
    dimensions = parse_braces(cursor) if cursor.kind == "{" else ()
    value = parse_expression(cursor) if cursor.accept(":=") else None
    cursor.expect(";", f"at the end of the declaration of {text}")
    span = cursor.span_from(start)
    return Declaration(span, kind, type_name, text.lower(), text, dimensions, value, local)


def _record(cursor: Cursor, start: int, local: bool) -> RecordDefinition:
    cursor.advance()
    name = cursor.name("the name of the record").lower()
    components = []
    while not cursor.accept("endrecord"):
        type_name = cursor.name("a component's type").lower()
        components.append((type_name, cursor.name("a component's name").lower()))
        cursor.expect(";", "after the component")
    return RecordDefinition(cursor.span_from(start), name, tuple(components), local)


def _alias(cursor: Cursor, start: int, local: bool) -> AliasDefinition:
    cursor.advance()
    type_name = cursor.name("a type").lower()
    name = cursor.name("the name of the alias").lower()
    cursor.expect(";", "after the alias")
    return AliasDefinition(cursor.span_from(start), name, type_name, local)


def _routine(cursor: Cursor, start: int, local: bool) -> Routine:
    kind = cursor.kind
    cursor.advance()
    returns = cursor.name("the function's type").lower() if kind == "func" else None
    text = cursor.name(f"the name of the {kind.upper()}")
    parameters = _parameters(cursor) if kind != "trap" else ()
    declarations: list[Declaration] = []
    while cursor.kind in STORAGE:
        declarations += _mended(cursor, cursor.start)
    end = f"end{kind}"
    ends = frozenset({end, *HANDLERS})
    head = f"{kind.upper()} {text}"
    body = parse_block(cursor, ends, head, start)
    handler = _handler(cursor, ends, head, start)
    cursor.expect(end, f"to end {head}")
    if cursor.jumps:
        cursor.check_jumps(body)
        if handler is not None:
            cursor.check_jumps(handler.body, frozenset(body.labels))
        cursor.jumps = False
    return Routine(
        cursor.span_from(start),
        kind,
        text.lower(),
        text,
        parameters,
        tuple(declarations),
        body,
        returns,
        handler,
        local,
    )


def _handler(cursor: Cursor, ends: frozenset[str], head: str, start: int) -> Handler | None:
    """The ERROR part; UNDO and BACKWARD are checked for their form and left out of the tree."""
    handler = None
    while (kind := cursor.kind) in HANDLERS:
        cursor.advance()
        numbers: tuple[Expression, ...] = ()
        if kind == "error" and cursor.accept("("):
            numbers = cursor.listed(parse_expression)
            cursor.expect(")", "after the error numbers")
        body = parse_block(cursor, ends, head, start)
        if kind == "error" and handler is None:
            handler = Handler(numbers, body)
    return handler


def _parameters(cursor: Cursor) -> tuple[Parameter, ...]:
    cursor.expect("(", "after the name of the routine")
    parameters: list[Parameter] = []
    group = 0
    while not cursor.accept(")"):
        if not cursor.accept("|"):
            group += 1
            if parameters and not cursor.accept(",") and cursor.kind != "\\":
                raise cursor.unexpected("',' or ')'")
        parameters.append(_parameter(cursor, group, parameters))
    return tuple(parameters)


def _parameter(cursor: Cursor, group: int, before: list[Parameter]) -> Parameter:
    start = cursor.start
    alternative = bool(before) and before[-1].group == group
    optional = cursor.accept("\\") or (alternative and before[-1].optional)
    mode = "in"
    if cursor.kind in ("inout", "var", "pers"):
        mode = cursor.kind
        cursor.advance()
    type_name = cursor.name("the type of a parameter").lower()
    if type_name == "ref" and cursor.kind == NAME and cursor.peek() == NAME:
        type_name = cursor.name("the type of a parameter").lower()
    text = cursor.name("the name of a parameter")
    dimensions = _open_dimensions(cursor)
    span = cursor.span_from(start)
    return Parameter(span, mode, type_name, text.lower(), text, dimensions, optional, group)


def _open_dimensions(cursor: Cursor) -> int:
    """``{*, *}``: an array of any size."""
    if not cursor.accept("{"):
        return 0
    count = 1
    cursor.expect("*", "as the size of an array parameter")
    while cursor.accept(","):
        cursor.expect("*", "as the size of an array parameter")
        count += 1
    cursor.expect("}", "after the sizes of an array parameter")
    return count
