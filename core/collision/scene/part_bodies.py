"""Bodies of parts that are picked and placed, and the pairs that they make with all else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...cell.cell import Cell
from ...cell.workpiece import Workpiece
from ...door import called
from ...errors import InputError, Note
from ...handling.arrangement import Arrangement
from ...robot.model import Robot
from ..distance.solid import Solid
from .allowed_pairs import exclusion_reason
from .bodies import Body, BodyKind, pieces_of, tool_like_solids
from .frames import WORLD, FrameTree, frame_of_axis


def refuse_parts(cell: Cell) -> None:
    """Refuse a cell whose parts are not followed: what is carried would be left out.

    Raises:
        InputError: the cell has parts.
    """
    if cell.parts:
        where = "the cell" if cell.file is None else str(cell.file)
        names = ", ".join(repr(part.name) for part in cell.parts)
        raise InputError(
            f"{where} has parts that are picked and placed ({names}): they are followed by "
            f"{called('emulate')} and {called('check')}, not by what proves clearances or changes "
            "motions; here, take a cell file without [[part]], with what is carried in the shape "
            "and mass of the tool, and what lies around as [[obstacle]]"
        )


def part_solids(parts: Iterable[Workpiece]) -> tuple[dict[str, list[Solid]], list[Note]]:
    """The solids of each kind of part, convex as a tool's, and what is odd about them.

    Raises:
        InputError: a mesh cannot be used.
    """
    solids: dict[str, list[Solid]] = {}
    notes: list[Note] = []
    for part in parts:
        solids[part.name], odd = tool_like_solids(part.name, part.geometry)
        notes += odd
    return solids, notes


def part_bodies(robot: Robot, parts: Arrangement, solids: Mapping[str, list[Solid]]) -> list[Body]:
    """The bodies of parts where they are; those that have left the cell count as lying still."""
    found: list[Body] = []
    for placed in parts:
        name, kind = placed.part.name, BodyKind.HELD if placed.held else BodyKind.PART
        frame, placement = WORLD, placed.pose
        if placed.held:
            frame, placement = robot.arm_size, robot.flange @ placed.pose
        elif placed.carrier is not None:
            frame = frame_of_axis(robot, placed.carrier)
        found += pieces_of(placed.name, name, kind, frame, placement, solids[name])
    return found


def part_pairs(
    cell: Cell, bodies: Sequence[Body], first: int, frames: FrameTree, gone: frozenset[str]
) -> NDArray[np.int64]:
    """Pairs (P, 2) of parts' bodies with all others that count, as in `sort_pairs`.

    Args:
        cell: what it allows.
        bodies: all, those of parts from index ``first`` on.
        first: see there.
        frames: that they ride on.
        gone: names of parts that have left the cell.
    """
    kept: list[tuple[int, int]] = []
    known: dict[tuple[object, ...], bool] = {}
    there = [k for k in range(first, len(bodies)) if bodies[k].thing not in gone]
    for j in there:
        mine = bodies[j]
        for i in (*range(first), *(k for k in there if k < j and bodies[k].frame != mine.frame)):
            other = bodies[i]
            asked = (mine.part, mine.kind, mine.frame, other.part, other.kind, other.frame)
            if asked not in known:
                known[asked] = exclusion_reason(cell, other, mine, frames) is None
            if known[asked]:
                kept.append((i, j))
    return np.array(kept, dtype=np.int64).reshape(-1, 2)
