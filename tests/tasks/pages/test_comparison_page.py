"""What the page of a log beside its emulation holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.tasks.pages.comparison_page import LATE, comparison_page

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("noise", [0.0, 3e-5])
def test_how_late_the_robot_is_goes_on_evenly_where_it_stands(tmp_path: Path, noise: float) -> None:
    """A robot that takes 2 % longer everywhere, on a program with stops, waits and ways back."""
    program = flyby.read(ROOT / "examples/pick.script", cell=ROOT / "examples/cell/pick.toml")
    moved = flyby.emulate(program).trajectory
    t = np.arange(0.0, moved.t[-1], 0.008)
    q = np.column_stack([np.interp(t, moved.t, column) for column in moved.q_motor.T])
    q += noise * np.random.default_rng(3).normal(size=q.shape)
    rows = np.column_stack([1.02 * t, q])
    path = tmp_path / "slow.csv"
    np.savetxt(path, rows, "%.9g", ",", header="t,q1,q2,q3,q4,q5,q6", comments="")
    page = comparison_page(flyby.compare(program, log=path))
    measured = page.tracks[1]
    (late,) = [one for one in measured.channels if one.chart == LATE]
    times = measured.motion.t.values
    inside = (times > 0.5) & (times < times[-1] - 0.5)
    slope, begin = np.polyfit(times[inside], late.values.values[inside], 1)
    assert slope == pytest.approx(1e3 * 0.02 / 1.02, rel=0.02)
    off = late.values.values - (slope * times + begin)
    assert np.abs(off[inside]).max() < 12.0
