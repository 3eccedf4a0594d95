"""Spans of a robot's own time on the station's clock."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.program.signal import Level, WaitSignal
from flyby.core.station.actions import Action
from flyby.core.station.clock import Schedule, Spell

WAIT = Action(WaitSignal(Level("go", True)), 1.0, 0, "wait", None)


def waiting(lag: float) -> Schedule:
    """It waits for two seconds when its own time is 1 s."""
    return Schedule("one", 0.0, 9.0, (Spell(WAIT, 1.0, 3.0),), lag)


def test_what_is_before_a_wait_and_behind_it() -> None:
    spans = np.array([[0.5, 0.9], [0.9, 1.5], [1.2, 1.5]])
    expected = [[0.5, 0.9], [0.9, 3.5], [3.2, 3.5]]
    np.testing.assert_allclose(waiting(0.05).clocked(spans), expected)


@given(lag=st.floats(0.0, 0.1), own=st.floats(0.0, 2.0), span=st.floats(0.0, 0.5))
def test_a_motion_behind_its_command_may_come_to_rest_or_leave(
    lag: float, own: float, span: float
) -> None:
    """What it begins as the command goes on comes behind the wait; where it has not come to rest
    when the command stands, it may do so before."""
    ((begin, end),) = waiting(lag).clocked(np.array([[own, own + span]]))
    assert begin == pytest.approx(own if own <= 1.0 + 2.0 * lag + 1e-9 else own + 2.0)
    assert end == pytest.approx(own + span + (2.0 if own + span >= 1.0 - 1e-9 else 0.0))
