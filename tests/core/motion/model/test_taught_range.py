"""What fits were taught by: written and read back, put together, and what lies beyond."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.move_figures import range_notes, range_of
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.provenance import FitRecord, Provenance, provenance_text
from flyby.core.motion.model.taught_range import (
    KINDS,
    TaughtRange,
    beyond,
    merged,
    range_entries,
    read_range,
    shown,
)
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor

from ....identification.fit.known_truth import ROBOT, START, program

POSITIVE = st.floats(1e-4, 1e3)
SPANS = st.none() | st.tuples(POSITIVE, POSITIVE).map(lambda pair: (min(pair), max(pair)))
ANGLES = st.tuples(*[st.floats(-6.0, 6.0)] * 6)


@st.composite
def ranges(draw: st.DrawFn) -> TaughtRange:
    one, other = draw(ANGLES), draw(ANGLES)
    return TaughtRange(
        tuple(kind for kind in KINDS if draw(st.booleans())),
        draw(st.booleans()),
        draw(SPANS),
        draw(SPANS),
        draw(st.none() | POSITIVE),
        tuple(map(min, one, other)),
        tuple(map(max, one, other)),
        draw(SPANS),
    )


@given(ranges())
def test_what_is_written_is_read_and_encloses_what_it_was(taught: TaughtRange) -> None:
    made = read_range(range_entries(taught))
    assert not beyond(made, taught)
    for name in ("speed", "zone", "payload"):
        was, now = getattr(taught, name), getattr(made, name)
        if was is not None:
            assert now[0] <= was[0] and was[1] <= now[1]
            assert now == pytest.approx(was, rel=2e-3)
    assert made.upper == pytest.approx(taught.upper, abs=2e-3)
    assert read_range(range_entries(made)) == made
    assert shown(made) or made == TaughtRange()


@given(st.lists(ranges(), min_size=1, max_size=4))
def test_what_several_cover_holds_each(several: list[TaughtRange]) -> None:
    whole = merged(several)
    assert merged([whole]) == whole
    for one in several:
        assert not beyond(whole, one)


@given(ranges())
def test_where_nothing_is_known_nothing_is_said(driven: TaughtRange) -> None:
    assert beyond(TaughtRange(), driven) == ()


WITHIN = TaughtRange(
    ("MoveJ", "MoveL"), True, (0.05, 1.0), (0.001, 0.1), 0.1, (-1.0,) * 6, (1.0,) * 6, (0.0, 20.0)
)
BEYOND = {
    "arcs": {"moves": KINDS},
    "20 mm/s": {"speed": (0.02, 1.0)},
    "1500 mm/s": {"speed": (0.05, 1.5)},
    "zones of 200 mm": {"zone": (0.001, 0.2)},
    "legs of 50 mm": {"leg": 0.05},
    "axis 3 at -80": {"lower": (-1.0, -1.0, -1.4, -1.0, -1.0, -1.0)},
    "30 kg": {"payload": (0.0, 30.0)},
}


@pytest.mark.parametrize("told", BEYOND)
def test_what_lies_beyond_is_named(told: str) -> None:
    (said,) = beyond(WITHIN, replace(WITHIN, **BEYOND[told]))
    assert said.startswith(told)


def test_axes_about_which_everything_is_alike_are_not_named() -> None:
    turned = replace(WITHIN, lower=(-3.0, *WITHIN.lower[1:5], -6.0))
    assert beyond(WITHIN, turned) == ()


def test_every_part_is_stated_by_a_file() -> None:
    entries = range_entries(WITHIN)
    assert len(entries) == len(fields(TaughtRange)) - 1  # lower and upper are one entry
    with pytest.raises(InputError, match="unknown key of a range"):
        read_range({**entries, "speed": [0, 1]})


def test_a_run_says_what_it_covers_and_where_it_leaves_what_was_taught() -> None:
    vendor = find_vendor("abb")

    def driven(told: Program):
        return Controller(vendor, ROBOT, START).run(told)

    slow, fast = driven(program(0.03, 0.3)), driven(program(0.03, 0.8))
    covers = range_of(slow)
    assert covers.moves == ("MoveJ", "MoveL") and covers.stops
    assert covers.speed is not None and covers.speed[0] == pytest.approx(0.3, rel=1e-3)
    assert covers.zone == (0.03, 0.03)
    record = FitRecord("logs", "runs", "by hand", taught=covers)
    taught = replace(START, provenance={"time.settling_s": Provenance("fitted", fit=record)})
    assert taught.taught == covers
    assert range_notes(slow, taught) == ()
    (note,) = range_notes(fast, taught)
    assert note.move is None and "mm/s" in note.message and "extrapolates" in note.message
    assert range_notes(fast, START) == ()
    assert "[fits.logs.range]" in provenance_text(taught.provenance)


def test_a_model_that_nobody_fitted_says_nothing() -> None:
    assert MotionModel().taught is None


def test_the_shipped_fit_says_what_it_was_taught_by() -> None:
    vendor, robot = find_vendor("abb"), find_robot("abb/irb6640-180-255")
    taught = vendor.motion_of(robot).taught
    assert taught is not None and taught.speed is not None and len(taught.lower) == robot.size
