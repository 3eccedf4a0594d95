"""When world zones set their outputs: between samples, too."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.motion.command.trajectory import Trajectory
from flyby.core.program.signal import SetSignal
from flyby.core.program.world_zone import WorldZone
from flyby.core.station.world_zones import crossings, on_at_start

PERIOD = 0.004
"""s between samples."""


def driven(position: FloatArray, q: FloatArray, dq: FloatArray) -> Any:
    """A run with this trajectory, and nothing else."""
    count = len(position)
    t = PERIOD * np.arange(count)
    still, turn = np.zeros_like(q), np.tile([1.0, 0, 0, 0], (count, 1))
    move = np.zeros(count, dtype=np.int64)
    return SimpleNamespace(trajectory=Trajectory(t, q, dq, still, position, turn, 0.0 * t, move))


def straight(speed: float, off: float, count: int = 200) -> Any:
    """The TCP along x at a speed, m/s, beside the origin."""
    x = speed * PERIOD * (np.arange(count) - count / 2 + 0.37)
    position = np.column_stack([x, np.full(count, off), np.zeros(count)])
    return driven(position, np.zeros((count, 1)), np.zeros((count, 1)))


def found(zone: WorldZone, run: Any) -> list[tuple[float, bool]]:
    made = []
    for action in crossings(zone, run):
        assert isinstance(action.does, SetSignal)
        assert action.time - 1e-4 < action.soonest < action.time
        made.append((action.time, bool(action.does.value)))
    return made


@given(st.floats(0.2, 3.0), st.floats(1e-4, 0.2), st.floats(0.0, 0.999))
def test_a_ball_that_is_passed_is_entered_and_left_when_it_is(
    speed: float, radius: float, share: float
) -> None:
    """However small it is, and however much faster than it is looked at."""
    run = straight(speed, share * radius)
    zone = WorldZone("z", "one", "do", ball=((0.0, 0.0, 0.0), radius))
    half = radius * math.sqrt(1.0 - share**2) / speed
    middle = PERIOD * (100 - 0.37)
    if half < 1e-4:
        return  # it may be touched unseen
    if middle - half <= 0.0 or middle + half >= run.trajectory.t[-1]:
        return
    (entered, on), (left, off) = found(zone, run)
    assert (on, off) == (True, False)
    assert (entered, left) == pytest.approx((middle - half, middle + half), abs=1.1e-4)


@given(st.floats(0.0, math.pi), st.floats(0.05, 0.95), st.booleans())
def test_axes_that_swing_are_located(phase: float, level: float, inside: bool) -> None:
    rate, count = 9.0, 400
    at = rate * PERIOD * np.arange(count) + phase
    q, dq = np.sin(at)[:, None], rate * np.cos(at)[:, None]
    run = driven(np.zeros((count, 3)), q, dq)
    zone = WorldZone("z", "one", "do", inside, axes=((0, level, 2.0),))
    edge = math.asin(level)
    roots = [
        (turn + 2 * math.pi * k - phase) / rate
        for k in range(-1, 4)
        for turn in (edge, math.pi - edge)
    ]
    last = run.trajectory.t[-1]
    wanted = sorted(t for t in roots if 0.0 < t < last)
    times = [time for time, _ in found(zone, run)]
    assert times == pytest.approx(wanted, abs=1.1e-4)
    value = on_at_start(zone, run)
    for _, on in found(zone, run):
        assert on is not value
        value = on


def test_a_tooth_between_two_samples_is_seen() -> None:
    """A turn of the axis that begins and ends between samples is that of their speeds."""
    dq = np.zeros((9, 1))
    dq[3], dq[4] = 2.0, -2.0
    run = driven(np.zeros((9, 3)), np.zeros((9, 1)), dq)
    zone = WorldZone("z", "one", "do", axes=((0, 1e-3, 1.0),))
    (entered, _), (left, _) = found(zone, run)
    assert 3 * PERIOD < entered < 3.5 * PERIOD < left < 4 * PERIOD


@pytest.mark.parametrize("height", [0.5, -0.5])
def test_a_cylinder_stands_on_its_foot_or_hangs_from_it(height: float) -> None:
    foot = 0.0 if height > 0 else 0.5
    zone = WorldZone("z", "one", "do", cylinder=((1.0, 0.0, foot), 0.2, height))
    places = np.array(
        [[1.0, 0.0, 0.25], [1.19, 0.0, 0.49], [1.21, 0.0, 0.25], [1.0, 0.0, -0.01], [1, 0, 0.51]]
    )
    held = zone.holds(places, np.zeros((5, 1)))
    assert held.tolist() == [True, True, False, False, False]


def test_a_robot_that_stands_on_a_face_crosses_nothing() -> None:
    """For an hour: it is not looked at in ever shorter steps."""
    count = 900_000
    position = np.tile([0.1, 0.0, 0.0], (count, 1))
    run = driven(position, np.zeros((count, 1)), np.zeros((count, 1)))
    assert not found(WorldZone("z", "one", "do", ball=((0.0, 0.0, 0.0), 0.1)), run)
