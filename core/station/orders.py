"""All orders in which a station's programs may pass their actions, whatever time they take.

A state says how far each program is, which outputs are on, which changes are still on their way
along a wire, and what latches and counters hold. What wires and timers take is left open, so that
every order that the signals allow is among them, and some that times rule out. What no reachable
state holds together cannot be at one time (`together`); states out of which nothing leads are
deadlocks that may happen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..collision.mutual.meetings import Together
from ..errors import InputError
from ..program.signal import Condition, Joined, Meet, SetSignal, WaitSignal
from .actions import Action
from .plc import PLC, ROUNDS
from .station import (
    Gate,
    GateKind,
    Input,
    RobotStation,
    levels_at_start,
    signal_key,
)

_MOST_STATES = 300_000
_ON_THE_WAY = 8
"""Changes on their way along one wire that are counted; this many, or one less, may be more."""


class _State(NamedTuple):
    """Where everything is.

    Args:
        at: how many of its actions each robot has passed.
        levels: keys of the signals that are on.
        pending: changes on their way along each wire.
        counts: of each gate that counts.
        pulses: keys of signals whose pulses have not ended, and what they are then.
    """

    at: tuple[int, ...]
    levels: frozenset[str]
    pending: tuple[int, ...]
    counts: tuple[int, ...]
    pulses: tuple[tuple[str, bool], ...] = ()


@dataclass(frozen=True)
class Orders:
    """What may be at once.

    Args:
        actions: of each robot, as they were looked at.
        reachable: how far all robots may be at one time, in the order of ``actions``.
        stuck: states in which some robots wait for ever: how far each is.
        states: how many were looked at.
    """

    actions: Mapping[str, tuple[Action, ...]]
    reachable: frozenset[tuple[int, ...]]
    stuck: tuple[tuple[int, ...], ...]
    states: int

    def together(self, one: str, other: str, sizes: tuple[int, int]) -> NDArray[np.bool_]:
        """Whether two robots may be in two sections at once, as an array of ``sizes``.

        Section k of a robot lies between its actions k − 1 and k.
        """
        names = list(self.actions)
        a, b = names.index(one), names.index(other)
        found = np.zeros(sizes, dtype=bool)
        for at in self.reachable:
            found[at[a], at[b]] = True
        return found


def explore(station: RobotStation, actions: Mapping[str, Sequence[Action]]) -> Orders:
    """Look at every order.

    Args:
        station: with its wires and gates.
        actions: of each robot.

    Raises:
        InputError: there are too many to look at, or the PLC's logic never comes to rest.
    """
    return _Explorer(station, actions).all()


class _Explorer:
    def __init__(self, station: RobotStation, actions: Mapping[str, Sequence[Action]]) -> None:
        self._station = station
        self._names = tuple(station.members)
        self._actions = [tuple(actions[name]) for name in self._names]
        self._wires = [(signal_key(w.source), signal_key(w.target)) for w in station.wires]
        self._gates = list(station.gates.items())
        sets = {
            signal_key(f"{name}.{action.does.name}")
            for name, doings in zip(self._names, self._actions, strict=True)
            for action in doings
            if isinstance(action.does, SetSignal)
        }
        self._known = {target for _, target in self._wires} | sets
        self._known |= {signal_key(name) for name in station.given}
        self._known |= {signal_key(name) for name in station.initial}

    def all(self) -> Orders:
        """Breadth first."""
        first = _State(
            (0,) * len(self._names),
            levels_at_start(self._station),
            (0,) * len(self._wires),
            (0,) * len(self._gates),
        )
        unseen = [False] * len(self._gates)
        first = self._settled(first, first.levels, unseen)
        states, numbers = [first], {first: 0}
        before: list[list[int]] = [[]]
        for k, state in enumerate(states):
            for after in self._successors(state):
                if after not in numbers:
                    if len(states) >= _MOST_STATES:
                        raise InputError(
                            f"the programs' actions can come in more than {_MOST_STATES:,} orders: "
                            "what their interlocks allow is not looked at; clearances in time are"
                        )
                    numbers[after] = len(states)
                    states.append(after)
                    before.append([])
                if after != state:
                    before[numbers[after]].append(k)
        actions = dict(zip(self._names, self._actions, strict=True))
        stuck = self._stuck(states, before)
        return Orders(actions, frozenset(s.at for s in states), stuck, len(states))

    def _stuck(
        self, states: Sequence[_State], before: Sequence[Sequence[int]]
    ) -> tuple[tuple[int, ...], ...]:
        """How far robots are where none ever goes on, whatever signals still do.

        Args:
            states: that are reachable.
            before: of each, which states it comes behind.
        """
        ends = tuple(map(len, self._actions))
        alive = [False] * len(states)
        left = [k for k, state in enumerate(states) if state.at == ends]
        for after, earlier in zip(states, before, strict=True):
            left += [k for k in earlier if states[k].at != after.at]
        while left:
            k = left.pop()
            if not alive[k]:
                alive[k] = True
                left += before[k]
        dead = (state.at for state, lives in zip(states, alive, strict=True) if not lives)
        return tuple(dict.fromkeys(dead))

    def _successors(self, state: _State) -> Iterator[_State]:
        for k, pending in enumerate(state.pending):
            if pending:
                yield from self._delivered(state, k, pending)
        for k, (key, on) in enumerate(state.pulses):
            left = state.pulses[:k] + state.pulses[k + 1 :]
            yield self._changed(state._replace(pulses=left), key, on)
        for name, gate in self._gates:
            if gate.kind is GateKind.TIMER:
                key = signal_key(f"{PLC}.{name}")
                if key not in state.levels and any(_holds(state.levels, i) for i in gate.inputs):
                    yield self._changed(state, key, True)
        for k, actions in enumerate(self._actions):
            if state.at[k] < len(actions):
                yield from self._acted(state, k, actions[state.at[k]])

    def _acted(self, state: _State, k: int, action: Action) -> Iterator[_State]:
        onward = state._replace(at=_stepped(state.at, (k,)))
        match action.does:
            case SetSignal(name, value, pulse):
                key = signal_key(f"{self._names[k]}.{name}")
                if pulse is not None:
                    pulses = tuple(sorted((*onward.pulses, (key, not bool(value)))))
                    onward = onward._replace(pulses=pulses)
                yield self._changed(onward, key, bool(value))
            case WaitSignal(condition, longest):
                if longest is not None or self._met(state.levels, self._names[k], condition):
                    yield onward
            case Meet():
                yield from self._together(state, k, action.does)

    def _together(self, state: _State, k: int, meet: Meet) -> Iterator[_State]:
        """All robots of a meeting go on at once, when they are all there."""
        parties = self._parties(k, meet)
        for party in parties:
            actions = self._actions[party]
            at = state.at[party]
            does = actions[at].does if at < len(actions) else None
            if not isinstance(does, Meet) or does.label != meet.label:
                return
        yield state._replace(at=_stepped(state.at, parties))

    def _parties(self, k: int, meet: Meet) -> tuple[int, ...]:
        if meet.parties is not None:
            return tuple(p for p in meet.parties if p < len(self._names)) or (k,)
        return tuple(
            p
            for p, actions in enumerate(self._actions)
            if any(isinstance(a.does, Meet) and a.does.label == meet.label for a in actions)
        )

    def _met(self, levels: frozenset[str], robot: str, condition: Condition) -> bool:
        if isinstance(condition, Joined):
            parts = [self._met(levels, robot, part) for part in condition.parts]
            return all(parts) if condition.every else any(parts)
        key = signal_key(f"{robot}.{condition.name}")
        if key not in self._known:
            return True
        return (key in levels) == condition.on

    def _delivered(self, state: _State, k: int, pending: int) -> Iterator[_State]:
        """A change reaches its target: with what the source was then."""
        source, target = self._wires[k]
        on = (source in state.levels) == (pending % 2 == 1)
        left = [pending - 1]
        if pending == _ON_THE_WAY - 1:
            left.append(_ON_THE_WAY)
        for count in left:
            after = (*state.pending[:k], count, *state.pending[k + 1 :])
            yield self._changed(state._replace(pending=after), target, on)

    def _changed(self, state: _State, key: str, on: bool) -> _State:
        if (key in state.levels) == on:
            return state
        held = [any(_holds(state.levels, one) for one in gate.inputs) for _, gate in self._gates]
        levels = state.levels | {key} if on else state.levels - {key}
        return self._settled(state._replace(levels=levels), state.levels, held)

    def _settled(self, state: _State, before: frozenset[str], held: list[bool]) -> _State:
        """Gates follow, and what changed goes on its way."""
        counts, pending = list(state.counts), list(state.pending)
        levels = set(state.levels)
        for key in levels ^ before:
            self._sent(key, pending)
        for _ in range(ROUNDS):
            changed = False
            for g, (name, gate) in enumerate(self._gates):
                key = signal_key(f"{PLC}.{name}")
                if self._gate(g, key, gate, levels, held, counts) != (key in levels):
                    levels ^= {key}
                    self._sent(key, pending)
                    changed = True
            if not changed:
                return state._replace(
                    levels=frozenset(levels), pending=tuple(pending), counts=tuple(counts)
                )
        raise InputError("the PLC's logic does not come to rest in every order of signals")

    def _sent(self, key: str, pending: list[int]) -> None:
        for k, (source, _) in enumerate(self._wires):
            if source == key:
                pending[k] += 1
                if pending[k] > _ON_THE_WAY:
                    # What the source is stays what it is for two less.
                    pending[k] -= 2

    def _gate(
        self,
        g: int,
        key: str,
        gate: Gate,
        levels: set[str],
        held: list[bool],
        counts: list[int],
    ) -> bool:
        holds = [_holds(levels, one) for one in gate.inputs]
        rises, held[g] = any(holds) and not held[g], any(holds)
        match gate.kind:
            case GateKind.AND:
                return all(holds)
            case GateKind.OR:
                return any(holds)
            case GateKind.LATCH:
                reset = any(_holds(levels, one) for one in gate.resets)
                return not reset and (key in levels or any(holds))
            case GateKind.COUNTER:
                if rises:
                    counts[g] = min(counts[g] + 1, gate.least)
                if any(_holds(levels, one) for one in gate.resets):
                    counts[g] = 0
                return counts[g] >= gate.least
            case GateKind.TIMER:
                return key in levels and any(holds)


def _holds(levels: frozenset[str] | set[str], one: Input) -> bool:
    return (signal_key(one.name) in levels) == one.on


def _stepped(at: tuple[int, ...], which: Sequence[int]) -> tuple[int, ...]:
    return tuple(value + (k in which) for k, value in enumerate(at))


def sections_mask(
    reachable: NDArray[np.bool_],
    actions: tuple[Sequence[Action], Sequence[Action]],
    own: tuple[Callable[[], NDArray[np.float64]], Callable[[], NDArray[np.float64]]],
    lags: tuple[float, float],
) -> Together:
    """Whether intervals of two robots can be passed at one time.

    Args:
        reachable: of sections, see `Orders.together`.
        actions: of each, as they are reckoned with.
        own: (L, 2) s of the intervals of each, as they are when it is asked.
        lags: s by which each motion is behind its command.
    """
    sums = np.zeros((reachable.shape[0] + 1, reachable.shape[1] + 1), dtype=np.int64)
    sums[1:, 1:] = reachable.cumsum(axis=0).cumsum(axis=1)

    latest = [np.array([action.time for action in doings]) for doings in actions]
    earliest = [
        # What comes behind is not done before; what is done before may be as late as it.
        np.minimum.accumulate([action.soonest for action in doings][::-1])[::-1]
        for doings in actions
    ]

    def sections(k: int, rows: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        span = own[k]()[rows]
        # While it waits, a robot may still be coming to rest.
        first = np.searchsorted(latest[k], span[:, 0] - lags[k] - 1e-9, "left")
        last = np.searchsorted(earliest[k], span[:, 1] + 1e-9, "right")
        return first, last

    def together(
        i: NDArray[np.int64], j: NDArray[np.int64]
    ) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        (a0, a1), (b0, b1) = sections(0, i), sections(1, j)
        count = sums[a1 + 1, b1 + 1] - sums[a0, b1 + 1] - sums[a1 + 1, b0] + sums[a0, b0]
        return count > 0, count == (a1 + 1 - a0) * (b1 + 1 - b0)

    return together
