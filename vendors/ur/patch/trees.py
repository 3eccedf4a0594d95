"""What is particular to programs that stand in trees of PolyScope.

A waypoint has joints, and its pose follows from them, so that its ``qnear`` is no free choice: it
is the joints at the new pose, in the posture that was asked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ....core.errors import FlybyError
from ....core.program.move import Move
from ....core.program.program import Program
from ....core.program.target import PoseTarget
from ....core.robot.model import Robot
from ....core.source.patch.edits import alike
from ....core.source.reading import Files
from ..motion.configuration import UrConfiguration
from ..urp.changes.tree_file import TreeFile
from ..urp.literals import Position


def trees_of(files: Files) -> dict[str, TreeFile]:
    """The trees among files, by name."""
    return {file.name: file for file in files.values() if isinstance(file, TreeFile)}


def with_taught_joints(
    program: Program, before: Program, trees: Mapping[str, TreeFile], robot: Robot
) -> Program:
    """The program whose moved waypoints have the joints that they will be stored with.

    Args:
        program: changed.
        before: as it was read.
        trees: that it was read of.
        robot: whose solutions are told apart.
    """
    if len(program.moves) != len(before.moves):
        return program
    pairs = zip(before.moves, program.moves, strict=True)
    return program.with_moves(tuple(_taught(old, new, trees, robot) for old, new in pairs))


def _taught(old: Move, new: Move, trees: Mapping[str, TreeFile], robot: Robot) -> Move:
    target = new.target
    if not isinstance(target, PoseTarget) or not isinstance(old.target, PoseTarget):
        return new
    near = target.configuration
    if not isinstance(near, UrConfiguration) or alike(old.target, target):
        return new
    found = _position(old, trees)
    if found is None:
        return new
    file, position = found
    joints = file.joints_at(position, target.pose, _solution(new, near.joints, robot))
    if joints is None:
        return new
    return replace(new, target=replace(target, configuration=UrConfiguration(joints)))


def _position(move: Move, trees: Mapping[str, TreeFile]) -> tuple[TreeFile, Position] | None:
    span = move.origin.target.numbers[:1] if move.origin is not None else ()
    if not span or span[0] is None or span[0].file not in trees:
        return None
    file = trees[span[0].file]
    position = file.position_at(span[0].start)
    return None if position is None else (file, position)


def _solution(move: Move, near: Sequence[float], robot: Robot) -> Sequence[float]:
    """The solution of the arm that the controller takes: the one nearest to ``qnear``."""
    assert isinstance(move.target, PoseTarget)
    flange = move.work_object.pose @ move.target.pose @ move.tool.tcp.inverse()
    try:
        found = robot.inverse(flange)
    except FlybyError:
        return (
            near  # out of reach by the robot of the catalogue, perhaps not by the arm's own table
        )
    wanted = np.array(near)
    all_turns = [one.q + 2.0 * np.pi * np.round((wanted - one.q) / (2.0 * np.pi)) for one in found]
    nearest = min(all_turns, key=lambda q: float(np.linalg.norm(q - wanted)))
    return [float(value) for value in nearest]
