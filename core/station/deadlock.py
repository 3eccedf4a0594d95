"""Why robots of a station wait for ever: cycles of waits, and signals that nobody sets any more."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ..errors import Span
from ..program.signal import Level, Meet, SetSignal, WaitSignal, levels
from .actions import Action
from .clock import Spell, StationClock, StationRun
from .plc import PLC
from .station import RobotStation, signal_key


@dataclass(frozen=True, slots=True)
class Reason:
    """Why one robot waits for ever.

    Args:
        robot: that waits.
        action: what for.
        since: s, from when on.
        on: robots that would have to go on first; none where nobody ever will.
        said: in a sentence.
    """

    robot: str
    action: Action
    since: float
    on: tuple[str, ...]
    said: str

    @property
    def span(self) -> Span | None:
        """Where the wait stands."""
        return self.action.span


@dataclass(frozen=True)
class Deadlock:
    """Robots that wait for ever.

    Args:
        reasons: of each of them.
        cycle: robots of which each waits for the next, and the last for the first; empty where
            something else is why.
    """

    reasons: tuple[Reason, ...]
    cycle: tuple[str, ...]

    def __str__(self) -> str:
        if self.cycle:
            ring = " → ".join((*self.cycle, self.cycle[0]))
            head = f"deadlock, each waits for the next: {ring}"
        else:
            head = "the station never ends"
        return "; ".join((head, *(reason.said for reason in self.reasons)))


def deadlock(
    station: RobotStation,
    run: StationRun,
    actions: Mapping[str, Sequence[Action]],
    clock: StationClock,
) -> Deadlock | None:
    """Why a run does not end; None if it does."""
    stuck = run.stuck
    if not stuck:
        return None
    reasons = [_reason(station, run, actions, clock, name, spell) for name, spell in stuck.items()]
    waits_for = {reason.robot: reason.on for reason in reasons}
    return Deadlock(tuple(reasons), _cycle(waits_for))


def _reason(
    station: RobotStation,
    run: StationRun,
    actions: Mapping[str, Sequence[Action]],
    clock: StationClock,
    name: str,
    spell: Spell,
) -> Reason:
    action = spell.action
    where = "" if action.span is None else f" ({action.span})"
    head = f"{name} waits at {action.text}{where} from {spell.begin:.3f} s on"
    if isinstance(action.does, Meet):
        lacking = _lacking(run, actions, clock, name, action.does)
        tail = ", ".join(lacking) or "others"
        never = [other for other in lacking if _meetings(actions[other], action.does) == 0]
        if never:
            said = f"{head}: {', '.join(never)} never meets at {action.does.label!r}"
            return Reason(name, action, spell.begin, (), said)
        last = [_last(other, actions[other], action.does) for other in lacking]
        return Reason(
            name, action, spell.begin, tuple(lacking), f"{head} for {tail}{_behind(last)}"
        )
    assert isinstance(action.does, WaitSignal)
    wanted = list(levels(action.does.condition))
    setters: dict[str, None] = {}
    for level in wanted:
        for key, on in _sources(station, signal_key(f"{name}.{level.name}"), level.on, set()):
            setters |= dict.fromkeys(_who_will(actions, run, key, on))
    if not setters:
        keys = {
            source
            for level in wanted
            for source in _sources(station, signal_key(f"{name}.{level.name}"), level.on, set())
        }
        last = [_last(other, doings, keys) for other, doings in actions.items() if other != name]
        said = f"{head}: nobody {_would(wanted)} any more{_behind(last)}"
        return Reason(name, action, spell.begin, (), said)
    return Reason(name, action, spell.begin, tuple(setters), f"{head} for {', '.join(setters)}")


def _last(robot: str, actions: Sequence[Action], what: Meet | set[tuple[str, bool]]) -> str:
    """A robot's last meeting of a name, or the last that it does to signals, with its line."""
    for action in reversed(actions):
        does = action.does
        if isinstance(what, Meet):
            found = isinstance(does, Meet) and does.label == what.label
        else:
            found = isinstance(does, SetSignal) and any(
                (signal_key(f"{robot}.{does.name}"), on) in what
                for on in {bool(does.value), bool(does.value) != (does.pulse is not None)}
            )
        if found:
            where = "" if action.span is None else f" ({action.span})"
            return f"{robot} at {action.text}{where}"
    return ""


def _behind(last: Sequence[str]) -> str:
    """The same of some robots."""
    known = [said for said in last if said]
    return f"; the last such: {', '.join(known)}" if known else ""


def _would(wanted: Sequence[Level]) -> str:
    return " or ".join(f"{'sets' if level.on else 'resets'} {level.name}" for level in wanted)


def _lacking(
    run: StationRun,
    actions: Mapping[str, Sequence[Action]],
    clock: StationClock,
    name: str,
    meet: Meet,
) -> list[str]:
    """Who is not at a meeting."""
    stuck = run.stuck
    there = {
        other
        for other, spell in stuck.items()
        if isinstance(spell.action.does, Meet) and spell.action.does.label == meet.label
    }
    return [party for party in clock.parties(name, meet) if party not in there]


def _meetings(actions: Sequence[Action], meet: Meet) -> int:
    return sum(isinstance(a.does, Meet) and a.does.label == meet.label for a in actions)


def _sources(
    station: RobotStation, key: str, on: bool, seen: set[tuple[str, bool]]
) -> Iterator[tuple[str, bool]]:
    """Signals and their values so that one gets its own: back along wires and gates."""
    if (key, on) in seen:
        return
    seen.add((key, on))
    yield key, on
    for wire in station.wires:
        if signal_key(wire.target) == key:
            yield from _sources(station, signal_key(wire.source), on, seen)
    for name, gate in station.gates.items():
        if signal_key(f"{PLC}.{name}") == key:
            for one in gate.inputs:
                yield from _sources(station, signal_key(one.name), one.on == on, seen)
            for one in gate.resets:
                yield from _sources(station, signal_key(one.name), one.on != on, seen)


def _who_will(
    actions: Mapping[str, Sequence[Action]], run: StationRun, key: str, on: bool
) -> Iterator[str]:
    """Robots that would still set a signal to a value, if they went on."""
    for name, doings in actions.items():
        stuck = run.stuck.get(name)
        if stuck is None:
            continue
        for action in doings:
            does = action.does
            if action.time < stuck.action.time or not isinstance(does, SetSignal):
                continue
            pulsed = does.pulse is not None
            if signal_key(f"{name}.{does.name}") == key and (bool(does.value) == on or pulsed):
                yield name
                break


def _cycle(waits_for: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    """Robots in a ring, each waiting for the next."""
    for first in waits_for:
        path, at = [first], first
        while True:
            nexts = [other for other in waits_for.get(at, ()) if other in waits_for]
            if not nexts:
                break
            at = nexts[0]
            if at in path:
                return tuple(path[path.index(at) :])
            path.append(at)
    return ()
