"""Nominal segments: ends met, arcs through their points, and the reverse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.segments import (
    ARC_SEGMENT,
    JOINT_SEGMENT,
    LINE_SEGMENT,
    TURN_LENGTH,
    Ends,
    EndsGradient,
    SegmentsGradient,
    left_jacobian,
    left_jacobian_inverse,
    make_segments,
    pull_segments,
)
from flyby.core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

KIND = np.array([JOINT_SEGMENT, LINE_SEGMENT, ARC_SEGMENT, ARC_SEGMENT, LINE_SEGMENT, ARC_SEGMENT])
FOLLOWS = np.array([False, False, True, False, False, True])
SWIVELS = np.array([False, False, False, False, True, False])
TCP, ARC = KIND != JOINT_SEGMENT, KIND == ARC_SEGMENT
SEEDS = st.integers(0, 10_000)


def ends(seed) -> Ends:
    rng, count = np.random.default_rng(seed), len(KIND)
    rotation = matrix_from_rotation_vector(0.8 * rng.normal(size=(count, 2, 3)))
    via = rng.normal(size=(count, 3))
    position = rng.normal(size=(count, 2, 3))
    q, prescribed = rng.normal(size=(count, 2, 6)), rng.normal(size=(count, 2, 2))
    via_rotation = matrix_from_rotation_vector(rng.normal(size=(count, 3)))
    return Ends(
        KIND,
        q,
        position,
        rotation,
        prescribed,
        via,
        via_rotation,
        FOLLOWS,
        SWIVELS,
        *rng.uniform(0.1, 2.0, (7, count)),
        np.full(count, np.inf),
    )


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS)
def test_segments_meet_their_ends(seed) -> None:
    e = ends(seed)
    s = make_segments(e)
    np.testing.assert_allclose(e.q[~TCP, 0] + s.delta_q[~TCP], e.q[~TCP, 1])
    line = TCP & ~ARC
    np.testing.assert_allclose(s.position[line, :2].sum(1), e.position[line, 1])
    c, u, v = np.moveaxis(s.position[ARC], 1, 0)
    angle = s.angle[ARC][:, None]
    np.testing.assert_allclose(c + u, e.position[ARC, 0], atol=1e-8)
    end = c + u * np.cos(angle) + v * np.sin(angle)
    np.testing.assert_allclose(end, e.position[ARC, 1], atol=1e-7)
    turn = matrix_from_rotation_vector(s.turn_a) @ matrix_from_rotation_vector(s.turn_b)
    np.testing.assert_allclose((e.rotation[:, 0] @ turn)[TCP], e.rotation[TCP, 1], atol=1e-9)
    assert np.all(s.turn_a[~FOLLOWS & ~SWIVELS] == 0)
    own = np.where(ARC[:, None], 0.0, s.turn_a)
    np.testing.assert_allclose(s.turn**2, np.sum(own**2 + s.turn_b**2, axis=1))


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS)
def test_arcs_pass_the_auxiliary_point_on_their_way(seed) -> None:
    e = ends(seed)
    s = make_segments(e)
    for k in np.flatnonzero(ARC):
        c, u, v = s.position[k]
        to_via = e.via[k] - c
        radius = np.linalg.norm(u)
        assert np.linalg.norm(to_via) == pytest.approx(radius, rel=1e-7)
        at = np.mod(np.arctan2(to_via @ v, to_via @ u), 2 * np.pi)
        assert 0 < at < s.angle[k] < 2 * np.pi
        assert s.length[k] == pytest.approx(radius * s.angle[k])


def test_a_tool_that_follows_the_arc_turns_at_a_constant_rate_relative_to_the_tangent() -> None:
    """A quarter circle whose tool keeps pointing along the tangent turns with the arc alone."""
    quarter = matrix_from_rotation_vector(np.array([0.0, 0.0, np.pi / 2]))
    e = Ends(
        np.array([ARC_SEGMENT]),
        np.zeros((1, 2, 6)),
        np.array([[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]),
        np.stack([np.eye(3), quarter])[None],
        np.zeros((1, 2, 0)),
        np.array([[np.sqrt(0.5), np.sqrt(0.5), 0.0]]),
        np.eye(3)[None],
        np.array([True]),
        np.array([False]),
        *np.ones((7, 1)),
        np.full(1, np.inf),
    )
    s = make_segments(e)
    np.testing.assert_allclose(s.turn_a[0], [0, 0, np.pi / 2], atol=1e-12)
    np.testing.assert_allclose(s.turn_b[0], 0.0, atol=1e-12)
    assert s.scale[0] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_auxiliary_point_tells_which_way_the_tool_turns_round_a_half_circle(sense) -> None:
    """Equal orientations at both ends: the tool hardly turns, or turns once, as the middle says."""
    tilt = matrix_from_rotation_vector(np.array([0.0, 0.0, 1e-3 * sense]))
    turns = []
    for middle in (np.eye(3), matrix_from_rotation_vector(np.array([0.0, 0.0, np.pi]))):
        e = Ends(
            np.array([ARC_SEGMENT]),
            np.zeros((1, 2, 6)),
            np.array([[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]]),
            np.stack([np.eye(3), tilt])[None],
            np.zeros((1, 2, 0)),
            np.array([[0.0, 1.0, 0.0]]),
            middle[None],
            np.array([True]),
            np.array([False]),
            *np.ones((7, 1)),
            np.full(1, np.inf),
        )
        s = make_segments(e)
        turns.append(s.turn_a[0, 2] + s.turn_b[0, 2])
    assert turns[0] == pytest.approx(1e-3 * sense)
    assert turns[1] == pytest.approx(1e-3 * sense + 2 * np.pi)


def test_scales_count_length_turn_and_external_axes() -> None:
    e = ends(3)
    s = make_segments(e)
    assert s.scale[0] == pytest.approx(np.linalg.norm(e.q[0, 1] - e.q[0, 0]))
    turn = np.linalg.norm(rotation_vector(e.rotation[1, 0].T @ e.rotation[1, 1]))
    external = np.linalg.norm(e.prescribed[1, 1] - e.prescribed[1, 0])
    length = np.linalg.norm(e.position[1, 1] - e.position[1, 0])
    assert s.scale[1] == pytest.approx(np.sqrt(length**2 + (TURN_LENGTH * turn) ** 2 + external**2))


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS, size=st.sampled_from([0.0, 1e-6, 9e-5, 2e-4, 0.5, 3.0]))
def test_left_jacobians_are_inverse_and_exact(seed, size) -> None:
    rng = np.random.default_rng(seed)
    vector = rng.normal(size=3)
    vector *= size / np.linalg.norm(vector)
    J = left_jacobian(vector)
    np.testing.assert_allclose(J @ left_jacobian_inverse(vector), np.eye(3), atol=1e-9)
    step, h = rng.normal(size=3), 1e-6
    above, below = (matrix_from_rotation_vector(vector + s * h * step) for s in (1, -1))
    np.testing.assert_allclose(rotation_vector(above @ below.T) / (2 * h), J @ step, atol=1e-8)


@settings(max_examples=8, deadline=None)
@given(seed=SEEDS)
def test_the_reverse_is_the_gradient(seed) -> None:
    e = ends(seed)
    s = make_segments(e)
    # Circles through nearly collinear points are too large for finite differences.
    assume(s.length[ARC].max() <= 30 and np.linalg.norm(s.turn_b, axis=1).max() <= 2.8)
    rng = np.random.default_rng(seed + 1)
    names = list(SegmentsGradient.__dataclass_fields__)
    weights = {name: rng.normal(size=getattr(s, name).shape) for name in names}
    # What a kind of segment does not have carries no gradient.
    weights["position"][~TCP] = 0.0
    weights["position"][TCP & ~ARC, 2] = 0.0
    weights["delta_q"][TCP] = 0.0
    for name in ("turn_a", "turn_b", "turn", "delta_prescribed", "length"):
        weights[name][~TCP] = 0.0
    bar = SegmentsGradient(**{name: w.copy() for name, w in weights.items()})
    out = EndsGradient.zeros(e)
    pull_segments(s, bar, out)

    def total(case):
        made = make_segments(case)
        return sum(np.sum(getattr(made, name) * weights[name]) for name in names)

    h = 1e-6
    for name in ("q", "position", "prescribed", "via"):
        array, numeric = getattr(e, name), np.zeros_like(getattr(e, name))
        for i in np.ndindex(array.shape):
            old = array[i]
            array[i] = old + h
            above = total(e)
            array[i] = old - h
            numeric[i] = (above - total(e)) / (2 * h)
            array[i] = old
        check(name, getattr(out, name), numeric)
    numeric = np.zeros_like(out.turn)
    for i in np.ndindex(numeric.shape):
        step = np.zeros_like(out.turn)
        step[i] = h
        values = [
            total(replace(e, rotation=turn @ e.rotation))
            for turn in map(matrix_from_rotation_vector, (step, -step))
        ]
        numeric[i] = (values[0] - values[1]) / (2 * h)
    check("turn", out.turn, numeric)


def check(name, exact, numeric) -> None:
    scale = max(1.0, np.abs(numeric).max())
    np.testing.assert_allclose(exact / scale, numeric / scale, atol=2e-6, err_msg=name)
