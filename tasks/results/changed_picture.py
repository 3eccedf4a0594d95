"""The picture of a changed program: its cell with the path before and after."""

from __future__ import annotations

from ...core.cell.cell import Cell
from ...core.motion.emulator.controller import Controller
from ...drawing.cell import draw_cell
from ...problems.improve.solution import Solution
from ..setup import Setup, start_of


def draw_change(made: Solution, cell: Cell, setup: Setup, kind: str) -> bytes:
    """The cell with both paths as a file; one path where nothing has changed.

    Args:
        made: what was made of a program.
        cell: what stands around.
        setup: its robot.
        kind: ``png``, ``pdf`` or ``svg``.
    """
    controller, start = Controller(setup.vendor, setup.robot), start_of(made.original)
    runs = [("before", controller.run(made.original, start))]
    if made.changed:
        runs.append(("after", controller.run(made.program, start)))
    return draw_cell(cell, runs, kind)
