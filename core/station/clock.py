"""A station on one clock: every robot at its own speed, but for what it waits for."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError, Note
from ..program.signal import Condition, Joined, Meet, SetSignal, WaitSignal, levels
from .actions import Action
from .plc import Plc
from .station import ClockPace, RobotStation, levels_at_start, signal_key

_SWINGS = 10_000
"""Changes of signals, at one instant or while all robots wait, after which these swing for ever."""


@dataclass(frozen=True, slots=True)
class Spell:
    """Time that a robot waits for something.

    Args:
        action: what it waits for.
        begin, end: s on the station's clock; ``end`` is infinite if it waits for ever.
        given_up: whether a time-out ended it.
    """

    action: Action
    begin: float
    end: float
    given_up: bool = False


@dataclass(frozen=True)
class Schedule:
    """One robot on the station's clock.

    Args:
        name: of the robot.
        begin: s, when its program begins.
        end: s, when it has ended; infinite if it never does.
        waits: in their order.
        lag: s by which the motion is behind its command on average, and up to twice as much.
        pace: at which its own time passes.
        ready: waits that held it up for no time, and s for which what they wait for was there.
    """

    name: str
    begin: float
    end: float
    waits: tuple[Spell, ...]
    lag: float = 0.0
    pace: ClockPace = field(default_factory=ClockPace.steady)
    ready: tuple[tuple[Action, float], ...] = ()

    def clocked(self, own: FloatArray) -> FloatArray:
        """The station's time of spans of the robot's own (L, 2) s: from when, until when.

        From when its command stands until its motion does, a robot may still be coming to where it
        waits, or be about to leave.
        """
        at = np.array([spell.action.time for spell in self.waits])
        spent = np.array([spell.end - spell.begin for spell in self.waits])
        passed = np.append(0.0, np.cumsum(spent))
        before = passed[np.searchsorted(at + 2.0 * self.lag, own[:, 0] - 1e-9, "left")]
        behind = passed[np.searchsorted(at, own[:, 1] + 1e-9, "right")]
        return np.asarray(self.pace.passed(own) + self.begin + np.stack([before, behind], -1))

    def own(self, time: FloatArray) -> FloatArray:
        """The robot's own time (T,) s at times (T,) s of the station."""
        at = np.array([spell.action.time for spell in self.waits]) + self.lag
        spent = np.array([spell.end - spell.begin for spell in self.waits])
        start = self.pace.passed(at) + self.begin + np.append(0.0, np.cumsum(spent))[:-1]
        left = time - self.begin
        for begin, length in zip(start - self.begin, spent, strict=True):
            waited = np.clip(time - self.begin - begin, 0.0, length)
            left = left - waited
        return self.pace.own_at(np.asarray(left))


@dataclass(frozen=True, slots=True)
class SignalChange:
    """A signal that changes.

    Args:
        time: s.
        name: its key.
        on: what it becomes.
    """

    time: float
    name: str
    on: bool


@dataclass(frozen=True)
class StationRun:
    """A station's run.

    Args:
        schedules: by robot.
        changes: of signals, in their order.
        notes: what a user should know.
    """

    schedules: Mapping[str, Schedule]
    changes: tuple[SignalChange, ...]
    notes: tuple[Note, ...]

    @property
    def duration(self) -> float:
        """s, until the last robot has ended; infinite if one never does."""
        return max(schedule.end for schedule in self.schedules.values())

    @property
    def stuck(self) -> dict[str, Spell]:
        """What robots wait for for ever, by robot."""
        return {
            name: schedule.waits[-1]
            for name, schedule in self.schedules.items()
            if schedule.end == np.inf and schedule.waits
        }


