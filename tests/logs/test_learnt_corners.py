"""The emulator beside figures of real corners that were measured once; no log is needed."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.corners import measure_corner

TABLE = tomllib.loads(Path(__file__).with_name("corners.toml").read_text("utf-8"))
GUN = Tool("gun", Pose((0.075, 0.0, 0.4933), (np.cos(np.pi / 12), 0.0, np.sin(np.pi / 12), 0.0)))
SPEED = Speed(tcp=0.05, reorientation=np.radians(500))
WAYPOINT, TURN = np.array([2.2, 0.0, 1.0]), np.radians(30)
POINTS = np.array(
    [
        WAYPOINT + np.array([0.0, 0.5, 0.0]),
        WAYPOINT,
        WAYPOINT + 0.5 * np.array([np.sin(TURN), -np.cos(TURN), 0.0]),
    ]
)


def target(point, tilt) -> PoseTarget:
    half = np.radians(tilt) / 2
    return PoseTarget(Pose(tuple(point), (np.cos(half), 0.0, np.sin(half), 0.0)))


CLOCK = 1.008
"""The virtual controller stamps a sample every 4 ms that it makes every 4.032 ms."""


@pytest.mark.parametrize("entry", TABLE["corner"], ids=lambda entry: entry["run"])
def test_the_emulated_corner_is_near_the_measured_one(entry) -> None:
    name = TABLE["source"]["robot"]
    radius = 1e-3 * entry["zone"]["radius"]
    zone = Radius(radius, 1.5 * radius, 1.5 * radius)
    moves = (
        MoveJ(target(POINTS[0], 135.0), SPEED, FINE, GUN),
        MoveL(target(POINTS[1], 112.5), SPEED, zone, GUN),
        MoveL(target(POINTS[2], 90.0), SPEED, FINE, GUN),
    )
    run = Controller(find_vendor("abb"), find_robot(name)).run(Program(moves))
    motion = run.trajectory
    corner = measure_corner(motion.t, motion.position, POINTS, 1e-3 * entry["zone"]["look"])
    found = {
        "apex": 1e3 * corner.apex,
        "entry": 1e3 * corner.entry,
        "exit": 1e3 * corner.exit,
        "duration": corner.duration,
    }
    for figure, value in entry["measured"].items():
        if figure == "duration":
            value *= CLOCK
        assert found[figure] == pytest.approx(value, abs=entry["slack"][figure]), figure
