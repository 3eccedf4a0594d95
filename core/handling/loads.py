"""What carried parts weigh, as the loads of a program's moves."""

from __future__ import annotations

from dataclasses import replace

from ..errors import Note
from ..program.move import Move
from ..program.program import Program
from ..program.tool import Load
from ..robot.inertia import Inertia
from .arrangement import Arrangement
from .handling import Handling

_SAME = 0.02
"""Share of a mass by which a program's own load may differ from the cell's without a note."""


def with_loads(program: Program, handling: Handling) -> tuple[Program, tuple[Note, ...]]:
    """The program whose moves carry the parts that are held, and what there is to say.

    A program that declares another load while it holds parts says itself what it carries: then
    that counts, as it does for the controller.

    Args:
        program: as it was read.
        handling: its parts.
    """
    moves: list[Move] = []
    notes: list[Note] = []
    empty: Move | None = None
    told: set[tuple[object, ...]] = set()
    for index, move in enumerate(program.moves):
        held = tuple(placed for placed in handling.held(index) if placed.part.load is not None)
        if not held:
            empty = empty if handling.held(index) else move
            moves.append(move)
            continue
        if empty is None:
            empty = move
        if (move.tool.load, move.load) == (empty.tool.load, empty.load):
            moves.append(replace(move, load=_joined(move, held)))
            continue
        moves.append(move)
        names = ", ".join(placed.part.name for placed in held)
        parts = sum(placed.part.load.mass for placed in held if placed.part.load is not None)
        declared, before = _mass(move), _mass(empty)
        said = names, declared, before
        if said not in told and abs(declared - before - parts) > _SAME * max(declared, parts):
            notes.append(
                Note(
                    f"the program declares a load of its own for {names}, {declared:g} kg with the "
                    f"tool instead of {before:g} kg: by the cell file it is {before + parts:g} kg; "
                    "the program's counts",
                    index,
                    move.statement,
                )
            )
            told.add(said)
    return program.with_moves(tuple(moves)), tuple(notes)


def _mass(move: Move) -> float:
    """kg that a move declares, with the tool."""
    loads = (move.tool.load if move.tool.robot_held else None, move.load)
    return sum(load.mass for load in loads if load is not None)


def _joined(move: Move, held: Arrangement) -> Load:
    """The payload of a move with parts, in the frame that it is declared in."""
    frame = move.tool.tcp if move.tool.robot_held else move.work_object.pose
    bodies = [] if move.load is None else [Inertia.of_load(move.load)]
    names = [] if move.load is None or move.load.name is None else [move.load.name]
    for placed in held:
        assert placed.part.load is not None
        bodies.append(Inertia.of_load(placed.part.load, frame.inverse() @ placed.pose))
        names.append(placed.name)
    total = bodies[0]
    for body in bodies[1:]:
        total = total + body
    return Load.of_body(total, ", ".join(names))
