"""Hypothesis strategy of programs whose zones are large for their legs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from ..core.arrays import FloatArray
from ..core.program.arc_orientation import ArcOrientation
from ..core.program.move import MoveC, MoveJ, MoveL, Statement
from ..core.program.program import Program
from ..core.program.speed import Speed
from ..core.program.target import PoseTarget
from ..core.program.zone import FINE, Radius, Zone
from ..core.robot.model import Robot
from .strategies import joint_target, make_an_arc


@st.composite
def crowded_programs(
    draw: st.DrawFn, robot: Robot, q: FloatArray, joint: Speed, path: Speed, turning: ArcOrientation
) -> Program:
    """Programs whose zones are large for their legs: lines, arcs and joint moves of millimetres to
    decimetres, all turned alike, whose zones are few, so that many of them are one datum.

    Args:
        robot: the robot.
        q: (N,), a regular configuration that they stay near.
        joint, path: speeds of joint moves, and of lines and arcs.
        turning: of the tool along arcs.
    """
    statements: list[Statement] = [MoveJ(joint_target(robot, q), joint, FINE)]
    home = robot.flange_pose(q)
    shared = draw(st.lists(st.integers(2, 60), min_size=1, max_size=2))
    radii = st.sampled_from([0.0, 0.001, *(1e-3 * radius for radius in shared)])
    place = np.array(home.position)
    count = draw(st.integers(3, 6))
    for number in range(count):
        zone: Zone = FINE
        if number < count - 1:
            radius = draw(radii)
            zone = Radius(radius) if radius else FINE
        step = draw(st.sampled_from([0.004, 0.01, 0.03, 0.1]))
        way = np.array([draw(st.floats(-1.0, 1.0, allow_subnormal=False)) for _ in range(3)])
        assume(np.linalg.norm(way) > 0.3)
        place = np.clip(place + step * way, np.array(home.position) - 0.12, None)
        place = np.minimum(place, np.array(home.position) + 0.12)
        x, y, z = (round(float(v), 5) for v in place)
        end = replace(home, position=(x, y, z))
        kind = draw(st.sampled_from([MoveL, MoveL, MoveC, MoveJ]))
        if kind is MoveC:
            begin = replace(home, position=_end_of(statements[-1], robot))
            last = np.array(begin.position)
            side = np.array([draw(st.floats(-1.0, 1.0, allow_subnormal=False)) for _ in range(3)])
            via = 0.5 * (last + place) + 0.4 * step * side
            a, b, c = (round(float(v), 5) for v in via)
            middle = replace(home, position=(a, b, c))
            if make_an_arc(begin, middle, end):
                arc = MoveC(
                    PoseTarget(end),
                    path,
                    zone,
                    via=PoseTarget(middle),
                    orientation=turning,
                )
                statements.append(arc)
                continue
            kind = MoveL
        if kind is MoveJ:
            rows = [s.q for s in robot.inverse(end)]
            nearest = min(rows, key=lambda row: float(np.abs(row - q).max()))
            statements.append(MoveJ(joint_target(robot, np.round(nearest, 6)), joint, zone))
        else:
            statements.append(MoveL(PoseTarget(end), path, zone))
    return Program(tuple(statements))


def _end_of(statement: Statement, robot: Robot) -> tuple[float, float, float]:
    """Where the flange is at the end of a move."""
    assert isinstance(statement, MoveJ | MoveL | MoveC)
    target = statement.target
    if isinstance(target, PoseTarget):
        return target.pose.position
    return robot.flange_pose(target.joints).position
