"""Moves whose tool or work object nobody knows: they are driven with the controller's own."""

from __future__ import annotations

from collections.abc import Collection

from ..door import spelt
from ..errors import InputError
from ..spatial.pose import IDENTITY
from .move import Move
from .program import Program
from .question import QuestionKind


def assumed_places(program: Program) -> dict[int, tuple[str, ...]]:
    """The tools and work objects that are not known, by the index of each move that uses one.

    One that the program has set by then is what it is set to.
    """
    placed = {name.casefold() for name in program.placed}
    asked = _asked(program)
    if not asked:
        return {}
    found: dict[int, tuple[str, ...]] = {}
    known: dict[tuple[int, int], tuple[str, ...]] = {}  # of most moves they are a few objects
    for index, move in enumerate(program.moves):
        pair = id(move.tool), id(move.work_object)
        if pair not in known:
            known[pair] = tuple(asked[n] for n in _at_default(move, placed) if n in asked)
        if known[pair]:
            found[index] = known[pair]
    return found


def refuse_assumed(program: Program) -> None:
    """Refuse a program that something is proven of, or written from, if a place of it, a tool or a
    work object is not known: it would hold for what that is taken for.

    Raises:
        InputError: it names what is not known, and the first move that uses it.
    """
    assumed = assumed_places(program)
    if assumed:
        names = [*dict.fromkeys(name for names in assumed.values() for name in names)]
        where = program.moves[min(assumed)].statement
        be, it = ("is", "it is") if len(names) == 1 else ("are", "they are")
        raise InputError(
            f"{where}: {' and '.join(names)} {be} not known: nothing can be proven or written with "
            f"what {it} taken for; say what {it} in a file ({spelt('answers')}; `flyby ask` writes "
            "one)"
        )
    for move in program.moves:
        if move.supposed:
            raise InputError(
                f"{move.statement}: {move.supposed}, which nobody says: nothing can be proven or "
                f"written with what is taken for it; say it in a file ({spelt('answers')}; "
                "`flyby ask` writes one)"
            )


def _asked(program: Program) -> dict[str, str]:
    """Data that nobody says, as they are written, by their names without case."""
    return {
        question.key.casefold(): question.key
        for question in program.questions
        if question.kind is QuestionKind.DATUM and not question.answered
    }


def _at_default(move: Move, placed: Collection[str]) -> list[str]:
    """What of a move is at the controller's own, or was put to where the robot drives it."""
    parts = (move.tool.name, move.tool.tcp), (move.work_object.name, move.work_object.pose)
    at = ((name.casefold(), pose) for name, pose in parts)
    return [name for name, pose in at if pose == IDENTITY or name in placed]
