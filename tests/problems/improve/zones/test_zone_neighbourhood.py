"""Trials at single waypoints are the whole program's own path there."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Fine, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.problems.improve.zones.neighbourhood import CornerPath, Neighbourhoods
from flyby.testing.strategies import Parts, programs, radii, speeds

ROBOTS = {name: find_robot(name) for name in ("abb/irb1200-5-090", "kuka/kr30-3")}


@pytest.mark.parametrize("name", ROBOTS)
@given(data=st.data())
@settings(max_examples=15)
def test_a_trial_is_the_whole_programs_path_round_its_waypoint(name, data):
    robot, vendor = ROBOTS[name], find_vendor(name.partition("/")[0])
    parts = Parts(lambda _: radii(0.08), lambda _: speeds())
    program = data.draw(programs(robot, vendor.label, parts))
    controller = Controller(vendor, robot)
    try:
        path = controller.plan(program)
    except MotionError:
        assume(False)
    corners = [i for i, zone in enumerate(path.route.zones) if not isinstance(zone, Fine)]
    assume(corners)
    trials = Neighbourhoods(robot, path.route, controller.model)
    found = trials.paths([(i, path.route.zones[i]) for i in corners])
    for i, trial in zip(corners, found, strict=True):
        assert isinstance(trial, CornerPath)
        at, extent = path.layout.waypoint[i + 1], path.layout.extent[i].max(axis=0)
        assert trial.extent == pytest.approx(tuple(extent), rel=1e-9, abs=1e-12)
        inside = (path.sigma >= at - extent[0]) & (path.sigma <= at + extent[1])
        q = trial.at(path.sigma[inside] - at)
        assert np.abs(q - path.q[inside]).max(initial=0.0) < 2e-6


def test_the_path_outside_the_stretch_stays_as_it_is():
    controller, program = _three_lines()
    for size in (0.01, 0.06):
        wide = _with_zone(program, 1, size)
        before, after = controller.plan(program), controller.plan(wide)
        trial = Neighbourhoods(controller.robot, before.route, controller.model).paths(
            [(0, wide.moves[1].zone)]
        )[0]
        assert isinstance(trial, CornerPath)
        at = after.layout.waypoint[1]
        outside = (after.sigma < at - trial.extent[0]) | (after.sigma > at + trial.extent[1])
        nominal = np.array(
            [np.interp(after.sigma[outside], before.sigma, column) for column in before.q.T]
        )
        assert np.abs(nominal.T - after.q[outside]).max() < 1e-3
        # The zone for orientation reaches beyond the TCP's sphere.
        assert trial.extent[0] > 1.4 * size


def test_what_the_arm_cannot_follow_is_told_and_the_rest_is_emulated():
    controller, program = _three_lines()
    trials = Neighbourhoods(controller.robot, controller.plan(program).route, controller.model)
    zone = Radius(0.02, 0.03, 0.03)
    alone = trials.paths([(0, zone)])[0]
    assert isinstance(alone, CornerPath)
    both = trials.paths([(0, zone), (1, zone), (0, FINE)])
    assert all(isinstance(path, CornerPath) for path in both)
    assert isinstance(both[0], CornerPath) and isinstance(both[2], CornerPath)
    assert np.array_equal(both[0].q, alone.q)
    assert both[0].passed and not both[2].passed
    assert trials.paths([]) == []


def _three_lines() -> tuple[Controller, Program]:
    """Two lines that meet at right angles and turn the tool, and one more."""
    robot = ROBOTS["abb/irb1200-5-090"]
    angles = ((0, 10, 10, 0, 60, 0), (25, 20, 5, 10, 50, 20), (30, 35, -10, 0, 70, 0))
    targets = [JointTarget(tuple(np.radians(a))) for a in ((0, 0, 0, 0, 40, 0), *angles)]
    first, *others = targets
    speed, zone = Speed(tcp=0.5), Radius(0.001, 0.0015, 0.0015)
    moves = [MoveJ(first, speed)] + [MoveL(target, speed, zone) for target in others]
    moves[-1] = MoveL(others[-1], speed, FINE)
    return Controller(find_vendor("abb"), robot), Program(tuple(moves), start=first)


def _with_zone(program: Program, move: int, size: float) -> Program:
    moves = list(program.moves)
    moves[move] = MoveL(moves[move].target, moves[move].speed, Radius(size, 1.5 * size, 1.5 * size))
    return program.with_moves(tuple(moves))
