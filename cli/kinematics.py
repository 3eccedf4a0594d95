"""``flyby fk`` and ``flyby ik``: where the TCP is, and how the arm reaches it."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..tasks import catalogue
from ..tasks.options import texts
from ..tasks.options.texts import fixed
from .output.console import print_json, print_rich, print_table, warn

if TYPE_CHECKING:
    from ..core.program.target import Configuration
    from ..core.robot.inverse.solution import InverseSolution
    from ..core.robot.model import Robot
    from ..core.spatial.pose import Pose

RobotName = Annotated[
    str,
    typer.Argument(
        help="Robot, such as abb/irb6640-180-255, or its file: a catalogue file, a URDF, a KUKA's "
        "$machine.dat."
    ),
]
VendorName = Annotated[
    str | None,
    typer.Option(
        "--vendor", help="Whose controller drives the robot, where its file does not say."
    ),
]
ToolPose = Annotated[
    str | None,
    typer.Option(
        "--tool", help="TCP in the flange's frame, as a pose like POSE of 'flyby ik'; none: flange."
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, in SI units.")]


def fk(
    robot: RobotName,
    joints: Annotated[str, typer.Argument(help="Joint values in degrees: q1,q2,…")],
    tool: ToolPose = None,
    vendor: VendorName = None,
    json: AsJson = False,
) -> None:
    """Forward kinematics: the TCP in the robot's base, and the configuration's name."""
    arm = catalogue.robot(robot, vendor)
    q = texts.configuration(joints, "joint values", arm)
    _warn_beyond_limits(arm, q)
    tcp = arm.flange_pose(q) @ _tool(tool)
    label = _label(arm, q)
    if json:
        print_json(
            {
                "robot": arm.name,
                "joints_rad": q,
                "position_m": tcp.position,
                "quaternion_wxyz": tcp.quaternion,
                "configuration": _label_json(label),
            }
        )
        return
    position = ", ".join(fixed(1e3 * value, 3) for value in tcp.position)
    print_rich(f"position    {position} mm")
    print_rich("quaternion  " + ", ".join(fixed(value, 6) for value in tcp.quaternion))
    print_rich("rx, ry, rz  " + ", ".join(f"{fixed(value, 4)}°" for value in _turns(tcp)))
    if _label_text(label):
        print_rich(f"configuration  {_label_text(label)}")


def ik(
    robot: RobotName,
    pose: Annotated[
        str,
        typer.Argument(
            help="TCP in the robot's base: x,y,z,qw,qx,qy,qz or x,y,z,rx,ry,rz "
            "(mm; degrees about the fixed x, then y, then z) or x,y,z."
        ),
    ],
    tool: ToolPose = None,
    vendor: VendorName = None,
    json: AsJson = False,
) -> None:
    """Inverse kinematics: all configurations within limits that reach a pose."""
    arm = catalogue.robot(robot, vendor)
    flange = texts.pose(pose, "pose") @ _tool(tool).inverse()
    solutions = arm.inverse(flange)
    labels = [_label(arm, tuple(map(float, s.q))) for s in solutions]
    if arm.arm_size != 6 or arm.recognised is None:
        warn(f"the solutions of {arm.name} are found by search: there may be others")
    if json:
        print_json(
            {
                "robot": arm.name,
                "solutions": [
                    _solution_json(solution, label)
                    for solution, label in zip(solutions, labels, strict=True)
                ],
            }
        )
        return
    units = texts.axis_units(arm)
    heads = [f"{name} {unit}" for name, (unit, _) in zip(arm.axis_names, units, strict=True)]
    print_table(
        (*((head, "right") for head in heads), ("configuration", "left"), ("singular", "left")),
        [
            (
                *(fixed(v / scale, 3) for v, (_, scale) in zip(s.q, units, strict=True)),
                _label_text(label),
                ", ".join(sorted(s.singular)),
            )
            for s, label in zip(solutions, labels, strict=True)
        ],
    )


def _tool(text: str | None) -> Pose:
    from ..core.spatial.pose import IDENTITY

    return IDENTITY if text is None else texts.pose(text, "--tool")


def _label(robot: Robot, q: tuple[float, ...]) -> Configuration | None:
    import numpy as np

    return catalogue.driver_of(robot).label(robot, np.array(q))


def _label_json(label: Configuration | None) -> dict[str, Any] | None:
    """The parts that a vendor's configuration is compared and shown by."""
    if label is None or not dataclasses.is_dataclass(label):
        return None if label is None else {"label": str(label)}
    shown = [field.name for field in dataclasses.fields(label) if field.repr]
    return {name: getattr(label, name) for name in shown}


def _label_text(label: Configuration | None) -> str:
    """The same in one line; parts that are whole lists (UR's joint values) say nothing new."""
    parts = _label_json(label) or {}
    if any(isinstance(part, str) for part in parts.values()):
        return str(label)  # words that a controller shows
    return " ".join(f"{k}={v}" for k, v in parts.items() if not isinstance(v, tuple))


def _solution_json(solution: InverseSolution, label: Configuration | None) -> dict[str, Any]:
    branch = solution.branch
    return {
        "joints_rad": [float(value) for value in solution.q],
        "configuration": _label_json(label),
        "branch": None if branch is None else dataclasses.asdict(branch),
        "singular": sorted(solution.singular),
    }


def _turns(pose: Pose) -> tuple[float, float, float]:
    """Degrees about the fixed x, y and z axes, R = Rz Ry Rx."""
    m = pose.matrix()
    pitch = math.atan2(-m[2, 0], math.hypot(m[0, 0], m[1, 0]))
    if math.hypot(m[0, 0], m[1, 0]) < 1e-9:
        # Turns about x and z fall together: all of it about z.
        roll, yaw = 0.0, math.atan2(-m[0, 1], m[1, 1])
    else:
        roll, yaw = math.atan2(m[2, 1], m[2, 2]), math.atan2(m[1, 0], m[0, 0])
    return math.degrees(roll), math.degrees(pitch), math.degrees(yaw)


def _warn_beyond_limits(robot: Robot, q: tuple[float, ...]) -> None:
    for joint, value in zip(robot.joints, q, strict=True):
        if not joint.lower <= value <= joint.upper:
            warn(f"{joint.name} is outside its range")
