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
    """Refuse a program that something is proven of, or written from, if a tool or work object of
    it, or an argument of the routine that it begins with, is not known: it would hold for what that
    is taken for.

    Raises:
        InputError: it names them, and the first move that uses one.
    """
    _refuse_open(program)
    assumed = assumed_places(program)
    if not assumed:
        return
    names = [*dict.fromkeys(name for names in assumed.values() for name in names)]
    where = program.moves[min(assumed)].statement
    be, it = ("is", "it is") if len(names) == 1 else ("are", "they are")
    raise InputError(
        f"{where}: {' and '.join(names)} {be} not known: nothing can be proven or written with "
        f"what {it} taken for; say what {it} in a file ({spelt('answers')}; `flyby ask` writes one)"
    )


def _refuse_open(program: Program) -> None:
    asked = _asked(program)
    names = [name for name in program.open_arguments if name.casefold() in asked]
    if names:
        them = "argument " if len(names) == 1 else "arguments "
        raise InputError(
            f"{program.name}: nobody gives the {them}{' and '.join(names)} of the routine that it "
            "begins with: what is proven or written would hold for one call of it alone; give them "
            f"with the routine ({spelt('entry')}), or in a file ({spelt('answers')}; `flyby ask` "
            "writes one), or begin with a routine that calls it"
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
