"""Start and goal of a planned path: every configuration that is one, and why others are not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.scene.scene import CollisionScene
from ....core.errors import InputError, MotionError
from ....core.program.target import JointTarget, PoseTarget, Target
from ....core.program.tool import Tool, WorkObject
from ....core.robot.inverse.solution import UnreachableError
from ....core.robot.model import Robot
from ....core.spatial.pose import Pose
from .free_space import FreeSpace

SLACK = 1e-9
"""rad or m by which a joint value may pass its limit."""


@dataclass(frozen=True)
class PathEnd:
    """One end of a path.

    Args:
        name: ``start`` or ``goal``.
        configurations: of the arm, (n,) each, all free.
    """

    name: str
    configurations: tuple[FloatArray, ...]


def check_coupled(robot: Robot) -> None:
    """Refuse an arm with ranges of several joints together, which no search holds.

    Raises:
        InputError: it has one.
    """
    for coupled in robot.coupled_ranges:
        raise InputError(
            f"motions of {robot.name} are not searched freely: {coupled.shown()}, which the search "
            "does not hold"
        )


def external_values(robot: Robot, start: Target, goal: Target) -> tuple[float, ...]:
    """What the external axes stand at all along; those that neither end states, at zero.

    Raises:
        InputError: start and goal want different values, or there are too many.
    """
    count = len(robot.external_axes)
    rows = [(*end.external, *(0.0,) * (count - len(end.external))) for end in (start, goal)]
    if max(map(len, rows)) > count:
        raise InputError(
            f"{robot.name} has {count} external axes; start or goal give values of more"
        )
    if rows[0] != rows[1]:
        raise InputError(
            "paths are planned with the external axes at rest, but start and goal want different "
            "values of them; move them before or after"
        )
    return rows[0]


def free_end(
    name: str,
    target: Target,
    tool: Tool,
    work_object: WorkObject,
    space: FreeSpace,
    external: tuple[float, ...],
) -> PathEnd:
    """The configurations of a target that are free; all branches and turns of a pose.

    Raises:
        InputError: the target does not fit the robot.
        UnreachableError: no configuration of the arm brings the tool there.
        MotionError: all of them collide or come too near to something; the message says to what.
    """
    robot = space.scene.robot
    if isinstance(target, JointTarget):
        found = [_joint_values(name, robot, target)]
    else:
        found = _branches(name, robot, _flange(name, target, tool, work_object), external)
    free = tuple(q for q in found if space.keeps(q))
    if free:
        return PathEnd(name, free)
    blocks = list(dict.fromkeys(_why_not(space, q) for q in found))
    if len(found) == 1:
        raise MotionError(f"the {name} is not free: {blocks[0]}")
    raise MotionError(
        f"none of the {len(found)} configurations of the {name} is free: {'; '.join(blocks)}"
    )


def _joint_values(name: str, robot: Robot, target: JointTarget) -> FloatArray:
    """The target's joints, within their limits."""
    q = np.array(target.joints)
    if q.shape != (robot.arm_size,):
        raise InputError(
            f"the {name} has {q.size} joint values; {robot.name} has {robot.arm_size} joints"
        )
    for joint, value in zip(robot.joints, q, strict=True):
        if not joint.lower - SLACK <= value <= joint.upper + SLACK:
            raise InputError(
                f"the {name}: joint {joint.name} at {joint.shown(value)} is outside "
                f"{joint.shown(joint.lower)} to {joint.shown(joint.upper)}"
            )
    return q


def _flange(name: str, target: PoseTarget, tool: Tool, work_object: WorkObject) -> Pose:
    """The flange in the world."""
    if not tool.robot_held or work_object.robot_held or work_object.moved_by is not None:
        raise InputError(
            f"the {name}: poses to plan to are those of a tool that the robot holds, in a work "
            "object that stands still; give joint values instead"
        )
    return work_object.pose @ target.pose @ tool.tcp.inverse()


def _branches(name: str, robot: Robot, flange: Pose, external: Sequence[float]) -> list[FloatArray]:
    try:
        solutions = robot.inverse(flange, external)
    except UnreachableError as error:
        raise UnreachableError(f"the {name}: {error.message}", error.distance) from None
    return [turn for solution in solutions for turn in robot.turns(solution.q)]


def _why_not(space: FreeSpace, arm: FloatArray) -> str:
    """What is in the way of a configuration of the arm (n,)."""
    q = space.configurations(arm[None])
    contact = space.scene.contact(q[0])
    if contact is not None:
        return str(contact)
    return _nearest(space.scene, q, space.clearance)


def _nearest(scene: CollisionScene, q: FloatArray, clearance: float) -> str:
    found = scene.distances(q, clearance + 1e-3).distance[0]
    pair = int(found.argmin())
    first, second = scene.pair_names(pair)
    return (
        f"{first} and {second} are {1e3 * found[pair]:.3g} mm apart, less than the clearance of "
        f"{1e3 * clearance:.3g} mm"
    )
