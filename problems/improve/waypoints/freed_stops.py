"""Stops that may be passed get zones to begin with."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from ....core.errors import InputError, MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.program.program import Program
from ..zones.points import passable_stops
from .options import WaypointTask

_RADII = (0.01, 0.003, 0.001)
"""m that freed stops begin with: the first with which every waypoint is still driven."""


def with_freed_stops(
    controller: Controller, program: Program, task: WaypointTask, notes: list[Note]
) -> Program:
    """The program with small zones at stops that may be passed.

    Args:
        controller: drives it.
        program: the program.
        task: names the stops.
        notes: stops at which no zone can be driven are listed here, and stay.

    Raises:
        InputError: a move is named that is no stop, or one for a reason.
    """
    passable, moves = passable_stops(program), program.moves
    for i in task.freed:
        if not 0 <= i < len(moves) or i not in passable:
            raise InputError(
                f"move {i + 1} cannot be passed: it is no stop, or one for a reason (the "
                "last move, a wait, something that is switched there)"
            )
    for radius in _RADII:
        freed = _freed(program, task.freed, radius, task)
        if _driven(controller, program, freed, task):
            return freed
    made = program
    for i in task.freed:
        freed = _freed(made, [i], _RADII[-1], task)
        if _driven(controller, program, freed, task):
            made = freed
        else:
            notes.append(Note("stays a stop: its neighbours leave it no room for a zone", i))
    return made


def _freed(program: Program, stops: Collection[int], radius: float, task: WaypointTask) -> Program:
    moves = list(program.moves)
    for i in stops:
        moves[i] = replace(moves[i], zone=task.pattern.resized(radius))
    return program.with_moves(tuple(moves))


def _driven(controller: Controller, given: Program, freed: Program, task: WaypointTask) -> bool:
    """Whether the same waypoints are driven."""
    try:
        route = controller.plan(freed, task.start).route
    except MotionError:
        return False
    return route.moves == controller.plan(given, task.start).route.moves
