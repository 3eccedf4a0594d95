"""A program cut at its stops: what lies between two of them is a problem of its own.

The robot rests at a stop point, so that nothing before it changes what comes after. Stretches that
share data are one block, with what lies between them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....core.motion.path.path import Path
from ....core.program.move import MoveC, MoveJ, MoveL, Statement
from ....core.program.program import Program
from ....core.program.target import JointTarget
from ....core.program.zone import Fine
from .parts import ProgramPart
from .variables import ProgramVariables


@dataclass(frozen=True)
class MoveBlock:
    """Moves from one stop to another that are optimised together.

    Args:
        first, last: indices of its first and last move in the whole program.
        program: these moves alone, from the configuration where the robot rests.
        variables: of this program.
    """

    first: int
    last: int
    program: Program
    variables: ProgramVariables


def cut(
    program: Program, path: Path, variables: ProgramVariables, arm_size: int
) -> tuple[MoveBlock, ...]:
    """The blocks that have variables.

    Args:
        program: the whole program.
        path: its path.
        variables: all of them.
        arm_size: number of the arm's own joints.
    """
    bounds = stretches(path, len(program.moves))
    owner = np.repeat(np.arange(len(bounds)), [last - first + 1 for first, last in bounds])
    spans: list[list[int]] = []
    for part in variables.parts:
        inside = owner[list(part.moves)]
        spans.append([int(inside.min()), int(inside.max())])
    return tuple(
        _block(program, path, variables, bounds[begin][0], bounds[end][1], arm_size)
        for begin, end in _merged(spans)
    )


def stretches(path: Path, count: int) -> list[tuple[int, int]]:
    """First and last move of every stretch from stop to stop."""
    route = path.route
    ends = [route.moves[k] for k, zone in enumerate(route.zones) if isinstance(zone, Fine)]
    ends.append(count - 1)
    begins = [0, *(end + 1 for end in ends[:-1])]
    return list(zip(begins, ends, strict=True))


def _merged(spans: list[list[int]]) -> list[tuple[int, int]]:
    merged: list[list[int]] = []
    for begin, end in sorted(spans):
        if merged and begin <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], end)
        else:
            merged.append([begin, end])
    return [(begin, end) for begin, end in merged]


def _block(
    program: Program, path: Path, variables: ProgramVariables, first: int, last: int, arm_size: int
) -> MoveBlock:
    parts: list[ProgramPart] = []
    for part in variables.parts:
        if first <= part.moves[0] and part.moves[-1] <= last:
            moves = tuple(i - first for i in part.moves)
            parts.append(replace(part, moves=moves))
    alone = _alone(program, path, first, last, arm_size)
    return MoveBlock(first, last, alone, ProgramVariables(alone, parts))


def _alone(program: Program, path: Path, first: int, last: int, arm_size: int) -> Program:
    """The moves of a block, with the statements between them."""
    index = -1
    statements: list[Statement] = []
    for statement in program.statements:
        if isinstance(statement, MoveJ | MoveL | MoveC):
            index += 1
            if first <= index <= last:
                statements.append(statement)
        elif first <= index < last:
            statements.append(statement)
    begins = [k for k, move in enumerate(path.route.moves) if move >= first]
    q = path.route.ends.q[begins[0], 0]
    start = JointTarget(tuple(map(float, q[:arm_size])), tuple(map(float, q[arm_size:])))
    return replace(program, statements=tuple(statements), start=start, notes=(), reading=None)
