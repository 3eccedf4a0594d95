"""What differs between two states of a program, datum by datum."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace

from ..core.program.move import Move
from ..core.program.origin import Origin
from ..core.program.program import Program

_PARTS = ("target", "speed", "zone")

Change = tuple[tuple[int, str], ...]
"""Parts of moves that are one datum: (index of the move, name of the part)."""


def changes_of(given: Program, wanted: Program) -> list[Change]:
    """All that differs between two programs of as many moves; what stands in one place of the
    source is one change."""
    found: dict[Hashable, list[tuple[int, str]]] = {}
    for i, (old, new) in enumerate(zip(given.moves, wanted.moves, strict=True)):
        for part in _PARTS:
            if getattr(old, part) != getattr(new, part):
                found.setdefault((part, _place(old, i, part)), []).append((i, part))
    return [tuple(change) for change in found.values()]


def with_changes(given: Program, wanted: Program, changes: Sequence[Change]) -> Program:
    """The given program with these changes alone."""
    moves = list(given.moves)
    for change in changes:
        for i, part in change:
            values = {part: getattr(wanted.moves[i], part)}
            moves[i] = replace(moves[i], **values)
    return given.with_moves(tuple(moves))


def _place(move: Move, index: int, part: str) -> Hashable:
    if move.origin is None:
        return index
    origin: Origin = getattr(move.origin, part)
    return origin.numbers or (origin.span, move.origin.statement)
