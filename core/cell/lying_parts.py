"""The cell of a robot that no program has taken parts with: they lie where they are at first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ..display import counted
from ..errors import Note
from .cell import Cell, Obstacle


def with_parts_lying(cell: Cell) -> tuple[Cell, tuple[Note, ...]]:
    """The cell with its parts as obstacles where they lie at first, and what there is to say.

    Args:
        cell: where no program tells which parts are taken.
    """
    if not cell.parts:
        return cell, ()
    pieces = {part.name: [name for name, _ in part.pieces()] for part in cell.parts}
    allowed = [
        (one, other)
        for first, second in cell.allowed
        for one in pieces.get(first, [first])
        for other in pieces.get(second, [second])
    ]
    lying = tuple(_obstacles(cell))
    said = Note(
        f"{counted(lying, 'part')} of the cell ({', '.join(pieces)}) lie where they are at first, "
        "as no program takes them: what is carried belongs in the shape and mass of the tool, and "
        "what is not there out of the cell file"
    )
    made = replace(cell, obstacles=(*cell.obstacles, *lying), parts=(), allowed=tuple(allowed))
    return made, (said,)


def _obstacles(cell: Cell) -> Iterator[Obstacle]:
    for part in cell.parts:
        for name, pose in part.pieces():
            yield Obstacle(name, replace(part.geometry, placement=pose), part.carried_by)
