"""Parameters come back from logs of a model that is known, inside their intervals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.identification.fit import ParameterSet, fit, outcomes
from flyby.identification.logs.synthetic import Faults

from .known_truth import START, TRUE_VALUES, TRUTH, logged, ready

FAULTS = Faults(noise=1e-5, jitter=3e-4, stamp=2e-4, torn=5, hole=0.14, offset=0.7)


@pytest.fixture(scope="module")
def runs():
    wanted = ((0.03, 0.5), (0.08, 0.2), (0.0, 0.8), (0.05, 1.5))
    return [
        ready(logged(radius, speed, seed, FAULTS)) for seed, (radius, speed) in enumerate(wanted)
    ]


@pytest.fixture(scope="module")
def fitted(runs):
    return fit(ParameterSet.named(START, TRUE_VALUES), runs)


def test_known_parameters_lie_in_their_intervals(fitted) -> None:
    assert fitted.converged and not fitted.unseen
    for one in fitted.intervals:
        assert one.lower <= TRUE_VALUES[one.name] <= one.upper, one
        # An interval that holds everything would hold the truth too.
        assert one.upper - one.lower < 0.4 * abs(TRUE_VALUES[one.name]), one
    assert fitted.after < 0.02 * fitted.before


def test_faults_of_the_logs_are_known(runs) -> None:
    for run in runs:
        assert len(run.log.holes) == 1
        assert 3 <= len(run.log.torn) <= 8
        assert run.offset == pytest.approx(FAULTS.offset, abs=0.05)


def test_runs_are_predicted_after_the_fit(fitted) -> None:
    for one in outcomes(fitted):
        assert one.after.figures.path_p99 < 6e-5
        assert one.after.figures.path_p99 < 0.5 * one.before.figures.path_p99
        assert one.after.figures.cycle_time_ratio == pytest.approx(1.0, abs=5e-3)


def test_workers_change_nothing(runs, fitted) -> None:
    other = fit(ParameterSet.named(START, TRUE_VALUES), runs, workers=2)
    np.testing.assert_allclose(other.values, fitted.values, rtol=1e-9)


def test_sound_logs_give_the_parameters_themselves() -> None:
    sound = Faults(noise=0.0, jitter=0.0)
    # The other figures are not fitted here: they are those of the truth.
    runs = [ready(logged(0.03, 0.5, 0, sound), TRUTH), ready(logged(0.08, 0.2, 1, sound), TRUTH)]
    base = replace(TRUTH, tcp=START.tcp, smoothing=START.smoothing)
    found = fit(ParameterSet.named(base, list(TRUE_VALUES)[:2]), runs)
    np.testing.assert_allclose(found.values, [-0.5, 0.04], rtol=2e-3)


def test_zones_between_two_samples_are_not_identifiable() -> None:
    """A zone of 1 mm at 0.5 m/s is over in 4 ms."""
    run = ready(logged(0.001, 0.5, 0, Faults(period=0.008)))
    found = fit(ParameterSet.named(START, ["blend.tcp.beta[0]", "time.smoothing_s[*]"]), [run])
    assert [one.name for one in found.unseen] == ["blend.tcp.beta[0]"]
    assert "too small to be seen" in found.unseen[0].reason
    assert "every 8 ms" in found.unseen[0].reason
    assert [one.name for one in found.intervals] == ["time.smoothing_s[*]"]
    assert found.model.tcp == START.tcp


def test_what_no_run_uses_is_not_identifiable() -> None:
    runs = [ready(logged(radius, 0.4, k)) for k, radius in enumerate((0.03, 0.05, 0.08))]
    texts = ["blend.tcp.beta[0]", "blend.joint.beta[0] = 0.1"]
    found = fit(ParameterSet.named(START, texts), runs)
    assert [one.name for one in found.unseen] == ["blend.joint.beta[0]"]
    assert "no log changes with it" in found.unseen[0].reason


def test_two_that_only_their_sum_shows_are_told_apart() -> None:
    """Averages of nearly one length: one of them stays, and the other takes what both explain."""
    base = replace(START, smoothing=(0.04, 0.04))
    runs = [ready(logged(0.03, 0.5, k), base) for k in range(2)]
    texts = ["time.smoothing_s[0]", "time.smoothing_s[1]"]
    found = fit(ParameterSet.named(replace(TRUTH, smoothing=base.smoothing), texts), runs)
    assert len(found.unseen) == 1 and len(found.intervals) == 1
    assert "only together with time.smoothing_s" in found.unseen[0].reason


def test_nothing_to_fit_is_refused() -> None:
    run = ready(logged())
    with pytest.raises(InputError, match="name parameters"):
        fit(ParameterSet.named(START, []), [run])
    with pytest.raises(InputError, match="no run"):
        fit(ParameterSet.named(START, ["time.settling_s"]), [])
    with pytest.raises(InputError, match=r"none of the parameters: blend\.joint\.beta"):
        fit(ParameterSet.named(START, ["blend.joint.beta[0] = 0"]), [run])
