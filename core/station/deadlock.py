"""Why robots of a station wait for ever: cycles of waits, and signals that nobody sets any more."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ..errors import Span
from ..program.signal import Level, Meet, SetSignal, WaitSignal, levels
from .actions import Action
from .clock import Spell, StationClock, StationRun
from .plc import PLC
from .station import (
    Gate,
    GateKind,
    Input,
    RobotStation,
    levels_at_start,
    signal_key,
)


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
    now = _levels(station, run)
    missing = [
        level
        for level in levels(action.does.condition)
        if now.get(signal_key(f"{name}.{level.name}"), False) != level.on
    ]
    keys: dict[tuple[str, bool], None] = {}
    for level in missing:
        _sources(station, signal_key(f"{name}.{level.name}"), level.on, now, keys)
    setters = {who: None for key, on in keys for who in _who_will(actions, run, key, on)}
    if len(setters) > 1:
        # What it would do itself behind the wait helps nobody.
        setters.pop(name, None)
    if not setters:
        last = [_last(other, doings, keys) for other, doings in actions.items() if other != name]
        said = f"{head}: nobody {_would(missing)} any more{_behind(last)}"
        return Reason(name, action, spell.begin, (), said)
    return Reason(name, action, spell.begin, tuple(setters), f"{head} for {', '.join(setters)}")


def _last(robot: str, actions: Sequence[Action], what: Meet | Collection[tuple[str, bool]]) -> str:
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


def _levels(station: RobotStation, run: StationRun) -> dict[str, bool]:
    """What signals are when nobody goes on any more, by their keys."""
    now = dict.fromkeys(levels_at_start(station), True)
    return now | {change.name: change.on for change in run.changes}


def _sources(
    station: RobotStation,
    key: str,
    on: bool,
    now: Mapping[str, bool],
    found: dict[tuple[str, bool], None],
) -> None:
    """Signals and their values that lack so that one gets its own: back along wires and gates.

    Args:
        station: with its wires and gates.
        key, on: the signal, and the value.
        now: what signals are.
        found: gets them.
    """
    if (key, on) in found:
        return
    found[key, on] = None
    for wire in station.wires:
        if signal_key(wire.target) == key:
            _sources(station, signal_key(wire.source), on, now, found)
    for name, gate in station.gates.items():
        if signal_key(f"{PLC}.{name}") == key:
            for one, holds in _wanted(gate, on):
                source = signal_key(one.name)
                level = one.on == holds
                counted = gate.kind is GateKind.COUNTER and one in gate.inputs
                # What is counted has to come again, though it is there.
                if counted or now.get(source, False) != level:
                    _sources(station, source, level, now, found)


def _wanted(gate: Gate, on: bool) -> Iterator[tuple[Input, bool]]:
    """Inputs of a gate, and whether they have to hold so that it becomes what it is not."""
    if on:
        yield from ((one, True) for one in gate.inputs)
        yield from ((one, False) for one in gate.resets)
    elif gate.resets:
        yield from ((one, True) for one in gate.resets)
    else:
        yield from ((one, False) for one in gate.inputs)


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
    """Robots in a ring, each waiting for the next, the shortest."""
    rings: list[tuple[str, ...]] = []
    for first in waits_for:
        paths: list[tuple[str, ...]] = [(first,)]
        seen = {first}
        for path in paths:
            for other in waits_for.get(path[-1], ()):
                if other == first:
                    rings.append(path)
                elif other in waits_for and other not in seen:
                    seen.add(other)
                    paths.append((*path, other))
    return min(rings, key=len, default=())
