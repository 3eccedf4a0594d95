"""The gun's signals: where they are sent, in each vendor's words, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.registry import find_vendor
from flyby.problems.paint.spray.signals import GunSignals, gun_events
from flyby.problems.paint.spray.trajectory import PaintTrajectory


def line(flow: list[float]) -> PaintTrajectory:
    position = np.zeros((len(flow) + 1, 3))
    position[:, 0] = 0.1 * np.arange(len(position))
    return PaintTrajectory.at_speed(
        position, np.tile((0.0, 0.0, -1.0), (len(position), 1)), 0.2, flow
    )


@pytest.mark.parametrize(
    ("vendor", "signals", "texts"),
    [
        (
            "abb",
            GunSignals("doGun", "aoFlow", nominal_flow=0.8, delay=0.05),
            ["\\AOp:=aoFlow,0.8", "doGun,1", "\\AOp:=aoFlow,0.4", "doGun,0"],
        ),
        (
            "kuka",
            GunSignals("5", "2", delay=0.05),
            ["$ANOUT[2]=1", "$OUT[5]=TRUE", "$ANOUT[2]=0.5", "$OUT[5]=FALSE"],
        ),
    ],
)
def test_what_is_said_where(vendor: str, signals: GunSignals, texts: list[str]):
    events = gun_events(line([0.0, 1.0, 1.0, 0.5, 0.0]), signals, find_vendor(vendor))
    assert [len(at) for at in events] == [0, 2, 0, 1, 1, 0]
    assert [event.text for at in events for event in at] == texts
    assert {event.time for at in events for event in at} == {0.05}


@given(st.lists(st.booleans(), min_size=1, max_size=12))
def test_the_gun_is_on_where_it_paints(painting: list[bool]):
    """Carrying the switches out one after the other gives the flow back, off at the end."""
    flow = [float(on) for on in painting]
    on, found = False, []
    for at in gun_events(line(flow), GunSignals("doGun"), find_vendor("abb")):
        for event in at:
            assert (event.text == "doGun,1") != on
            on = event.text == "doGun,1"
        found.append(on)
    assert found == [*painting, False]


def test_a_language_without_actions_on_the_way_is_refused():
    with pytest.raises(InputError, match="ur has no actions at a place of the path"):
        gun_events(line([1.0]), GunSignals("0"), find_vendor("ur"))


def test_a_flow_that_nothing_sets_is_refused():
    with pytest.raises(InputError, match=r"the flow changes to 0\.5 .* no output for it"):
        gun_events(line([1.0, 0.5]), GunSignals("doGun"), find_vendor("abb"))


def test_a_delay_beyond_what_the_controller_looks_ahead_is_refused():
    with pytest.raises(InputError, match=r"up to 0\.5 s ahead, the gun's delay is 0\.7 s"):
        gun_events(line([1.0]), GunSignals("doGun", delay=0.7), find_vendor("abb"))


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"switch": " "}, "a name"),
        ({"switch": "a", "delay": -0.1}, "delay"),
        ({"switch": "a", "nominal_flow": 0.0}, "nominal_flow"),
    ],
)
def test_signals_check_themselves(wrong: dict, word: str):
    with pytest.raises(InputError, match=word):
        GunSignals(**wrong)
