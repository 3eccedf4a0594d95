"""In which order a part changes hands: by the clocks of a run, or as signals let robots on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.mutual.meetings import InTurn
from ..motion.emulator.run import Run
from .actions import Action, Stand, stand_of
from .clock import Schedule
from .hand_over import FollowedHandOver

_SAME = 1e-9
"""s."""


class _Times(NamedTuple):
    """When a part changes hands, by the own clocks of both robots.

    Args:
        given: where the giver stands with it and lets go.
        comes: the taker where it begins to come to the part.
        taken: and where it takes it.
    """

    given: Stand
    comes: Stand
    taken: Stand

    @classmethod
    def of(cls, hand_over: FollowedHandOver, giver: Run, taker: Run) -> _Times:
        """Of the two programs as driven."""
        released, taken = hand_over.released, hand_over.taken
        first = min(hand_over.coming) - 1
        return cls(
            stand_of(giver, hand_over.moves[0], released.statement),
            stand_of(taker, first, len(taker.program.statements)),
            stand_of(taker, hand_over.moves[1], taken.statement),
        )


def turn_by_clocks(
    hand_over: FollowedHandOver,
    runs: tuple[Run, Run],
    schedules: tuple[Schedule, Schedule],
    apart: float,
) -> InTurn:
    """What the clocks of giver and taker say.

    Args:
        hand_over: of the two.
        runs: of giver and taker.
        schedules: likewise.
        apart: s by which the clocks may be off against each other.
    """
    times = _Times.of(hand_over, *runs)
    giver, taker = schedules
    reached = _passed(giver, times.given.reached, -1) + giver.lag
    let_go, taken = hand_over_times(hand_over, runs, schedules)
    return InTurn(
        held=bool(taken + apart <= let_go),
        brought=bool(reached + apart <= taker.clocked(np.full((1, 2), times.comes.left))[0, 1]),
        let_go=bool(let_go + apart <= taker.clocked(np.full((1, 2), times.taken.left))[0, 1]),
    )


def hand_over_times(
    hand_over: FollowedHandOver, runs: tuple[Run, Run], schedules: tuple[Schedule, Schedule]
) -> tuple[float, float]:
    """When the giver lets go of a part and the taker takes it, s on the station's clock; infinite
    for what never happens.

    Args:
        hand_over: of the two.
        runs: of giver and taker.
        schedules: likewise.
    """
    times = _Times.of(hand_over, *runs)
    return (
        _passed(schedules[0], times.given.at, hand_over.released.statement),
        _passed(schedules[1], times.taken.at, hand_over.taken.statement),
    )


def _passed(schedule: Schedule, time: float, statement: int) -> float:
    """s on the station's clock at which a robot comes to a statement, at a time of its own."""
    waited = sum(
        spell.end - spell.begin
        for spell in schedule.waits
        if _before(spell.action, time, statement)
    )
    return float(schedule.pace.passed(np.array([time]))[0]) + schedule.begin + waited


def turn_by_orders(
    hand_over: FollowedHandOver,
    runs: tuple[Run, Run],
    actions: tuple[Sequence[Action], Sequence[Action]],
    reachable: NDArray[np.bool_],
) -> InTurn:
    """What holds in all orders that the signals allow.

    Args:
        hand_over: of the two robots.
        runs: of giver and taker.
        actions: likewise, as they are reckoned with.
        reachable: (G, T), sections of giver and taker that may be at once, see `Orders.together`.
    """
    times, (giver, taker) = _Times.of(hand_over, *runs), actions
    statement, moves = hand_over.released.statement, hand_over.moves
    stands = [
        k
        for k, action in enumerate(giver)
        if action.move >= moves[0]
        and min(action.time, action.soonest) >= times.given.reached - _SAME
    ]
    arrived = stands[0] + 1 if stands else len(giver) + 1
    comes = _done(taker, times.comes.left, min(hand_over.coming) - 1)
    holding = sum(_before(action, times.given.at, statement) for action in giver) + 1
    off = _done(taker, times.taken.left, moves[1])
    before = sum(_before(action, times.taken.at, hand_over.taken.statement) for action in taker)
    return InTurn(
        held=not reachable[holding - 1 :, : before + 1].any(),
        brought=not reachable[:arrived, comes:].any(),
        let_go=not reachable[:holding, off:].any(),
    )


def _before(action: Action, time: float, statement: int) -> bool:
    """Whether an action may come before a statement at a time of its program."""
    if abs(action.time - time) > _SAME:
        return action.time < time
    return action.statement < statement


def _done(actions: Sequence[Action], left: float, move: int) -> int:
    """How many actions are surely over when a program leaves the end of a move."""
    over = [
        action.time < left - _SAME
        or (action.time < left + _SAME and action.move <= move and action.statement >= 0)
        for action in actions
    ]
    return over.index(False) if False in over else len(over)
