"""Torn samples, holes, jitter and held samples, found where they were put."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.identification.logs.cleaning import clean_samples

from .faulty_logs import PERIOD, emulated, faulty, joints, program


@pytest.fixture(scope="module")
def run():
    return emulated(program())


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), torn=st.integers(0, 8))
def test_torn_samples_and_the_hole_are_found(run, seed, torn) -> None:
    log = faulty(run, seed, torn=torn)
    found = clean_samples(log.t, log.q)
    # One that is torn where the path turns may be as near to it as its neighbours are.
    assert len(set(log.torn) - set(found.torn)) <= 1
    assert len(set(found.torn) - set(log.torn)) <= 1
    assert not found.valid[found.torn].any()
    assert [(hole.begin, hole.end) for hole in found.holes] == [log.hole]
    assert found.period == pytest.approx(PERIOD, rel=0.1)
    assert len(found.notes) == bool(len(found.torn)) + 1


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    jitter=st.sampled_from([0.0, 5e-4, 1.5e-3]),
    noise=st.sampled_from([0.0, 1e-6, 3e-5]),
)
def test_jitter_and_noise_are_no_tears(run, seed, jitter, noise) -> None:
    """At most one sample in a hundred of a log without tears is doubted."""
    log = faulty(run, seed, noise=noise, jitter=jitter, torn=0)
    found = clean_samples(log.t, log.q)
    assert len(found.torn) <= 0.01 * len(log.t)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), jitter=st.floats(3e-4, 1.5e-3))
def test_jitter_and_noise_are_measured(run, seed, jitter) -> None:
    log = faulty(run, seed, noise=2e-5, jitter=jitter, torn=0)
    found = clean_samples(log.t, log.q)
    # The time between two samples has the jitter of both.
    assert found.jitter == pytest.approx(np.sqrt(2) * jitter, rel=0.25)
    # Of noise along the motion nothing is seen; the four neighbours' own adds to the sample's.
    assert 0.4 * 2e-5 < np.median(found.noise) < 2 * 2e-5


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), size=st.floats(0.005, 3.0), axis=st.integers(0, 5))
def test_a_wild_sample_is_found(run, seed, size, axis) -> None:
    log = faulty(run, seed, torn=0)
    at = int(np.random.default_rng(seed).integers(5, len(log.t) - 5))
    q = log.q.copy()
    q[at, axis] += size
    found = clean_samples(log.t, q)
    near_hole = np.abs(log.t[at] - np.array(log.hole)).min() < 4 * PERIOD
    # One joint alone moves where the motion is in that joint alone: never here for long.
    assert at in found.torn or near_hole


def test_samples_asked_for_twice_are_held(run) -> None:
    t = np.arange(0, run.trajectory.duration, PERIOD)
    q = joints(run, t)
    polled = np.arange(0, t[-1], PERIOD / 4)
    held = q[np.floor(polled / PERIOD + 1e-9).astype(int)]
    found = clean_samples(polled, held)
    moving = np.abs(np.interp(polled, t[1:], np.abs(np.diff(q, axis=0)).max(axis=1))) > 1e-3
    first = np.concatenate([[True], (np.diff(held, axis=0) != 0).any(axis=1)])
    # Ends of motion may be called rest.
    assert found.valid[moving & ~first].mean() < 0.03
    assert found.valid[first].all()
    assert any("repeat" in note for note in found.notes)


def test_a_rest_is_no_fault() -> None:
    t = np.arange(0, 1, PERIOD)
    found = clean_samples(t, np.zeros((len(t), 6)))
    assert found.valid.all() and found.notes == ()


@settings(max_examples=30, deadline=None)
@given(data=st.data())
def test_any_samples_are_taken(data) -> None:
    """Nothing breaks on a log, however wild; what is marked is inside it."""
    count = data.draw(st.integers(2, 40))
    gaps = data.draw(st.lists(st.floats(1e-6, 1e3), min_size=count, max_size=count))
    size = st.floats(-1e6, 1e6)
    q = np.array(data.draw(st.lists(size, min_size=2 * count, max_size=2 * count)))
    try:
        found = clean_samples(np.cumsum(gaps), q.reshape(count, 2))
    except InputError:
        return
    assert found.valid.sum() + len(found.torn) + len(found.held) == count
    assert np.isfinite(found.noise).all()


def test_resampling_fills_what_was_torn_but_no_hole(run) -> None:
    log = faulty(run, 3, noise=0.0, jitter=1e-3)
    even = clean_samples(log.t, log.q).resampled(0.004)
    assert np.ptp(np.diff(even.t)[:-1]) < 1e-9
    inside = (even.t > log.hole[0]) & (even.t < log.hole[1])
    np.testing.assert_array_equal(even.valid, ~inside)
    off = np.abs(even.q - joints(run, even.t))[even.valid]
    assert off.max() < 2e-4
    with pytest.raises(InputError, match="period"):
        even.resampled(0.0)
    with pytest.raises(InputError, match="two samples"):
        clean_samples(np.zeros(1), np.zeros((1, 6)))
