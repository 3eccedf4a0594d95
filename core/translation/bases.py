"""From which named targets a program computes others: ``Offs(p10,0,0,50)`` is one of p10."""

from __future__ import annotations

import re
from dataclasses import replace

from ..program.move import Move
from ..program.origin import MoveOrigin, Origin, Ownership
from ..program.program import Program
from ..source.reading import Files, Reading

_NAME = re.compile(r"[^\W\d]\w*")


def with_bases(program: Program, source: Program) -> Program:
    """The program in which the origins of computed targets name the first target, of those that
    the program drives to, in the expression that computes them.

    Args:
        source: as it was read.
    """
    reading = source.reading
    if not isinstance(reading, Reading):
        return program
    names = {m.target.name.casefold() for m in program.moves if m.target.name}
    moves = [_with_base(move, reading.files, names) for move in program.moves]
    return program.with_moves(tuple(moves))


def _with_base(move: Move, files: Files, names: set[str]) -> Move:
    origin = move.origin
    if origin is None or move.target.name is not None:
        return move
    base = _base(origin.target, files, names)
    if base is None:
        return move
    named: MoveOrigin = replace(origin, target=replace(origin.target, base=base))
    return replace(move, origin=named)


def _base(origin: Origin, files: Files, names: set[str]) -> str | None:
    if origin.ownership is not Ownership.DERIVED:
        return None
    file = files.get(origin.span.file)
    text = "" if file is None else file.text[origin.span.start : origin.span.end]
    found = (name.casefold() for name in _NAME.findall(text))
    return next((name for name in found if name in names), None)
