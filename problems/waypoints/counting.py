"""The number of via points: idle ones are left out, others are added where they pay."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...core.collision.verdict import Certificate
from ...core.motion.controller import Run
from ...core.motion.path import Path
from ...core.motion.segments import JOINT_SEGMENT, LINE_SEGMENT
from ...core.program.move import Move, MoveC, MoveJ, MoveL, Statement
from ...core.program.program import Program
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.zone import Radius
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import (
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)
from .options import Effort, Task
from .selection import Selection

_SERVES_NOTHING = 1e-4
"""Share of the cost that a via point must save to stay."""
_PAYS = 2e-3
"""Share of the cost that a new via point must save."""
_MOST_CHANGES = 6
_BRIEF = 30
"""Iterations of a search without a via point, from the optimum with it."""
_ZONE = 0.25
"""Share of the way to the nearer neighbour that a new via point's zone begins with."""
_SMALLEST = 2e-3


@dataclass(frozen=True)
class Counted:
    """A proven program.

    Args:
        run: the program, driven.
        certificate: of the run.
        cost: its objective.
        task: with the indices of its moves.
    """

    run: Run
    certificate: Certificate
    cost: float
    task: Task


Improved = Callable[[Program, Task, Effort], Counted | None]
Selected = Callable[[Counted], Selection]


def change_count(best: Counted, improved: Improved, selected: Selected, effort: Effort) -> Counted:
    """The program with as many via points as it is best with.

    Args:
        best: as it is.
        improved: optimises a program; None where it cannot.
        selected: what may change in a program.
        effort: of the searches so far; these are shorter, as they begin near an optimum.
    """
    brief = replace(effort, starts=1, generations=0, iterations=min(_BRIEF, effort.iterations))
    longer = replace(effort, starts=1, generations=min(1, effort.generations))
    for _ in range(_MOST_CHANGES):
        changed = _without_one(best, improved, selected(best), brief) or _with_one(
            best, improved, selected(best), longer
        )
        if changed is None:
            return best
        best = changed
    return best


def idle_points(
    best: Counted, selection: Selection, judged: Callable[[Program], float | None]
) -> Iterator[int]:
    """Via points (indices of moves) without which, all else as it is, nothing is lost.

    Args:
        best: the program.
        selection: what may change in it.
        judged: a program's cost; None if it does not keep its clearance.
    """
    for i in _removable(selection):
        cost = judged(_without(best.run.program, i))
        if cost is not None and cost <= best.cost * (1.0 + 1e-9):
            yield i


def _removable(selection: Selection) -> list[int]:
    return [group[0] for group in selection.points if len(group) == 1]


def _without_one(
    best: Counted, improved: Improved, selection: Selection, effort: Effort
) -> Counted | None:
    for i in _removable(selection):
        task = best.task.renumbered(_gone(i))
        found = improved(_without(best.run.program, i), task, effort)
        if found is not None and found.cost <= best.cost * (1.0 + _SERVES_NOTHING):
            return found
    return None


def _with_one(
    best: Counted, improved: Improved, selection: Selection, effort: Effort
) -> Counted | None:
    """With a via point in the middle of the longest leg next to one that moves."""
    path = best.run.path
    moving = {i for group in selection.points for i in group}
    legs = [
        k
        for k, move in enumerate(path.route.moves)
        if move in moving or (k > 0 and path.route.moves[k - 1] in moving)
    ]
    for k in sorted(legs, key=lambda k: -path.segments.scale[k]):
        i = path.route.moves[k]
        middle = _middle(best.run.program.moves[i], path, k, best.task.pattern)
        if i in best.task.keep or middle is None:
            continue
        task = best.task.renumbered(_later(i))
        found = improved(_inserted(best.run.program, i, middle), task, effort)
        if found is not None and found.cost < best.cost * (1.0 - _PAYS):
            return found
        return None
    return None


def _gone(index: int) -> Callable[[int], int | None]:
    """New indices of moves when one has been left out."""
    return lambda k: None if k == index else k - (k > index)


def _later(index: int) -> Callable[[int], int | None]:
    """New indices of moves when one has been put before ``index``."""
    return lambda k: k + (k >= index)


def _without(program: Program, index: int) -> Program:
    statements = list(program.statements)
    del statements[_place(program, index)]
    return replace(program, statements=tuple(statements))


def _inserted(program: Program, index: int, move: Move) -> Program:
    statements: list[Statement] = list(program.statements)
    statements.insert(_place(program, index), move)
    return replace(program, statements=tuple(statements))


def _place(program: Program, index: int) -> int:
    """Index among the statements of a move."""
    places = [k for k, s in enumerate(program.statements) if isinstance(s, MoveJ | MoveL | MoveC)]
    return places[index]


def _middle(move: Move, path: Path, segment: int, pattern: Radius) -> Move | None:
    """A move to the middle of a leg, like the one that drives it; None where that cannot be."""
    ends = path.segments.ends
    if len(path.route.prescribed):
        return None
    q = ends.q[segment].mean(axis=0)
    p0, p1 = ends.position[segment]
    radius = max(_SMALLEST, _ZONE * 0.5 * float(np.linalg.norm(p1 - p0)))
    zone = pattern.resized(radius)
    plain = replace(move, zone=zone, events=(), origin=None)
    if ends.kind[segment] == JOINT_SEGMENT:
        return replace(plain, target=JointTarget(tuple(map(float, q))))
    if ends.kind[segment] != LINE_SEGMENT:
        return None
    R0, R1 = ends.rotation[segment]
    half = R0 @ matrix_from_rotation_vector(0.5 * rotation_vector(R0.T @ R1))
    x, y, z = (float(v) for v in 0.5 * (p0 + p1))
    w, i, j, k = (float(v) for v in quaternion_from_matrix(half))
    return replace(plain, target=PoseTarget(Pose((x, y, z), (w, i, j, k))))
