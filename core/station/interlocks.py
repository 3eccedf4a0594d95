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
        action: the wait that could go, or the output that could be set earlier.
        earlier: s of the robot's own time by which it could be; None for a wait that could go.
        place: m of the TCP's path before where it is set now.
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
            for k, action in enumerate(doings):
                if not isinstance(action.does, WaitSignal):
                    continue
                without = {**self.actions, name: (*doings[:k], *doings[k + 1 :])}
                seconds = self._quicker(without)
                if seconds <= _LEAST:
                    continue
                orders = explore(self.station, without)
                if not orders.stuck and self._clear(name, orders, without):
                    yield Saving(name, action, None, 0.0, seconds)

    def outputs(self, orders: Orders) -> Iterator[Saving]:
        """Outputs that others wait for, and that could be set earlier."""
        wanted = awaited(self.station, self.actions)
        for name, doings in self.actions.items():
            for k, action in enumerate(doings):
                if not isinstance(action.does, SetSignal):
                    continue
                if signal_key(f"{name}.{action.does.name}") not in wanted:
                    continue
                begin = doings[k - 1].time if k else 0.0
                if self._quicker(self._moved(name, k, begin)) <= _LEAST:
                    continue
                time = self._earliest(name, k, begin, orders)
                if time < action.time - _LEAST:
                    seconds = self._quicker(self._moved(name, k, time))
                    place = self._way(name, time, action.time)
                    yield Saving(name, action, action.time - time, place, seconds)

    def _earliest(self, name: str, k: int, begin: float, orders: Orders) -> float:
        """The earliest own time, s, found by halving what is not proven."""
        low, high = begin, self.actions[name][k].time
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self._clear(name, orders, self._moved(name, k, middle)):
                high = middle
            else:
                low = middle
        return high

    def _moved(self, name: str, k: int, time: float) -> dict[str, tuple[Action, ...]]:
        doings = self.actions[name]
        moved = (*doings[:k], replace(doings[k], time=time, earliest=None), *doings[k + 1 :])
        return {**self.actions, name: moved}

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
