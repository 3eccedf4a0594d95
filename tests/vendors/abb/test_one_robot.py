"""The example of a motion file of one robot lies on how its type is driven."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import flyby
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.registry import find_robot, find_vendor

ROOT = Path(__file__).parents[3]
ROBOT = find_robot("abb/irb6640-180-255")
TYPE = find_vendor("abb").motion_of(ROBOT)
ONE = load_motion_model(ROOT / "examples" / "irb6640_one_robot.toml", TYPE, ROBOT.name)


def test_it_states_figures_of_one_robot_alone() -> None:
    stated = {key for key in ONE.figures if ONE.provenance[key] != TYPE.provenance.get(key)}
    assert stated >= {"servo.friction_rad", "servo.drag_s", "elasticity.lag_s"}
    assert {ONE.provenance[key].status for key in stated} == {"fitted"}
    assert ONE.torque == TYPE.torque


def test_its_tool_stays_within_millimetres_of_its_type() -> None:
    program = flyby.read(ROOT / "examples" / "square.mod", robot=ROBOT.name)
    of_type, of_one = (
        Controller(find_vendor("abb"), ROBOT, replace(model, servo=replace(model.servo, rest=0.0)))
        .run(program)
        .trajectory
        for model in (TYPE, ONE)
    )
    away = np.linalg.norm(of_one.position - of_type.position, axis=1)
    assert 1e-4 < away.max() < 5e-3
