"""How fast legs are driven from zone to zone; skipped where FLYBY_LOGS names no folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit.zone_sizes import resized
from flyby.identification.logs import clean, load_run
from flyby.identification.logs.run import LoggedRun
from flyby.identification.prediction import Prediction, predict

# What the logs show of zones that nobody recorded: factors on the record's rule.
SIZES = {
    "lin_16_20250722_102250": 1.0,
    "lin_18_20250722_101641": 1.1,
    "lin_26_20250722_103002": 2.0,
}


def predicted(run: LoggedRun, program: Program) -> Prediction:
    controller = Controller(find_vendor(run.robot.split("/")[0]), find_robot(run.robot))
    return predict(controller, run.name, program, clean(run), period=2e-3)


@pytest.mark.parametrize("name", sorted(SIZES))
def test_a_kuka_takes_as_long_from_corner_to_corner_as_its_legs_superposed(
    logs: Path, name: str
) -> None:
    run = load_run(logs / "kuka_kr3_real" / f"{name}.json", find_robot)
    found = predicted(run, resized(run.program, SIZES[name])).figures
    assert found.cycle_time_ratio == pytest.approx(1.0, abs=0.02)
    assert found.path_p99 < 0.25e-3
    assert np.degrees(found.joint_clock_p99) < 0.6


def at_100_mm(run: LoggedRun) -> Program:
    """What logs show of lines whose speeds and radii were not recorded."""
    speed = Speed(tcp=1.0, tcp_acceleration=0.5)
    moves = tuple(
        replace(m, speed=speed, zone=Radius(0.1) if isinstance(m.zone, Radius) else m.zone)
        for m in run.program.moves
    )
    return run.program.with_moves(moves)


def test_points_left_out_a_short_first_leg_and_a_sharp_corner_of_a_ur(logs: Path) -> None:
    """No figure was fitted to this run: 5 of 11 points left out, two blends made smaller."""
    run = load_run(logs / "ur10e_ursim" / "lin_12_20250626_121340.json", find_robot)
    found = predicted(run, at_100_mm(run))
    assert found.driven.path.route.moves == (0, 2, 4, 6, 9, 10, 11)
    assert sorted(found.driven.path.corners.kept) == [0, 3]
    assert found.figures.path_max < 0.01e-3


def test_a_ur_enters_its_blends_at_the_root_of_twice_acceleration_times_radius(
    logs: Path,
) -> None:
    """Stamps of this log are those of arrival; steps along the path are of 2 ms."""
    run = load_run(logs / "ur10e_ursim" / "lin_18_20250701_092904.json", find_robot)
    found = predicted(run, at_100_mm(run))
    step = np.linalg.norm(np.diff(found.residuals.tcp, axis=0), axis=1)
    arc = 0.5 * (found.residuals.arc[1:] + found.residuals.arc[:-1])
    place = found.driven.trajectory.position
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(place, axis=0), axis=1))])
    speeds = np.gradient(length, found.driven.trajectory.t)
    emulated = np.interp(arc, length, speeds)
    # Beyond, the controller brakes harder towards a sharp corner than it is emulated.
    before = (arc > 0.01) & (arc < 1.5)
    # Samples that were lost make a step of two or three periods.
    single = before & (step < 1.5 * 0.002 * emulated)
    assert single.sum() > 0.8 * before.sum()
    ratio = step[single] / (0.002 * emulated[single])
    assert np.median(np.abs(ratio - 1.0)) < 2e-3
    # Waypoints left out and a blend made smaller on the way; it begins blends at whole periods.
    assert found.figures.path_max < 0.06e-3
    assert np.median(found.residuals.path) < 2e-6
