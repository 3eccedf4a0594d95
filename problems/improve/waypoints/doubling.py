"""Two via points in place of one, where the path hardly changes: room for another shape.

A controller's blends have one law. What a program can do beside that is to have more corners. A
new one in the middle of a leg would take the room from the zones beside it, which reach half way
in good programs; so the corner itself is cut off. The two points stand on its legs, within its
zone, and the path goes on between the old corner and its chord.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core.motion.geometry.corners import POSITION
from ....core.motion.geometry.segments import JOINT_SEGMENT, LINE_SEGMENT
from ....core.motion.path.path import Path
from ....core.program.move import Move, MoveC, MoveJ, MoveL, Statement
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget, Target
from ....core.program.zone import Radius, Zone
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import (
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)

_ALONG = 0.5
"""Share of the way from the corner to an edge of its zone at which a point stands."""
_ROOM = 0.45
"""Radius of both zones, as a share of the way between the points: less than half leaves room."""
_SMALLEST = 2e-3
"""m, radius that they have at least: a corner that has no room for them is left as it is."""


def doubled(program: Program, path: Path, index: int, arm_size: int) -> Program | None:
    """The program with two via points in place of one.

    Args:
        program: as it is driven.
        path: its path.
        index: of the move to the via point; the new move comes before it.
        arm_size: number of the arm's own joints.

    Returns:
        None where no corner is rounded or its zone is too small for two, where an arc begins or
        ends, or where external axes move on their own.
    """
    corner = path.route.zone_moves.index(index)
    before, after = _ALONG * path.corners.reach[corner, POSITION]
    if before <= 0.0 or after <= 0.0 or len(path.route.prescribed):
        return None
    first = _on_leg(path, corner, 1.0 - before, arm_size)
    second = _on_leg(path, corner + 1, after, arm_size)
    if first is None or second is None:
        return None
    move = program.moves[index]
    position = path.segments.ends.position
    way = before * (position[corner, 0] - position[corner, 1])
    if _alike(path, corner):
        way = way - after * (position[corner + 1, 1] - position[corner + 1, 0])
    else:
        second = move.target
    radius = _ROOM * float(np.linalg.norm(way))
    if radius < _SMALLEST:
        return None
    zone = _resized(move.zone, radius)
    # Both get data of their own: what other moves read stays as it is.
    plain = replace(move, zone=zone, origin=None)
    return _with(program, index, replace(plain, target=first), replace(plain, target=second))


def without(program: Program, index: int) -> Program:
    """The program without a move."""
    return _with(program, index)


def _with(program: Program, index: int, *moves: Move) -> Program:
    """The program with these moves in place of one."""
    statements: list[Statement] = list(program.statements)
    places = [k for k, s in enumerate(statements) if isinstance(s, MoveJ | MoveL | MoveC)]
    statements[places[index] : places[index] + 1] = moves
    return replace(program, statements=tuple(statements))


def _alike(path: Path, corner: int) -> bool:
    """Whether the move to the corner could also end on the leg after it."""
    kinds, chains = path.segments.ends.kind, path.route.chains
    return bool(kinds[corner] == kinds[corner + 1] and chains[corner] is chains[corner + 1])


def _on_leg(path: Path, segment: int, share: float, arm_size: int) -> Target | None:
    """A target at a share of a leg; None on arcs."""
    ends = path.segments.ends
    if ends.kind[segment] == JOINT_SEGMENT:
        q = ends.q[segment, 0] + share * path.segments.delta_q[segment]
        values = tuple(map(float, q))
        return JointTarget(values[:arm_size], values[arm_size:])
    if ends.kind[segment] != LINE_SEGMENT:
        return None
    p0, p1 = ends.position[segment]
    R0, R1 = ends.rotation[segment]
    turned = R0 @ matrix_from_rotation_vector(share * rotation_vector(R0.T @ R1))
    x, y, z = (float(v) for v in p0 + share * (p1 - p0))
    w, i, j, k = (float(v) for v in quaternion_from_matrix(turned))
    return PoseTarget(Pose((x, y, z), (w, i, j, k)))


def _resized(zone: Zone, radius: float) -> Zone:
    """A zone of this size; a share of the contour is none, and stays."""
    if not isinstance(zone, Radius):
        return zone
    return zone.resized(radius) if zone.tcp > 0.0 else Radius(radius)
