"""Residuals of runs, their derivatives, and the emulation behind them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.commanded_motion import stamped_motion
from flyby.core.motion.emulator.controller import Controller
from flyby.identification.fit.emulation import STEP, Nuisance, RunEmulator, commanded
from flyby.identification.fit.loss import curvature, influence, loss, square_root
from flyby.identification.fit.parameters import ParameterSet
from flyby.identification.fit.problem import Problem, Variables, first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.fit.runs import CLOCK, LAG, prepare
from flyby.identification.fit.selection import candidates, compare_models, grouped
from flyby.identification.fit.zone_sizes import alike, guess, resized
from flyby.identification.logs import clean
from flyby.identification.logs.synthetic import SOUND, Faults

from .known_truth import ROBOT, START, TRUE_VALUES, TRUTH, VENDOR, logged, program, ready


@pytest.fixture(scope="module")
def run():
    return ready(logged(faults=SOUND))


def test_the_truth_leaves_nothing(run) -> None:
    emulator = RunEmulator(ready(run.run, TRUTH))
    window = sum(TRUTH.smoothing)
    rest = emulator.residuals(TRUTH, Nuisance(0.5 * window))
    assert np.abs(rest).max() < 0.05


def test_a_log_that_is_late_is_not_beside_the_path(run) -> None:
    """Late by ε, rows are within ε / CLOCK; as far beside the joints' path they count 1 / LAG."""
    one = ready(run.run, TRUTH)
    emulator, middle, late = RunEmulator(one), 0.5 * sum(TRUTH.smoothing), 1e-3
    rows = emulator.residuals(TRUTH, Nuisance(middle + late))
    moving = np.linalg.norm(rows, axis=1) > 0.1
    assert moving.sum() > 20
    assert np.linalg.norm(rows, axis=1).max() < 1.1 * late / CLOCK
    e = np.linalg.solve(one.weight[:, : ROBOT.size], rows[:, : ROBOT.size, None])[moving, :, 0]
    beside = np.roll(e, 1, axis=1)
    beside -= e * (np.sum(e * beside, axis=1) / np.sum(e * e, axis=1))[:, None]
    beside *= (np.linalg.norm(e, axis=1) / np.linalg.norm(beside, axis=1))[:, None]
    counted = np.einsum("kmn,kn->km", one.weight[moving, : ROBOT.size], beside)
    share = np.linalg.norm(counted, axis=1) / np.linalg.norm(rows[moving], axis=1)
    assert np.median(share) > 0.6 * CLOCK / LAG


def test_the_fit_commands_what_the_controller_does() -> None:
    """The fit asks for single moments; the controller samples all of them."""
    controller = Controller(VENDOR, ROBOT, TRUTH)
    told = program(0.03, 0.5)
    path = controller.plan(told)
    timing = controller.stamp(told, path)
    trajectory = controller.sample(told, timing, 0.004)
    q = commanded(
        controller, controller.smoothing(told, path), stamped_motion(timing), trajectory.t
    )
    np.testing.assert_allclose(q, trajectory.q_motor, atol=2e-7)


