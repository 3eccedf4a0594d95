"""All logged runs cleaned and aligned; skipped where FLYBY_LOGS names no folder."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.rules import ArcTurn
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.alignment import align
from flyby.identification.logs import clean, load_run

from .conftest import runs


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
    for path in runs(logs, "abb_*robotstudio/*.json"):
        _, log = loaded(path)
        assert len(log.torn) == 0 and not log.holes, path
    for path in runs(logs, "abb_*real/*.json"):
        _, log = loaded(path)
        assert 1 <= len(log.torn) < 0.05 * len(log.t), path
        assert log.holes, path


def test_few_samples_of_any_run_are_doubted(logs) -> None:
    for path in runs(logs, "*/*.json"):
        _, log = loaded(path)
        doubted = ~log.valid
        doubted[log.held] = False  # the logger said the same twice: no doubt about those
        assert doubted.sum() <= max(6, 0.05 * len(log.t)), path  # the shortest has 107
        assert len(log.held) < 0.1 * len(log.t), path


def test_runs_of_other_programs_are_refused(logs) -> None:
    by_robot: dict[str, dict[str, Path]] = {}
    for path in runs(logs, "*/*.json"):
        shape = path.stem.split("__")[0]
        by_robot.setdefault(loaded(path)[0].robot, {}).setdefault(shape, path)
    paths = list(by_robot["abb/irb6640-180-255"].values())
    trajectory = motion(next(path for path in paths if path.stem.startswith("movel_30_car")))
    others = [path for path in paths if path.stem.startswith(("blade", "curve"))]
    assert others
    for path in others:
        with pytest.raises(InputError, match="does not follow"):
            align(find_robot("abb/irb6640-180-255"), trajectory, loaded(path)[1])
