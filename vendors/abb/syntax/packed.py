"""The parts of brackets that came as one token."""

from __future__ import annotations

import re
from functools import partial

from ....core.errors import Span
from ....core.source.text.files import SourceText
from .tree import Aggregate, Number, Packed

_SPAN = partial(tuple.__new__, Span)
"""A span of its parts: most of a program's text are numbers."""
_NUMBER = re.compile(r"-?[0-9][0-9.eE+-]*")


def number_spans(packed: Packed) -> tuple[Span, ...]:
    """Spans of its numbers, left to right."""
    whole, text = packed.span, packed.text
    file, line, column, start = whole.file, whole.line, whole.column, whole.start
    places = [found.span() for found in _NUMBER.finditer(text)]
    if "\n" not in text and "\r" not in text:
        return tuple([_SPAN((file, line, column + a, start + a, start + b)) for a, b in places])
    source = SourceText(text, file)
    return tuple(_place(whole, source, a, b) for a, b in places)


def unpacked(packed: Packed) -> Aggregate:
    """The same with a node for every number."""
    spans = iter(number_spans(packed))
    source = SourceText(packed.text, packed.span.file)
    opening = [i for i, character in enumerate(packed.text) if character == "["][1:]
    closing = [i + 1 for i, character in enumerate(packed.text) if character == "]"]
    rows = iter(zip(opening, closing, strict=False))
    items: list[Number | Aggregate] = []
    for value in packed.value:
        if isinstance(value, tuple):
            numbers = tuple(Number(next(spans), v) for v in value)
            items.append(Aggregate(_place(packed.span, source, *next(rows)), numbers))
        else:
            items.append(Number(next(spans), value))
    return Aggregate(packed.span, tuple(items))


def _place(whole: Span, source: SourceText, start: int, end: int) -> Span:
    """A stretch of the text of ``whole`` as a place in the file."""
    inner = source.span(start, end)
    column = inner.column + (whole.column - 1 if inner.line == 1 else 0)
    line = whole.line + inner.line - 1
    return Span(whole.file, line, column, whole.start + start, whole.start + end)
