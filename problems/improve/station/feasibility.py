"""What a station has to stand while the programs of its robots are improved, one by one.

A changed program may run beside the others if the station ends, does not take longer, and is proven
as well as before: two robots that were kept apart by their interlocks, or needed none, still are;
two that only their times kept apart are still apart in time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import Enum, auto
from itertools import combinations

from ....core.collision.mutual.conflict import Conflict, ConflictCause, PairVerdict
from ....core.collision.mutual.meetings import Meetings
from ....core.collision.proof.verdict import Certificate, Verdict
from ....core.dialect import SignalWords
from ....core.errors import InputError, MotionError
from ....core.handling.handling import handling_of
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.spatial.pose import IDENTITY
from ....core.station.actions import Action, actions_of
from ....core.station.awaited import bearing
from ....core.station.clearances import StationProver
from ....core.station.clock import StationClock, StationRun
from ....core.station.conflict_words import conflict_said
from ....core.station.deadlock import deadlock
from ....core.station.early_late import other_orders
from ....core.station.orders import Orders, explore
from ....core.station.station import RobotStation
from ....core.station.world_zones import with_zones
from ..solve_round_verify import Beside

_LATER = 1e-9
"""Share of the station time that does not count."""
Pair = tuple[str, str]


class _Keeping(Enum):
    """What keeps two robots apart."""

    SPACE = auto()
    """They share none."""
    ORDERS = auto()
    """Their interlocks."""
    TIMES = auto()
    """Only their times."""


@dataclass(frozen=True)
class StationSnapshot:
    """A station with its programs as they are at one time of an improvement.

    Args:
        station: the robots.
        actions: of their programs.
        run: on one clock.
        orders: that the signals allow, of the actions that bear on others; None where these are
            not known.
        prover: of the clearances.
    """

    station: RobotStation
    actions: Mapping[str, tuple[Action, ...]]
    run: StationRun
    orders: Orders | None
    prover: StationProver

    @property
    def duration(self) -> float:
        """s, until the last robot has ended."""
        return self.run.duration

    @property
    def ordered(self) -> dict[str, tuple[Action, ...]]:
        """The actions that bear on others."""
        return bearing(self.station, self.actions)


class StationFeasibility:
    """A station whose robots' programs change one by one.

    Args:
        station: the robots with their programs as given.
        words: how each robot's language says what it does with signals.
        known: whether all of that is known; else nothing is said about interlocks.
        jitter: s by which each robot may be early or late where times keep two apart.
        say: told what is being done.

    Attributes:
        state: with all changes that were taken over.
        given: as it was given.

    Raises:
        InputError: robots make moves together, or a wait stands behind a zone.
        MotionError: two robots are not proven to keep clear, or the station never ends.
    """

    def __init__(
        self,
        station: RobotStation,
        words: Mapping[str, SignalWords | None],
        known: bool,
        jitter: float,
        say: Callable[[str], None] = lambda _: None,
    ) -> None:
        together = [
            name
            for name, member in station.members.items()
            if len(member.pace.own) > 1 or member.carried
        ]
        if together:
            raise InputError(
                f"{', '.join(together)}: programs whose moves are made together with other "
                "robots', or on what these turn, are not improved yet"
            )
        for name, member in station.members.items():
            if member.world != IDENTITY:
                raise InputError(
                    f"{name}: programs of a robot with a world of its own in the station file are "
                    "not improved yet: say in its cell where it stands (base), or improve it there"
                )
            if member.passing is not None:
                move = member.program.moves[member.passing.moves[0]]
                raise InputError(
                    f"{name}: {move.statement}: the move ends in a zone, and then the program "
                    "waits for a signal: the robot stops there or passes through, and programs "
                    "are improved where that is known: end the move at a stop (fine)"
                )
        self._words, self._known, self._jitter = words, known, jitter
        self.given = self.state = self._state(station, None)
        self._kept: dict[Pair, _Keeping] = {}
        never = self._never_ends(self.state)
        if never is not None:
            raise MotionError(f"{never}: nothing can be improved before")
        for pair in combinations(station.members, 2):
            say(f"proving that {pair[0]} and {pair[1]} keep clear of each other")
            self._kept[pair] = self._kept_by(pair)

    def beside(self, name: str) -> Beside:
        """What the other robots, as they are now, say of programs of one of them."""

        def said(run: Run) -> Certificate | None:
            return self._refused(name, self._with(name, run))

        return said

    def placed(self, name: str, controller: Controller, run: Run) -> Certificate | None:
        """What the other robots say of a program as driven from another base; None for nothing.

        Args:
            name: of the robot.
            controller: that drives it as it stands there.
            run: the program as driven from there.
        """
        members = dict(self.state.station.members)
        own = members[name]
        members[name] = replace(
            own,
            run=run,
            cell=replace(own.cell, robot=controller.robot),
            controller=controller,
        )
        station = replace(self.state.station, members=members)
        return self._refused(name, self._state(station, self.state))

    def duration_with(self, name: str, run: Run) -> float:
        """s that the station takes with another program of one robot, proven or not."""
        station = self.state.station
        members = dict(station.members)
        members[name] = replace(members[name], run=run)
        actions = {**self.state.actions, name: self._actions(station, name, run)}
        return StationClock(replace(station, members=members), actions).run().duration

    def take(self, name: str, run: Run) -> bool:
        """Take a program over, if it may run beside the others.

        Args:
            name: of the robot.
            run: the program as driven.

        Returns:
            whether it was taken over.
        """
        state = self._with(name, run)
        if self._refused(name, state) is not None:
            return False
        self.state = state
        return True

    def ordered_of(self, name: str, run: Run) -> tuple[Action, ...]:
        """The actions of a robot that bear on others, in another run of it."""
        station = self.state.station
        actions = {**self.state.actions, name: self._actions(station, name, run)}
        return bearing(station, actions)[name]

    def _actions(self, station: RobotStation, name: str, run: Run) -> tuple[Action, ...]:
        return with_zones(actions_of(run, self._words[name]), station.zones, name, run)

    def _with(self, name: str, run: Run) -> StationSnapshot:
        members = dict(self.state.station.members)
        own = members[name]
        handling = own.handling
        if handling is not None:
            handling = handling_of(run.program, own.cell, handling.start)
        program = own.bare(run.program)
        members[name] = replace(own, program=program, run=run, handling=handling)
        return self._state(replace(self.state.station, members=members), self.state)

    def _state(self, station: RobotStation, before: StationSnapshot | None) -> StationSnapshot:
        actions = {
            name: before.actions[name]
            if before is not None and before.station.members[name].run is member.run
            else self._actions(station, name, member.run)
            for name, member in station.members.items()
        }
        ordered = bearing(station, actions)
        orders = None
        if self._known:
            with suppress(InputError):
                orders = explore(station, ordered)
        run = StationClock(station, actions).run()
        prover = StationProver(station, ordered, None if before is None else before.prover)
        return StationSnapshot(station, actions, run, orders, prover)

    def _never_ends(self, state: StationSnapshot) -> str | None:
        """Why a station never ends; None if it does."""
        clock = StationClock(state.station, state.actions)
        stuck = deadlock(state.station, state.run, state.actions, clock)
        return None if stuck is None else str(stuck)

    def _kept_by(self, pair: Pair) -> _Keeping:
        """What keeps two robots apart as they are given."""
        for keeping in (_Keeping.SPACE, _Keeping.ORDERS, _Keeping.TIMES):
            verdict = self._verdict(self.state, pair, keeping)
            if verdict is not None and verdict.proven:
                return keeping
        assert verdict is not None
        worst = min(verdict.conflicts.values(), key=lambda conflict: _distance(conflict))
        said = conflict_said(self.state.station, pair, worst)
        raise MotionError(
            f"the robots do not keep clear of each other as they are: {said}; mend that first"
        )

    def _refused(self, name: str, state: StationSnapshot) -> Certificate | None:
        """Why a state is not taken over, as a certificate of one robot's run; None if it is."""
        given, made = (s.station.members[name].handling for s in (self.given, state))
        if given is not None and made is not None and given.arrangements != made.arrangements:
            return _refusal("parts of its cell would be taken or released elsewhere")
        never = self._never_ends(state)
        if never is not None:
            return _refusal(f"beside the other robots {never}")
        before = self.state
        if state.orders is None and before.orders is not None:
            return _refusal("in which orders the signals let the robots on is not known any more")
        if _may_lock(state) and not _may_lock(before):
            return _refusal("beside the other robots the signals would allow a deadlock")
        if state.duration > before.duration * (1.0 + _LATER):
            return _refusal("the station would take longer")
        for pair in self._kept:
            if name in pair:
                conflict = self._conflict(state, pair)
                if conflict is not None:
                    return self._certificate(state, name, pair, conflict)
        return None

    def _conflict(self, state: StationSnapshot, pair: Pair) -> Conflict | None:
        """The worst of two robots that are not kept apart as well as before."""
        keeping = self._kept[pair]
        verdict = self._verdict(state, pair, keeping)
        if verdict is not None and not verdict.proven and keeping is _Keeping.SPACE:
            verdict = self._verdict(state, pair, _Keeping.ORDERS) or verdict
        if verdict is None or verdict.proven:
            return None
        return min(verdict.conflicts.values(), key=_distance)

    def _verdict(self, state: StationSnapshot, pair: Pair, keeping: _Keeping) -> PairVerdict | None:
        """Whether two robots are kept apart in one way; None where that cannot be said."""
        prover, clearance = state.prover.prover(*pair), state.station.clearance
        match keeping:
            case _Keeping.SPACE:
                return prover.prove(clearance, Meetings.at_any_time())
            case _Keeping.ORDERS:
                if state.orders is None:
                    return None
                return state.prover.interlocked(*pair, state.orders, state.ordered)
            case _Keeping.TIMES:
                verdict = PairVerdict(clearance)
                others = other_orders(state.station, state.actions, state.run, self._jitter)
                for run in (state.run, *others):
                    one, other = (run.schedules[name].clocked for name in pair)
                    meetings = Meetings((one, other), 2.0 * self._jitter, every=False)
                    verdict = prover.prove(clearance, meetings)
                    if not verdict.proven:
                        break
                return verdict

    def _certificate(
        self, state: StationSnapshot, name: str, pair: Pair, conflict: Conflict
    ) -> Certificate:
        side = pair.index(name)
        prover = state.prover.prover(*pair)
        motion = (prover.one, prover.other)[side]
        begin, end = (float(s) for s in motion.sigma[conflict.rows[side]])
        if self._kept[pair] is _Keeping.TIMES:
            begin = 0.0  # All that was driven before has brought the robot there when it is.
        return Certificate(
            Verdict.VIOLATED if conflict.cause is ConflictCause.NEAR else Verdict.UNPROVEN,
            _distance(conflict),
            conflict_said(state.station, pair, conflict),
            conflict.moves[side],
            (begin, end),
            conflict.time(side),
            conflict.pair,
            conflict.distance,
        )


def _may_lock(state: StationSnapshot) -> bool:
    return state.orders is not None and bool(state.orders.stuck)


def _refusal(message: str) -> Certificate:
    return Certificate(Verdict.UNPROVEN, math.inf, message)


def _distance(conflict: Conflict) -> float:
    return math.inf if conflict.distance is None else conflict.distance
