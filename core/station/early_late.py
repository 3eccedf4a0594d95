"""What else a station does if robots are a little early or late: another one may come first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from ..arrays import FloatArray
from .actions import Action
from .clock import Schedule, StationClock, StationRun
from .station import RobotStation

_MOST = 6
"""Robots of which all combinations are looked at; of more, each is early or late by itself."""
_ROUNDING = 1e-6
"""s by which times are off that mean the same."""


def other_orders(
    station: RobotStation,
    actions: Mapping[str, tuple[Action, ...]],
    run: StationRun,
    jitter: float,
) -> list[StationRun]:
    """Runs in which robots are early or late, and something else happens than in the schedule.

    As long as everybody waits for the same, nobody is off by more than the robots themselves are.

    Args:
        station: the robots.
        actions: of their programs.
        run: the schedule.
        jitter: s by which each robot may be early or late.
    """
    found = []
    for late in _shifts(len(station.members), 2.0 * jitter):
        members = {
            name: replace(member, begins=member.begins + by)
            for (name, member), by in zip(station.members.items(), late, strict=True)
        }
        made = StationClock(replace(station, members=members), actions).run()
        if any(
            _differs(schedule, made.schedules[name], actions[name], jitter)
            for name, schedule in run.schedules.items()
        ):
            found.append(made)
    return found


def _shifts(count: int, by: float) -> Iterator[tuple[float, ...]]:
    """By how much later each robot begins, less what all do."""
    if by > 0.0 and count <= _MOST:
        yield from (late for late in product((0.0, by), repeat=count) if len(set(late)) > 1)
    elif by > 0.0:
        for k, first in product(range(count), (0.0, by)):
            yield tuple(by - first if other == k else first for other in range(count))


def _differs(one: Schedule, other: Schedule, actions: Sequence[Action], jitter: float) -> bool:
    """Whether a robot's schedule is off by more than the jitter from one that is so much later."""
    times, shifted = (_times(schedule, actions) for schedule in (one, other))
    known = np.isfinite(times)
    if not np.array_equal(known, np.isfinite(shifted)):
        return True
    off = np.abs(shifted[known] - times[known] - jitter)
    return bool((off > jitter + _ROUNDING).any())


def _times(schedule: Schedule, actions: Sequence[Action]) -> FloatArray:
    """s, when a robot comes to its actions, when it goes on behind them, and when it ends."""
    at = np.array([action.time for action in actions])
    return np.append(schedule.clocked(np.stack([at, at], -1)).ravel(), schedule.end)
