"""The point mass: derivatives, what each kind of avoidance promises, jumping and its cure."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.sqp import check_derivatives, solve
from flyby.core.sqp.result import Result
from flyby.validation.textbook import (
    GARDEN,
    MAZE,
    WALL,
    Arcs,
    Avoidance,
    PointMass,
    Scene,
    prove_free,
)

PROVABLE = (Avoidance.CHORDS, Avoidance.BERNSTEIN)
TOUCH = 1e-4
OVER_THE_WALL = 7.2
seeds = st.integers(0, 2**32 - 1)
kinds = st.sampled_from(list(Avoidance))


@cache
def solved(
    scene: Scene, nodes: int, avoidance: Avoidance, guided: bool, limit: int = 500
) -> tuple[PointMass, Result]:
    problem = PointMass(scene, nodes, avoidance)
    guess = problem.through(scene.way) if guided else problem.straight_line()
    # The interior point of our own, since a hundred nodes would take Clarabel a minute.
    qp = "interior_point" if nodes > 50 else "clarabel"
    return problem, solve(problem.nlp(), guess, max_iterations=limit, qp=qp)


def free(problem: PointMass, result: Result) -> bool:
    return prove_free(problem.arcs(result.x), problem.scene, -TOUCH).free


# ------------------------------------------------------------------------------ callables


@given(kinds, st.integers(3, 6), seeds)
@settings(max_examples=25)
def test_derivatives(avoidance: Avoidance, nodes: int, seed: int) -> None:
    problem = PointMass(GARDEN, nodes, avoidance)
    w = problem.straight_line() + np.random.default_rng(seed).normal(size=problem.n)
    assert check_derivatives(problem.nlp(), w).passed


@given(seeds)
def test_rows_of_the_motion(seed: int) -> None:
    problem = PointMass(GARDEN, 5)
    w = problem.straight_line() + np.random.default_rng(seed).normal(size=problem.n)
    nodes, h = w[1:].reshape(5, 6), w[0] / 4
    expected = []
    for here, after in pairwise(nodes):
        expected.extend(after[:2] - here[:2] - h * (here[2:4] + after[2:4]) / 2)
    for here, after in pairwise(nodes):
        expected.extend(after[2:4] - here[2:4] - h * here[4:])
    expected.extend(here[4:] @ here[4:] for here in nodes[:-1])
    assert problem.constraints(w)[:20] == pytest.approx(expected)
    squares = [
        (node[0] - x) ** 2 + (node[1] - y) ** 2
        for x, y, _ in GARDEN.circles
        for node in nodes[1:-1]
    ]
    assert problem.constraints(w)[20:] == pytest.approx(squares)


@given(st.sampled_from(PROVABLE), seeds)
@settings(max_examples=60)
def test_rows_that_hold_keep_the_whole_motion_away(avoidance: Avoidance, seed: int) -> None:
    """Of a random motion, the radius that the rows just allow is kept all along it."""
    random = np.random.default_rng(seed)
    centre = random.uniform(-1.0, 1.0, 2)
    place, speed = random.normal(scale=2.0, size=(2, 2))
    forces = random.normal(size=(5, 2))
    forces /= np.maximum(1.0, np.linalg.norm(forces, axis=1))[:, None]
    h = random.uniform(0.1, 1.0)
    w = _moved(place, speed, forces, h)

    def allowed(radius: float) -> bool:
        scene = Scene((0.0, 0.0), (1.0, 1.0), ((*centre, radius),))
        problem = PointMass(scene, 6, avoidance)
        lower, upper = problem.nlp().bounds[2:]
        c = problem.constraints(w)
        return bool(((c >= lower - 1e-9) & (c <= upper + 1e-9)).all())

    radius, step = 0.0, 4.0
    while step > 1e-6:
        radius, step = (radius + step, step) if allowed(radius + step) else (radius, step / 2)
    points = PointMass(GARDEN, 6).arcs(w).points(400)
    inner = points[400:-400]  # the rows take it that the mass begins and ends at rest
    assert radius == 0.0 or np.linalg.norm(inner - centre, axis=1).min() >= radius - 1e-6


def _moved(place: np.ndarray, speed: np.ndarray, forces: np.ndarray, h: float) -> np.ndarray:
    """Variables of a motion that is exact."""
    w = [len(forces) * h]
    for force in (*forces, np.zeros(2)):
        w.extend([*place, *speed, *force])
        place, speed = place + h * speed + h * h * force / 2, speed + h * force
    return np.array(w)


# ---------------------------------------------------------------------------------- proof


@given(seeds, st.floats(-0.3, 0.5))
@settings(max_examples=60)
def test_the_proof_agrees_with_dense_sampling(seed: int, clearance: float) -> None:
    random = np.random.default_rng(seed)
    circle = (*random.uniform(-1.0, 1.0, 2), random.uniform(0.3, 1.0))
    scene = Scene((0.0, 0.0), (1.0, 1.0), (tuple(map(float, circle)),))
    problem = PointMass(scene, 4)
    forces = random.normal(scale=2.0, size=(3, 2))
    place, speed = random.normal(scale=2.0, size=(2, 2))
    arcs = problem.arcs(_moved(place, speed, forces, 0.7))
    gaps = np.linalg.norm(arcs.points(3000) - scene.centres[0], axis=1) - scene.radii[0]
    proof = prove_free(arcs, scene, clearance)
    if proof.free:
        assert gaps.min() >= clearance
        assert clearance <= proof.clearance <= gaps.min() + 1e-12
    else:
        assert gaps.min() < clearance + 1e-5
        assert np.hypot(*np.subtract(proof.place, circle[:2])) - circle[2] < clearance + 1e-9


@pytest.mark.parametrize("scene", [GARDEN, MAZE])
def test_the_ways_are_free(scene: Scene) -> None:
    corners = np.array(scene.way)
    assert scene.way[0] == scene.start and scene.way[-1] == scene.goal
    legs = np.stack([corners[:-1], (corners[:-1] + corners[1:]) / 2, corners[1:]], axis=1)
    assert prove_free(Arcs(legs, 1.0), scene).free


def test_the_wall_leaves_no_gap_in_the_square() -> None:
    """Of the line through its circles' centres each covers a piece; together they cover it all."""
    x = {circle[0] for circle in WALL.circles}
    assert len(x) == 1 and WALL.start[0] < min(x) < WALL.goal[0]
    covered = WALL.lower[1]
    for _, y, radius in WALL.circles:
        assert y - radius < covered
        covered = y + radius
    assert covered > WALL.upper[1]


