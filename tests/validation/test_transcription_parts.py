"""Curves, distances and derivatives of the transcription."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.motion.model.blend import PARABOLA
from flyby.core.sqp import check_derivatives
from flyby.validation.scenes.scene import SECOND_ORDER
from flyby.validation.transcription import Grid, Overlap, Transcription, initial_guess
from flyby.validation.transcription.capsule_box import nearest
from flyby.validation.transcription.curves import BlendCurve, Line

from .transcription_tasks import make_task

blends = st.sampled_from([SECOND_ORDER, PARABOLA])
shares = st.floats(0.05, 0.49)
seeds = st.integers(0, 2**32 - 1)


def theta(s: float, entry: float, before: float, exit_: float, after: float) -> FloatArray:
    return np.array([[s, entry, before, exit_, after]])


@given(blends, st.floats(0.0, 1.0), shares, shares, st.floats(0.2, 2.0), st.floats(0.2, 2.0))
def test_a_blend_has_the_papers_polynomials(
    law: object, s: float, a: float, b: float, before: float, after: float
) -> None:
    """Pieces V, III and I of p_i, written out as they are printed."""
    alpha = law.alpha  # type: ignore[attr-defined]
    p = sum(c * s**k for k, c in enumerate(alpha))
    r_before, r_after = a * before, b * after
    printed = [
        r_before * (1 - p) * (1 - s) / before,
        1 - r_before * (1 - p) * (1 - s) / before - r_after * p * s / after,
        r_after * p * s / after,
    ]
    found = BlendCurve(alpha).weights(theta(s, r_before, before, r_after, after), 0).value[0]
    assert found == pytest.approx(printed, abs=1e-12)


@given(blends, shares, shares, shares, st.floats(0.2, 2.0), st.floats(0.2, 2.0), seeds)
def test_lines_run_into_blends_in_the_same_place_and_direction(
    law: object, a: float, b: float, c: float, before: float, after: float, seed: int
) -> None:
    blend = BlendCurve(law.alpha)  # type: ignore[attr-defined]
    points = np.random.default_rng(seed).normal(size=(3, 2))
    entry, exit_ = a * before, b * after
    at_line = theta(1.0, c * before, before, entry, before)
    at_blend = theta(0.0, entry, before, exit_, after)
    place = Line().weights(at_line, 0).value @ points[:2]
    assert place == pytest.approx(blend.weights(at_blend, 0).value @ points, abs=1e-9)
    by_s = Line().weights(at_line, 1).value @ points[:2]  # per s, which runs (ℓ − r_A − r_B)
    met = blend.weights(at_blend, 1).value @ points  # per s, which runs k r_A
    length = before * (1.0 - c - a)
    assert by_s / length == pytest.approx(met / (blend.entry_slope * entry), abs=1e-8)


@given(seeds, st.integers(0, 2))
def test_weights_add_up_and_follow_each_other(seed: int, order: int) -> None:
    random = np.random.default_rng(seed)
    at = np.column_stack([random.uniform(0, 1, 3), random.uniform(0.1, 0.4, (3, 4))])
    at[:, 2::2] += 0.5
    for curve in (Line(), BlendCurve(SECOND_ORDER.alpha)):
        here = curve.weights(at, order)
        assert here.value.sum(axis=1) == pytest.approx(1.0 if order == 0 else 0.0, abs=1e-9)
        if order < 2:
            assert here.slope[:, :, 0] == pytest.approx(curve.weights(at, order + 1).value)


boxes = st.tuples(*[st.floats(0.05, 1.0)] * 3).map(np.array)
places = st.tuples(*[st.floats(-2.0, 2.0)] * 3).map(np.array)


@given(places, places, boxes)
def test_nearest_is_what_many_points_say(a: FloatArray, b: FloatArray, half: FloatArray) -> None:
    found = nearest(a[None], b[None], half)
    points = a + np.linspace(0.0, 1.0, 2001)[:, None] * (b - a)
    least = np.linalg.norm(points - np.clip(points, -half, half), axis=1).min()
    step = np.linalg.norm(b - a) / 2000
    if found.distance[0] > 0.0:
        assert least - step <= found.distance[0] <= least + 1e-12
    else:
        assert least <= step + 1e-6
        inside = (np.abs(points) <= half).all(axis=1)
        depth = (half - np.abs(points[inside])).min(axis=1).max(initial=0.0)
        assert -found.distance[0] >= depth - 1e-9  # the way out is at least as far as that


@given(st.integers(1, 3), blends, st.sampled_from(list(Overlap)), st.integers(2, 3), seeds)
@settings(max_examples=8)
def test_derivatives(vias: int, law: object, overlap: Overlap, intervals: int, seed: int) -> None:
    problem = Transcription(
        make_task(vias, law, overlap),  # type: ignore[arg-type]
        Grid(intervals, intervals + 1),
        margin=0.003,
    )
    x = initial_guess(problem)
    x *= 1.0 + 0.02 * np.random.default_rng(seed).normal(size=problem.n)
    free = problem.task.clearances.values(x[problem.layout.points])
    assume(free.min() > -0.04)  # no axis inside the box
    found = check_derivatives(problem.nlp(), x, 2e-5)
    assert found.passed, str(found)


@given(st.integers(1, 3), blends, st.floats(0.1, 0.95))
@settings(max_examples=15)
def test_the_guess_holds_every_row(vias: int, law: object, share: float) -> None:
    problem = Transcription(make_task(vias, law), Grid(3, 6))  # type: ignore[arg-type]
    x = initial_guess(problem, share)
    nlp = problem.nlp()
    x_lower, x_upper, c_lower, c_upper = nlp.bounds
    assert np.all((x >= x_lower - 1e-9) & (x <= x_upper + 1e-9))
    c = problem.constraints(x)
    timed = np.flatnonzero((c < c_lower - 1e-9) | (c > c_upper + 1e-9))
    # Blends pass corners on the inside, where the first via point is not clear of the box.
    assert set(timed) <= set(range(problem.clearance_rows.start, problem.m))
    assert max(problem.worst_shares(x)) > 0.9  # and no slower than it must be


def test_matrices_share_their_pattern() -> None:
    problem = Transcription(make_task(1), Grid(2, 3))
    x = initial_guess(problem)
    one, other = problem.jacobian(x), problem.jacobian(1.01 * x)
    assert np.array_equal(one.indices, other.indices)
    assert not np.array_equal(one.data, other.data)
