"""Robots that stop at a point which their program passes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.program import Program
from flyby.core.program.zone import FINE, Fine, Radius
from flyby.core.registry import find_vendor
from flyby.identification.logs.cleaning import clean_samples
from flyby.identification.prediction import predict
from flyby.identification.unplanned_stops import with_stops

from .faulty_logs import PERIOD, ROBOT, emulated, joints, program

CONTROLLER = Controller(find_vendor("ur"), ROBOT, MotionModel())


def logged(driven: Program, seed: int = 0, pause: tuple[float, float] = (0.0, 0.0)):
    """A log with jitter and noise; at a time it stands still for a while."""
    run, rng = emulated(driven), np.random.default_rng(seed)
    t = np.arange(0.0, run.trajectory.duration + 0.3 + pause[1], PERIOD)
    t = t + rng.uniform(-0.1, 0.1, len(t)) * PERIOD
    since = np.where(t < pause[0], t, np.maximum(t - pause[1], pause[0]))
    q = joints(run, since)
    return clean_samples(t, q + 2e-6 * rng.normal(size=q.shape))


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 1000), radius=st.floats(0.01, 0.08))
def test_a_stop_that_no_program_says_is_emulated(seed: int, radius: float) -> None:
    told = program(radius=radius)
    log = logged(with_stops(told, (0,)), seed)
    found = predict(CONTROLLER, "stopped", told, log)
    assert found.stops == (0,)
    assert found.driven.program.moves[0].zone == Fine(programmed=False)
    assert found.figures.path_max < 1e-4
    assert found.figures.cycle_time_ratio == pytest.approx(1.0, abs=0.01)
    assert "stops at the end of move 1," in found.log.notes[-1]


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 1000), leg=st.floats(0.15, 0.3))
def test_what_passes_is_no_stop(seed: int, leg: float) -> None:
    told = program(leg)
    assert predict(CONTROLLER, "passed", told, logged(told, seed)).stops == ()
    stopping = told.with_moves(tuple(replace(move, zone=FINE) for move in told.moves))
    assert predict(CONTROLLER, "said", stopping, logged(stopping, seed)).stops == ()


def test_a_pause_on_the_way_is_no_stop_at_a_point() -> None:
    told = program(0.3, 0.02)
    found = predict(CONTROLLER, "paused", told, logged(told, pause=(0.6, 0.4)))
    assert found.stops == ()
    assert found.driven.program.moves[0].zone == Radius(0.02)
