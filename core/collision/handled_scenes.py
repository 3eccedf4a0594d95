"""The scenes of a program that takes parts and releases them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..cell.cell import Cell
from ..handling.arrangement import Arrangement
from ..handling.handling import Handling
from ..motion.path.path import Path
from ..program.tool import Tool
from .proof.certificate import SceneOf, scenes_of
from .scene.handled_pairs import RESTING, set_aside
from .scene.scene import CollisionScene


def scenes_along(
    cell: Cell, handling: Handling | None, plan: Callable[[], Path], clearance: float
) -> SceneOf:
    """The scenes of a program's moves, with or without parts.

    Args:
        cell: what stands around.
        handling: of the program; None for a cell without parts.
        plan: gives the program's path, which is asked for where there are parts.
        clearance: see `handled_scenes`.

    Raises:
        InputError: the cell has parts, and nobody says where they are.
        MotionError: the program cannot be driven.
    """
    if handling is None:
        return scenes_of(cell)
    return handled_scenes(cell, handling, plan(), clearance)


def handled_scenes(cell: Cell, handling: Handling, path: Path, clearance: float = 0.0) -> SceneOf:
    """The scenes of a cell with its parts where they are on each move.

    On the moves at which a part is taken or released, the pairs that touch there are left out
    (`flyby.core.collision.scene.handled_pairs`), to be proven clear from where they are apart, and
    not too deep in each other before.

    Args:
        cell: what stands around.
        handling: of the program. Others that have the same targets where parts are handled handle
            them alike.
        path: of the program, all of it.
        clearance: m that is to be kept, with what the motion model leaves open.
    """
    bare: dict[tuple[Tool, float], CollisionScene] = {}
    known: dict[tuple[Tool, int], CollisionScene] = {}
    moves = path.sample_moves()

    def rearranged(tool: Tool, parts: Arrangement, smaller: float) -> CollisionScene:
        if (tool, smaller) not in bare:
            bare[tool, smaller] = CollisionScene(cell, tool, parts, smaller)
        return bare[tool, smaller].rearranged(parts)

    def scene(tool: Tool, move: int = 0, /) -> CollisionScene:
        parts = handling.arrangements[move]
        handled = bool(handling.before[move] or handling.behind[move])
        key = tool, move if handled else -1 - _same_before(handling, move)
        if key not in known:
            made = rearranged(tool, parts, 0.0)
            rows = np.flatnonzero(moves == move)
            if handled and rows.size:
                ends = path.q[rows[[0, -1]]]
                made = set_aside(
                    made, handling, move, ends, clearance, lambda: rearranged(tool, parts, RESTING)
                )
            known[key] = made
        return known[key]

    return scene


def _same_before(handling: Handling, move: int) -> int:
    """The first of the moves up to this one along which nothing changes hands."""
    while move > 0 and handling.arrangements[move - 1] is handling.arrangements[move]:
        move -= 1
    return move
