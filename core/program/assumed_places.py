"""Moves of which nobody knows the place, the tool or the work object, though they are driven with
what is taken for these: nothing is proven of them, and nothing written."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Collection
from dataclasses import replace

from ..door import spelt
from ..errors import InputError, Span
from ..spatial.pose import IDENTITY
from .move import Move, MoveC, Opaque, Wait
from .program import Program
from .question import QuestionKind
from .target import JointTarget

FROM_THE_START = "where it goes depends on where the robot stands before the first move"


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


def doubtful_places(program: Program) -> dict[int, tuple[str, ...]]:
    """What nobody knows of the places that moves are driven to, by the index of each such move: its
    tool and work object, or else where the robot stands first, or the target itself.

    The configuration that is programmed there tells nothing of a place that is not its own.
    """
    found = assumed_places(program)
    for index, move in enumerate(program.moves):
        if move.supposed:
            what = "the start" if move.supposed == FROM_THE_START else "the target"
            found.setdefault(index, (what,))
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
            said = f"in a file ({spelt('answers')}; `flyby ask` writes one)"
            if move.supposed == FROM_THE_START:
                said = f"({spelt('start')})"
            raise InputError(
                f"{move.statement}: {move.supposed}, which nobody says: nothing can be proven or "
                f"written with what is taken for it; say it {said}"
            )


def supposed_from_start(program: Program, without: Program | None) -> Program:
    """A program that was read from a start which is taken for the true one: moves say so that
    nobody knew without it, or that went elsewhere.

    Args:
        without: the program as it is read without a start; None where it cannot be.
    """
    known = defaultdict[Span | None, deque[Move]](deque)
    for move in () if without is None else without.moves:
        known[move.statement].append(move)  # of a loop several: one for each pass
    statements = []
    for statement in program.statements:
        if not isinstance(statement, Wait | Opaque):
            others = known[statement.statement]
            same = bool(others) and _goes_alike(statement, others.popleft())
            if not (same or statement.open or statement.supposed):
                statement = replace(statement, supposed=FROM_THE_START)
        statements.append(statement)
    return replace(program, statements=tuple(statements))


def _goes_alike(move: Move, other: Move) -> bool:
    """Whether it is known of another reading of a move that it goes the same way."""
    return not (other.open or other.supposed) and _way(move) == _way(other)


def _way(move: Move) -> tuple[object, ...]:
    """What the path of a move is made of, without configurations: where a program leaves these to
    the controller they are those near to where it starts."""
    via = (move.via.pose, move.orientation) if isinstance(move, MoveC) else ()
    at = move.target.joints if isinstance(move.target, JointTarget) else move.target.pose
    return at, move.target.external, move.zone, move.tool, move.work_object, via


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
