"""A stud welding station: 23 studs on a curved panel, four of them behind clamp towers (ours).

The robot goes from home over all studs and back: 24 motions from rest to rest, each a program of
its own. On four of them a clamp tower stands in the straight way, and two via points lead over it.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell, Obstacle
from ...core.cell.geometry import Geometry
from ...core.program.program import Program
from ...core.program.tool import Tool
from ...core.robot.shape import Box
from ...core.spatial.pose import Pose
from .arm import ALWAYS_TOUCHING, degrees_per_second, rod_shape, rod_tool, scene_arm
from .scene import Scene, joint_program, joint_target
from .solids import plate
from .stud_poses import HOME, STUDS, VIAS

VELOCITY = (100.0, 90.0, 90.0, 170.0, 120.0, 190.0)
"""degree/s."""
ACCELERATION = (3.1, 4.0, 9.2, 15.0, 12.0, 20.0)
"""rad/s²."""
RADII = (0.2, 0.2, 0.16, 0.09)
TOOL_LENGTH, TOOL_RADIUS = 0.45, 0.03
CLEARANCE = 0.005
STANDOFF = 0.03
"""m along the panel's normal from a stud to the tool's tip."""
STUD_PLACES = (
    *((1.3, y) for y in (-0.63, -0.45, -0.27, -0.09, 0.09, 0.27, 0.45, 0.63)),
    *((1.6, y) for y in (0.63, 0.45, 0.27, 0.09, -0.09, -0.27, -0.45, -0.63)),
    *((1.9, y) for y in (-0.63, -0.42, -0.21, 0.0, 0.21, 0.42, 0.63)),
)
"""x and y of the studs, m, in the order in which they are welded."""
PANEL_CENTRE, PANEL_HEIGHT, PANEL_RADIUS = 1.6, 0.8, 3.0
PANEL_LOWER, PANEL_UPPER = (1.2, -0.74), (2.0, 0.74)
"""m, corners of the panel seen from above."""
PANEL_THICKNESS, PANEL_GRID = 0.02, 0.04
"""m; triangles of this grid stand above the true panel by less than 0.1 mm."""
TOWER_SIZE, TOWER_FOOT, TOWER_TOP = (0.12, 0.05), -0.02, 0.25
"""m: edges along x and y, and where a tower begins and ends above the mean of its two studs."""


def panel_height(x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Height z of the panel, m: z₀ + (y² + (x − x_c)² / 2) / 2R."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    rise = y**2 + 0.5 * (x - PANEL_CENTRE) ** 2
    return np.asarray(PANEL_HEIGHT + rise / (2.0 * PANEL_RADIUS))


def panel_normal(x: float, y: float) -> FloatArray:
    """The panel's unit normal (3,), upwards."""
    slope = np.array([0.5 * (x - PANEL_CENTRE), y]) / PANEL_RADIUS
    normal = np.array([-slope[0], -slope[1], 1.0])
    return np.asarray(normal / np.linalg.norm(normal))


def stud_welding() -> Scene:
    """The station without the panel: towers only, the capsule of the tool ends round its tip."""
    return _scene("stud_welding", rod_shape((0.0, 0.0, TOOL_LENGTH), TOOL_RADIUS), _towers())


def stud_welding_with_panel() -> Scene:
    """The station with the panel as an obstacle.

    The tip stands 30 mm above the panel at each stud, and the capsule of the tool has a radius of
    30 mm: here it ends at the tip, not round it, or it would touch the panel at every stud.
    """
    panel = plate(panel_height, PANEL_LOWER, PANEL_UPPER, PANEL_GRID, PANEL_THICKNESS)
    obstacles = (*_towers(), Obstacle("panel", Geometry(panel)))
    shape = rod_shape((0.0, 0.0, TOOL_LENGTH - TOOL_RADIUS), TOOL_RADIUS)
    return _scene("stud_welding_with_panel", shape, obstacles)


def _scene(name: str, shape: Geometry, obstacles: tuple[Obstacle, ...]) -> Scene:
    tool = rod_tool("gun", TOOL_LENGTH)
    cell = Cell(
        robot=scene_arm(RADII, degrees_per_second(VELOCITY, ACCELERATION)),
        vendor="abb",
        clearance=CLEARANCE,
        tools={tool.name: tool},
        tool_geometries={tool.name: shape},
        obstacles=obstacles,
        allowed=ALWAYS_TOUCHING,
    )
    return Scene(name, cell, motions(tool), tool, free=(0, 1, 2, 3, 4, 5))


def motions(tool: Tool) -> tuple[Program, ...]:
    """The 24 motions; motion k ends at stud k, the last one at home."""
    stops = [
        joint_target(HOME, "home"),
        *(joint_target(stud, f"stud{k}") for k, stud in enumerate(STUDS)),
        joint_target(HOME, "home"),
    ]
    programs = []
    for k, (start, end) in enumerate(pairwise(stops)):
        vias = [joint_target(via, f"via{k}_{i}") for i, via in enumerate(VIAS.get(k, ()))]
        programs.append(joint_program(f"motion{k}", [start, *vias, end], tool))
    return tuple(programs)


def _towers() -> tuple[Obstacle, ...]:
    """One clamp tower half way along each motion that has via points."""
    return tuple(Obstacle(f"tower{k}", _tower(k)) for k in VIAS)


def _tower(motion: int) -> Geometry:
    """The tower between the studs of a motion."""
    places = np.array(STUD_PLACES[motion - 1 : motion + 1])
    x, y = (float(v) for v in places.mean(axis=0))
    height = float(panel_height(places[:, 0], places[:, 1]).mean())
    centre = height + 0.5 * (TOWER_FOOT + TOWER_TOP)
    return Geometry(Box((*TOWER_SIZE, TOWER_TOP - TOWER_FOOT)), Pose((x, y, centre)))
