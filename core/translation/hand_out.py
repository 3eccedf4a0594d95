"""A translation as it is written, read again and driven before anybody gets it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from ..display import counted
from ..driving.driven_program import DrivenPart
from ..errors import MotionError
from ..lint.check import check
from ..lint.finding import Finding, Severity
from ..program.folding import usable
from ..program.move import MoveC, MoveJ, MoveL
from ..program.program import Program
from ..robot.model import Robot
from ..source.execution.answers import Answers
from ..source.reading import ReadOptions
from ..vendor import Vendor
from .translate import Translation

Around = Callable[[Program, Sequence[DrivenPart]], list[Finding]]
_CYCLES = 2
"""Passes that are driven of a loop without an end: how it comes back to its beginning counts."""


def check_driven(
    made: Translation,
    sources: Mapping[str, str],
    vendor: Vendor,
    robot: Robot,
    around: Around | None = None,
) -> None:
    """Refuse source files that the new robot cannot drive as they are written.

    Args:
        made: what was written.
        sources: its texts by file name.
        vendor, robot: the new ones.
        around: finds what a program meets in its cell; None without one.

    Raises:
        MotionError: an error of `flyby check` in them; the move and line of the old program are
            named.
    """
    main = next((name for name in sources if name.lower().endswith(vendor.suffixes)), None)
    if main is None or vendor.reader is None or not made.program.moves:
        return
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_bytes(text.encode())
        options = ReadOptions(None, robot, Answers(cycles=_CYCLES))
        again = vendor.reader.read_file(Path(folder) / main, options)
    again = _with_own_tools(replace(again, notes=()), made.program)
    met = None if around is None else partial(around, again)
    found = check(again, vendor, robot, made.start, met)
    errors = [f for f in found if f.severity is Severity.ERROR]
    if not errors:
        return
    first, *rest = errors
    move = None if first.move is None else _index(made.program, again, first.move)
    span = None if move is None else made.program.moves[move].statement
    more = f" ({counted(rest, 'further error')})" if rest else ""
    raise MotionError(
        f"what would be written for {robot.name} is at fault: {first.message}: {first.fix}{more}",
        move,
        span,
    )


def _with_own_tools(again: Program, program: Program) -> Program:
    """What was read again, with the names of tools, which no language need have."""
    tools = (program.moves[_index(program, again, k)].tool for k in range(len(again.moves)))
    moves = zip(again.moves, tools, strict=True)
    return again.with_moves(tuple(replace(m, tool=replace(m.tool, name=t.name)) for m, t in moves))


def _index(program: Program, again: Program, move: int) -> int:
    """Index of the translated move that a move of the written program is."""
    moves = program.moves
    length = _loop(program)
    # What comes before the program's own moves is the way to its start.
    index = move - (len(again.moves) - len(moves) - length)
    if index >= len(moves) and length:
        index -= length
    return min(max(index, 0), len(moves) - 1)


def _loop(program: Program) -> int:
    """Moves of the loop without an end."""
    loop = next((s for s in usable(program) if s.endless), None)
    if loop is None:
        return 0
    inside = program.statements[loop.begin : loop.end]
    return sum(isinstance(s, MoveJ | MoveL | MoveC) for s in inside)
