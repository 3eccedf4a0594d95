"""Programs of the cluttered scene: a torch goes to stations on a bench and draws an arc at each."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.program.move import Move, MoveC, MoveJ, MoveL
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import Load, Tool
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_rotation_vector
from .scene import joint_target

HOME = (0.0, -15.0, 15.0, 0.0, 60.0, 0.0)
"""degree."""
COLUMNS, ROWS = (1.2, 1.4, 1.6, 1.8, 2.0), (-0.72, -0.36, 0.0, 0.36, 0.72)
"""m, x and y of the stations."""
HEIGHT, DIVE = 0.65, 0.35
"""m: z of the arcs, and how far above them the torch comes and goes."""
ARC_RADIUS = 0.04
TILT = math.radians(12.0)
"""Largest tilt of a station's tool about x and y."""
FAST = Speed(tcp=1.5, reorientation=math.radians(500.0), name="fast")
"""Of all moves but arcs."""
PROCESS = Speed(tcp=0.25, reorientation=math.radians(500.0), name="process")
"""Of the arcs."""
TOUR = (6, 8, 18, 16)
"""Stations of the short program."""
POINTS_A_STATION = 4


def torch() -> Tool:
    """A torch of 20 kg, its tip 0.42 m before the flange, 0.1 m beside its axis, tilted by 22°."""
    turn = (math.cos(math.radians(11.0)), 0.0, math.sin(math.radians(11.0)), 0.0)
    load = Load(20.0, (0.03, 0.0, 0.15), (0.1625, 0.1625, 0.025))
    return Tool("torch", Pose((0.1, 0.0, 0.42), turn), load)


@dataclass(frozen=True)
class Station:
    """A place on the bench.

    Args:
        index: number of the station, in the order of the long program.
        pose: middle of the arc: z of the tool downwards into the work, the arc in its x-y plane.
    """

    index: int
    pose: Pose

    def at(self, x: float, y: float, back: float = 0.0) -> Pose:
        """The pose moved by x and y in its own plane and drawn back along the tool, m."""
        return self.pose @ Pose((x, y, -back))


def stations(seed: int) -> tuple[Station, ...]:
    """All stations, column by column to and fro; the tilt of each comes from the seed."""
    rng = np.random.default_rng(seed)
    found: list[Station] = []
    for column, x in enumerate(COLUMNS):
        rows = ROWS if column % 2 == 0 else ROWS[::-1]
        found += [Station(len(found) + k, _pose(x, y, rng)) for k, y in enumerate(rows)]
    return tuple(found)


def _pose(x: float, y: float, rng: np.random.Generator) -> Pose:
    """Tool downwards, its x axis towards the robot, tilted a little, at another height."""
    downwards = np.diag([-1.0, 1.0, -1.0])
    outwards = matrix_from_rotation_vector(np.array([0.0, 0.0, math.atan2(y, x)]))
    tilt = matrix_from_rotation_vector(np.array([*rng.uniform(-TILT, TILT, 2), 0.0]))
    matrix = np.eye(4)
    matrix[:3, :3] = outwards @ tilt @ downwards
    matrix[:3, 3] = x, y, HEIGHT + rng.uniform(-0.05, 0.05)
    return Pose.from_matrix(matrix)


def tour(robot: Robot, tool: Tool, seed: int) -> Program:
    """Sixteen moves through four stations and one back home."""
    places = stations(seed)
    moves = _moves(robot, tool, (places[k] for k in TOUR))
    home = joint_target(HOME, "home")
    back = MoveJ(target=home, speed=FAST, tool=tool)
    return Program((*moves, back), name="clutter", start=home)


def round_of_all(robot: Robot, tool: Tool, seed: int) -> Program:
    """A hundred moves through all stations."""
    moves = _moves(robot, tool, stations(seed))
    return Program(tuple(moves), name="clutter_100", start=joint_target(HOME, "home"))


def _moves(robot: Robot, tool: Tool, places: Iterable[Station]) -> list[Move]:
    """Above each station, down, round an arc, up again."""
    moves: list[Move] = []
    q = np.radians(HOME)
    for place in places:
        q = nearest(robot, tool, place.at(-ARC_RADIUS, 0.0, DIVE), q)
        moves += _at_station(place, q, tool)
    return moves


def _at_station(place: Station, above: FloatArray, tool: Tool) -> list[Move]:
    k, r = place.index, ARC_RADIUS
    joints = JointTarget(tuple(float(v) for v in above), name=f"above{k}")
    return [
        MoveJ(target=joints, speed=FAST, tool=tool),
        MoveL(target=PoseTarget(place.at(-r, 0.0), name=f"begin{k}"), speed=FAST, tool=tool),
        MoveC(
            target=PoseTarget(place.at(r, 0.0), name=f"end{k}"),
            via=PoseTarget(place.at(0.0, r), name=f"round{k}"),
            speed=PROCESS,
            tool=tool,
        ),
        MoveL(target=PoseTarget(place.at(r, 0.0, DIVE), name=f"leave{k}"), speed=FAST, tool=tool),
    ]


def nearest(robot: Robot, tool: Tool, pose: Pose, q: FloatArray) -> FloatArray:
    """The configuration (6,) of q's own branch that brings the tool's tip to a pose.

    Raises:
        InputError: there is none.
    """
    found = [s.q for s in robot.inverse(pose @ tool.tcp.inverse())]
    alike = [other for other in found if other[4] * q[4] > 0 and abs(other[0] - q[0]) < np.pi / 2]
    if not alike:
        raise InputError(f"{robot.name} cannot reach {pose} without folding over")
    return min(alike, key=lambda other: float(np.abs(other - q).max()))
