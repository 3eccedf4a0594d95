"""Two joints round a box: the smallest scene that has everything (numbers ours).

Joints 2 and 3 of an IRB 6640-180/2.55 move the tool in the plane y = 0 from one side of a box to
the other, over three via points that somebody has placed with a generous hand.
"""

from __future__ import annotations

from ...core.cell.cell import Cell, Obstacle
from ...core.cell.geometry import Geometry
from ...core.program.target import JointTarget
from ...core.robot.shape import Box
from ...core.spatial.pose import Pose
from .arm import ALWAYS_TOUCHING, degrees_per_second, rod_shape, rod_tool, scene_arm
from .scene import Scene, joint_program, joint_target

VELOCITY = (90.0, 90.0)
"""degree/s of joints 2 and 3."""
ACCELERATION = (4.0, 9.2)
"""rad/s²."""
RADII = (0.2, 0.2, 0.16, 0.1)
TOOL_LENGTH, TOOL_RADIUS = 0.3, 0.05
BOX_LOWER, BOX_UPPER = (1.5, -0.6, 0.0), (1.65, 0.6, 0.75)
CLEARANCE = 0.005
START = (-4.190250160656601, 69.0621685428542)
"""degree, joints 2 and 3; the TCP at x 1.12, z 0.45."""
END = (38.266183927545704, 11.46697496741543)
"""The TCP at x 2.2, z 0.5."""
VIAS = (
    (-21.065325913536334, 62.338449528653555),
    (-4.7394220193631815, 42.64659805035402),
    (22.294999645313332, 18.621490138922418),
)
"""The TCP at x 1.3, z 0.85, then 1.65, 1.0 and 2.1, 0.85."""
FREE_JOINTS = (1, 2)


def two_joints() -> Scene:
    """The scene; its one program stops at every via point."""
    tool = rod_tool("rod", TOOL_LENGTH)
    centre = tuple(0.5 * (a + b) for a, b in zip(BOX_LOWER, BOX_UPPER, strict=True))
    edges = tuple(b - a for a, b in zip(BOX_LOWER, BOX_UPPER, strict=True))
    box = Geometry(Box((edges[0], edges[1], edges[2])), Pose((centre[0], centre[1], centre[2])))
    cell = Cell(
        robot=scene_arm(RADII, degrees_per_second(VELOCITY, ACCELERATION, first=1)),
        vendor="abb",
        clearance=CLEARANCE,
        tools={tool.name: tool},
        tool_geometries={tool.name: rod_shape((0.0, 0.0, TOOL_LENGTH), TOOL_RADIUS)},
        obstacles=(Obstacle("box", box),),
        allowed=(*ALWAYS_TOUCHING, ("J4", tool.name)),
    )
    points = [_target(degrees, f"p{k}") for k, degrees in enumerate((START, *VIAS, END))]
    return Scene(
        "two_joints", cell, (joint_program("two_joints", points, tool),), tool, FREE_JOINTS
    )


def _target(degrees: tuple[float, float], name: str) -> JointTarget:
    """A target at the values of joints 2 and 3, all others at zero."""
    return joint_target((0.0, *degrees, 0.0, 0.0, 0.0), name)
