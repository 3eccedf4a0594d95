"""Where work objects may stand, and how long tools may be, that nobody knows and a program needs.

The controllers' own defaults (the base's frame, the flange) are taken for those. Where they leave
targets out of reach, a place is looked for from which the arm drives the program: an example for
whoever has to say what it is, and no measurement.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import permutations, product

import numpy as np

from ..arrays import FloatArray
from ..errors import FlybyError
from ..motion.emulator.controller import Controller
from ..program.assumed_places import assumed_places
from ..program.move import Move, MoveC
from ..program.program import Program
from ..program.target import JointTarget, PoseTarget
from ..robot.ready_posture import ready_posture
from ..spatial.pose import Pose
from .past_faults import ENOUGH, count_faults

LONGEST = 80
"""Moves of a program for which places are looked for."""
_DRIVEN = 6
"""Places that are driven from, of those from which all targets are reached."""
_SHARES = (1.0, 1.25, 0.75, 1.5)
"""Of the distance at which an arm is ready."""
_HEIGHTS = (0.0, -0.25, 0.25, -0.5)
"""Shares of that distance by which it stands higher."""
_LENGTHS = (0.1, 0.2, 0.3, 0.45)
"""m of a tool."""
_ROUND = 2
"""Decimals, m."""


def frames_that_fit(
    controller: Controller, program: Program, start: JointTarget | None = None
) -> dict[str, Pose]:
    """Poses of unknown work objects, and TCPs of unknown tools, with which an arm drives a program.

    Returns:
        By the keys of the questions; nothing where the defaults do, or no place is found that does
        better than they.
    """
    if not 0 < len(program.moves) <= LONGEST or controller.robot.external_axes:
        return {}
    least = count_faults(controller, program, start, ENOUGH)
    found: dict[str, Pose] = {}
    for key, tool in _unknown(program):
        if not least:
            break
        fitting = _places(controller, program, key, tool)
        for pose, _ in zip(fitting, range(_DRIVEN), strict=False):
            moved = _with(program, key, pose)
            faults = count_faults(controller, moved, start, least)
            if faults < least:
                least, found[key], program = faults, pose, moved
            if not least:
                break
    return found


def placed(program: Program, found: Mapping[str, Pose]) -> Program:
    """A program with its unknown tools and work objects at such poses, which are still unknown."""
    for key, pose in found.items():
        program = _with(program, key, pose)
    return replace(program, placed=(*program.placed, *found))


def _unknown(program: Program) -> list[tuple[str, bool]]:
    """Work objects, then tools that are at their default: the key, and whether it is a tool."""
    found: dict[tuple[str, bool], None] = {}
    for index, keys in assumed_places(program).items():
        move = program.moves[index]
        for key in keys:
            found[key, key.casefold() == move.tool.name.casefold()] = None
    return sorted(found, key=lambda item: item[1])


def _with(program: Program, key: str, pose: Pose) -> Program:
    """The program with an unknown tool or work object as a pose."""
    asked = assumed_places(program)
    moves: list[Move] = []
    for index, move in enumerate(program.moves):
        changed = move
        if key in asked.get(index, ()):
            if move.tool.name.casefold() == key.casefold():
                changed = replace(move, tool=replace(move.tool, tcp=pose))
            else:
                changed = replace(move, work_object=replace(move.work_object, user=pose))
        moves.append(changed)
    return program.with_moves(tuple(moves))


def _places(controller: Controller, program: Program, key: str, tool: bool) -> Iterator[Pose]:
    """Poses with which all targets that hang on a tool or work object are reached."""
    asked = assumed_places(program)
    mine = [m for k, m in enumerate(program.moves) if key in asked.get(k, ()) and not m.open]
    mine = [m for m in mine if m.tool.robot_held and not m.work_object.robot_held]
    goals = list(dict.fromkeys((m.tool, m.work_object, goal) for m in mine for goal in _goals(m)))
    if not goals:
        return
    if tool:
        places = [frame.pose @ goal for _, frame, goal in goals]
        for tcp in _tools():
            if _reached(controller, (place @ tcp.inverse() for place in places)):
                yield tcp
        return
    places = [goal @ own.tcp.inverse() for own, _, goal in goals]
    middle = np.mean([place.position for place in places], axis=0)
    for frame in _frames(controller, middle):
        if _reached(controller, (frame @ place for place in places)):
            yield frame


def _goals(move: Move) -> list[Pose]:
    targets = [move.target, *([move.via] if isinstance(move, MoveC) else [])]
    return [target.pose for target in targets if isinstance(target, PoseTarget)]


def _reached(controller: Controller, flanges: Iterable[Pose]) -> bool:
    try:
        return all(controller.robot.inverse(flange) for flange in flanges)
    except FlybyError:
        return False


def _tools() -> Iterator[Pose]:
    for length, turn in product(_LENGTHS, _turns()):
        R = np.eye(4)
        R[:3, :3], R[2, 3] = turn, length
        yield Pose.from_matrix(R)


def _frames(controller: Controller, middle: FloatArray) -> Iterator[Pose]:
    """Frames that put the middle of the targets to where the arm is ready, the plainest first."""
    posture = ready_posture(controller.robot)
    if posture is None:
        return
    ready = controller.robot.flange_pose(np.array(posture)).position
    far = float(np.hypot(ready[0], ready[1]))
    for turn, share, height in product(_turns(), _SHARES, _HEIGHTS):
        at = np.array([share * ready[0], share * ready[1], ready[2] + height * far])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = turn, np.round(at - turn @ middle, _ROUND)
        yield Pose.from_matrix(T)


def _turns() -> list[FloatArray]:
    """The turns by quarters, those that change least first."""
    found = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            turn = np.zeros((3, 3))
            turn[range(3), order] = signs
            if np.linalg.det(turn) > 0:
                found.append(turn)
    return sorted(found, key=lambda turn: (-np.trace(turn), -turn[2, 2]))
