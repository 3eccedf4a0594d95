"""Loads that a language does not state."""

from __future__ import annotations

from dataclasses import replace

from ..dialect import Dialect
from ..program.program import Program
from .losses import LossesOfPart


def without_loads(program: Program, dialect: Dialect | None, losses: LossesOfPart) -> Program:
    """The program without what tools and parts weigh, where a language has no words for it; that
    is a loss of the first move that carries them."""
    if dialect is None or dialect.loads:
        return program
    told: set[str] = set()
    moves = []
    for i, move in enumerate(program.moves):
        for load, name in ((move.tool.load, move.tool.name), (move.load, "the part")):
            if load is not None and name not in told:
                told.add(name)
                losses.at(
                    i,
                    f"the load of {name} ({load.mass:.4g} kg) has no words: set it on the "
                    "controller",
                )
        moves.append(replace(move, tool=replace(move.tool, load=None), load=None))
    return program.with_moves(tuple(moves))
