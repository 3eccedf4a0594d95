"""Lines that turn the tool by half a turn, for which rounding decides which way round.

A program holds its numbers with few digits, so another controller may turn the other way. A target
that is a little nearer leaves no choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..motion.geometry.segments import Segments, make_segments
from ..motion.path.path import Route
from ..program.move import MoveL
from ..program.program import Program
from ..program.target import PoseTarget
from ..spatial.pose import Pose
from ..spatial.rotation import matrix_from_rotation_vector, rotation_vector
from .losses import LossesOfPart

NEARER = 2e-5
"""rad that a half turn is made smaller: many times what the digits of any language leave open."""
_SHORT = 1.0 - 1e-7
"""Share of a turn that is told from one the other way round, whatever is rounded."""


def decided(program: Program, route: Route, losses: LossesOfPart) -> Program:
    """The program with half turns a little smaller, in the way that the old robot goes.

    Args:
        program, route: on the old robot.
    """
    turns = _turns(make_segments(route.ends))
    moves, changed = list(program.moves), False
    before: FloatArray | None = None
    for k, i in enumerate(route.moves):
        move, start = moves[i], route.ends.rotation[k, 0]
        same_frame = k > 0 and _frames_agree(program, route.moves[k - 1 : k + 1])
        if before is not None and same_frame:
            start = before
        before = None
        if not isinstance(move, MoveL) or not isinstance(move.target, PoseTarget):
            continue
        end = _nearer(start, route.ends.rotation[k, 1], turns[k])
        if end is None:
            continue
        matrix = move.target.pose.matrix()
        matrix[:3, :3] = before = end
        pose = replace(Pose.from_matrix(matrix), position=move.target.pose.position)
        moves[i], changed = replace(move, target=replace(move.target, pose=pose)), True
        losses.at(
            i,
            "turns the tool by half a turn on a line, so that rounding decides the way round: the "
            f"target is {np.degrees(NEARER):.1g}° nearer, for the way that the old robot goes",
        )
    return program.with_moves(tuple(moves)) if changed else program


def _turns(segments: Segments) -> FloatArray:
    """(M, 3), how tools turn as a whole, the way round that their parts a and b go."""
    # All but half a turn leaves no doubt.
    parts = (_SHORT * segments.turn_a, _SHORT * segments.turn_b)
    one, other = (matrix_from_rotation_vector(part) for part in parts)
    return np.asarray(rotation_vector(one @ other))


def _frames_agree(program: Program, moves: Sequence[int]) -> bool:
    first, second = (program.moves[i] for i in moves)
    return (first.tool, first.work_object) == (second.tool, second.work_object)


def _nearer(start: FloatArray, end: FloatArray, turn: FloatArray) -> FloatArray | None:
    """Where to turn from ``start`` instead of ``end`` (3, 3); None if there is no doubt."""
    size = float(np.linalg.norm(turn))
    if size < np.pi - 2 * NEARER:
        return None
    left = rotation_vector(start.T @ end)
    if left @ turn > 0.0 and np.linalg.norm(left) < np.pi - 0.5 * NEARER:
        return None
    return np.asarray(start @ matrix_from_rotation_vector(turn / size * (np.pi - NEARER)))
