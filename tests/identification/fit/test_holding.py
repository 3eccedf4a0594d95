"""A fit leaves what was before only as far as runs that were held back ask for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.motion.model.provenance import FitRecord, Provenance
from flyby.identification.fit import ParameterSet, fit, fit_held
from flyby.identification.fit.holding import HOLDS, HeldFit, chosen, evened
from flyby.identification.fit.judgement import Judgement, is_gain
from flyby.identification.fit.problem import Problem, Variables, first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.fit.secants import RunDerivatives, carried

from .known_truth import START, TRUTH, logged, ready

TEXTS = ["blend.tcp.beta[0]", "time.smoothing_s[*]"]
KINDS = ((0.03, 0.5), (0.08, 0.2), (0.05, 0.8))
NEAR = replace(TRUTH, tcp=START.tcp)


def test_the_harder_a_fit_is_held_the_less_it_leaves_what_was_before() -> None:
    run = ready(logged(0.05, 0.5, 0), NEAR)
    before, parameters = NEAR.tcp.beta[0], ParameterSet.named(NEAR, TEXTS)
    away, losses = [], []
    for hold in (1e3, 1.0, 0.0):
        found = fit(replace(parameters, hold=hold), [run])
        away.append(abs(found.model.tcp.beta[0] - before))
        losses.append(found.after)
    assert away[0] < 0.05 < 0.45 < away[-1]
    assert away == sorted(away) and losses == sorted(losses, reverse=True)


def test_a_robot_that_differs_is_followed() -> None:
    runs = [ready(logged(*one, k), NEAR) for k, one in enumerate(KINDS)]
    held = fit_held(ParameterSet.named(NEAR, TEXTS), runs)
    assert held.judgement is not None and held.judgement.better and held.share in HOLDS
    assert held.fit.model.tcp.beta[0] == pytest.approx(-0.5, abs=0.05)
    assert held.judgement.gains.mean() > np.log(5.0)


def test_of_the_same_robot_nothing_is_learnt() -> None:
    runs = [ready(logged(*one, k), TRUTH) for k, one in enumerate(KINDS)]
    held = fit_held(ParameterSet.named(TRUTH, TEXTS), runs)
    assert held.fit.model.tcp.beta[0] == pytest.approx(TRUTH.tcp.beta[0], abs=0.01)


def judged(share: float, after: tuple[float, ...]) -> tuple[HeldFit, Judgement]:
    before = (1.0,) * len(after)
    made = Judgement(("a", "b", "c", "d", "e"), before, after, before, after, False)
    return HeldFit(None, made, share), made  # type: ignore[arg-type]


def test_a_hold_that_may_be_handed_out_is_taken_before_one_that_gains_more() -> None:
    mild = judged(0.1, (0.9, 0.8, 0.7, 0.8, 0.7))
    astray = judged(0.01, (5.0, 0.3, 0.3, 0.3, 0.3))
    strong = judged(1.0, (0.99, 0.98, 0.99, 0.98, 0.99))
    assert astray[1].gains.mean() > mild[1].gains.mean() and not astray[1].better
    assert chosen([strong, mild, astray]).share == 0.1
    assert chosen([astray]).share == 0.01
    clear = judged(0.001, (0.3, 0.3, 0.2, 0.2, 0.3))
    assert chosen([strong, mild, astray, clear]).share == 0.001


def test_runs_that_nothing_explains_count_less() -> None:
    odd = replace(TRUTH, tcp=replace(TRUTH.tcp, beta=(3.0,)), settling=0.3)
    models = (TRUTH, odd, TRUTH)
    runs = [
        ready(logged(*one, k, model=m), TRUTH)
        for k, (one, m) in enumerate(zip(KINDS, models, strict=True))
    ]
    made, loss = evened(TRUTH, runs)
    assert [np.array_equal(a.weight, b.weight) for a, b in zip(made, runs, strict=True)] == [
        True,
        False,
        True,
    ] or sum(np.array_equal(a.weight, b.weight) for a, b in zip(made, runs, strict=True)) == 2
    with RunPool(runs) as pool:
        rest = Problem(pool, Variables.of(ParameterSet(TRUTH, ()), runs)).residuals(np.zeros(3))
    assert 0.0 < loss < 0.5 * float(rest @ rest)


def test_what_was_fitted_before_is_known_by_its_interval() -> None:
    origin = Provenance(
        "fitted",
        fit=FitRecord("logs", "runs", "c"),
        fitted=("blend.tcp.beta[0] in -8 .. 8",),
        interval=((-0.52, -0.48),),
    )
    told = replace(TRUTH, provenance={"blend.tcp.beta": origin})
    known, loose = (ParameterSet.named(model, TEXTS).parameters[0].known for model in (told, TRUTH))
    assert 0.01 < known < 0.1 < loose


@given(st.lists(st.floats(-3.0, 3.0), min_size=2, max_size=9))
def test_a_gain_is_no_loss(gains: list[float]) -> None:
    values = np.array(gains)
    assert not (is_gain(values) and is_gain(-values))
    assert not is_gain(np.zeros_like(values))
    assert is_gain(np.abs(values) + 10.0)


@given(st.integers(0, 2**31))
def test_derivatives_that_are_carried_on_foretell_the_step_behind(seed: int) -> None:
    """And those of a linear problem stay what they are."""
    rng = np.random.default_rng(seed)
    J, values, step = rng.normal(size=(7, 3)), rng.normal(size=7), rng.normal(size=3)
    known = [RunDerivatives(values, J)]
    (exact,) = carried(known, step, [values + J @ step]) or [None]
    assert exact is not None and exact.jacobian == pytest.approx(J, abs=1e-9)
    there = values + J @ step + 0.01 * rng.normal(size=7)
    made = carried(known, step, [there])
    if made is not None:
        assert made[0].jacobian @ step == pytest.approx(there - values, abs=1e-9)
    assert carried(known, step, [values - J @ step]) is None


def test_what_is_known_at_the_start_is_not_evaluated_again() -> None:
    runs = [ready(logged(0.05, 0.5, 0), NEAR)]
    variables = Variables.of(ParameterSet.named(NEAR, TEXTS), runs, first_nuisances(runs))
    start = np.zeros(variables.size)
    with RunPool(runs) as pool:
        rows = [one for one, _ in Problem(pool, variables).linearised(start)]
        known = Problem(pool, variables, rows)
        expected = Problem(pool, variables).jacobian(start)
        assert np.array_equal(known.jacobian(start), expected) and not known.exact
