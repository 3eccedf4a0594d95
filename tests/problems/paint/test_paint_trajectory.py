"""Painting trajectories: what they refuse, and what moving, turning round and cutting preserve."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.spatial.pose import Pose
from flyby.problems.paint.spray.trajectory import PaintTrajectory

from .paint_cases import wandering

SEEDS = st.integers(0, 10_000)


@given(SEEDS)
def test_moving_keeps_lengths_and_angles(seed):
    trajectory = wandering(6, seed)
    rng = np.random.default_rng(seed)
    turn = rng.normal(size=4)
    turn /= np.linalg.norm(turn)
    moved = trajectory.moved(Pose(tuple(rng.normal(size=3)), tuple(turn)))
    assert np.allclose(moved.lengths, trajectory.lengths)
    assert np.allclose(moved.nozzle @ moved.nozzle.T, trajectory.nozzle @ trajectory.nozzle.T)


def test_speed_gives_durations():
    trajectory = PaintTrajectory.at_speed(
        [[0, 0, 0], [1, 0, 0], [1, 2, 0]], [[0, 0, -1.0]] * 3, 0.5
    )
    assert np.allclose(trajectory.duration, (2.0, 4.0))
    assert np.allclose(trajectory.speeds, 0.5)
    assert trajectory.times[-1] == trajectory.total_duration == 6.0


def test_values_cannot_be_changed():
    trajectory = wandering(4, 1)
    with pytest.raises(ValueError, match="read-only"):
        trajectory.position[0, 0] = 1.0


UP = [[0.0, 0.0, -1.0]] * 2
ENDS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((ENDS[:1], UP[:1], [], []), "W >= 2"),
        ((ENDS, UP[:1], [1.0], [1.0]), r"nozzle: expected \(2, 3\)"),
        ((ENDS, UP, [0.0], [1.0]), r"duration\[0\] is not above zero"),
        ((ENDS, UP, [1.0], [-1.0]), r"flow\[0\] is negative"),
        ((ENDS, UP, [1.0, 1.0], [1.0]), r"duration: expected \(1,\)"),
        ((ENDS, [[0, 0, -2.0], [0, 0, -1.0]], [1.0], [1.0]), "unit length"),
        ((ENDS, [[0, 0, -1.0], [0, 0, 1.0]], [1.0], [1.0]), "half a turn"),
        (([[np.nan, 0, 0], [1, 0, 0]], UP, [1.0], [1.0]), "not finite"),
        ((ENDS, UP, [1.0], [1.0], UP), "along the nozzle"),
        (("text", UP, [1.0], [1.0]), "array of numbers"),
    ],
)
def test_refusals(arguments, message):
    with pytest.raises(InputError, match=message):
        PaintTrajectory(*arguments)


def test_speed_needs_lengths():
    with pytest.raises(InputError, match="repeated"):
        PaintTrajectory.at_speed([[0, 0, 0], [0, 0, 0]], UP, 1.0)
    with pytest.raises(InputError, match="above zero"):
        PaintTrajectory.at_speed(ENDS, UP, 0.0)
