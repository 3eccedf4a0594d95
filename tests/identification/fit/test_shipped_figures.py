"""Figures that were fitted and are shipped: what they say of a corner, and of logs where there are
any (FLYBY_LOGS)."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.corners import measure_corner
from flyby.identification.fit import ParameterSet, prepare
from flyby.identification.fit.keys import fit_of, value_of
from flyby.identification.fit.outcome import predicted
from flyby.identification.fit.parameters import fitted_before
from flyby.identification.fit.problem import first_nuisances
from flyby.identification.logs import load_run
from flyby.identification.tcp_path import tcp_positions

ROBOT = "abb/irb6640-180-255"
HOME = np.array([0.3, 0.3, 0.4, 0.6, -0.5, -0.5])
LOGS = os.environ.get("FLYBY_LOGS")
RUNS = {
    # mm of the path, greatest; degrees of joints at their time, 99 %.
    "movel_30_car__v50_z10": (0.05, 0.02),
    "movel_30_car__v500_z50": (0.3, 0.1),
    "movel_30_car__v1000_z50": (0.2, 0.15),
}


@pytest.fixture(scope="module")
def controller() -> Controller:
    return Controller(find_vendor("abb"), find_robot(ROBOT))


def test_usual_ranges_hold_what_is_shipped(controller) -> None:
    """Else who fits a figure without a range of his own cannot leave it."""
    model = controller.model
    for text in fitted_before(model):
        for key in text.partition(" in ")[0].split(" + "):
            asked, value = fit_of(key), value_of(model, key)
            assert value is not None and asked.lower < value < asked.upper, key


def apex(controller: Controller, radius: float, speed: float) -> float:
    """How far a corner of a right angle, turned by zones, leaves its waypoint, in m; as logged."""
    at = np.array(controller.robot.flange_pose(HOME).position)
    points = at + np.array([[0, 0, 0], [0, -0.35, 0], [0.35, -0.35, 0]])
    quaternion = controller.robot.flange_pose(HOME).quaternion
    told = Speed(tcp=speed, reorientation=5.0)
    moves = (
        MoveL(PoseTarget(Pose(tuple(points[1]), quaternion)), told, Radius(radius, radius, radius)),
        MoveL(PoseTarget(Pose(tuple(points[2]), quaternion)), told, FINE),
    )
    start = JointTarget(tuple(HOME))
    found = controller.run(Program(moves, start=start), period=5e-4).trajectory
    logged = tcp_positions(controller.robot, FLANGE, found.q_motor)
    return measure_corner(found.t, logged, points, 2 * radius + 0.02).apex


def test_slow_corners_are_the_zones_alone(controller: Controller) -> None:
    """Halfway through a zone the blend is (1/4 − β/16) (x_exit − x_wp + x_entry − x_wp) away …"""
    beta = sum(controller.model.tcp.beta[:1])
    share = (0.25 + beta / 16) * np.sqrt(2)
    for radius, rel in ((0.01, 0.1), (0.05, 0.01), (0.1, 0.01)):
        assert apex(controller, radius, 0.05) == pytest.approx(share * radius, rel=rel)


def test_fast_corners_are_cut_further(controller: Controller) -> None:
    """As logs show: averages over the joints reach over a corner, the further the faster."""
    speeds = (0.02, 0.05, 0.1, 0.3)
    far = [apex(controller, 0.001, speed) for speed in speeds]
    assert (np.diff(far) > 0).all()
    assert far[0] < 0.7e-3 and 3e-3 < far[-1] < 1e-2


def test_every_fitted_figure_says_where_it_comes_from() -> None:
    for robot in (ROBOT, "kuka/kr3-r540", "ur/ur10e", "ur/ur3"):
        arm = find_robot(robot)
        model = find_vendor(robot.split("/")[0]).motion_of(arm)
        for figure, origin in model.provenance.items():
            if origin.fit is not None:
                assert origin.fit.source and origin.fit.command, figure
        named = ParameterSet.named(model, fitted_before(model))
        for one in named.parameters:
            assert one.lower <= one.start <= one.upper


@pytest.mark.skipif(LOGS is None, reason="FLYBY_LOGS names no folder of logged runs")
@pytest.mark.parametrize("name", RUNS)
def test_logs_are_predicted(controller: Controller, name: str) -> None:
    (path,) = Path(LOGS or "").glob(f"**/abb_irb6640_robotstudio/{name}.json")
    run = prepare(
        load_run(path, find_robot), find_vendor("abb"), controller.robot, controller.model
    )
    found = predicted(run, controller.model, first_nuisances([run])[0]).figures
    path_max, joint = RUNS[name]
    assert 1e3 * found.path_max < path_max
    assert np.degrees(found.joint_time_p99) < joint
    assert found.cycle_time_ratio == pytest.approx(1.0, abs=0.01)
