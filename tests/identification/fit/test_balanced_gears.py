"""A fit of gears that hold a weight does not stay where their slack is used up in all places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.motion.command.elasticity import held_at_rest
from flyby.core.motion.model.elasticity import Carried, Elasticity
from flyby.identification.fit import ParameterSet
from flyby.identification.fit.balanced_gears import balanced, begun_again
from flyby.identification.fit.minimum import minimise
from flyby.identification.fit.problem import first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.logs.synthetic import Faults

from .known_truth import HOME, ROBOT, TRUTH, logged, ready

SLACK = 1e-4
HEAVY = Elasticity(
    (5e-5,),
    (Carried(3, (2e-5, 1.5e-4)), Carried(5, (9e-5, 3e-5))),
    slack=(0.0, SLACK),
    weight=(0.0, 8.0),
)
# Half of the slack is used up at home.
LEFT = 0.5 * SLACK - float(held_at_rest(HEAVY, ROBOT, HOME[None])[0, 1])
HOLDING = replace(TRUTH, elasticity=replace(HEAVY, spring=(0.0, LEFT / float(np.sin(HOME[1])))))
KEYS = (
    "elasticity.carried[0].lead_s2_per_m2[1]",
    "elasticity.carried[1].lead_s2_per_m2[0]",
    "elasticity.slack_rad[1]",
    "elasticity.weight[1] in -10 .. 10",
    "elasticity.spring_rad[1] in -0.05 .. 0.05",
)
OFF = 1.25
SOUND = Faults(noise=2e-6, jitter=0.0)


@pytest.fixture(scope="module")
def runs():
    wanted = ((0.0, 0.05), (0.03, 0.5), (0.01, 0.2))
    return [
        ready(logged(radius, speed, seed, SOUND, HOLDING, 0.3), HOLDING)
        for seed, (radius, speed) in enumerate(wanted)
    ]


@pytest.fixture(scope="module")
def rough():
    known = ParameterSet.named(HOLDING, KEYS)
    start = OFF * known.start
    return replace(known.starting_at(start), base=known.model(start))


def test_springs_balance_the_weight(runs, rough) -> None:
    values = balanced(rough, rough.start, runs)
    q = np.concatenate([run.q for run in runs])
    before, after = (
        held_at_rest(rough.model(one).elasticity, ROBOT, q)[:, 1] for one in (rough.start, values)
    )
    assert np.abs(before).min() > 3 * OFF * SLACK
    assert np.abs(after).min() < OFF * SLACK
    np.testing.assert_array_equal(values[:4], rough.start[:4])


def test_nothing_is_balanced_without_a_spring(runs, rough) -> None:
    assert balanced(rough.without(["elasticity.spring_rad[1]"]), rough.start[:4], runs) is None


def test_slack_that_is_left_is_let_be(runs, rough) -> None:
    assert balanced(rough, rough.start / OFF, runs) is None


def test_slack_that_is_used_up_everywhere_is_found(runs, rough) -> None:
    """A fit stays with the spring at its bound and no slack, as one to real logs did."""
    astray = rough.start.copy()
    astray[2:] = 0.0, 8.0, -0.05
    lost = replace(rough.starting_at(astray), base=rough.model(astray))
    with RunPool(runs) as pool:
        alone = minimise(pool, lost, first_nuisances(runs))
        truth = minimise(pool, ParameterSet(HOLDING, ()), first_nuisances(runs))
        again = begun_again(pool, lost, alone)
    assert alone.last > 2.0 * truth.last
    assert again.last < 1.02 * truth.last
    assert again.iterations > alone.iterations
