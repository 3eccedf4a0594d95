"""Values as KRL's aggregates, ``{X 100,Y 0,…}``: mm, degrees, kg, kg m².

Components and their order: "Quickguide KRL-Syntax" and published data lists.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import degrees

from ....core.errors import InputError
from ....core.program.target import Configuration, JointTarget, PoseTarget
from ....core.program.tool import Load
from ....core.robot.joint import JointKind
from ....core.robot.model import Robot
from ....core.source.text.axis_values import axis_values
from ....core.spatial.pose import Pose, Vector3
from ..motion.configuration import KukaConfiguration
from ..values.angles import written_angles
from ..values.types import external_fields
from .numbers import number

ARM_AXES = 6
EXTERNAL_AXES = 6
MM = 1e-3
NO_LOAD = "{M 0,CM {X 0,Y 0,Z 0,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}"


def frame(pose: Pose) -> str:
    """``FRAME``: ``{X,Y,Z,A,B,C}``."""
    return _braced(_pose(pose))


def e6pos(target: PoseTarget, robot: Robot) -> str:
    """``E6POS``: a frame, S and T where they are stated, and the external axes.

    Raises:
        InputError: the configuration is another vendor's, or there are more external values than
            axes.
    """
    parts = [*_pose(target.pose), *_status(target.configuration)]
    return _braced([*parts, *_external(target.external, robot)])


def e6axis(target: JointTarget, robot: Robot) -> str:
    """``E6AXIS``: ``{A1,…,A6,E1,…}``.

    Raises:
        InputError: another number of joints than six, or more external values than axes.
    """
    if len(target.joints) != ARM_AXES:
        raise InputError(
            f"an E6AXIS has {ARM_AXES} arm axes, but the target has {len(target.joints)}"
        )
    arm = [f"A{k} {number(v)}" for k, v in enumerate(axis_values(robot, target.joints), 1)]
    return _braced([*arm, *_external(target.external, robot)])


def load(value: Load | None) -> str:
    """``LOAD``: mass, centre and principal axes in the flange's frame, principal moments."""
    if value is None:
        return NO_LOAD
    centre = _braced(_pose(Pose(value.centre, value.axes)))
    moments = _braced(_named("XYZ", value.inertia))
    return _braced([f"M {number(value.mass)}", f"CM {centre}", f"J {moments}"])


def _pose(pose: Pose) -> list[str]:
    x, y, z = pose.position
    position: Vector3 = (x / MM, y / MM, z / MM)
    return [*_named("XYZ", position), *_named("ABC", written_angles(pose.quaternion))]


def _status(configuration: Configuration | None) -> list[str]:
    if configuration is None:
        return []
    if not isinstance(configuration, KukaConfiguration):
        raise InputError(
            f"{configuration} is no Status and Turn: label the target's solution for this robot, "
            "or take the configuration away"
        )
    stated = (("S", configuration.status), ("T", configuration.turn))
    return [f"{name} {value}" for name, value in stated if value is not None]


def _external(values: Sequence[float], robot: Robot) -> list[str]:
    axes = robot.external_axes
    if len(values) > min(len(axes), EXTERNAL_AXES):
        raise InputError(
            f"the target has {len(values)} external axes, {robot.name} has {len(axes)} of the "
            f"{EXTERNAL_AXES} that KRL knows"
        )
    linear = JointKind.PRISMATIC
    return [
        f"{name.upper()} {number(value / MM if axis.joint.kind is linear else degrees(value))}"
        for name, value, axis in zip(external_fields(robot), values, axes, strict=False)
    ]


def _named(names: str, values: Iterable[float]) -> list[str]:
    return [f"{name} {number(value)}" for name, value in zip(names, values, strict=True)]


def _braced(parts: Iterable[str]) -> str:
    return "{" + ",".join(parts) + "}"
