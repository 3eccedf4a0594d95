"""Which statements of a program are executed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace

from ...errors import Span
from ...program.program import Program
from ..reading import Reading
from ..text.files import lines_of


def executed(program: Program, reading: Reading) -> Mapping[tuple[str, int], set[tuple[int, int]]]:
    """Start and end of every executed statement, by file and line."""
    found: defaultdict[tuple[str, int], set[tuple[int, int]]] = defaultdict(set)

    def note(span: Span) -> None:
        found[span.file, span.line].add((span.start, span.end))

    reading.read(reading.files, reading.main, replace(reading.options, executed=note))
    for move in program.moves:
        if move.origin is not None:
            # All lines of a motion instruction, where of a block only the first one is executed.
            span = move.origin.statement
            for line in lines_of_span(span, reading):
                found[span.file, line].add((span.start, span.end))
    return found


def lines_of_span(span: Span, reading: Reading) -> range:
    """The numbers of the lines that a span touches."""
    text = reading.files[span.file].text[span.start : span.end]
    return range(span.line, span.line + len(lines_of(text)))
