"""What larger zones alone bring: what a search of points and zones must not fall short of."""

from __future__ import annotations

from dataclasses import replace

from ....core.cell.cell import Cell
from ....core.errors import FlybyError
from ....core.motion.emulator.controller import Controller
from ....core.program.program import Program
from ...reading_back import ReadBack
from ..solution import Solution
from ..zones.maximize import maximize_zones
from ..zones.options import ZoneTask
from .changeable import select
from .options import WaypointTask


def zones_alone(
    controller: Controller,
    program: Program,
    base: Program,
    cell: Cell,
    task: WaypointTask,
    read_back: ReadBack,
) -> Solution | None:
    """The program with all zones that may change as large as they can be; points stay.

    Args:
        controller: drives it.
        program: that was given.
        base: the same with small zones at stops that may be passed.
        cell: what stands around, and the clearance to keep.
        task: what must stay.
        read_back: see `maximize_zones`.

    Returns:
        None where nothing is proven, or changes.
    """
    selection = select(base, controller.plan(base, task.start), controller.robot, task)
    changeable = {i for group in selection.zones for i in group}
    if not changeable:
        return None
    wanted = ZoneTask(
        clearance=task.clearance,
        residual=task.residual,
        freed=[i for i in task.freed if i in changeable],
        pattern=task.pattern,
        kept=[i for i in range(len(base.moves)) if i not in changeable],
        rounding=task.rounding,
        start=task.start,
        beside=task.beside,
        handling=task.handling,
    )
    try:
        made = maximize_zones(controller, program, cell, wanted, read_back)
    except FlybyError:
        return None
    return made if made.changed and made.proven else None


def with_zones_of(program: Program, other: Program) -> Program:
    """A program with the zones of another one of the same moves; all else stays where it stands in
    the source."""
    pairs = zip(program.moves, other.moves, strict=True)
    return program.with_moves(tuple(replace(old, zone=new.zone) for old, new in pairs))
