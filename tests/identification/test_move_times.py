"""What each move took in a log: a log that is slower in one stretch, on a way there and back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.tasks.results.comparison import Comparison

ROOT = Path(__file__).parents[2]
BEGIN, END, SHARE = 5.0, 7.0, 0.08
"""s from and to which the robot is slower, and by what."""


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    """The pick and place, whose robot goes down to each place and back up the same way."""
    program = flyby.read(ROOT / "examples/pick.script", cell=ROOT / "examples/cell/pick.toml")
    moved = flyby.emulate(program).trajectory
    t = np.arange(0.0, moved.t[-1], 0.008)
    q = np.column_stack([np.interp(t, moved.t, column) for column in moved.q.T])
    logged = 3.2 + t + SHARE * (np.clip(t, BEGIN, END) - BEGIN)
    path = tmp_path_factory.mktemp("log") / "slower.csv"
    rows = np.column_stack([logged, q])
    np.savetxt(path, rows, "%.9g", ",", header="t,q1,q2,q3,q4,q5,q6", comments="")
    return flyby.compare(program, log=path)


def test_each_move_takes_what_it_took(found: Comparison) -> None:
    moves = found.moves
    assert [one.move for one in moves] == list(range(1, 14))
    # Stops are found within a sample.
    at = np.cumsum([one.emulated for one in moves])
    slower = SHARE * (np.clip(at, BEGIN, END) - BEGIN)
    meant = np.diff(slower, prepend=0.0)
    np.testing.assert_allclose([one.longer for one in moves], meant, atol=4e-3)
    assert all(one.off is not None and one.off < 2e-5 for one in moves)


def test_the_move_that_differs_most_is_named(found: Comparison) -> None:
    assert "0.9 % longer than emulated" in found.times_said
    assert "the most at move 5, line 19: 0.08" in found.times_said


def test_of_guessed_speeds_no_times_are_claimed(found: Comparison) -> None:
    guessed = replace(found, run=replace(found.run, timed=False))
    assert "longer" not in guessed.times_said and "times say nothing" in guessed.times_said
