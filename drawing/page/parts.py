"""Parts that a program picks and places, as a page draws them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.cell.cell import Cell
from ...core.handling.arrangement import PlacedPart
from ...core.handling.handling import Handling
from ...core.robot.model import Robot
from .arm_content import (
    PageArm,
    PageBody,
    PageRole,
)
from .arms import Nodes
from .shapes import page_shape
from .track_content import (
    PagePart,
    PagePlace,
)


def with_parts(
    arm: PageArm, nodes: Nodes, robot: Robot, handling: Handling | None, cell: Cell | None
) -> tuple[PageArm, list[PagePart]]:
    """An arm with a body for each kind of part, and where all parts are from move to move.

    Args:
        arm: so far.
        nodes: of it.
        robot: whose.
        handling: what the program does to parts; None for nothing.
        cell: whose parts they are.

    Raises:
        InputError: a mesh cannot be used.
    """
    if handling is None or cell is None or not handling.arrangements:
        return arm, []
    bodies, shapes = list(arm.bodies), {}
    for part in cell.parts:
        known = [k for k, b in enumerate(bodies) if b.role is PageRole.PART and b.name == part.name]
        if not known:
            shape = page_shape(part.geometry.shape)
            bodies.append(PageBody(part.name, PageRole.PART, 0, np.eye(4), shape))
            known = [len(bodies) - 1]
        shapes[part.name] = known[0]
    made = []
    for k, first in enumerate(handling.arrangements[0]):
        places: list[PagePlace] = []
        last: PlacedPart | None = None
        for move, arrangement in enumerate(handling.arrangements):
            placed = arrangement[k]
            if placed != last:
                node = nodes.flange if placed.held else nodes.carrier(placed.carrier)
                places.append(PagePlace(move, node, placed.pose.matrix(), placed.gone))
                last = placed
        made.append(PagePart(first.name, shapes[first.part.name], places))
    return replace(arm, bodies=bodies), made
