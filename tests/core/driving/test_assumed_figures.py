"""The range of a time that rests on assumed speeds and accelerations."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.driving.assumed_figures import duration_range
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor

MOVE = MoveJ(JointTarget((0.8, -1.2, 1.4, 0.1, 0.5, 0.0)), Speed(), FINE)
PROGRAM = Program((MOVE,), start=JointTarget((0.0, -1.5, 1.5, 0.0, 0.3, 0.0)))


def controller(**spread: float) -> Controller:
    robot = replace(find_robot("kuka/kr30-3"), spread=spread)
    return Controller(find_vendor("kuka"), robot)


def test_stated_figures_leave_nothing_open() -> None:
    driver = controller()
    assert duration_range(driver, driver.run(PROGRAM)) is None


@settings(max_examples=10, deadline=None)
@given(a=st.floats(1.0, 3.0), v=st.floats(1.0, 2.0))
def test_the_range_holds_what_every_factor_between_makes(a, v) -> None:
    driver = controller(acceleration=a, velocity=v)
    run = driver.run(PROGRAM)
    least, most = duration_range(driver, run)
    assert least <= run.duration <= most
    joints = tuple(
        replace(j, velocity=j.velocity / v, acceleration=j.acceleration / a)
        for j in driver.robot.joints
    )
    slow = driver.with_robot(replace(driver.robot, joints=joints)).run(PROGRAM)
    assert most == pytest.approx(slow.duration, abs=0.03)
