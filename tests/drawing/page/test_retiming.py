"""A track on another clock drives the same motion, with rests in between."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.station.station import ClockPace
from flyby.drawing.page.curves import ACCELERATION, SPEED
from flyby.drawing.page.packing import Quantised
from flyby.drawing.page.retiming import OtherClock, cut_off, on_clock
from flyby.drawing.page.track_content import PageChannel, PageFlag, PageMotion, PageMove, PageTrack

STOPS = (0.0, 1.0, 2.5, 4.0)
"""s at which the motion below stands still."""


def track() -> PageTrack:
    """One axis that goes from stop to stop, as a cubic each, and back to where it was."""
    t = np.array(STOPS)
    q = np.array([0.0, 1.0, -0.5, 2.0])
    motion = PageMotion(Quantised(t, 1e-6), [Quantised(q, 1e-6)], [Quantised(0.0 * q, 1e-6)])
    channel = PageChannel("height", "x", Quantised(10.0 * q, 1e-3))
    stepped = PageChannel("asked", "x", Quantised(q, 1e-3), stepped=True)
    moves = [PageMove(k, "m", begin=a, end=b) for k, (a, b) in enumerate(pairwise(t), 1)]
    return PageTrack(
        "", 0, 4.0, motion, moves, [channel, stepped], flags=[PageFlag("wait", "w", 1.0)]
    )


def at(t: np.ndarray, values: np.ndarray, rates: np.ndarray, time: float) -> float:
    """The cubic between knots, as the viewer has it."""
    k = min(max(int(np.searchsorted(t, time, "right")) - 1, 0), len(t) - 2)
    span = t[k + 1] - t[k]
    if span <= 0.0:
        return float(values[k])
    s = min(max((time - t[k]) / span, 0.0), 1.0)
    rise, first, last = values[k + 1] - values[k], span * rates[k], span * rates[k + 1]
    b, c = 3 * rise - 2 * first - last, first + last - 2 * rise
    return float(values[k] + s * (first + s * (b + s * c)))


def own_at(clock: OtherClock, time: float) -> float:
    """The motion's own time at one of the other clock, which is linear between changes."""
    own = np.repeat(np.unique([*STOPS, *clock.pace.own]), 2)
    other = np.stack([clock.first(own[::2]), clock.last(own[::2])], -1).ravel()
    return float(np.interp(time, other, own))


RESTS = st.lists(st.tuples(st.sampled_from(STOPS), st.floats(1e-3, 5.0)), max_size=5).map(
    lambda rests: sorted(rests, key=lambda one: one[0])
)
PACES = st.lists(st.tuples(st.floats(0.01, 0.9), st.floats(1.0, 5.0)), max_size=4).map(
    lambda spans: ClockPace.slower(
        [
            (k + np.array([0.0, width]), np.array([0.0, width * slower]))
            for k, (width, slower) in enumerate(spans)
        ]
    )
)


@given(RESTS, st.floats(0.0, 3.0), st.integers(0, 40), PACES)
def test_the_motion_is_where_it_was_on_its_own_clock(
    stops: list[tuple[float, float]], begin: float, count: int, pace: ClockPace
) -> None:
    lists = np.array([a for a, _ in stops]), np.array([b for _, b in stops])
    rests = OtherClock(begin, *lists, pace=pace)
    given_, end = track(), begin + pace.at(4.0) + sum(length for _, length in stops)
    made = on_clock(given_, rests, np.linspace(begin, end, count))
    assert abs(made.duration - end) < 1e-9
    t, q, dq = (made.motion.t.values, made.motion.q[0].values, made.motion.dq[0].values)
    assert (np.diff(t) >= 0.0).all() and abs(t[0] - begin) < 1e-9 and abs(t[-1] - end) < 1e-9
    assert all(len(one.values.values) == len(t) for one in made.channels)
    own_t, own_q = given_.motion.t.values, given_.motion.q[0].values
    for time in np.linspace(begin, end, 57):
        own = own_at(rests, time)
        assert abs(at(t, q, dq, time) - at(own_t, own_q, 0.0 * own_q, own)) < 1e-6
    height = np.interp(own_t, own_t, 10.0 * own_q)
    for k, time in enumerate(t):
        own = own_at(rests, time)
        assert abs(made.channels[0].values.values[k] - np.interp(own, own_t, height)) < 1e-6
    for own, moved in zip(given_.moves, made.moves, strict=True):
        assert moved.begin <= moved.end + 1e-9
        assert abs(own_at(rests, moved.begin) - own.begin) < 1e-9
        assert abs(own_at(rests, moved.end) - own.end) < 1e-9


def test_a_rest_that_the_motion_lags_into_is_before_the_move() -> None:
    rests = OtherClock(0.0, np.array([0.03]), np.array([2.0]), lag=0.03)
    assert abs(rests.begins(np.array([0.0]))[0] - 2.0) < 1e-9
    assert abs(rests.first_at(0.0)) < 1e-9


def test_what_waits_for_ever_drives_no_further() -> None:
    rests = OtherClock(0.5, np.array([1.0]), np.array([2.0]))
    made = cut_off(on_clock(track(), rests, np.linspace(0.0, 3.5, 8)), 3.5)
    assert made.duration == made.motion.t.values[-1] == 3.5
    assert abs(made.motion.q[0].values[-1] - track().motion.q[0].values[1]) < 1e-9
    assert [None if m.end is None else round(m.end, 9) for m in made.moves] == [1.5, None, None]
    assert all(len(one.values.values) == len(made.motion.t.values) for one in made.channels)


def test_what_is_slower_has_less_speed_and_no_known_acceleration() -> None:
    half = ClockPace.slower([(np.array([1.0, 2.5]), np.array([0.0, 3.0]))])
    t = np.linspace(0.0, 4.0, 9)
    motion = PageMotion(Quantised(t, 1e-6), [Quantised(t, 1e-6)], [Quantised(0 * t + 1.0, 1e-6)])
    curves = [
        PageChannel(name, name, Quantised(0.0 * t + 10.0, 1e-3)) for name in (SPEED, ACCELERATION)
    ]
    given_ = PageTrack("", 0, 4.0, motion, channels=curves, flags=[PageFlag("wait", "w", 2.0, 0.5)])
    made = on_clock(given_, OtherClock(0.0, *np.empty((2, 0)), pace=half), np.empty(0))
    assert abs(made.flags[0].t - 3.0) < 1e-9 and abs(made.flags[0].duration - 1.0) < 1e-9
    rate, speed, acceleration = (
        made.motion.dq[0].values,
        *(one.values.values for one in made.channels),
    )
    now = made.motion.t.values
    slow, quick = (now > 1.1) & (now < 3.9), (now < 0.9) | (now > 4.1)
    assert slow.any() and quick.any()
    np.testing.assert_allclose(rate, 0.1 * speed)
    np.testing.assert_allclose(speed[slow], 5.0, rtol=1e-6)
    np.testing.assert_allclose(speed[quick], 10.0, rtol=1e-6)
    assert np.isnan(acceleration[slow]).all() and (acceleration[quick] == 10.0).all()
