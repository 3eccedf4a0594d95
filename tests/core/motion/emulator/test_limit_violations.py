"""Accelerations that pass their limit between two samples, at which it holds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.limit_violations import _shares
from flyby.core.motion.path.between_states import joint_at
from flyby.core.motion.path.tcp_samples import States
from flyby.core.registry import find_robot

CHAIN = find_robot("ur/ur10e").chain
AXES = 6
NUMBERS = st.floats(-1, 1)
STATE = st.tuples(NUMBERS, NUMBERS, NUMBERS)


def one_interval(first, last) -> States:
    """Two samples whose first joint has q, q' and q'' at them; the others stand."""
    states = States.zeros(2, AXES)
    for s, (q, slope, bend) in enumerate((first, last)):
        states.q[s, 0], states.dq[s, 0], states.ddq[s, 0] = q, slope, bend
    return states


def accelerations(states: States, x0: float, x1: float) -> np.ndarray:
    """Of the first joint at many places of an interval of length one."""
    made = []
    for z in np.linspace(0.0, 1.0, 1001):
        _, slope, bend = joint_at(states, 0, 0, 1.0, z)
        made.append(0.5 * (x1 - x0) * slope + (x0 + z * (x1 - x0)) * bend)
    return np.array(made)


@settings(max_examples=100, deadline=None)
@given(first=STATE, last=STATE, x0=st.floats(0.01, 1.0), x1=st.floats(0.01, 1.0))
@example(first=(0.0, 0.0, 1.0), last=(0.0, 0.0, 1.0), x0=1.0, x1=1.0)
# As much to one side as to the other at all of five even places, and more between them.
@example(first=(0.0, 79.35686, -115.0353), last=(52.46089, 39.08983, -13.65868), x0=0.25, x1=1.0)
def test_no_acceleration_passes_its_limit_unseen(first, last, x0, x1) -> None:
    states = one_interval(first, last)
    driven = np.abs(accelerations(states, x0, x1))
    limit = max(driven[0], driven[-1])
    assume(limit > 1e-3)
    most, row, zero = np.zeros(1), np.full(1, -1), np.zeros(1, dtype=np.int64)
    free = np.full((1, AXES + 2), np.inf)
    held = free.copy()
    held[0, 0] = limit
    _shares(CHAIN, states, np.ones(1), np.array([x0, x1]), zero, zero, zero, free, held, most, row)
    share = driven.max() / limit
    if share > 1.005:
        assert most[0] == pytest.approx(share, rel=0.03)
        assert row[0] == AXES + 2
    else:
        assert most[0] <= 1.005


@given(
    q=st.floats(-3.0, 3.0),
    bend=st.floats(1e4, 1e6),
    length=st.floats(3e-10, 1e-5),
    z=st.floats(0.0, 1.0),
)
def test_rounded_positions_make_no_acceleration(q, bend, length, z) -> None:
    """Samples a nanometre apart, as in zones of micrometres: their positions are a few digits."""
    slope, end = 0.7, length
    last = (q + slope * end + 0.5 * bend * end**2, slope + bend * end, bend)
    states = one_interval((q, slope, bend), last)
    _, rate, found = joint_at(states, 0, 0, length, z)
    assert found == pytest.approx(bend, rel=1e-3)
    assert rate == pytest.approx(slope + z * bend * end, rel=1e-6)
    zero, most, row = np.zeros(1, dtype=np.int64), np.zeros(1), np.full(1, -1)
    free = np.full((1, AXES + 2), np.inf)
    held = free.copy()
    held[0, 0] = bend
    given_ = np.array([length]), np.ones(2), zero, zero, zero, free, held, most, row
    _shares(CHAIN, states, *given_)
    assert most[0] < 1.004
