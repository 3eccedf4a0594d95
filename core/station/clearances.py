"""Clearances between the robots of a station: proven in time, at any time, or under interlocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..collision.mutual.carried_work import CarriedWork
from ..collision.mutual.conflict import PairVerdict
from ..collision.mutual.handed_part import HandedPart
from ..collision.mutual.meetings import InTurn, Meetings
from ..collision.mutual.pair_proof import PairProver
from ..collision.mutual.robot_motion import RobotMotion
from .actions import Action
from .carried_proof import carried_work
from .clock import Schedule, StationRun
from .hand_over import HandOvers, follow_hand_overs
from .orders import Orders, sections_mask
from .station import RobotStation, StationRobot
from .turns import turn_by_clocks, turn_by_orders

_SAMPLED = (0.01, 0.001)
"""s between the instants at which the least distance is looked for, and round the least."""


@dataclass(frozen=True)
class PairClearance:
    """What is proven of two robots.

    Args:
        robots: their names.
        in_time: for the schedule, each robot up to the jitter early or late.
        any_time: whatever the clocks say; each pair of moves that may conflict is named.
        interlocked: in all orders that the signals allow; None where these are not known.
        least: m, the least distance met at the schedule's own times, in steps; no proof.
        least_at: s, when.
    """

    robots: tuple[str, str]
    in_time: PairVerdict
    any_time: PairVerdict
    interlocked: PairVerdict | None
    least: float
    least_at: float

    @property
    def safe(self) -> bool:
        """Whether the interlocks as programmed, or no need of any, keep the two apart."""
        return self.any_time.proven or (self.interlocked is not None and self.interlocked.proven)


class StationProver:
    """Proves the clearances of a station; motions are swept once.

    Robots that may pass through zones which waits stand behind are proven with both paths.

    Args:
        station: the robots.
        actions: of their programs that bear on others.
        before: a prover of the same station, whose motions are taken over where the run is the
            same.
    """

    def __init__(
        self,
        station: RobotStation,
        actions: Mapping[str, Sequence[Action]],
        before: StationProver | None = None,
    ) -> None:
        self._station, self._actions = station, actions
        known: dict[str, RobotMotion] = {} if before is None else before._motions
        members = station.members
        self._motions: dict[str, RobotMotion] = {
            name: motion for name, motion in known.items() if motion.run is members[name].run
        }
        self._passing: dict[str, RobotMotion] = {}
        self._provers: dict[tuple[str, str], PairProver] = {}
        if before is not None:
            self._provers |= {
                pair: prover
                for pair, prover in before._provers.items()
                if all(name in self._motions for name in pair)
            }

    @cached_property
    def _hand_overs(self) -> HandOvers:
        """Parts that change hands, as the programs are driven now."""
        return follow_hand_overs(self._station)

    def _motion(self, name: str, *, passing: bool = False) -> RobotMotion:
        """Of a robot that stops for all waits, or passes through zones which they stand behind."""
        known, member = self._passing if passing else self._motions, self._station.members[name]
        if name not in known:
            if passing and member.passing is not None:
                member = replace(member, run=member.passing.run)
            known[name] = self._swept(member)
        return known[name]

    def _swept(self, member: StationRobot) -> RobotMotion:
        """With the obstacles that some other robot has not in its own cell."""
        others = [
            {obstacle.name for obstacle in other.cell.obstacles}
            for other in self._station.members.values()
            if other is not member
        ]
        own = {obstacle.name for obstacle in member.cell.obstacles}
        lone = sorted({thing for known in others for thing in own - known})
        return RobotMotion(
            member.name,
            member.controller,
            member.run,
            member.cell,
            lone,
            self._hand_overs.handling(member),
            any_speed=True,
        )

    def prover(self, one: str, other: str) -> PairProver:
        """Of two robots that stop for all waits."""
        if (one, other) not in self._provers:
            self._provers[one, other] = self._of(one, other, (False, False))
        return self._provers[one, other]

    def _of(self, one: str, other: str, passing: tuple[bool, bool]) -> PairProver:
        allowed = [
            pair
            for a, b in self._station.allowed
            for pair in (_own(a, b, one, other), _own(b, a, one, other))
            if pair is not None
        ]
        first, second = (
            self._motion(name, passing=passes)
            for name, passes in zip((one, other), passing, strict=True)
        )
        hand_overs = self._hand_overs
        handed, awaited = hand_overs.between(one, other), hand_overs.awaited(one, other)
        carried = list(self._carried(one, other, allowed))
        return PairProver(first, second, allowed, handed, awaited, carried)

    def _carried(
        self, one: str, other: str, allowed: Sequence[tuple[str, str]]
    ) -> Iterator[CarriedWork]:
        """Moves of one of two robots on what the other one turns, and what is proven of them."""
        for worker, (own, its) in enumerate(((one, other), (other, one))):
            member, carrier = (self._station.members[name] for name in (own, its))
            turned = [pair[::-1] for pair in allowed] if worker else allowed
            handling = self._hand_overs.handling(member)
            for work in carried_work(member, carrier, handling, self._station.clearance, turned):
                yield replace(work, worker=worker)

    def _variants(self, one: str, other: str) -> Iterator[tuple[PairProver, tuple[bool, bool]]]:
        """Provers of two robots, and which of them passes through zones that waits stand behind."""
        yield self.prover(one, other), (False, False)
        for passes in ((True, False), (False, True), (True, True)):
            if all(
                self._station.members[name].passing is not None
                for name, passing in zip((one, other), passes, strict=True)
                if passing
            ):
                yield self._of(one, other, passes), passes

    def standing(self, schedule: Schedule, t: FloatArray) -> tuple[FloatArray, IntArray]:
        """Where a robot is on the station's clock.

        Args:
            schedule: of the robot.
            t: (T,) s.

        Returns:
            (T, N) its configurations, and (T,) the moves that it is on.
        """
        trajectory, own = self._station.members[schedule.name].run.trajectory, schedule.own(t)
        row = np.clip(np.searchsorted(trajectory.t, own, "right") - 1, 0, None)
        q = np.stack([np.interp(own, trajectory.t, q) for q in trajectory.q.T], -1)
        return q, trajectory.move[row]

    def any_time(self, one: str, other: str) -> PairVerdict:
        """What is proven of two robots whatever the clocks say."""
        meetings, wanted = Meetings.at_any_time(), self._station.clearance
        return _worst(p.prove(wanted, meetings) for p, _ in self._variants(one, other))

    @property
    def shapeless(self) -> tuple[str, ...]:
        """Positioners that carry nothing of which a shape is known."""
        return tuple(
            name
            for name, member in self._station.members.items()
            if not member.cell.robot.has_arm
            and not any(obstacle.carried_by for obstacle in member.cell.obstacles)
            and not member.cell.parts
        )

    def all(
        self,
        run: StationRun,
        jitter: float,
        orders: Orders | None,
        say: Callable[[str], None] = lambda _: None,
    ) -> list[PairClearance]:
        """Of all pairs.

        Args:
            run: the schedule.
            jitter: s by which each robot may be early or late.
            orders: that the signals allow; None where they are not known.
            say: told what is being done.
        """
        found = []
        solid = [name for name in self._station.members if name not in self.shapeless]
        for one, other in combinations(solid, 2):
            say(f"proving that {one} and {other} keep clear of each other")
            found.append(self._pair(one, other, run, jitter, orders))
        return found

    def _pair(
        self, one: str, other: str, run: StationRun, jitter: float, orders: Orders | None
    ) -> PairClearance:
        in_time, least, at = self.in_time(one, other, run, jitter)
        any_time = self.any_time(one, other)
        interlocked = None
        if orders is not None and not any_time.proven:
            interlocked = self.interlocked(one, other, orders, self._actions)
        return PairClearance((one, other), in_time, any_time, interlocked, least, at)

    def in_time(
        self, one: str, other: str, run: StationRun, jitter: float
    ) -> tuple[PairVerdict, float, float]:
        """What is proven of two robots for a schedule, and the least distance met, m, and when, s.

        Args:
            one, other: the robots, that stop for all waits.
            run, jitter: see `all`.
        """
        prover, clearance = self.prover(one, other), self._station.clearance
        schedules = run.schedules[one], run.schedules[other]
        least, at = self._sampled(prover, schedules)
        clocks = schedules[0].clocked, schedules[1].clocked

        def in_turn(part: HandedPart) -> InTurn:
            hand_over = self._hand_overs.of(part, one, other)
            runs, clocked = (prover.one.run, prover.other.run), schedules
            if part.giver:
                runs, clocked = runs[::-1], clocked[::-1]
            return turn_by_clocks(hand_over, runs, clocked, 2.0 * jitter)

        until = at + _SAMPLED[0] if least < clearance else np.inf
        meetings = Meetings(clocks, 2.0 * jitter, every=False, until=until, in_turn=in_turn)
        verdict = prover.prove(clearance, meetings)
        if verdict.proven and until < np.inf:
            # What samples took for too near is not: nothing behind it is known yet.
            verdict = prover.prove(clearance, replace(meetings, until=np.inf))
        return verdict, least, at

    def interlocked(
        self, one: str, other: str, orders: Orders, actions: Mapping[str, Sequence[Action]]
    ) -> PairVerdict:
        """What is proven of two robots in all orders that the signals allow.

        Args:
            one, other: the robots.
            orders: of these actions.
            actions: of each robot.
        """
        sizes = len(actions[one]) + 1, len(actions[other]) + 1
        reachable = orders.together(one, other, sizes)
        clocks, wanted = Meetings.at_any_time().clocks, self._station.clearance
        found = []
        for prover, passes in self._variants(one, other):
            doings = [
                self._passed(name, actions[name]) if passing else actions[name]
                for name, passing in zip((one, other), passes, strict=True)
            ]
            meetings = Meetings(clocks)
            if doings[0] is not None and doings[1] is not None:
                own = doings[0], doings[1]
                together = sections_mask(
                    reachable,
                    own,
                    (_own_times(prover.one), _own_times(prover.other)),
                    (prover.one.run.timing.lag, prover.other.run.timing.lag),
                )
                in_turn = self._in_turn(one, other, prover, own, reachable)
                meetings = Meetings(clocks, together=together, in_turn=in_turn)
            found.append(prover.prove(wanted, meetings))
        return _worst(found)

    def _in_turn(
        self,
        one: str,
        other: str,
        prover: PairProver,
        actions: tuple[Sequence[Action], Sequence[Action]],
        reachable: NDArray[np.bool_],
    ) -> Callable[[HandedPart], InTurn]:
        """In which order parts change hands in all orders that the signals allow."""
        runs = prover.one.run, prover.other.run

        def in_turn(part: HandedPart) -> InTurn:
            hand_over = self._hand_overs.of(part, one, other)
            if part.giver:
                return turn_by_orders(hand_over, runs[::-1], actions[::-1], reachable.T)
            return turn_by_orders(hand_over, runs, actions, reachable)

        return in_turn

    def _passed(self, name: str, actions: Sequence[Action]) -> Sequence[Action] | None:
        """The same actions of a robot that passes through zones; None where they are others.

        Then nothing is known of sections, and everything may be at once.
        """
        passing = self._station.members[name].passing
        assert passing is not None
        known = {(action.text, action.span) for action in actions}
        made = [action for action in passing.actions if (action.text, action.span) in known]
        alike = [(a.text, a.span, a.move) for a in made] == [
            (a.text, a.span, a.move) for a in actions
        ]
        return made if alike else None

    def _sampled(
        self, prover: PairProver, schedules: tuple[Schedule, Schedule]
    ) -> tuple[float, float]:
        """The least distance at the schedule's own times, in steps, and when."""
        last, step = max(map(self._until, schedules)), _SAMPLED[0]
        first, least, at = 0.0, np.inf, 0.0
        for finer in _SAMPLED:
            t = np.arange(first, last + step, finer)
            (one, first_moves), (other, other_moves) = (self.standing(s, t) for s in schedules)
            found, k, _ = prover.nearest(one, other, (first_moves, other_moves), at_once=True)
            if found < least:
                least, at = found, float(t[k])
            first, last, step = max(at - finer, 0.0), at + finer, finer
        return least, at

    def _until(self, schedule: Schedule) -> float:
        """s, when a robot stands still for good."""
        if np.isfinite(schedule.end):
            return schedule.end
        return schedule.waits[-1].begin


def _own(a: str, b: str, one: str, other: str) -> tuple[str, str] | None:
    """An allowed pair as parts of the one and the other."""
    (first, _, part), (second, _, piece) = a.partition("."), b.partition(".")
    return (part, piece) if (first, second) == (one, other) else None


def _own_times(motion: RobotMotion) -> Callable[[], FloatArray]:
    return lambda: motion.own_time


def _worst(found: Iterable[PairVerdict]) -> PairVerdict:
    """What holds of all: the first that is not proven, else what the least proves."""
    verdicts = list(found)
    left = [verdict for verdict in verdicts if not verdict.proven]
    return left[0] if left else min(verdicts, key=lambda verdict: verdict.clearance)
