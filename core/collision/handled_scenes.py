"""The scenes of a program that takes parts and releases them."""

from __future__ import annotations

import numpy as np

from ..cell.cell import Cell
from ..handling.handling import Handling
from ..motion.path.path import Path
from ..program.tool import Tool
from .clearance import in_steps
from .proof.certificate import SceneOf
from .scene.handled_pairs import touching
from .scene.scene import CollisionScene


def handled_scenes(cell: Cell, handling: Handling, path: Path) -> SceneOf:
    """The scenes of a cell with its parts where they are on each move.

    On the moves at which a part is taken or released, the pairs that touch there are left out
    (`flyby.core.collision.scene.handled_pairs`), to be proven from where they are apart.

    Args:
        cell: what stands around.
        handling: of the program. Others that have the same targets where parts are handled handle
            them alike.
        path: of the program, all of it.
    """
    bare: dict[Tool, CollisionScene] = {}
    known: dict[tuple[Tool, int], CollisionScene] = {}
    moves = path.sample_moves()

    def scene(tool: Tool, move: int = 0, /) -> CollisionScene:
        parts = handling.arrangements[move]
        before, behind = (bool(names[move]) for names in (handling.before, handling.behind))
        handled = before or behind
        key = tool, move if handled else -1 - _same_before(handling, move)
        if key not in known:
            if tool not in bare:
                bare[tool] = CollisionScene(cell, tool, parts)
            made = bare[tool].rearranged(parts)
            rows = np.flatnonzero(moves == move)
            if handled and rows.size:
                q = in_steps(path.q[rows], path.states.dq[rows], path.sigma[rows])
                pairs = touching(made, handling, move, q)
                made = made.leaving_out(pairs, before=before, behind=behind)
            known[key] = made
        return known[key]

    return scene


def _same_before(handling: Handling, move: int) -> int:
    """The first of the moves up to this one along which nothing changes hands."""
    while move > 0 and handling.arrangements[move - 1] is handling.arrangements[move]:
        move -= 1
    return move
