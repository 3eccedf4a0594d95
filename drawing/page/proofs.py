"""Where a proof is tightest, as a page draws it."""

from __future__ import annotations

from ...core.cell.cell import Cell
from ...core.collision.proof.verdict import Certificate
from ...core.collision.scene.scene import CollisionScene
from ...core.errors import FlybyError
from ...core.handling.arrangement import Arrangement
from ...core.program.program import Program
from .track_content import (
    PageProof,
)

Point = tuple[float, float, float]


def page_proof(
    proof: Certificate, cell: Cell, program: Program, parts: Arrangement | None = None
) -> PageProof:
    """A certificate with the nearest points of its pair.

    Args:
        proof: of a run of the program.
        cell: that it was proven in.
        program: that was proven.
        parts: where the cell's parts are on the move concerned; None for a cell without.
    """
    points = _nearest(proof, cell, program, parts)
    return PageProof(proof.proven, proof.message, proof.time, proof.pair, *points)


def _nearest(
    proof: Certificate, cell: Cell, program: Program, parts: Arrangement | None
) -> tuple[Point, Point] | tuple[None, None]:
    if proof.pair is None or proof.configuration is None or proof.move is None:
        return None, None
    try:
        scene = CollisionScene(cell, program.moves[proof.move].tool, parts)
    except FlybyError:
        return None, None
    for row in range(len(scene.pairs)):
        if scene.pair_names(row) == proof.pair:
            found = scene.witness(proof.configuration, row)
            return _point(found.point_a), _point(found.point_b)
    return None, None


def _point(at: object) -> Point:
    x, y, z = (float(value) for value in at)  # type: ignore[attr-defined]
    return x, y, z
