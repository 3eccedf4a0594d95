"""Where searches begin: the program as it is, and seeded variations of it.

Routes round an obstacle differ by several percent, more than solvers do. The variations are of
three kinds, at three sizes: pulled taut, towards the straight line between the points that stay
(the kind that finds most of the short routes); each via point moved on its own; and all of them
moved together, so that they land on one side of what is in the way.
"""

from __future__ import annotations

import numpy as np

from ....core.arrays import FloatArray
from ....core.motion.path.path import Path
from .blocks import MoveBlock
from .options import Effort
from .parts import PosePoint, ViaPoint

_OWN = 0.35
"""Spread of each via point about the common one, as a share of it."""
_SIZES = (1.0, 0.5, 0.25)
"""Shares of the spread, in turn."""
_NEAR = (0.15, 0.3, 0.6)
"""The same for variations of a good path."""
_TAUT, _OWN_WAY, _TOGETHER = range(3)
_KINDS = (_TAUT, _OWN_WAY, _TAUT, _TOGETHER)
"""Of the variations, in turn."""


def starting_points(block: MoveBlock, path: Path, effort: Effort) -> list[FloatArray]:
    """``effort.starts`` values of the block's variables, the program's own first.

    A block without via points that move has only that one: zones alone are searched from there.

    Args:
        block: the block.
        path: of its program as it was given.
        effort: how many, and how far apart.
    """
    count = effort.starts if _movable(block) else 1
    return [block.variables.start, *(_varied(block, path, effort, k) for k in range(1, count))]


def _varied(block: MoveBlock, path: Path, effort: Effort, number: int) -> FloatArray:
    variables = block.variables
    random = np.random.default_rng([effort.seed, block.first, number])
    kind = _KINDS[(number - 1) % len(_KINDS)]
    spread = effort.spread * _SIZES[(number - 1) % len(_SIZES)]
    x = _taut(block, path, random.uniform()) if kind == _TAUT else variables.start.copy()
    common: dict[int, FloatArray] = {}
    for index, part in enumerate(variables.parts):
        if not isinstance(part, ViaPoint):
            continue
        shift = spread * random.standard_normal(part.size)
        if kind == _TOGETHER and part.size in common:
            shift = common[part.size] + _OWN * shift
        common.setdefault(part.size, shift)
        x[variables.columns(index)] += shift
    return np.asarray(np.clip(x, variables.lower, variables.upper))


def variations(
    block: MoveBlock, x: FloatArray, effort: Effort, generation: int
) -> list[FloatArray]:
    """Values near those of a good path: each via point moved by less than between starts."""
    variables = block.variables
    found = []
    for k in range(effort.variations if _movable(block) else 0):
        random = np.random.default_rng([effort.seed, block.first, generation, k])
        spread = effort.spread * _NEAR[(generation + k) % len(_NEAR)]
        varied = x.copy()
        for index, part in enumerate(variables.parts):
            if isinstance(part, ViaPoint):
                varied[variables.columns(index)] += spread * random.standard_normal(part.size)
        found.append(np.clip(varied, variables.lower, variables.upper))
    return found


def _movable(block: MoveBlock) -> bool:
    return any(isinstance(part, ViaPoint) for part in block.variables.parts)


def _taut(block: MoveBlock, path: Path, slack: float) -> FloatArray:
    """Via points drawn to the line between their fixed neighbours but for ``slack`` of the way."""
    variables = block.variables
    x = variables.start.copy()
    waypoint = {move: k + 1 for k, move in enumerate(path.route.moves)}
    q, position = _waypoints(path)
    owners = [part if isinstance(part, ViaPoint) else None for part in variables.parts]
    moving = {waypoint[i] for part in owners if part is not None for i in part.moves}
    for index, part in enumerate(owners):
        if part is None:
            continue
        k = waypoint[part.moves[0]]
        first, last = k, k
        while first in moving:
            first -= 1
        while last in moving and last < len(q) - 1:
            last += 1
        share = (k - first) / (last - first) if last > first else 0.0
        values = position if isinstance(part, PosePoint) else q
        pull = (1.0 - slack) * ((1.0 - share) * values[first] + share * values[last] - values[k])
        x[variables.columns(index)] += part.along(pull)
    return np.asarray(x)


def _waypoints(path: Path) -> tuple[FloatArray, FloatArray]:
    """Configurations (M + 1, N) and TCP positions (M + 1, 3) in the work objects."""
    ends = path.segments.ends
    q = np.concatenate([ends.q[:1, 0], ends.q[:, 1]])
    return q, np.concatenate([ends.position[:1, 0], ends.position[:, 1]])
