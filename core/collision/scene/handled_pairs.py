"""Pairs of bodies that touch because a part is taken there, or released."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...handling.handling import Handling
from .bodies import BodyKind
from .scene import CollisionScene

RESTING = 2e-3
"""m by which a part may be off, or in, what it rests on where it is taken or released."""


def touching(
    scene: CollisionScene, handling: Handling, move: int, q: FloatArray
) -> NDArray[np.bool_]:
    """Which pairs of a scene may touch on a move, (P,): what is taken there or released.

    That is the tool and a part that it takes at the move's end or has released at its beginning,
    and a part that is carried with what it rests on there, as long as it does not go deeper into
    it.

    Args:
        scene: with the parts where they are on the move.
        handling: of the program.
        move: index in the program.
        q: (M, N), along the move.
    """
    left_out = np.zeros(len(scene.pairs), dtype=np.bool_)
    before, behind = handling.before[move], handling.behind[move]
    if not before | behind:
        return left_out
    resting: list[tuple[int, int]] = []
    things = [body.thing in before | behind for body in scene.bodies]
    for row in np.flatnonzero(np.array(things)[scene.pairs].any(axis=1)).tolist():
        first, second = (scene.bodies[k] for k in scene.pairs[row])
        if first.kind is BodyKind.TOOL and second.kind is BodyKind.PART:
            left_out[row] = first.own
        elif first.own != second.own:
            thing = next((b.thing for b in (first, second) if b.kind is BodyKind.HELD), "")
            resting += [(0, row)] if thing in before else []
            resting += [(len(q) - 1, row)] if thing in behind else []
    for row in _at_rest(scene, q, resting):
        deepest = scene.nearest(q, np.array([row]), 0.0)
        left_out[row] = deepest is None or deepest[0] >= -RESTING
    return left_out


def _at_rest(scene: CollisionScene, q: FloatArray, asked: list[tuple[int, int]]) -> list[int]:
    """Rows of pairs that all but touch at one of the samples (K,) that each is asked at."""
    if not asked:
        return []
    samples, rows = np.array(sorted(asked)).T
    distance, _ = scene.chosen_distances(q, (samples, rows), RESTING)
    return sorted(set(rows[distance < RESTING].tolist()))