@dataclass
class _Robot:
    """One robot on its way."""

    name: str
    actions: tuple[Action, ...]
    duration: float
    offset: float
    lag: float
    pace: ClockPace
    next: int = 0
    since: float | None = None
    waits: list[Spell] = field(default_factory=list)
    ready: list[tuple[Action, float]] = field(default_factory=list)
    end: float = np.inf

    @property
    def due(self) -> float:
        """s, when it comes to its next action."""
        if self.next < len(self.actions):
            return self.offset + self.pace.at(self.actions[self.next].time)
        return self.offset + self.pace.at(self.duration)

    @property
    def current(self) -> Action:
        return self.actions[self.next]

    @property
    def rests(self) -> bool:
        """Whether it has ended, or waits without a time-out."""
        if self.next == len(self.actions):
            return self.end < np.inf
        return self.since is not None and getattr(self.current.does, "longest", None) is None

    def waits_at(self, meet: Meet) -> bool:
        """Whether it waits for others at a meeting of this name."""
        if self.since is None:
            return False
        does = self.current.does
        return isinstance(does, Meet) and does.label == meet.label


class StationClock:
    """Runs a station once.

    Args:
        station: what to run.
        actions: of each robot.
        late: share of the range of wires' delays that changes take; 0 the least, 1 the greatest.
    """

    def __init__(
        self, station: RobotStation, actions: Mapping[str, tuple[Action, ...]], late: float = 0.5
    ) -> None:
        self._station, self._late = station, late
        self._levels = {signal_key(name): on for name, on in station.given.items()}
        self._levels |= dict.fromkeys(levels_at_start(station), True)
        self._plc = Plc(station.gates, self._levels)
        self._robots = {
            name: _Robot(
                name,
                actions[name],
                member.run.duration,
                member.begins,
                member.run.timing.lag,
                member.pace,
            )
            for name, member in station.members.items()
        }
        self._set = {
            signal_key(f"{name}.{action.does.name}")
            for name, doings in actions.items()
            for action in doings
            if isinstance(action.does, SetSignal)
        }
        self._driven = {signal_key(wire.target) for wire in station.wires} | self._set
        self._queue: list[tuple[float, int, Callable[[float], None]]] = []
        self._count = 0
        self._looked_at: set[float] = set()
        self._changes: list[SignalChange] = []
        self._notes: dict[str, Note] = {}

    def run(self) -> StationRun:
        """From all robots' beginnings to where nothing happens any more.

        Raises:
            InputError: the PLC's logic, or links round it, never come to rest.
        """
        for robot in self._robots.values():
            self._send(robot, robot.due)
        self._settle(0.0)
        last, same, idle = 0.0, 0, 0
        while self._queue and idle < _SWINGS:
            time, _, happen = heapq.heappop(self._queue)
            same = same + 1 if time == last else 0
            if same > _SWINGS:
                raise InputError("links and logic never come to rest: they depend on themselves")
            last = time
            happen(time)
            self._settle(time)
            # Signals may go on and off for ever where nobody goes on any more.
            idle = idle + 1 if all(robot.rests for robot in self._robots.values()) else 0
        return self._made()

    def _push(self, time: float, happen: Callable[[float], None]) -> None:
        self._count += 1
        heapq.heappush(self._queue, (time, self._count, happen))

    def _send(self, robot: _Robot, time: float) -> None:
        self._push(time, lambda now: self._arrive(robot, now))

    def _later(self, key: str, on: bool, time: float) -> None:
        self._push(time, lambda now: self._change(key, on, now))

    def _arrive(self, robot: _Robot, now: float) -> None:
        """A robot is at its next action, or at its end."""
        if robot.next == len(robot.actions):
            robot.end = now
            return
        action = robot.current
        match action.does:
            case SetSignal(name, value, pulse):
                on = bool(value)
                key = signal_key(f"{robot.name}.{name}")
                self._change(key, on, now)
                if pulse is not None:
                    self._later(key, not on, now + pulse)
                self._go_on(robot, now)
            case WaitSignal(condition, longest):
                if self._holds(robot, condition):
                    robot.ready.append((action, now - self._last_change(robot, condition)))
                    self._go_on(robot, now)
                    return
                robot.since = now
                if longest is not None:
                    index = robot.next
                    self._push(now + longest, lambda t: self._give_up(robot, index, t))
            case Meet():
                self._meet(robot, action.does, now)

    def _meet(self, robot: _Robot, meet: Meet, now: float) -> None:
        robot.since = now
        parties = [self._robots[name] for name in self.parties(robot.name, meet)]
        if all(party.waits_at(meet) for party in parties):
            for party in parties:
                self._go_on(party, now)

    def parties(self, name: str, meet: Meet) -> list[str]:
        """The robots of a meeting."""
        if meet.parties is not None:
            names = list(self._robots)
            return [names[k] for k in meet.parties if k < len(names)] or [name]
        return [
            other.name
            for other in self._robots.values()
            if any(
                isinstance(action.does, Meet) and action.does.label == meet.label
                for action in other.actions
            )
        ]

    def _go_on(self, robot: _Robot, now: float, given_up: bool = False) -> None:
        """A robot goes on behind its current action."""
        if robot.since is not None:
            robot.waits.append(Spell(robot.current, robot.since, now, given_up))
            robot.offset += now - robot.since
            robot.since = None
        robot.next += 1
        self._send(robot, max(robot.due, now))

    def _give_up(self, robot: _Robot, index: int, now: float) -> None:
        if robot.next == index and robot.since is not None:
            self._note(
                robot,
                f"{robot.current.text} is not fulfilled in time: its error handler is not known, "
                "the program is taken to go on",
            )
            self._go_on(robot, now, given_up=True)

    def _change(self, key: str, on: bool, now: float) -> None:
        if self._levels.get(key, False) == on:
            return
        self._levels[key] = on
        self._changes.append(SignalChange(now, key, on))
        self._carry(key, on, now)

    def _carry(self, key: str, on: bool, now: float) -> None:
        for wire in self._station.wires:
            if signal_key(wire.source) == key:
                delay = wire.least + self._late * (wire.greatest - wire.least)
                self._later(signal_key(wire.target), on, now + delay)

    def _settle(self, now: float) -> None:
        """Let gates change, and robots go on whose conditions hold."""
        changes, later = self._plc.settle(now)
        for key, on in changes:
            self._changes.append(SignalChange(now, key, on))
            self._carry(key, on, now)
        for due in set(later) - self._looked_at:
            self._looked_at.add(due)
            self._push(due, lambda now: None)
        for robot in self._robots.values():
            if robot.since is None or robot.next == len(robot.actions):
                continue
            does = robot.current.does
            if isinstance(does, WaitSignal) and self._holds(robot, does.condition):
                self._go_on(robot, now)

    def _holds(self, robot: _Robot, condition: Condition) -> bool:
        if isinstance(condition, Joined):
            parts = [self._holds(robot, part) for part in condition.parts]
            return all(parts) if condition.every else any(parts)
        key = signal_key(f"{robot.name}.{condition.name}")
        if key not in self._driven and key not in self._levels:
            self._note(
                robot,
                f"{condition.name}: no link sets it: what waits for it goes on at once",
            )
            return True
        return self._levels.get(key, False) == condition.on

    def _last_change(self, robot: _Robot, condition: Condition) -> float:
        """When a signal that a condition looks at changed for the last time; never is -infinite."""
        keys = {signal_key(f"{robot.name}.{level.name}") for level in levels(condition)}
        changed = (change.time for change in reversed(self._changes) if change.name in keys)
        return next(changed, -np.inf)

    def _note(self, robot: _Robot, message: str) -> None:
        span = robot.current.span
        where = "" if span is None else f"{span}: "
        self._notes.setdefault(f"{robot.name}: {message}", Note(f"{robot.name}: {where}{message}"))

    def _made(self) -> StationRun:
        schedules = {}
        for name, robot in self._robots.items():
            waits = list(robot.waits)
            if robot.since is not None:
                waits.append(Spell(robot.current, robot.since, np.inf))
            begin = self._station.members[name].begins
            ready = tuple(robot.ready)
            schedules[name] = Schedule(
                name, begin, robot.end, tuple(waits), robot.lag, robot.pace, ready
            )
        return StationRun(schedules, tuple(self._changes), tuple(self._notes.values()))
