"""All logged runs cleaned and aligned; skipped where FLYBY_LOGS names no folder."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.rules import ArcTurn
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.alignment import align
from flyby.identification.logs import clean, load_run
from flyby.identification.prediction import predict
from flyby.identification.residuals import residuals


@cache
def loaded(path: Path):
    run = load_run(path, find_robot)
    return run, clean(run)


def motion(path: Path):
    run, _ = loaded(path)
    vendor, robot = find_vendor(run.robot.split("/")[0]), find_robot(run.robot)
    model = vendor.motion_of(robot)
    if "robotstudio" in path.parent.name:
        model = replace(model, arc_turn=ArcTurn.AXIS)
    return Controller(vendor, robot, model).run(run.program, period=1e-3).trajectory


def test_virtual_controllers_tear_no_samples_and_a_real_one_does(logs) -> None:
    for path in sorted(logs.glob("abb_*robotstudio/*.json")):
        _, log = loaded(path)
        assert len(log.torn) == 0 and not log.holes, path
    for path in sorted(logs.glob("abb_*real/*.json")):
        _, log = loaded(path)
        assert 1 <= len(log.torn) < 0.05 * len(log.t), path
        assert log.holes, path


def test_few_samples_of_any_run_are_doubted(logs) -> None:
    for path in sorted(logs.glob("*/*.json")):
        _, log = loaded(path)
        doubted = ~log.valid
        doubted[log.held] = False  # the logger said the same twice: no doubt about those
        assert doubted.sum() <= max(6, 0.05 * len(log.t)), path  # the shortest has 107
        assert len(log.held) < 0.1 * len(log.t), path


def test_every_run_is_aligned_with_its_own_program(logs) -> None:
    for path in sorted(logs.glob("*/*.json")):
        run, log = loaded(path)
        if not run.zones_known:  # aligned once their zones are fitted
            continue
        robot, trajectory = find_robot(run.robot), motion(path)
        found = align(robot, trajectory, log)
        rest = residuals(robot, run.program.moves[0].tool, trajectory, log, found)
        assert np.degrees(np.percentile(np.abs(rest.joint_path).max(axis=1), 50)) < 2.0, path
        assert len(found.rows) > 0.2 * len(log.t), path


def test_a_robots_tool_follows_arcs_and_a_virtual_controllers_does_not(logs) -> None:
    """The same RAPID, told nothing of how to turn."""
    for folder, turn in (("real", ArcTurn.PROGRAMMED), ("robotstudio", ArcTurn.AXIS)):
        paths = sorted(logs.glob(f"abb_irb6640_{folder}/movec_*.json"))
        assert len(paths) >= 3
        for path in paths:
            run, log = loaded(path)
            controller = Controller(find_vendor("abb"), find_robot(run.robot))
            found = predict(controller, run.name, run.program, log, period=1e-3)
            assert found.turn is turn, path
            assert found.figures.joint_path_rms < np.radians(0.05), path


def test_runs_of_other_programs_are_refused(logs) -> None:
    by_robot: dict[str, dict[str, Path]] = {}
    for path in sorted(logs.glob("*/*.json")):
        shape = path.stem.split("__")[0]
        by_robot.setdefault(loaded(path)[0].robot, {}).setdefault(shape, path)
    paths = list(by_robot["abb/irb6640-180-255"].values())
    trajectory = motion(next(path for path in paths if path.stem.startswith("movel_30_car")))
    others = [path for path in paths if path.stem.startswith(("blade", "curve"))]
    assert others
    for path in others:
        with pytest.raises(InputError, match="does not follow"):
            align(find_robot("abb/irb6640-180-255"), trajectory, loaded(path)[1])
