"""Moves whose tool or work object nobody knows: they are driven with the controller's own."""

from __future__ import annotations

from ..spatial.pose import IDENTITY
from .move import Move
from .program import Program
from .question import QuestionKind


def assumed_places(program: Program) -> dict[int, tuple[str, ...]]:
    """The tools and work objects that are not known, by the index of each move that uses one.

    One that the program has set by then is what it is set to.
    """
    asked = {
        question.key.casefold(): question.key
        for question in program.questions
        if question.kind is QuestionKind.DATUM and not question.answered
    }
    if not asked:
        return {}
    found: dict[int, tuple[str, ...]] = {}
    known: dict[tuple[int, int], tuple[str, ...]] = {}  # of most moves they are a few objects
    for index, move in enumerate(program.moves):
        pair = id(move.tool), id(move.work_object)
        if pair not in known:
            known[pair] = tuple(asked[name] for name in _at_default(move) if name in asked)
        if known[pair]:
            found[index] = known[pair]
    return found


def _at_default(move: Move) -> list[str]:
    parts = (move.tool.name, move.tool.tcp), (move.work_object.name, move.work_object.pose)
    return [name.casefold() for name, pose in parts if pose == IDENTITY]
