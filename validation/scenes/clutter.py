"""A robot with a torch among pipes, gears, castings and clamps: a real six-axis path (ours).

The programs come first (`clutter_path`). Every thing then stands between two stations as near to
the arm's way as it may come (`clutter_layout`): near enough to forbid wide corners, and never
touching.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from ...core.cell.cell import Cell, Obstacle
from ...core.cell.geometry import Geometry
from ...core.motion.emulator.controller import Controller
from ...core.motion.geometry.pieces import Sampling
from ...core.program.move import MoveC
from ...core.program.program import Program
from ...core.program.tool import Tool
from ...core.registry import find_robot, find_vendor
from ...core.robot.model import Robot
from ...core.robot.shape import Box
from ...core.spatial.pose import Pose
from .arm import rod_shape
from .clutter_layout import arrange, thing
from .clutter_path import round_of_all, torch, tour
from .clutter_places import PLACES, SEED
from .scene import SECOND_ORDER_BLENDS, Scene
from .swept import SweptArm

ROBOT, VENDOR = "abb/irb6640-180-255", "abb"
CLEARANCE = 0.005
TORCH_RADIUS = 0.025
BENCH = Geometry(Box((1.3, 2.2, 0.05)), Pose((1.6, 0.0, 0.2)))
DENSE = Sampling(step=0.01, turn=0.05, joint=0.01, halvings=1)


def clutter(seed: int = SEED) -> Scene:
    """The scene with its short program: 17 moves, stops at every waypoint."""
    return _scene(seed, tour)


def clutter_100(seed: int = SEED) -> Scene:
    """The same cell with a program of a hundred waypoints through all stations."""
    return _scene(seed, round_of_all)


def _scene(seed: int, make: Callable[[Robot, Tool, int], Program]) -> Scene:
    tool, robot = torch(), find_robot(ROBOT)
    cell = Cell(
        robot=robot,
        vendor=VENDOR,
        clearance=CLEARANCE,
        tools={tool.name: tool},
        tool_geometries={tool.name: rod_shape(tool.tcp.position, TORCH_RADIUS)},
        obstacles=(Obstacle("bench", BENCH), *_things(seed)),
    )
    program = make(robot, tool, seed)
    arcs = tuple(k for k, move in enumerate(program.moves) if isinstance(move, MoveC))
    return Scene(program.name, cell, (program,), tool, tuple(range(robot.size)), process=arcs)


@cache
def _things(seed: int) -> tuple[Obstacle, ...]:
    """All things of a seed at their places."""
    places = PLACES if seed == SEED else arrange(swept_arm(seed), seed)
    obstacles = []
    for index, place in enumerate(places):
        mesh = thing(index, seed)
        obstacles.append(Obstacle(mesh.file.stem, Geometry(mesh, place)))
    return tuple(obstacles)


def swept_arm(seed: int) -> SweptArm:
    """Everything that the robot takes up on the ways of both programs."""
    tool, robot = torch(), find_robot(ROBOT)
    controller = Controller(find_vendor(VENDOR), robot, SECOND_ORDER_BLENDS, DENSE)
    ways = [controller.plan(make(robot, tool, seed)).q for make in (tour, round_of_all)]
    return SweptArm(robot, rod_shape(tool.tcp.position, TORCH_RADIUS), np.concatenate(ways))
