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
from ..distance.shrinking import shrink
from ..distance.solid import Solid
from .allowed_pairs import exclusion_reason
from .bodies import Body, BodyKind, pieces_of, tool_like_solids
from .frames import WORLD, frame_of_axis


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
            f"{called('emulate')}, {called('check')}, {called('zones')}, {called('optimize')} and "
            f"{called('pareto')}, as programs take them; here nobody says where they are: take a "
            "cell file without [[part]], with what is carried in the shape and mass of the tool, "
            "and what lies around as [[obstacle]]"
        )


def part_solids(
    parts: Iterable[Workpiece], smaller: float = 0.0
) -> tuple[dict[str, list[Solid]], list[Note]]:
    """The solids of each kind of part, convex as a tool's, and what is odd about them.

    Args:
        parts: of the cell.
        smaller: m by which they are to be smaller all round, see `shrink`.

    Raises:
        InputError: a mesh cannot be used.
    """
    solids: dict[str, list[Solid]] = {}
    notes: list[Note] = []
    for part in parts:
        whole, odd = tool_like_solids(part.name, part.geometry)
        solids[part.name] = [shrink(solid, smaller) for solid in whole] if smaller else whole
        notes += odd
    return solids, notes


def part_bodies(robot: Robot, parts: Arrangement, solids: Mapping[str, list[Solid]]) -> list[Body]:
    """The bodies of parts where they are; those that have left the cell count as lying still."""
    found: list[Body] = []
    for placed in parts:
        name, kind = placed.part.name, BodyKind.HELD if placed.held else BodyKind.PART
        frame, placement = WORLD, placed.pose
        if placed.held:
            frame, placement = robot.flange_link, robot.flange @ placed.pose
        elif placed.carrier is not None:
            frame = frame_of_axis(robot, placed.carrier)
        found += pieces_of(placed.name, name, kind, frame, placement, solids[name])
    return found


def part_pairs(
    cell: Cell, bodies: Sequence[Body], first: int, gone: frozenset[str]
) -> NDArray[np.int64]:
    """Pairs (P, 2) of parts' bodies with all others that count, as in `sort_pairs`.

    Args:
        cell: what it allows.
        bodies: all, those of parts from index ``first`` on.
        first: see there.
        gone: names of parts that have left the cell.
    """
    there = np.array([k for k in range(first, len(bodies)) if bodies[k].thing not in gone], int)
    rows = np.concatenate([np.arange(first), there])
    i, j = (index.ravel() for index in np.meshgrid(rows, there, indexing="ij"))
    # Things that lie on one frame do not move against each other, nor do those on the flange.
    frame = np.array([body.frame for body in bodies], int)
    chosen = (i < j) & ((i < first) | (frame[i] != frame[j]))
    i, j = i[chosen], j[chosen]
    # What is asked of a pair is the same for all bodies of a kind on a frame.
    kinds: dict[tuple[object, ...], int] = {}
    kind = np.array([kinds.setdefault((b.part, b.kind, b.frame), len(kinds)) for b in bodies], int)
    _, at, which = np.unique(kind[i] * len(kinds) + kind[j], return_index=True, return_inverse=True)
    asked = ((bodies[i[k]], bodies[j[k]]) for k in at)
    counts = np.array([exclusion_reason(cell, a, b) is None for a, b in asked], bool)
    return np.asarray(np.stack([i, j], axis=1)[counts[which]])
