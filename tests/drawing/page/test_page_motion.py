"""What a page keeps of a motion shows all of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core.program.target import PoseTarget
from flyby.core.spatial.pose import Pose
from flyby.drawing.page.knots import hermite
from flyby.drawing.page.packing import Packer
from flyby.drawing.page.tracks import driven_curves, page_motion
from flyby.tasks.results.runs import Run

ROOT = Path(__file__).parents[3]
PROGRAMS = {
    "examples/square.mod": {"robot": "abb/irb6640-180-255"},
    "examples/seam.src": {"robot": "kuka/kr30-3"},
    "examples/pick.script": {"cell": ROOT / "examples/cell/pick.toml"},
}
MOST_BYTES = 20


@pytest.fixture(params=PROGRAMS, scope="module")
def run(request: pytest.FixtureRequest) -> Run:
    return flyby.emulate(flyby.read(ROOT / request.param, **PROGRAMS[request.param]))


def test_the_flange_is_where_it_was(run: Run) -> None:
    trajectory, robot = run.trajectory, run.robot
    motion, _ = page_motion(trajectory, robot, driven_curves(run, robot))
    step = motion.q[0].step
    knots = motion.t.values
    q = np.stack([np.round(c.values / step) * step for c in motion.q], axis=1)
    dq = np.stack([np.round(c.values / c.step) * c.step for c in motion.dq], axis=1)
    assert len(knots) < 0.5 * len(trajectory.t)
    left = np.clip(np.searchsorted(knots, trajectory.t, side="right") - 1, 0, len(knots) - 2)
    span = knots[left + 1] - knots[left]
    share = np.divide(trajectory.t - knots[left], span, out=np.zeros_like(span), where=span > 0)
    back = hermite(share[:, None], span[:, None], (q[left], q[left + 1]), (dq[left], dq[left + 1]))
    _, shown = robot.forward(back)
    _, meant = robot.forward(trajectory.q)
    assert np.linalg.norm(shown - meant, axis=1).max() < 1e-4


def test_curves_are_seen_as_they_are(run: Run) -> None:
    trajectory, robot = run.trajectory, run.robot
    curves = driven_curves(run, robot)
    motion, channels = page_motion(trajectory, robot, curves)
    assert {curve.chart for curve in curves} >= {"speed", "push"}
    for curve, channel in zip(curves, channels, strict=True):
        if curve.stepped:
            rows = np.searchsorted(motion.t.values, trajectory.t, side="right") - 1
            seen = channel.values.values[rows]
        else:
            seen = np.interp(trajectory.t, motion.t.values, channel.values.values)
        off = np.abs(np.nan_to_num(seen) - np.nan_to_num(curve.values))
        assert off.max() <= 1.001 * curve.tolerance, curve.name


def test_a_sample_takes_few_bytes(run: Run) -> None:
    """Of the controller's samples, all joints together."""
    packer = Packer()
    motion, _ = page_motion(run.trajectory, run.robot, driven_curves(run, run.robot))
    size = len(packer.json(motion)) + len(packer.arrays())
    assert size / len(run.trajectory.t) < MOST_BYTES


def test_gaps_stay_gaps() -> None:
    """Where a move cannot be driven the clock stands still, and joints jump."""
    program = flyby.read(ROOT / "examples/square.mod", robot="abb/irb6640-180-255")
    moves = list(program.moves)
    moves[3] = replace(moves[3], target=PoseTarget(Pose((9.0, 0.0, 0.0))))
    run = flyby.emulate(program.with_moves(tuple(moves)))
    assert run.faults and run.trajectory.gaps
    motion, _ = page_motion(run.trajectory, run.robot)
    assert any(a == b for a, b in pairwise(motion.t.values))
