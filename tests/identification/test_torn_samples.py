"""Logs read joint by joint while the controller goes on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.registry import find_vendor
from flyby.identification.alignment import align
from flyby.identification.logs.cleaning import clean_samples
from flyby.identification.prediction import predict
from flyby.identification.torn_samples import find_torn, mended

from .faulty_logs import ROBOT, emulated, joints, program

READ, NOISE = 0.02, 1e-5


@pytest.fixture(scope="module")
def run():
    return emulated(program())


def read(run, seed: int, delay: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """t, q every 20 ms, late, of joints that are read later from some one on; and as they were."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, run.trajectory.duration, READ)
    t = t + rng.uniform(-0.2, 0.2, len(t)) * READ
    whole, later = joints(run, t), joints(run, t + delay)
    torn = np.arange(6) >= rng.integers(0, 6, len(t))[:, None]
    q = np.where(torn, later, whole) + NOISE * rng.normal(size=whole.shape)
    return t + rng.uniform(0.0, 0.005, len(t)), q, whole


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10**6), delay=st.floats(0.003, 0.012), ahead=st.booleans())
def test_torn_samples_are_put_together(run, seed, delay, ahead) -> None:
    delay = delay if ahead else -delay
    t, q, whole = read(run, seed, delay)
    log = clean_samples(t, q)
    found = align(ROBOT, run.trajectory, log)
    torn = find_torn(run.trajectory, found)
    assert torn is not None
    assert torn.delay == pytest.approx(delay, abs=2e-4)
    healed = mended(log, run.trajectory, found, torn)
    again = align(ROBOT, run.trajectory, healed)
    # From five times the tear's size to the noise; where joints turn sharply, speeds change.
    off = np.linalg.norm(again.off, axis=1)
    assert np.median(off) < 4 * NOISE
    assert off.mean() < 0.25 * np.linalg.norm(found.off, axis=1).mean()
    assert np.median(np.abs(healed.q - whole)[again.rows]) < 3 * NOISE
    assert "mix joints of two cycles" in healed.notes[-1]


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10**6), delay=st.floats(0.003, 0.008), lag=st.floats(0.0, 2e-3))
def test_few_torn_samples_are_put_together(run, seed, delay, lag) -> None:
    """Alone or two in a row, beside servos that follow at different distances."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, run.trajectory.duration, 0.008)
    lags = lag * rng.uniform(-1.0, 1.0, 6)
    whole = np.stack([joints(run, t - one)[:, j] for j, one in enumerate(lags)], -1)
    whole += NOISE * rng.normal(size=whole.shape)
    later = joints(run, t + delay) - joints(run, t)
    breaks = np.zeros(len(t), dtype=int)
    for first in rng.choice(np.arange(10, len(t) - 10, 10), 5, replace=False):
        breaks[first : first + rng.integers(1, 3)] = rng.integers(1, 6)
    q = whole + later * ((np.arange(6) >= breaks[:, None]) & (breaks > 0)[:, None])
    log = replace(clean_samples(t, q), valid=np.ones(len(t), dtype=bool))
    found = align(ROBOT, run.trajectory, log)
    torn = find_torn(run.trajectory, found)
    size = np.abs(q - whole).max(axis=1)[found.rows]
    tear = size > 3e-4
    if not tear.any():
        return
    assert torn is not None and torn.delay == pytest.approx(delay, rel=0.15)
    healed = mended(log, run.trajectory, found, torn)
    off = np.abs(healed.q - whole)[found.rows].max(axis=1)
    # Two that differ side by side may hide each other.
    assert np.mean(off[tear] < 0.2 * size[tear]) > 0.6


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10**6), bend=st.floats(0.0, 5e-4))
def test_whole_samples_stay(run, seed, bend) -> None:
    """Noise, jitter, and a path that is emulated a little wrong are no torn samples."""
    t, q, _ = read(run, seed, 0.0)
    q = q + bend * np.sin(3.0 * t)[:, None] * np.array([1.0, -0.5, 0.7, 0.2, -1.0, 0.4])
    found = align(ROBOT, run.trajectory, clean_samples(t, q))
    assert find_torn(run.trajectory, found) is None


@settings(max_examples=12, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    late=st.floats(0.001, 0.008),
    first=st.integers(1, 5),
    noise=st.sampled_from([1e-5, 1e-4]),
    uneven=st.sampled_from([0.0, 1e-3]),
)
def test_lags_are_no_tears(run, seed, late, first, noise, uneven) -> None:
    """Joints that are late in all samples alike, as servos are, are the emulation's error."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, run.trajectory.duration, READ)
    lags = np.where(np.arange(6) >= first, late, 0.0) + uneven * rng.uniform(-1.0, 1.0, 6)
    q = np.stack([joints(run, t - lag)[:, j] for j, lag in enumerate(lags)], -1)
    q = q + noise * rng.normal(size=q.shape)
    found = align(ROBOT, run.trajectory, clean_samples(t, q))
    assert find_torn(run.trajectory, found) is None


def test_predictions_mend_what_they_compare_and_say_what_was_read(run) -> None:
    controller = Controller(find_vendor("ur"), ROBOT, MotionModel())
    t, q, whole = read(run, 1, 0.004)
    found = predict(controller, "torn", program(), clean_samples(t, q))
    assert found.figures.path_p99 < 5e-5
    told = next(note for note in found.log.notes if "two cycles" in note)
    count, of = map(int, told.split(" samples")[0].split(" of "))
    torn = np.ptp(q - whole, axis=1)[found.alignment.rows] > 1e-4
    assert of == pytest.approx(len(t), abs=5)
    assert count == pytest.approx(torn.sum(), rel=0.2)
    assert found.read is not None and found.read.path_p99 > 5 * found.figures.path_p99
    as_it_was = predict(controller, "whole", program(), clean_samples(t, whole))
    assert as_it_was.read is None
