"""All logged runs through the emulator; skipped where FLYBY_LOGS names no folder."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.controller import Controller
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.comparison import compare
from flyby.identification.logs import load_run

MM = 1e-3
END_OFF = {
    # A real arm's own calibrated lengths: its logged joints do not meet its target with nominal
    # ones.
    "robot_movel_x400": 1.5 * MM,
}


def runs(logs: Path, pattern: str) -> list[Path]:
    found = sorted(logs.glob(pattern))
    assert found, f"{logs} holds no {pattern}"
    return found


@cache
def comparison(path: Path):
    run = load_run(path, find_robot)
    robot = find_robot(run.robot)
    controller = Controller(find_vendor(run.robot.split("/")[0]), robot)
    emulated = controller.run(run.program).trajectory
    return compare(robot, run.program.moves[0].tool, run.t, run.q, emulated)


def test_every_run_can_be_emulated_from_its_start_to_its_end(logs) -> None:
    for path in runs(logs, "*/*.json"):
        found = comparison(path)
        assert found.start < 0.1 * MM, path
        assert found.end < max(0.2 * MM, END_OFF.get(path.stem, 0.0)), path
        assert np.isfinite(found.deviation).all()


def test_abb_virtual_controller_starts_and_ends_on_its_program(logs) -> None:
    for path in runs(logs, "abb_*robotstudio/*.json"):
        found = comparison(path)
        assert max(found.start, found.end) < 0.01 * MM, path


@pytest.mark.parametrize(
    ("pattern", "limit"),
    [("*__v50_z10", 0.5 * MM), ("*__v50_z50", 1.0 * MM), ("*__v50_z200", 5.0 * MM)],
)
def test_slow_abb_runs_are_followed(logs, pattern, limit) -> None:
    """All but the last percent: within 2 mm of a stop the joints do not stop together."""
    for path in runs(logs, f"abb_irb6640_robotstudio/{pattern}.json"):
        found = comparison(path)
        assert np.percentile(found.deviation, 99) < limit, path
        assert found.deviation.max() < max(limit, 0.7 * MM), path
        assert found.cycle_time_ratio == pytest.approx(1.0, abs=0.01), path


def test_a_dense_curve_at_process_speed_takes_its_time(logs) -> None:
    (path,) = runs(logs, "abb_irb6640_dense_robotstudio/*.json")
    found = comparison(path)
    assert np.percentile(found.deviation, 99) < 1.2 * MM
    assert found.cycle_time_ratio == pytest.approx(1.0, abs=0.01)


def test_single_moves_of_a_virtual_ur_are_on_their_line(logs) -> None:
    for path in runs(logs, "ur3_cb3_timing/ursim_*.json"):
        found = comparison(path)
        assert found.deviation.max() < 0.01 * MM, path
        assert found.cycle_time_ratio == pytest.approx(1.0, abs=0.05), path


@pytest.mark.parametrize("name", ["movel_30_car", "movec_30_car", "moveljl_30_car"])
def test_a_program_and_its_rapid_module_give_the_same_motion(logs, name) -> None:
    (path,) = runs(logs, f"abb_irb6640_robotstudio/{name}__v50_z10.json")
    run, vendor = load_run(path, find_robot), find_vendor("abb")
    robot = find_robot(run.robot)
    ((file, text),) = vendor.writer.write(run.program, robot, {}).items()
    back = vendor.read(text, file, robot=robot)
    controller = Controller(vendor, robot)
    one = controller.run(run.program).trajectory
    other = controller.run(back, start=run.program.start).trajectory
    np.testing.assert_allclose(one.t, other.t, atol=1e-5)
    # RAPID's numbers carry seven digits.
    np.testing.assert_allclose(one.q, other.q, atol=1e-6)
