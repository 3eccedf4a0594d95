"""A clock or a speed override explains a log before figures of the motion do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.model.motion_model import MotionModel
from flyby.identification.fit import ParameterSet, PreparedRun, fit
from flyby.identification.logs import LoggedRun, clean
from flyby.identification.logs.synthetic import synthetic_run
from flyby.identification.prediction import predict
from flyby.identification.time_scale import Cause, time_scale

from .known_truth import ROBOT, START, TRUE_VALUES, TRUTH, USUAL, VENDOR, program, ready

BASE = replace(TRUTH, tcp=START.tcp, smoothing=START.smoothing)
TEXTS = list(TRUE_VALUES)[:2]
KINDS = ((0.03, 0.5), (0.08, 0.2), (0.0, 0.8))


class Slowed(Controller):
    """Driven at a share of all speeds."""

    share = 1.0

    def run(self, program, start=None, period=None, override=1.0) -> Run:
        return super().run(program, start, period, self.share)


def logged(model: MotionModel, k: int, clock: float = 1.0, share: float = 1.0) -> LoggedRun:
    controller = Slowed(VENDOR, ROBOT, model)
    controller.share = share
    run = synthetic_run(controller, program(*KINDS[k]), f"run{k}", USUAL, k)
    return replace(run, t=run.t[0] + clock * (run.t - run.t[0]))


def runs(base: MotionModel, clock: float = 1.0, share: float = 1.0) -> list[PreparedRun]:
    return [ready(logged(TRUTH, k, clock, share), base) for k in range(3)]


@settings(max_examples=5)
@given(clock=st.floats(0.9, 1.1).filter(lambda c: abs(c - 1) > 5e-3))
def test_a_clock_alone_explains_a_log(clock: float) -> None:
    run = logged(TRUTH, 0, clock)
    controller = Controller(VENDOR, ROBOT, TRUTH)
    found = time_scale(controller, predict(controller, run.name, run.program, clean(run), 1e-3))
    assert found is not None and found.alone and found.cause is Cause.CLOCK
    assert found.value == pytest.approx(clock, abs=1e-3)
    more = "longer" if found.value > 1.0 else "less time"
    percent = f"{100 * abs(found.value - 1.0):.1f}"
    assert f"the robot took {percent} % {more} than emulated, evenly:" in found.told
    assert "check override and clock" in found.told


def test_an_override_alone_explains_a_log() -> None:
    run = logged(TRUTH, 0, share=0.8)
    controller = Controller(VENDOR, ROBOT, TRUTH)
    found = time_scale(controller, predict(controller, run.name, run.program, clean(run), 1e-3))
    assert found is not None and found.alone and found.cause is Cause.OVERRIDE
    assert found.value == pytest.approx(0.8, abs=0.01)
    assert "a speed override of 80" in found.told


@pytest.mark.parametrize("base", [TRUTH, replace(TRUTH, settling=0.0)], ids=["known", "settling"])
def test_logs_at_their_own_time_are_not_explained_by_a_clock(base: MotionModel) -> None:
    controller = Controller(VENDOR, ROBOT, base)
    for k in range(3):
        run = logged(TRUTH, k)
        found = time_scale(controller, predict(controller, run.name, run.program, clean(run), 1e-3))
        assert found is None or not found.alone, (k, found)


@pytest.mark.parametrize(
    ("clock", "share"), [(1.02, 1.0), (1.0, 0.9), (0.97, 1.0)], ids=["slow", "override", "fast"]
)
def test_what_is_fitted_beside_a_clock_is_true(clock: float, share: float) -> None:
    """Fitted without, accelerations and averages take the clock's place."""
    found = fit(ParameterSet.named(BASE, TEXTS), runs(BASE, clock, share))
    for one in found.intervals:
        assert one.value == pytest.approx(TRUE_VALUES[one.name], rel=0.03), one
    (said,) = found.scales
    assert said[0] == "run0, run1, run2"
    own = found.nuisances[0]
    assert (1 / own.clock, own.override) == pytest.approx((clock, share), abs=1e-3)
    assert ("override of" if clock == 1.0 else f"{100 * abs(clock - 1):.1f} %") in said[1]


def test_one_run_at_another_override_is_told_from_the_others() -> None:
    mixed = [*runs(BASE)[:2], ready(logged(TRUTH, 2, share=0.5), BASE)]
    found = fit(ParameterSet.named(BASE, TEXTS), mixed)
    (said,) = found.scales
    assert said[0] == "run2" and "a speed override of 50.0 %" in said[1]
    for one in found.intervals:
        assert one.value == pytest.approx(TRUE_VALUES[one.name], rel=0.03), one


def test_a_motion_that_takes_longer_is_no_clock() -> None:
    truth = replace(TRUTH, settling=0.08)
    slow = [ready(logged(truth, k), TRUTH) for k in range(3)]
    found = fit(ParameterSet.named(TRUTH, ["time.settling_s"]), slow)
    assert found.scales == []
    assert found.after < 0.05
    np.testing.assert_allclose([own.clock for own in found.nuisances], 1.0)


def test_a_clock_that_figures_hide_is_found_where_they_leave_much_unexplained() -> None:
    """The run's motion is emulated too slowly, so that its times do not show the clock alone."""
    run = ready(logged(TRUTH, 2, 1.02), START)
    assert run.scale is None
    found = fit(ParameterSet.named(START, TRUE_VALUES), [run])
    (said,) = found.scales
    assert "the robot took 2.0 % longer than emulated, evenly, beside what other" in said[1]
    assert found.after < 0.05
