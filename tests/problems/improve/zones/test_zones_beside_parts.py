"""Zones next to where parts are taken and released."""

from __future__ import annotations

import numpy as np
import pytest

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box, Cylinder
from flyby.core.spatial.pose import Pose
from flyby.problems.improve.rounding import Rounding
from flyby.problems.improve.zones.maximize import maximize_zones
from flyby.problems.improve.zones.options import ZoneTask

UR = find_robot("ur/ur10e")
CONTROLLER = Controller(find_vendor("ur"), UR)
GRIP = Tool("grip", Pose((0.0, 0.0, 0.2)))
CELL = Cell(
    UR,
    "ur",
    tools={"grip": GRIP},
    tool_geometries={"grip": Geometry(Cylinder(0.02, 0.2), Pose((0.0, 0.0, 0.1)))},
    obstacles=(Obstacle("floor", Geometry(Box((0.6, 1.0, 0.1)), Pose((0.7, 0.0, -0.05)))),),
    parts=(
        Workpiece(
            "crate", Geometry(Box((0.1, 0.1, 0.1)), Pose((0.6, 0.2, 0.05))), ("on",), ("off",)
        ),
    ),
)
DOWN, TOP, OVER = 0.02, 0.1, 0.12
"""m above the floor, of the TCP in the crate, of the crate's top, and a little above it."""


def to(y: float, z: float, zone=FINE) -> MoveL:
    target = PoseTarget(Pose((0.6, y, z), (0.0, 1.0, 0.0, 0.0)))
    return MoveL(target, Speed(tcp=0.5), zone, tool=GRIP)


@pytest.mark.parametrize("predefined", [(), tuple(Radius(1e-3 * r) for r in (5, 15, 30, 60))])
def test_a_tool_leaves_what_it_released_as_it_did(predefined) -> None:
    """It reaches down into the crate: a zone from there on would take it through its side."""
    program = Program(
        (
            to(0.2, 0.3),
            to(0.2, DOWN),
            Opaque("on", True),
            to(0.2, 0.3),
            to(-0.2, 0.3),
            to(-0.2, DOWN),
            Opaque("off", True),
            to(-0.2, OVER, Radius(0.001)),
            to(0.3, OVER),
        )
    )
    handling = handling_of(program, CELL)
    kept = [i for i, names in enumerate(handling.behind) if names]
    task = ZoneTask(
        handling=handling, kept=kept, clearance=0.0, rounding=Rounding(predefined=predefined)
    )
    made = maximize_zones(CONTROLLER, program, CELL, task)
    assert made.certificate is not None and made.certificate.proven
    assert 0.01 < made.program.moves[5].zone.tcp < OVER - TOP
    path = CONTROLLER.plan(made.program)
    q = path.q[path.sample_moves() == 5]
    scene = CollisionScene(CELL, GRIP, handling.arrangements[5])
    inside = scene.clearance(q, 1e-3) < 0.0
    assert inside.any()
    place = UR.forward(q[inside])[1]
    assert np.allclose(place[:, :2], (0.6, -0.2), atol=1e-5)
