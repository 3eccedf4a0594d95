"""Zones of rounded programs: none so large that the controller leaves its waypoint out."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.problems.improve.rounding import Rounding
from flyby.problems.improve.waypoints.aim import driven_moves, with_room
from flyby.problems.improve.waypoints.changeable import select
from flyby.problems.improve.waypoints.options import WaypointTask
from flyby.problems.improve.waypoints.variables import make_variables

CONTROLLER = Controller(find_vendor("ur"), find_robot("ur/ur10e"))
HOME = JointTarget((0.0, -1.5708, 1.5708, -1.5708, -1.5708, 0.0))
DOWN = (0.0, 1.0, 0.0, 0.0)
SPEED = Speed(tcp=0.2)


def at(x: float, z: float) -> PoseTarget:
    return PoseTarget(Pose((x, 0.35, z), DOWN))


@settings(max_examples=10, deadline=None)
@given(
    st.floats(0.0, 1e-5), st.floats(1e-9, 3e-6), st.floats(0.0, np.pi / 2), st.floats(0.001, 0.02)
)
def test_no_waypoint_is_left_out_for_the_sake_of_rounding(
    off: float, spare: float, way: float, larger: float
) -> None:
    """The least zone just fits its last leg, the zone before it just the leg between."""
    least = 1e-3
    last, leg = at(-0.45, 0.15), least + spare
    second = at(-0.45 + off + leg * np.sin(way), 0.15 + leg * np.cos(way))
    first = at(second.pose.position[0], second.pose.position[2] + larger + least + spare)
    program = Program(
        (
            MoveJ(first, Speed(joint=1.0), Radius(larger, larger, larger)),
            MoveL(second, SPEED, Radius(least, least, least)),
            MoveL(last, SPEED, FINE),
        ),
        start=HOME,
    )
    path = CONTROLLER.plan(program)
    selection = select(program, path, CONTROLLER.robot, WaypointTask())
    variables = make_variables(program, CONTROLLER.robot, selection, WaypointTask())
    # Numbers that change are rounded.
    x = variables.start + np.where(variables.scale == 0.1, 1e-7, 0.0)
    moves = driven_moves(CONTROLLER.plan, variables, x)

    def written(values: np.ndarray) -> Program:
        return variables.written(values, Rounding())

    room = with_room(x, variables, lambda values: CONTROLLER.plan(written(values)), moves)
    assert moves <= set(CONTROLLER.plan(written(room)).route.moves)
