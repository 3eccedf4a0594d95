"""What of a program's text changes: numbers of data, and motion instructions."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import Span
from ...program.move import Move
from ...program.origin import Origin
from ...program.program import Program
from ..patch.edits import changed_moves, reading_of
from ..patch.insertions import changes_of
from ..patch.uses import UseKind
from .executed import lines_of_span


@dataclass(frozen=True, slots=True)
class ChangedNumber:
    """A number that changes.

    Args:
        datum: that it belongs to; None for a literal where it is used.
        move: index of the first move that reads it.
        span: of the number.
    """

    datum: str | None
    move: int
    span: Span


def changed_numbers(before: Program, after: Program) -> list[ChangedNumber]:
    """Changed data by their first number, and changed literals outside of the move itself."""
    found: dict[object, ChangedNumber] = {}
    _, kept = changes_of(before, after)
    for index, old, new in changed_moves(before, after):
        for kind in UseKind:
            origin: Origin | None = getattr(old.origin, kind, None)
            if origin is None or getattr(old, kind) == getattr(new, kind):
                continue
            if not _same_datum(origin, new, kind):
                continue
            assert old.origin is not None
            own = old.origin.statement
            for k, span in enumerate(origin.numbers):
                if span is None or (span.file, span.line) in kept:
                    continue
                datum = origin.datum_of(k)
                inside = span.file == own.file and own.start <= span.start < own.end
                if datum is not None or not inside:
                    found.setdefault(datum or span, ChangedNumber(datum, index, span))
    return list(found.values())


def changed_statements(before: Program, after: Program) -> list[tuple[int, Span]]:
    """Motion instructions with other numbers or words of their own, and their first moves."""
    found: dict[Span, int] = {}
    reading = reading_of(before)
    _, kept = changes_of(before, after)
    for index, old, new in changed_moves(before, after):
        assert old.origin is not None
        own = old.origin.statement
        if kept:
            changed = any((own.file, line) not in kept for line in lines_of_span(own, reading))
        else:
            parts = (
                getattr(old.origin, k, None)
                for k in UseKind
                if getattr(old, k, 0) != getattr(new, k, 0)
            )
            spans = [span for part in parts if part is not None for span in part.numbers]
            changed = any(
                s is not None and s.file == own.file and own.start <= s.start < own.end
                for s in spans
            )
        if changed:
            found.setdefault(own, index)
    return [(index, span) for span, index in found.items()]


def _same_datum(old: Origin, new: Move, kind: UseKind) -> bool:
    origin: Origin | None = getattr(new.origin, kind, None)
    return origin is not None and origin.datum == old.datum
