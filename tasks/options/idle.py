"""Options that change nothing in a program: what was meant may be another move."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from ...core.door import spelt
from ...core.errors import Note
from .moves import is_named, moves_named, moves_to

if TYPE_CHECKING:
    from ...core.program.program import Program

ALL = "all"


def idle_kept(
    program: Program, kept: Sequence[int | str], passed: Collection[int], *, path: bool
) -> list[Note]:
    """Notes on moves that stay as they are without being kept.

    Args:
        program: the program.
        kept: as given; they are known to name moves or speeds.
        passed: indices of the moves whose zone might change otherwise.
        path: whether a kept move also holds the zone that it begins in.
    """
    notes = []
    for text in map(str, kept):
        moves = _named(program, text, "keep")
        near = {*moves, *(i - 1 for i in moves)} if path else set(moves)
        if moves and not near & set(passed):
            notes.append(_note("keep", text, "nothing of it would change", moves[0]))
    return notes


def idle_freed(
    program: Program, freed: Sequence[int | str], at_work: Collection[str]
) -> list[Note]:
    """Notes on outputs that are freed, and are on along no path that was taken for work.

    Args:
        program: the program.
        freed: as given; they are known to name stops or outputs.
        at_work: names of the outputs that are, without regard to case.
    """
    names = [text for text in map(str, freed) if text != ALL and not is_named(text)]
    why = "nothing is kept for it, as it is on along no lines at one speed"
    return [
        Note(f"{spelt('free')} {text} has no effect: {why}")
        for text in names
        if text.casefold() not in at_work and not moves_to(program.moves, text)
    ]


def idle_limits(
    program: Program,
    limits: Sequence[str] | Mapping[int | str, object],
    passed: Collection[int],
    stay: Mapping[int, str],
) -> list[Note]:
    """Notes on limits of points that do not move in any case.

    Args:
        program: the program.
        limits: as given; they are known to name moves or speeds.
        passed: indices of the moves that the robot passes.
        stay: why targets of some of these stay.
    """
    notes = []
    names = list(limits) if isinstance(limits, Mapping) else [t.partition("=")[0] for t in limits]
    for text in map(str, names):
        if text == ALL:
            continue
        moves = _named(program, text, "limit")
        if moves and not set(moves) & set(passed) - set(stay):
            why = "the robot stops there, and stops stay where they are"
            notes.append(_note("limit", text, stay.get(moves[0], why), moves[0]))
    return notes


def _named(program: Program, text: str, option: str) -> list[int]:
    """Indices of moves by any of their names, that of their speed included."""
    if is_named(text):
        return moves_named(program, text, option)
    by_speed = [i for i, move in enumerate(program.moves) if move.speed.name == text]
    return [*by_speed, *moves_to(program.moves, text)]


def _note(option: str, text: str, why: str, move: int) -> Note:
    return Note(f"{spelt(option)} {text} has no effect: {why}", move)
