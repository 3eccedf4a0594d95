"""Curves and orientations against finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.geometry.curves import (
    ARC,
    LINE,
    POLYNOMIAL,
    Curves,
    evaluate,
    parameter_jet,
    pull,
)
from flyby.core.motion.geometry.orientation_curves import orientation, pull_orientation
from flyby.core.motion.model.blend import BASIS, Blend
from flyby.core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

SETTINGS = settings(max_examples=25, deadline=None)
BLENDS = [Blend(), Blend(alpha=(0, 0, 3, -2), beta=(0.3, -0.2))]
SLOPES = st.floats(0.2, 4.0)
SEEDS = st.integers(0, 10_000)


def one_curve(kind, blend, slopes, seed) -> Curves:
    rng = np.random.default_rng(seed)
    curves = Curves.empty(1, 3, blend.coefficients)
    curves.kind[0] = kind
    curves.window[0] = [0.3, 1.7, *slopes]
    curves.control[0] = rng.normal(size=(BASIS, 3))
    curves.angle[0] = 1.3
    return curves


def value(curves, sigma) -> np.ndarray:
    out = np.empty((3, 3))
    evaluate(curves, 0, sigma, np.empty((BASIS, 4)), out)
    return out


@SETTINGS
@given(d0=SLOPES, d1=SLOPES, share=st.floats(0.0, 1.0))
def test_the_map_to_s_is_monotone_and_meets_both_slopes(d0, d1, share) -> None:
    window = np.array([0.4, 2.5, d0, d1])
    assert parameter_jet(window, 0.4)[:2] == pytest.approx((0.0, 1 / (2.5 * d0)))
    assert parameter_jet(window, 2.9)[:2] == pytest.approx((1.0, 1 / (2.5 * d1)))
    sigma = 0.4 + 2.5 * share
    jet = parameter_jet(window, sigma)
    assert jet[1] > 0
    h = 1e-5
    above, below = parameter_jet(window, sigma + h), parameter_jet(window, sigma - h)
    for order in range(3):
        slope = (above[order] - below[order]) / (2 * h)
        assert slope == pytest.approx(jet[order + 1], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("blend", BLENDS)
@pytest.mark.parametrize("kind", [LINE, POLYNOMIAL, ARC])
@SETTINGS
@given(d0=SLOPES, d1=SLOPES, share=st.floats(0.02, 0.98), seed=SEEDS)
def test_derivatives_are_those_of_the_value(kind, blend, d0, d1, share, seed) -> None:
    curves, sigma, h = one_curve(kind, blend, (d0, d1), seed), 0.3 + 1.7 * share, 1e-5
    numeric = (value(curves, sigma + h) - value(curves, sigma - h)) / (2 * h)
    np.testing.assert_allclose(numeric[:2], value(curves, sigma)[1:], rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("blend", BLENDS)
@pytest.mark.parametrize("kind", [LINE, POLYNOMIAL, ARC])
@settings(max_examples=8, deadline=None)
@given(d0=SLOPES, d1=SLOPES, share=st.floats(0.02, 0.98), seed=SEEDS)
def test_the_reverse_is_the_gradient(kind, blend, d0, d1, share, seed) -> None:
    curves, sigma, h = one_curve(kind, blend, (d0, d1), seed), 0.3 + 1.7 * share, 1e-6
    weights = np.random.default_rng(seed + 1).normal(size=(3, 3))
    gradient = curves.zeros_like()
    by_sigma = pull(curves, 0, sigma, np.empty((BASIS, 4)), weights, gradient)
    slope = np.sum(weights * (value(curves, sigma + h) - value(curves, sigma - h))) / (2 * h)
    assert by_sigma == pytest.approx(slope, rel=1e-5, abs=1e-5)
    for name in ("window", "control", "angle", "coefficients"):
        array, exact = getattr(curves, name), getattr(gradient, name)
        numeric = np.zeros_like(array)
        for i in np.ndindex(array.shape):
            old = array[i]
            array[i] = old + h
            above = np.sum(weights * value(curves, sigma))
            array[i] = old - h
            below = np.sum(weights * value(curves, sigma))
            array[i] = old
            numeric[i] = (above - below) / (2 * h)
        np.testing.assert_allclose(exact, numeric, rtol=2e-5, atol=2e-5, err_msg=name)


def turning_case(seed, size):
    rng = np.random.default_rng(seed)
    reference = matrix_from_rotation_vector(rng.normal(size=3))
    return rng, reference, size * rng.normal(size=(3, 6))


def turned(reference, vectors):
    R = np.empty((3, 3))
    omega, alpha = orientation(reference, vectors, np.zeros((3, 3, 3)), R)
    return R, np.array(omega), np.array(alpha)


@SETTINGS
@given(seed=SEEDS, size=st.sampled_from([1e-7, 1e-3, 0.3, 0.9]))
def test_angular_velocity_and_acceleration_are_those_of_the_orientation(seed, size) -> None:
    _, reference, vectors = turning_case(seed, size)
    h = 1e-5

    def at(t):
        first = vectors[1] + t * vectors[2]
        moved = np.array([vectors[0] + t * vectors[1] + t * t / 2 * vectors[2], first, vectors[2]])
        return turned(reference, moved)

    (R, omega, alpha), (R1, omega1, _), (R0, omega0, _) = at(0.0), at(h), at(-h)
    expected = reference @ matrix_from_rotation_vector(vectors[0, :3])
    expected = expected @ matrix_from_rotation_vector(vectors[0, 3:])
    np.testing.assert_allclose(R, expected, atol=1e-12)
    np.testing.assert_allclose(rotation_vector(R1 @ R0.T) / (2 * h), omega, rtol=1e-5, atol=1e-8)
    np.testing.assert_allclose((omega1 - omega0) / (2 * h), alpha, rtol=1e-5, atol=1e-7)


@SETTINGS
@given(seed=SEEDS, size=st.sampled_from([1e-3, 0.3, 0.9]))
def test_the_reverse_of_an_orientation_is_the_gradient(seed, size) -> None:
    rng, reference, vectors = turning_case(seed, size)
    turn, omega_bar, alpha_bar = rng.normal(size=(3, 3))
    middle, h = turned(reference, vectors)[0], 1e-5

    def total(frame, moved):
        R, omega, alpha = turned(frame, moved)
        return rotation_vector(R @ middle.T) @ turn + omega @ omega_bar + alpha @ alpha_bar

    exact = np.zeros((3, 6))
    by_frame = pull_orientation(
        reference,
        vectors,
        tuple(turn),
        tuple(omega_bar),
        tuple(alpha_bar),
        np.zeros((3, 3, 3)),
        exact,
    )
    numeric = np.zeros((3, 6))
    for i in np.ndindex(3, 6):
        step = np.zeros((3, 6))
        step[i] = h
        change = total(reference, vectors + step) - total(reference, vectors - step)
        numeric[i] = change / (2 * h)
    np.testing.assert_allclose(exact, numeric, rtol=1e-5, atol=1e-6)
    for axis, slope in enumerate(by_frame):
        step = h * np.eye(3)[axis]
        above, below = (matrix_from_rotation_vector(s * step) @ reference for s in (1, -1))
        change = total(above, vectors) - total(below, vectors)
        assert slope == pytest.approx(change / (2 * h), rel=1e-5, abs=1e-6)
