"""Source text → syntax tree: the routines and data lists of a file.

A descent by hand over the tokens of `lexer`, for its messages and its speed.
"""

from __future__ import annotations

import re
from pathlib import PurePath

from ....core.errors import Note, ParseError
from ....core.source.text.files import SourceText
from .cursor import Cursor
from .expressions import parse_indices
from .lexer import END, NEWLINE, tokenize
from .statements import CLOSING, parse_block
from .tree import Block, DataList, Parameter, Routine, Unit

_INCLUDE = re.compile(r"INCLUDE[ \t]+[\"<'\w]", re.IGNORECASE)


def parse(source: SourceText) -> Unit:
    """What a source text holds.

    Where statements of it may be stepped over, a file that is only a part of one, without DEF or
    DEFDAT, is read as if they stood round it.

    Raises:
        SourceError: the text is no KRL, or is cut off.
    """
    try:
        return _parse(source)
    except ParseError as error:
        raise (error if source.damage is None else source.damage.first(error)) from None


def _parse(source: SourceText) -> Unit:
    cursor = Cursor(tokenize(source))
    routines: list[Routine] = []
    lists: list[DataList] = []
    notes: list[Note] = []
    while True:
        start = cursor.start
        shared = cursor.accept("global")
        kind = cursor.kind
        if kind in ("def", "deffct"):
            routines.append(_routine(cursor, start, shared, notes))
        elif kind == "defdat" and not shared:
            lists.append(_data_list(cursor, notes))
        elif kind == NEWLINE:
            cursor.advance()
        elif kind == END:
            break
        elif kind in CLOSING:
            raise cursor.unexpected("DEF, DEFFCT or DEFDAT")
        elif source.damage is not None and _INCLUDE.match(source.text, start):
            _step_over_include(cursor)
        elif source.damage is not None and not routines and not lists:
            _add_part(cursor, routines, lists)
        else:
            raise cursor.unexpected("DEF, DEFFCT or DEFDAT (a program begins with one)")
    if not routines and not lists:
        raise source.error("the file holds no DEF and no DEFDAT: it is empty or no KRL", 0)
    if source.damage is not None:
        notes += source.damage.notes()
    return Unit(source, tuple(routines), tuple(lists), tuple(notes))


def _step_over_include(cursor: Cursor) -> None:
    """A line of another language, before the first routine."""
    error = cursor.source.error(
        "KRL includes no files: take the line out, and name the files that belong to the program",
        cursor.start,
    )
    cursor.skip_line()
    cursor.step_over(error)


def _add_part(cursor: Cursor, routines: list[Routine], lists: list[DataList]) -> None:
    """A part of a program, or of a data list, is read as all of it."""
    start = cursor.start
    path = PurePath(cursor.source.file.replace("\\", "/"))
    data = path.suffix.lower() == ".dat"
    kind = "DEFDAT" if data else "DEF"
    span = cursor.source.span(start, start)
    part = cursor.source.error(f"the file is a part of a program, without {kind}", start)
    cursor.step_over(part, f"it is read as {kind} {path.stem}")
    body = parse_block(cursor, frozenset({END}), f"the {kind}", start)
    name = path.stem.lower()
    if data:
        lists.append(DataList(span, name, path.stem, False, body))
    else:
        routines.append(Routine(span, name, path.stem, (), body, None, False))


def _routine(cursor: Cursor, start: int, shared: bool, notes: list[Note]) -> Routine:
    kind = cursor.kind
    begin = cursor.start
    cursor.advance()
    returns = None
    if kind == "deffct":
        returns = cursor.word("the type of the function's value").lower()
        if cursor.kind == "[":
            parse_indices(cursor)
    text = cursor.word(f"the name of the {kind.upper()}")
    parameters = _parameters(cursor) if cursor.kind == "(" else ()
    if not cursor.at_end_of_line:
        cursor.skip_line()
    span = cursor.span_from(start)
    end = "end" if kind == "def" else "endfct"
    # A function that ends with END is met, and no controller would mistake it.
    ends = frozenset({end, "end"})
    body = _body(cursor, ends, f"{kind.upper()} {text}", begin, notes)
    if cursor.jumps:
        cursor.check_jumps(body)
        cursor.jumps = False
    return Routine(span, text.lower(), text, parameters, body, returns, shared)


def _parameters(cursor: Cursor) -> tuple[Parameter, ...]:
    """``(A:IN, B[]:OUT)``; parameters are handed over by reference unless they are ``:IN``."""
    cursor.advance()
    parameters: list[Parameter] = []
    while not cursor.accept(")"):
        if parameters:
            cursor.expect(",", "between the parameters")
        text = cursor.word("the name of a parameter")
        if cursor.kind == "[":
            parse_indices(cursor)
        by_reference = True
        if cursor.accept(":"):
            by_reference = cursor.word("IN or OUT").lower() != "in"
        parameters.append(Parameter(text.lower(), text, by_reference))
    return tuple(parameters)


def _body(
    cursor: Cursor, ends: frozenset[str], opened_by: str, start: int, notes: list[Note]
) -> Block:
    """The statements up to the keyword that closes them, or to the end of the file."""
    body = parse_block(cursor, ends | {END}, opened_by, start)
    if cursor.kind == END:
        opened = cursor.source.span(start, start)
        wanted = " or ".join(sorted(end.upper() for end in ends))
        notes.append(
            Note(
                f"the file ends without {wanted}, to close {opened_by}; is it all there?",
                span=opened,
            )
        )
    else:
        cursor.advance()
        cursor.skip_line()
    return body


def _data_list(cursor: Cursor, notes: list[Note]) -> DataList:
    start = cursor.start
    cursor.advance()
    text = cursor.word("the name of the DEFDAT")
    public = cursor.accept_word("public")
    cursor.skip_line()
    span = cursor.span_from(start)
    body = _body(cursor, frozenset({"enddat"}), f"DEFDAT {text}", start, notes)
    return DataList(span, text.lower(), text, public, body)