# -------------------------------------------------------------------------------- jumping


@pytest.mark.parametrize("nodes", [20, 40, 100])
def test_samples_alone_jump_the_wall_from_the_straight_line(nodes: int) -> None:
    problem, result = solved(MAZE, nodes, Avoidance.SAMPLES, guided=False, limit=100)
    assert result.constraint_violation < 1e-5  # every sample is where it may be
    proof = prove_free(problem.arcs(result.x), MAZE, -TOUCH)
    assert proof.answer == "hit"
    assert MAZE.circles[proof.circle][0] == 5.0  # a circle of the wall
    assert problem.places(result.x)[:, 1].max() < OVER_THE_WALL


def test_samples_alone_jump_a_wall_without_any_way() -> None:
    problem, result = solved(WALL, 20, Avoidance.SAMPLES, guided=False)
    assert result.success
    assert not free(problem, result)


def test_a_guess_along_a_free_way_leads_over_the_wall() -> None:
    problem, result = solved(MAZE, 20, Avoidance.SAMPLES, guided=True)
    assert result.success
    assert problem.places(result.x)[:, 1].max() > OVER_THE_WALL


@pytest.mark.parametrize("avoidance", PROVABLE)
def test_a_provable_formulation_is_free_between_the_samples(avoidance: Avoidance) -> None:
    problem, result = solved(MAZE, 20, avoidance, guided=True)
    assert result.success
    assert free(problem, result)
    assert problem.places(result.x)[:, 1].max() > OVER_THE_WALL


@pytest.mark.parametrize("avoidance", PROVABLE)
@pytest.mark.parametrize("scene", [MAZE, WALL])
def test_a_provable_formulation_never_jumps(avoidance: Avoidance, scene: Scene) -> None:
    problem, result = solved(scene, 20, avoidance, guided=False, limit=25)
    assert not result.success or free(problem, result)
    assert scene is MAZE or not result.success


def test_bernstein_gives_away_less_than_chords() -> None:
    times = [solved(MAZE, 20, avoidance, guided=True)[1].objective for avoidance in PROVABLE]
    assert times[1] < times[0]
