"""A fit hands out what was fitted, and does without figures only where the loss says so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from flyby.core.motion.model.motion_model import MotionModel
from flyby.identification.fit import (
    Fit,
    Interval,
    ParameterSet,
    Unseen,
    fit,
    fitting,
    judge,
    motion_file,
)
from flyby.identification.fit.minimum import minimise
from flyby.identification.fit.run_pool import RunPool

from .known_truth import START, TRUTH, logged, ready

KINDS = ((0.03, 0.5), (0.08, 0.2), (0.05, 0.8))
SETTLED = replace(START, settling=0.02)


def loss_of(fitted: Fit) -> float:
    """Of the model that is handed out, with what it says of the runs."""
    with RunPool(fitted.runs) as pool:
        rows = minimise(pool, ParameterSet(fitted.model, ()), fitted.nuisances)
    return rows.last


@pytest.fixture
def doubts(monkeypatch: pytest.MonkeyPatch) -> str:
    """Intervals that say nothing of the time at stops."""
    name = "time.settling_s"

    def loose(parameters: ParameterSet, known: Sequence[Interval]) -> list[Unseen]:
        return [Unseen(name, "doubted") for one in parameters.parameters if one.name == name]

    monkeypatch.setattr(fitting, "loose", loose)
    return name


def test_a_figure_whose_interval_says_nothing_stays_if_the_logs_ask_for_it(doubts: str) -> None:
    runs = [ready(logged(0.0, speed, k, model=SETTLED), START) for k, speed in enumerate((0.5, 1))]
    found = fit(ParameterSet.named(START, ["blend.tcp.beta[0]", doubts]), runs)
    assert doubts not in {one.name for one in found.unseen}
    assert [one.name for one in found.rough] == [doubts]
    assert found.model.settling == pytest.approx(0.02, abs=2e-3)
    assert found.after < 0.1 * found.before


def test_the_loss_is_that_of_the_model_handed_out(doubts: str) -> None:
    """What the logs do not ask for stays as it was, and the rest is fitted with it there."""
    truth = replace(START, tcp=replace(START.tcp, beta=(-0.5,)))
    runs = [ready(logged(0.05, 0.5, k, model=truth), START) for k in range(2)]
    texts = [f"{doubts} = 0.03", "blend.tcp.beta[0]"]
    found = fit(ParameterSet.named(START, texts), runs)
    assert [one.name for one in found.unseen] == [doubts]
    assert found.model.settling == START.settling
    assert loss_of(found) == pytest.approx(found.after, rel=1e-3)
    text = motion_file(found, "x")
    assert doubts.partition(".")[2] not in text
    assert f"beta = [{found.model.tcp.beta[0]:.6g}]" in text


def test_the_loss_before_is_that_of_the_model_before() -> None:
    """A start that is far off does not make a fit good."""
    runs = [ready(logged(0.05, 0.5, k), TRUTH) for k in range(2)]
    found = fit(ParameterSet.named(TRUTH, ["blend.tcp.beta[0] = 1.5"]), runs)
    assert found.before == pytest.approx(found.after, rel=0.05)


def test_lists_that_are_empty_stay_so_where_the_logs_show_nothing() -> None:
    plain = replace(MotionModel(), settling=0.05)
    truth = replace(plain, joint_acceleration_scale=(1.0, 1.6))
    runs = [ready(logged(0.03, 0.8, k, model=truth), plain) for k in range(2)]
    texts = ["blend.joint.beta[0] = 0.2", "time.smoothing_s[0] = 0.02"]
    texts += [f"limit.joint_acceleration_scale[{k}] = 1" for k in range(6)]
    found = fit(ParameterSet.named(plain, texts), runs)
    assert found.model.joint.beta == ()
    assert "blend.joint.beta[0]" in {one.name for one in found.unseen}
    assert all(v > 0 for v in found.model.joint_acceleration_scale)
    assert found.after <= found.before * 1.001
    assert loss_of(found) == pytest.approx(found.after, rel=1e-3)


def test_runs_held_back_judge_a_fit() -> None:
    texts = ["blend.tcp.beta[0]", "time.smoothing_s[*]"]
    base = replace(TRUTH, tcp=START.tcp)
    runs = [ready(logged(*one, k), base) for k, one in enumerate(KINDS)]
    learnt = fit(ParameterSet.named(base, texts), runs)
    judged = judge(learnt)
    assert judged is not None and judged.better and not judged.worse and not judged.by_corners
    assert np.mean(judged.after) < 0.1 * np.mean(judged.before)


def test_a_fit_that_predicts_worse_than_before_is_found_out() -> None:
    """One run of another controller leads the fit away from what the others do."""
    odd = replace(TRUTH, tcp=replace(TRUTH.tcp, beta=(1.5,)))
    runs = [
        ready(logged(*one, k, model=odd if k == 1 else TRUTH), TRUTH) for k, one in enumerate(KINDS)
    ]
    found = fit(ParameterSet.named(TRUTH, ["blend.tcp.beta[0]"]), runs)
    assert found.after < found.before
    judged = judge(found)
    assert judged is not None and not judged.better
    assert runs[0].name in judged.worse and runs[2].name in judged.worse
    assert f"the zone and speed of {runs[0].name}" in " ".join(judged.helpful)


def test_corners_judge_where_there_is_one_run() -> None:
    run = ready(logged(0.05, 0.5, 0), START)
    found = fit(ParameterSet.named(START, ["time.smoothing_s[*]"]), [run])
    judged = judge(found)
    assert judged is not None and judged.by_corners and judged.better
    assert judged.helpful == ("runs of other speeds, zones, kinds of moves and places",)
    lonely = replace(run, cluster=np.zeros_like(run.cluster))
    assert judge(replace(found, runs=(lonely,))) is None


def test_a_limit_that_is_reached_nowhere_stays_near_what_it_was() -> None:
    """That joint 1 is not what limits the run shows no more than that it is not slower."""
    truth = replace(START, joint_acceleration_scale=(8.0, *START.joint_acceleration_scale[1:]))
    runs = [ready(logged(0.03, 0.8, k, model=truth), START) for k in range(2)]
    found = fit(ParameterSet.named(START, ["limit.joint_acceleration_scale[0]"]), runs)
    assert 1.0 < found.model.joint_acceleration_scale[0] < 6.0
    assert found.after < 0.02 * found.before
