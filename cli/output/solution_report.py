"""What commands that change a program say of the solution: figures, proof, files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ...tasks.files.source_places import note_json, short_place
from .console import print_rich, print_table, warn, warn_of

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.errors import Span
    from ...problems.improve.solution import FigureRow, Solution

NAMED = 3
"""Moves of a line whose numbers are said."""
_FIGURES = (("", "left"), ("unit", "left"), ("before", "right"), ("after", "right"), ("%", "right"))


def tell_solution(program: Path, made: Solution, cell: Cell, written: Sequence[Path]) -> None:
    """Print figures before and after, notes, the proof and what was written."""
    rows = [
        (row.what, row.unit, *row.shown, percent(row)) for row in made.table(cell.robot.axis_names)
    ]
    print_table(_FIGURES, rows)
    warn_of(made.notes)
    if made.certificate is not None:
        say = print_rich if made.proven else warn
        say(f"{program}: {made.certificate}")
    for pair in _allowed(cell):
        print_rich(f"allowed to touch by the cell: {pair[0]} and {pair[1]}")
    for path in written:
        print_rich(f"wrote {path}")


def solution_json(made: Solution, cell: Cell, written: Sequence[Path]) -> dict[str, Any]:
    """The same for ``--json``."""
    proof = made.certificate
    return {
        "robot": cell.robot.name,
        "changed": made.changed,
        "proven": made.proven,
        "certificate": None if proof is None else proof.message,
        "allowed": [list(pair) for pair in _allowed(cell)],
        "figures": [
            {"what": row.what, "unit": row.unit, "before": row.before, "after": row.after}
            for row in made.table(cell.robot.axis_names)
        ],
        "notes": [note_json(note) for note in made.notes],
        "files": [str(path) for path in written],
    }


def _allowed(cell: Cell) -> Sequence[tuple[str, str]]:
    """What a user allows to touch; where there is no file it is a matter of the floor alone."""
    return () if cell.file is None else cell.allowed


class ChangedMove(NamedTuple):
    """A move of a table of changes.

    Args:
        move: index of it.
        span: where it stands; None where nobody knows.
        said: what is said of it.
    """

    move: int
    span: Span | None
    said: tuple[str, ...]


def changed_rows(
    program: Path, moves: Sequence[ChangedMove], gained: Mapping[int, float]
) -> Iterator[tuple[str, str, tuple[str, ...], str]]:
    """Moves, their line, what is said of them, and what is gained there: a line that runs several
    times is changed once, and is one row with all that it gains.

    Args:
        program: the main file.
        moves: that changed.
        gained: s at the waypoint of each move of the program, changed or not.
    """
    from ...tasks.results.lines import in_lines

    for alike in in_lines(moves, lambda one: (one.span, one.said)):
        place = short_place(program, alike[0].span)
        gains = [gained[one.move] for one in alike if one.move in gained]
        times = f" ×{len(alike)}" if len(alike) > 1 else ""
        numbers = ", ".join(str(one.move + 1) for one in alike[:NAMED])
        more = "" if len(alike) <= NAMED else ", …"
        shown = gain_shown(sum(gains) if gains else None)
        yield f"{numbers}{more}", f"{place}{times}", alike[0].said, shown
    changed = {one.move for one in moves}
    left = gain_shown(sum(gain for move, gain in gained.items() if move not in changed))
    if moves and float(left):
        yield "others", "", ("",) * len(moves[0].said), left


def gain_shown(seconds: float | None) -> str:
    """Time that a change gains; empty where it is not known."""
    return "" if seconds is None else f"{seconds:z.3f}"


def percent(row: FigureRow) -> str:
    """The change in percent; empty where there is none, or the value before is shown as zero."""
    if row.change is None or float(row.shown[0]) == 0.0:
        return ""
    shown = f"{row.change:.1f}"
    return "0.0" if shown == "-0.0" else shown
