"""The parts of the optimisation: variables, cost, limits; derivatives against differences."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.footprint import ring
from flyby.problems.paint.thickness.constraints import PaintConstraints
from flyby.problems.paint.thickness.objective import PaintObjective, Scenario
from flyby.problems.paint.thickness.options import OuterLoop, PaintLimits, PaintWeights
from flyby.problems.paint.thickness.reference import ReferencePlanes
from flyby.problems.paint.thickness.robust import PaintErrors, scenarios
from flyby.problems.paint.thickness.variables import ThicknessVariables

from .paint_cases import TARGET, bumpy, wandering

SEEDS = st.integers(0, 10_000)
FEW = settings(max_examples=10)


def variables_of(seed: int) -> ThicknessVariables:
    trajectory = wandering(5, seed)
    rng = np.random.default_rng(seed)
    normal = -trajectory.nozzle + rng.uniform(-0.2, 0.2, trajectory.nozzle.shape)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    foot = trajectory.position - 0.25 * normal + rng.uniform(-0.02, 0.02, normal.shape)
    return ThicknessVariables.of(trajectory, ReferencePlanes(foot, normal))


def somewhere(variables: ThicknessVariables, seed: int) -> np.ndarray:
    return np.random.default_rng(seed + 1).uniform(-0.5, 0.5, variables.size)


@FEW
@given(SEEDS)
def test_zero_is_the_start(seed):
    variables = variables_of(seed)
    found = variables.trajectory(np.zeros(variables.size))
    assert np.allclose(found.position, variables.start.position, atol=1e-15)
    assert np.allclose(found.nozzle, variables.start.nozzle, atol=1e-14)
    assert np.allclose(found.duration, variables.start.duration)
    z = somewhere(variables, seed)
    assert np.allclose(variables.at(*variables.parts(z)), z, atol=1e-12)


@FEW
@given(SEEDS)
def test_angles_are_the_tangent_of_the_tilt(seed):
    variables = variables_of(seed)
    z = somewhere(variables, seed)
    angles = variables.parts(z)[1]
    tilt = variables.reference.tilt(variables.trajectory(z))
    assert np.allclose(np.linalg.norm(angles, axis=1), np.tan(tilt))


@FEW
@given(SEEDS)
def test_turns_are_the_nozzles_slopes(seed):
    variables = variables_of(seed)
    z = somewhere(variables, seed)
    turns = variables.turns(z)
    for k in range(2):
        h = np.zeros(variables.size)
        h[3 + k : 5 * variables.waypoints : 5] = 1e-6
        ahead, behind = variables.trajectory(z + h).nozzle, variables.trajectory(z - h).nozzle
        slope = (ahead - behind) / (2 * h[3 + k] * variables.units[3 + k])
        assert np.allclose(turns[:, k], slope, atol=1e-7)


def objective_of(seed: int, weights: PaintWeights) -> tuple[ThicknessVariables, PaintObjective]:
    variables = variables_of(seed)
    deposition = Deposition(bumpy(15, seed), ring(0.2).scaled(5e-5), 3)
    cases = scenarios(deposition, PaintErrors(height=0.01, radius=0.03))
    return variables, PaintObjective(cases, TARGET, weights, variables)


EVERYTHING = PaintWeights(time=0.3, paint=2.0, position=5.0, bend=3.0, direction=7.0, speed=4.0)


@FEW
@given(SEEDS)
def test_gradient_against_differences(seed):
    variables, objective = objective_of(seed, EVERYTHING)
    z = somewhere(variables, seed)
    found = objective.gradient(z)
    for way in np.random.default_rng(seed).normal(size=(3, variables.size)):
        step = 1e-5
        expected = (objective.value(z + step * way) - objective.value(z - step * way)) / (2 * step)
        assert found @ way == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(found).sum())


@FEW
@given(SEEDS)
def test_curvature_is_gauss_and_newtons(seed):
    """With residuals r of all scenarios, JᵀJ by differences of r, and what the path adds."""
    weights = PaintWeights(position=5.0, bend=3.0, direction=7.0, speed=4.0)
    variables, objective = objective_of(seed, weights)
    z = somewhere(variables, seed)
    deposition = Deposition(bumpy(15, seed), ring(0.2).scaled(5e-5), 3)
    cases = scenarios(deposition, PaintErrors(height=0.01, radius=0.03))
    samples = deposition.samples
    share = np.sqrt(samples.areas / samples.area) * 100.0 / TARGET

    def residuals(at: np.ndarray) -> np.ndarray:
        trajectory = variables.trajectory(at)
        parts = [
            math.sqrt(case.weight) * share * case.deposition.thickness(trajectory) for case in cases
        ]
        parts.append(math.sqrt(10.0) * np.diff(trajectory.position, axis=0).ravel())
        parts.append(math.sqrt(6.0) * np.diff(trajectory.position, 2, axis=0).ravel())
        parts.append(math.sqrt(8.0) * np.diff(trajectory.speeds))
        parts.append(math.sqrt(14.0) * np.diff(trajectory.nozzle, axis=0).ravel())
        return np.concatenate(parts)

    found = objective.curvature(z)
    assert np.allclose(found, found.T)
    step = 1e-5
    for way in np.random.default_rng(seed).normal(size=(3, variables.size)):
        slope = (residuals(z + step * way) - residuals(z - step * way)) / (2 * step)
        assert way @ found @ way == pytest.approx(slope @ slope, rel=1e-5)


@FEW
@given(SEEDS, st.sampled_from((0.05, math.inf)))
def test_rows_jacobian_against_differences(seed, deviation):
    variables = variables_of(seed)
    rows = PaintConstraints(
        PaintLimits(deviation=deviation), variables, variables.start.position + 0.01
    )
    z = somewhere(variables, seed)
    found = rows.jacobian(z).toarray()
    assert found.shape == (rows.size, variables.size) == (len(rows.upper), variables.size)
    step = 1e-6
    for way in np.random.default_rng(seed).normal(size=(3, variables.size)):
        expected = (rows.values(z + step * way) - rows.values(z - step * way)) / (2 * step)
        assert np.allclose(found @ way, expected, rtol=1e-6, atol=1e-6)


@FEW
@given(SEEDS)
def test_repaired_points_keep_tilt_deviation_and_speed(seed):
    variables = variables_of(seed)
    limits = PaintLimits(deviation=0.02, tilt=math.radians(5.0), speed=(0.2, 0.4))
    rows = PaintConstraints(limits, variables, variables.start.position)
    point = rows.repaired(4.0 * somewhere(variables, seed))
    found = variables.trajectory(point)
    assert variables.reference.tilt(found).max() <= limits.tilt * (1 + 1e-9)
    away = np.linalg.norm(found.position - variables.start.position, axis=1)
    assert away.max() <= limits.deviation * (1 + 1e-9)
    assert found.speeds.max() <= 0.4 * (1 + 1e-9)
    assert found.speeds.min() >= 0.2 * (1 - 1e-9)
    assert np.allclose(rows.repaired(point), point, atol=1e-9)


@FEW
@given(SEEDS)
def test_a_kept_limit_is_no_violation(seed):
    variables = variables_of(seed)
    z = np.zeros(variables.size)
    start = variables.start
    distance = variables.reference.distance(start)
    speeds, lengths = start.speeds, start.lengths
    tilt = float(variables.reference.tilt(start).max())
    kept = PaintLimits(
        distance=(0.9 * distance.min(), 1.1 * distance.max()),
        tilt=1.1 * tilt,
        speed=(0.9 * speeds.min(), 1.1 * speeds.max()),
        step=(0.9 * lengths.min(), 1.1 * lengths.max()),
    )
    assert PaintConstraints(kept, variables, start.position).violation(z) == 0.0
    for broken in (
        {"distance": (1.01 * distance.min(), 2.0)},
        {"tilt": 0.9 * tilt},
        {"speed": (0.9 * speeds.min(), 0.99 * speeds.max())},
        {"speed": (1.01 * speeds.min(), 1.1 * speeds.max())},
        {"step": (1.01 * lengths.min(), 2.0)},
    ):
        limits = {name: getattr(kept, name) for name in ("distance", "tilt", "speed", "step")}
        rows = PaintConstraints(PaintLimits(**{**limits, **broken}), variables, start.position)
        assert rows.violation(z) > 0.0, broken


def test_scenarios_hold_the_mean_square_of_what_is_quadratic():
    """Weights and places are those of a rule that is exact for the second moments."""
    deposition = Deposition(bumpy(5, 1), ring(0.2), 1)
    found = scenarios(deposition, PaintErrors(height=0.01, radius=0.05))
    assert sum(case.weight for case in found) == pytest.approx(1.0)
    nominal = deposition.footprint
    height = sum(
        case.weight * (case.deposition.footprint.source_distance - nominal.source_distance) ** 2
        for case in found
    )
    radius = sum(
        case.weight * (case.deposition.footprint.radius / nominal.radius - 1.0) ** 2
        for case in found
    )
    assert math.sqrt(height) == pytest.approx(0.01)
    assert math.sqrt(radius) == pytest.approx(0.05)
    assert [type(case) for case in scenarios(deposition, PaintErrors())] == [Scenario]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PaintLimits(distance=(0.3, 0.2)), "distance"),
        (lambda: PaintLimits(speed=(0.0, 0.2)), "speed"),
        (lambda: PaintLimits(tilt=math.radians(85.0)), "tilt"),
        (lambda: PaintLimits(deviation=0.0), "deviation"),
        (lambda: PaintWeights(time=-1.0), "time"),
        (lambda: OuterLoop(rounds=0), "rounds"),
        (lambda: OuterLoop(duration=1.0), "box"),
        (lambda: PaintErrors(height=-1.0), "height"),
        (lambda: ReferencePlanes(np.zeros((2, 3)), np.ones((2, 3))), "unit length"),
        (lambda: ReferencePlanes(np.zeros((2, 3)), np.ones((3, 3))), r"\(W, 3\)"),
        (
            lambda: ThicknessVariables.of(
                wandering(3, 1), ReferencePlanes.below(wandering(4, 1), 0.2)
            ),
            "4 planes for 3 waypoints",
        ),
        (
            lambda: ThicknessVariables.of(
                wandering(3, 1),
                ReferencePlanes(np.zeros((3, 3)), np.tile((0.0, 0.0, -1.0), (3, 1))),
            ),
            "does not point at the surface",
        ),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()
