"""What a run has not come to: routines that move the robot and that its conditions lead past."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from ....core.door import spelt
from ....core.errors import Note, Span
from ..syntax.traversal import calls_in, expressions_of
from ..syntax.tree import Invoke, Routine
from ..values.data import Globals
from .instructions import MOVING

_NAMED = 4
"""Routines in a message."""


def passed_by(
    data: Globals, entry: Routine, ran: Collection[int], driven: Collection[Span]
) -> Note | None:
    """What is to be said where most of the motion is in routines that were not called; else None.

    Args:
        data: the modules at hand; no further one is taken in.
        entry: the routine that was run.
        ran: ids of the routines that were called.
        driven: the statements that have moved the robot.
    """
    missed = [
        (routine, moves)
        for routine in _reachable(data, entry)
        if id(routine) not in ran and (moves := _own_moves(routine))
    ]
    left = sum(moves for _, moves in missed)
    here = len({(span.file, span.start) for span in driven})
    if not here or left <= here:
        return None
    named = ", ".join(routine.text for routine, _ in missed[:_NAMED])
    if len(missed) > _NAMED:
        named += f" and {len(missed) - _NAMED} more"
    return Note(
        f"{here} of {here + left} statements that move the robot are driven: conditions lead past "
        f"{named}; {spelt('entry')} drives a routine by itself",
        span=missed[0][0].span,
    )


def _own_moves(routine: Routine) -> int:
    return sum(isinstance(s, Invoke) and s.name in MOVING for s in routine.body.walk())


def _reachable(data: Globals, entry: Routine) -> list[Routine]:
    """The routines that one may call, by others or itself, in the order in which they are met."""
    found, met = [entry], {id(entry)}
    for routine in found:
        home = data.scope_of(routine).home
        for name in _called(routine):
            called = data.routine(name, home)
            if called is not None and id(called) not in met:
                met.add(id(called))
                found.append(called)
    return found


def _called(routine: Routine) -> Iterator[str]:
    for statement in routine.body.walk():
        if isinstance(statement, Invoke):
            yield statement.name
        for expression in expressions_of(statement):
            yield from (call.name for call in calls_in(expression))
