"""Waits behind a zone: a robot that finds its condition fulfilled in time does not stop there.

Programs are driven with a stop at every wait. Where the move before one ends in a zone, a
controller may pass through it, so that path is driven, too, and proofs are made of both.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

from ..dialect import SignalWords
from ..motion.emulator.run import Run
from ..motion.geometry.overlaps import taken
from ..motion.model.rules import Overlap
from ..program.move import Opaque, Wait
from ..program.program import Program
from ..program.signal import WaitSignal
from ..program.zone import Fine
from .actions import Action
from .clock import StationClock, StationRun
from .station import RobotStation

_ROUNDS = 8
_MOST_UNSURE = 4
"""Places at which the jitter says whether a robot stops, of which each combination is looked at."""
_TOUCHING = 1.0 - 1e-9
"""Share of a segment from which the zones at its ends have been shrunk until they touch."""


class Passed(NamedTuple):
    """A station whose robots pass through zones where what they wait for is there in time.

    Args:
        station: its robots as they are driven then.
        actions: of these.
        run: on one clock.
    """

    station: RobotStation
    actions: dict[str, tuple[Action, ...]]
    run: StationRun


def waits_behind_zones(program: Program, words: SignalWords | None) -> tuple[int, ...]:
    """Indices of the moves that end in a zone, and then nothing but a wait for signals stops.

    Where a language stops at every wait that the program does not let the robot pass (KRL, but for
    ``CONTINUE``), only those count that it lets it pass.

    Args:
        program: as it was read.
        words: of its language; None if nobody knows.
    """
    found: list[int] = []
    if words is None:
        return ()
    for move, between in _between(program):
        waits = [
            s
            for s in between
            if isinstance(s, Opaque) and _awaits(s, words) and not (words.stops and s.stops)
        ]
        stops = any(
            s.duration > 0.0 if isinstance(s, Wait) else s.stops for s in between if s not in waits
        )
        last = move == len(program.moves) - 1
        if waits and not stops and not last and not isinstance(program.moves[move].zone, Fine):
            found.append(move)
    return tuple(found)


def stopping(program: Program, words: SignalWords | None) -> Program:
    """The program that stops for all of its waits for signals."""
    if words is None:
        return program
    statements = [
        replace(s, stops=True) if isinstance(s, Opaque) and not s.stops and _awaits(s, words) else s
        for s in program.statements
    ]
    return replace(program, statements=tuple(statements))


def passing(program: Program, words: SignalWords | None, which: Collection[int]) -> Program:
    """The program that does not stop for waits behind moves, given by their indices."""
    assert words is not None
    statements, move = [], -1
    for statement in program.statements:
        if isinstance(statement, Opaque):
            if move in which and _awaits(statement, words):
                statement = replace(statement, stops=False)
        elif not isinstance(statement, Wait):
            move += 1
        statements.append(statement)
    return replace(program, statements=tuple(statements))


def zones_overlap(stopping: Run, passed: Run) -> bool:
    """Whether zones that are passed change others, as they overlap.

    Then where a robot passes through some of them alone, its path is neither of these two.

    Args:
        stopping: the program with a stop at every wait.
        passed: as it passes through all zones that waits stand behind.
    """
    path = passed.path
    match path.model.overlap:
        case Overlap.SKIP:
            return path.route.moves != stopping.path.route.moves
        case Overlap.SHRINK:
            wanted = path.corners.sources
            count = len(wanted) + 1
            return any(taken(k, wanted, count).value > _TOUCHING for k in range(1, count - 1))
    return False


def passed_in_time(
    station: RobotStation, actions: Mapping[str, tuple[Action, ...]], jitter: float
) -> list[Passed] | None:
    """The station in which robots pass through zones where what they wait for is there in time.

    Where that hangs on less than the jitter, a robot may stop or pass, and there is one of each.

    Args:
        station: with its robots stopping everywhere.
        actions: of these.
        jitter: s by which each robot may be early or late.

    Returns:
        Empty where no robot passes; None where it hangs on the jitter at too many places.
    """
    which = {
        name: set(member.passing.moves)
        for name, member in station.members.items()
        if member.passing is not None
    }
    made = _passed(station, actions, which)
    for _ in range(_ROUNDS):
        held = {
            name: {s.action.move for s in made.run.schedules[name].waits if s.end > s.begin} & moves
            for name, moves in which.items()
        }
        if not any(held.values()):
            break
        for name, moves in held.items():
            which[name] -= moves
        made = _passed(station, actions, which)
    unsure = list(_unsure(made, which, 2.0 * jitter))
    if len(unsure) > _MOST_UNSURE:
        return None
    found = []
    for count in range(len(unsure) + 1):
        for flipped in combinations(unsure, count):
            chosen = {
                name: moves ^ {move for other, move in flipped if other == name}
                for name, moves in which.items()
            }
            if any(chosen.values()):
                found.append(_passed(station, actions, chosen))
    return found


def _passed(
    station: RobotStation,
    actions: Mapping[str, tuple[Action, ...]],
    which: Mapping[str, Collection[int]],
) -> Passed:
    """The station whose robots pass behind some moves."""
    members, doings = dict(station.members), dict(actions)
    for name, moves in which.items():
        known = members[name].passing
        assert known is not None
        if moves:
            run, doings[name] = known.drive(moves)
            members[name] = replace(members[name], run=run)
    made = replace(station, members=members)
    return Passed(made, doings, StationClock(made, doings).run())


def _unsure(
    made: Passed, which: Mapping[str, Collection[int]], within: float
) -> Iterator[tuple[str, int]]:
    """Robots and moves behind which a robot passes or stops by less than some s."""
    for name, moves in which.items():
        known, schedule = made.station.members[name].passing, made.run.schedules[name]
        assert known is not None
        waited = dict.fromkeys(known.moves, 0.0)
        for spell in schedule.waits:
            if spell.action.move in waited:
                waited[spell.action.move] += spell.end - spell.begin
        # It looks ahead, from where the zone begins.
        late = {
            action.move
            for action, ready in schedule.ready
            if ready < within + action.time - action.soonest
        }
        for move in known.moves:
            if move in late if move in moves else waited[move] < within:
                yield name, move


def _between(program: Program) -> list[tuple[int, list[Wait | Opaque]]]:
    """Indices of moves, and what stands behind each before the next."""
    found: list[tuple[int, list[Wait | Opaque]]] = []
    for statement in program.statements:
        if isinstance(statement, Wait | Opaque):
            if found:
                found[-1][1].append(statement)
        else:
            found.append((len(found), []))
    return found


def _awaits(statement: Opaque, words: SignalWords) -> bool:
    return isinstance(words.read(statement.text), WaitSignal)
