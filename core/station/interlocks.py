"""What interlocks cost: waits that could go, and outputs that could be set earlier, all proven."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..program.signal import SetSignal, WaitSignal
from .actions import Action
from .awaited import Actions, awaited
from .clearances import PairClearance, StationProver
from .clock import StationClock
from .orders import Orders, explore
from .station import RobotStation, signal_key

_HALVINGS = 8
_LEAST = 1e-3
"""s that a change of an interlock saves at least to be named."""


@dataclass(frozen=True, slots=True)
class Saving:
    """A change of an interlock that is proven to keep the robots clear, in every order.

    Args:
        robot: whose program it is.
        action: the wait that could go, or the output that could be set earlier, the first time that
            its statement is carried out; it is proven for all times.
        earlier: s of the robot's own time by which it could be; None for a wait that could go.
        place: m of the TCP's path before where it is set now, the least of all times.
        seconds: that the station would be quicker.
    """

    robot: str
    action: Action
    earlier: float | None
    place: float
    seconds: float


def savings(
    station: RobotStation,
    actions: Mapping[str, tuple[Action, ...]],
    prover: StationProver,
    clearances: Sequence[PairClearance],
    orders: Orders,
) -> list[Saving]:
    """Waits and outputs that hold the station up more than they need to, the dearest first.

    Each is looked at by itself, the others as they are.

    Args:
        station: the robots.
        actions: of their programs.
        prover: of the station.
        clearances: as proven now; where interlocks do not keep robots apart, nothing is looked for.
        orders: as the signals allow them now.
    """
    if orders.stuck or not all(pair.safe for pair in clearances):
        return []
    base = StationClock(station, actions).run().duration
    locked = [pair.robots for pair in clearances if not pair.any_time.proven]
    search = _Search(station, actions, prover, locked, base)
    found = [*search.waits(), *search.outputs(orders)]
    found = [saving for saving in found if saving.seconds > _LEAST]
    return sorted(found, key=lambda saving: -saving.seconds)


@dataclass(frozen=True)
class _Search:
    station: RobotStation
    actions: Mapping[str, tuple[Action, ...]]
    prover: StationProver
    locked: Sequence[tuple[str, str]]
    base: float

    def waits(self) -> Iterator[Saving]:
        """Waits without which the robots keep clear all the same."""
        for name, doings in self.actions.items():
            for passes in _statements(doings, WaitSignal):
                left = tuple(a for k, a in enumerate(doings) if k not in passes)
                without = {**self.actions, name: left}
                seconds = self._quicker(without)
                if seconds <= _LEAST:
                    continue
                orders = explore(self.station, without)
                if not orders.stuck and self._clear(name, orders, without):
                    yield Saving(name, doings[passes[0]], None, 0.0, seconds)

    def outputs(self, orders: Orders) -> Iterator[Saving]:
        """Outputs that others wait for, and that could be set earlier."""
        wanted = awaited(self.station, self.actions)
        for name, doings in self.actions.items():
            for passes in _statements(doings, SetSignal):
                action = doings[passes[0]]
                assert isinstance(action.does, SetSignal)
                if signal_key(f"{name}.{action.does.name}") not in wanted:
                    continue
                # The order of actions stays as it is, in every pass.
                most = min(doings[k].time - (doings[k - 1].time if k else 0.0) for k in passes)
                if self._quicker(self._moved(name, passes, most)) <= _LEAST:
                    continue
                earlier = self._most(name, passes, most, orders)
                if earlier > _LEAST:
                    seconds = self._quicker(self._moved(name, passes, earlier))
                    times = [doings[k].time for k in passes]
                    place = min(self._way(name, time - earlier, time) for time in times)
                    yield Saving(name, action, earlier, place, seconds)

    def _most(self, name: str, passes: Sequence[int], most: float, orders: Orders) -> float:
        """s by which a statement can come earlier, found by halving what is not proven."""
        low, high = 0.0, most
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self._clear(name, orders, self._moved(name, passes, middle)):
                low = middle
            else:
                high = middle
        return low

    def _moved(
        self, name: str, passes: Sequence[int], earlier: float
    ) -> dict[str, tuple[Action, ...]]:
        doings = list(self.actions[name])
        for k in passes:
            doings[k] = replace(doings[k], time=doings[k].time - earlier, earliest=None)
        return {**self.actions, name: tuple(doings)}

    def _clear(self, name: str, orders: Orders, actions: Actions) -> bool:
        """Whether a robot keeps clear of all others, if its actions are these."""
        return all(
            self.prover.interlocked(one, other, orders, actions).proven
            for one, other in self.locked
            if name in (one, other)
        )

    def _quicker(self, actions: Mapping[str, tuple[Action, ...]]) -> float:
        return self.base - StationClock(self.station, actions).run().duration

    def _way(self, name: str, begin: float, end: float) -> float:
        """m that the TCP moves between two own times."""
        trajectory = self.station.members[name].run.trajectory
        steps = np.linalg.norm(np.diff(trajectory.position, axis=0), axis=1)
        way = np.append(0.0, np.cumsum(steps))
        return float(np.interp(end, trajectory.t, way) - np.interp(begin, trajectory.t, way))


def _statements(
    doings: Sequence[Action], kind: type[SetSignal] | type[WaitSignal]
) -> Iterator[list[int]]:
    """Indices of the actions of a kind, those of one statement together: who changes a line changes
    it for every pass of its loop, and for every call of its routine."""
    found: dict[object, list[int]] = {}
    for k, action in enumerate(doings):
        if isinstance(action.does, kind):
            found.setdefault(k if action.span is None else (action.span, action.text), []).append(k)
    yield from found.values()