@pytest.mark.parametrize("place", [False, True])
def test_derivatives(run, place: bool) -> None:
    one = replace(run, by_place=place, run=replace(run.run, zones_known=False))
    # What time does to the path at stops is no smooth function of places.
    texts = ["blend.tcp.beta[0]"] if place else [*TRUE_VALUES, "time.settling_s"]
    parameters = ParameterSet.named(START, texts)
    problem = Problem(RunPool([one]), Variables.of(parameters, [one], [Nuisance(0.03, 1.0, 1.1)]))
    n = problem.variables.size
    rng = np.random.default_rng(0)
    J = problem.jacobian(np.zeros(n))
    for _ in range(3):
        d = rng.normal(size=n)
        h = 2e-4
        numeric = (problem.residuals(h * d) - problem.residuals(-h * d)) / (2 * h)
        # A sample that is matched to another piece of the path has a kink there.
        far = np.sort(np.abs(numeric - J @ d))
        assert far[: -len(far) // 100].max() < 0.02 * np.abs(J).max()


def test_what_a_parameter_does_not_touch_is_the_same_afresh(run) -> None:
    """Stages that are kept give what all stages made anew give."""
    emulator = RunEmulator(run)
    parameters = ParameterSet.named(START, list(TRUE_VALUES))
    rows = emulator.rows(parameters.stepped(parameters.start, STEP), Nuisance(0.03))
    for k, one in enumerate(parameters.parameters):
        step = 1e-3 * one.scale
        point = parameters.start.copy()
        point[k] += step
        fresh = RunEmulator(run).residuals(parameters.model(point), Nuisance(0.03))
        np.testing.assert_allclose(rows.values + step * rows.by_parameter[..., k], fresh, atol=1e-9)


def test_a_smoother_command_is_no_later(run) -> None:
    """Offsets are counted from the middle of the window: smoothing moves no run in time."""
    emulator = RunEmulator(run)
    named = ParameterSet.named(START, ["time.smoothing_s[*]"])
    rows = emulator.rows(named.stepped(np.array([0.03]), STEP), Nuisance(0.03))
    by_width, by_offset = rows.by_parameter[..., 0].ravel(), rows.by_offset.ravel()
    both = by_width @ by_offset / np.linalg.norm(by_width) / np.linalg.norm(by_offset)
    assert abs(both) < 0.3


@given(r=st.floats(-1e6, 1e6))
def test_the_loss_is_half_the_square_of_its_root(r: float) -> None:
    value = np.array([r])
    phi, slope = square_root(value)
    np.testing.assert_allclose(0.5 * phi**2, loss(value), rtol=1e-12, atol=1e-300)
    np.testing.assert_allclose(phi * slope, influence(value), rtol=1e-12, atol=1e-300)
    assert 0 < curvature(value)[0] <= 1
    assert abs(influence(value)[0]) <= 2.0


def test_another_robots_run_is_refused(run) -> None:
    with pytest.raises(InputError, match="wrong robot"):
        prepare(replace(run.run, robot="abb/irb1200-5-090"), VENDOR, ROBOT, START)


def test_degrees_are_refused(run) -> None:
    with pytest.raises(InputError, match="degrees"):
        prepare(replace(run.run, q=np.degrees(run.run.q)), VENDOR, ROBOT, START)


def test_a_log_that_ends_early_is_refused(run) -> None:
    half = len(run.run.t) // 2
    with pytest.raises(InputError, match="shorter than the program"):
        prepare(replace(run.run, t=run.run.t[:half], q=run.run.q[:half]), VENDOR, ROBOT, START)


def test_samples_off_the_path_take_no_part() -> None:
    run = ready(logged(faults=Faults(torn=6)))
    assert len(run.log.torn) >= 4
    assert not set(run.log.t[run.log.torn]) & set(run.t)


def test_zones_that_nobody_recorded_are_found() -> None:
    made = logged(0.04, 0.3, faults=SOUND)
    rule = replace(made, program=resized(made.program, 0.1), zones_known=False, timed=False)
    found = ready(rule, TRUTH)
    assert found.by_place and found.size == pytest.approx(10.0, rel=0.2)
    controller = Controller(VENDOR, ROBOT, TRUTH)
    _, size, _ = guess(controller, "x", rule.program, clean(made))
    assert size == found.size


def test_zones_alike() -> None:
    told = program(0.04, 0.3)
    assert alike(told) == told
    twice = resized(resized(told, 2.0), 0.5)
    assert twice.moves[0].zone.tcp == pytest.approx(0.04)


def test_runs_are_grouped_by_what_they_share() -> None:
    runs = [ready(logged(r, v, faults=SOUND)) for r, v in ((0.03, 0.5), (0.05, 0.5), (0.03, 0.2))]
    assert grouped(runs, "zone") == [(0, 2), (1,)]
    assert grouped(runs, "speed") == [(0, 1), (2,)]
    assert grouped(runs, "run") == [(0,), (1,), (2,)]
    with pytest.raises(InputError, match="same moves"):
        grouped(runs, "moves")
    with pytest.raises(InputError, match="not by 'colour'"):
        grouped(runs, "colour")


def test_a_figure_that_explains_the_logs_earns_its_place() -> None:
    runs = [
        ready(logged(radius, 0.3, seed), TRUTH) for seed, radius in enumerate((0.03, 0.05, 0.08))
    ]
    base = replace(TRUTH, tcp=START.tcp)
    named = ParameterSet.named(base, ["blend.tcp.beta[0] = -0.4", "elasticity.own_s2[0]"])
    both, without_beta, without_own = compare_models(
        runs, first_nuisances(runs), candidates(named), grouped(runs, "zone")
    )
    assert both.count == 2 and without_beta.count == without_own.count == 1
    # Corners that bulge are seen by runs of other zones; the lead was right before.
    assert without_beta.mean > 5 * both.mean and without_beta.gain < -2 * without_beta.error
    assert without_own.mean == pytest.approx(both.mean, rel=0.2)


MODELS = (
    TRUTH,
    replace(TRUTH, elasticity=START.elasticity),
    replace(TRUTH, joint_acceleration_scale=(0.8,) * ROBOT.arm_size),
    replace(TRUTH, smoothing=(0.03, 0.05)),
    replace(TRUTH, tcp=START.tcp),
)
OWN = (Nuisance(0.04), Nuisance(0.05, 1.01), Nuisance(0.04, 1.0, 0.8), Nuisance(0.04, override=0.9))


@settings(max_examples=15)
@given(st.lists(st.tuples(st.sampled_from(MODELS), st.sampled_from(OWN)), min_size=2, max_size=5))
def test_what_was_asked_for_before_changes_nothing(run, asked) -> None:
    """What is kept of one emulation enters the next only where both agree."""
    used = RunEmulator(run)
    for model, own in asked:
        found = used.residuals(model, own)
    np.testing.assert_array_equal(found, RunEmulator(run).residuals(model, own))
