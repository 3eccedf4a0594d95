"""Events along a move."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, Span
from flyby.core.program.event import Event, EventAnchor
from flyby.core.program.move import MoveJ
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget


@given(st.floats(), st.floats())
def test_an_event_has_a_distance_not_below_zero_and_a_finite_time(
    distance: float, time: float
) -> None:
    sound = math.isfinite(distance) and math.isfinite(time) and distance >= 0
    if sound:
        event = Event("do1", distance=distance, time=time)
        assert (event.distance, event.time) == (distance, time)
        return
    with pytest.raises(InputError, match="do1"):
        Event("do1", distance=distance, time=time)


def test_events_count_in_a_move_and_their_places_in_the_text_do_not() -> None:
    event = Event("do1", EventAnchor.START, 0.1, -0.2, Span("a", 1, 1, 0, 1))
    assert event == Event("do1", EventAnchor.START, 0.1, -0.2)
    assert event != Event("do1", EventAnchor.END, 0.1, -0.2)
    move = MoveJ(JointTarget((0.0,)), Speed())
    assert move.events == ()
    assert MoveJ(JointTarget((0.0,)), Speed(), events=(event,)) != move
