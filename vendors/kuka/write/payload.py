"""The one load on the flange that KRL knows, ``$LOAD``, out of a tool's and a payload's."""

from __future__ import annotations

from ....core.program.move import Move
from ....core.program.tool import Load
from ....core.robot.inertia import carried_inertia
from ....core.spatial.pose import Pose


def flange_load(move: Move) -> Load | None:
    """What the flange carries along a move, in the flange's frame; None for nothing."""
    tool = move.tool.load if move.tool.robot_held else None
    if move.load is None:
        return tool
    if tool is None:
        held = move.tool.tcp if move.tool.robot_held else move.work_object.pose
        return _placed(move.load, held)
    return Load.of_body(carried_inertia(move.tool, move.load))


def _placed(load: Load, frame: Pose) -> Load:
    """A load declared in ``frame``, seen from the flange."""
    at = frame @ Pose(load.centre, load.axes)
    return Load(load.mass, at.position, load.inertia, at.quaternion, load.name)
