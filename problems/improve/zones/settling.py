"""From what is clear at each waypoint to the zones of a program."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from ....core.program.program import Program
from ....core.program.zone import Fine, Zone
from ..rounding import SMALLEST, Rounding
from .points import Points
from .rules import Rules
from .search import SizeBracket
from .sizes import size_of

WORTH = 2e-3
"""Share by which a zone must grow to be changed."""


def settle(
    points: Points,
    program: Program,
    rules: Rules,
    found: Mapping[int, SizeBracket],
    rounding: Rounding,
) -> dict[int, Zone]:
    """The zone of each corner that might change.

    Zones that the source states in one place become one; neighbours share their legs; sizes are
    rounded down, or to a predefined zone.

    Args:
        points: of the program.
        program: as it was given.
        rules: of the vendor.
        found: by corner; corners at which no zone has any effect are left out.
        rounding: of sizes, or to predefined zones.
    """
    sizes = _one_a_group(points, {corner: known.size for corner, known in found.items()})
    movable = {corner: size for corner, size in sizes.items() if size >= SMALLEST}
    if rules.shared_legs:
        growths = {corner: points.growths[corner] for corner in movable}
        movable = _one_a_group(points, rules.share_legs(growths, movable))
    zones = {corner: program.moves[points.move[corner]].zone for corner in points.growths}
    for corner, size in movable.items():
        fitting = points.growths[corner].rounded(size, rounding)
        cut = not rules.shared_legs and found[corner].fails is None
        if _worth(zones[corner], fitting, math.inf if cut else size):
            zones[corner] = fitting
    for members in points.groups:
        # A corner at which the zone has no effect has it in common with the others all the same.
        settled = [corner for corner in members if corner in movable]
        for corner in members:
            if settled and corner not in found:
                zones[corner] = zones[settled[0]]
    return zones


def _one_a_group(points: Points, sizes: Mapping[int, float]) -> dict[int, float]:
    least = dict(sizes)
    for members in points.groups:
        known = [sizes[corner] for corner in members if corner in sizes]
        least.update((corner, min(known)) for corner in members if corner in sizes)
    return least


def _worth(old: Zone, new: Zone, clear: float) -> bool:
    """Whether a zone is to be replaced: it is not clear, or the new one is noticeably larger.

    Args:
        old, new: zones.
        clear: size up to which all is clear; infinite where the controller cuts larger zones
            down to one that is.
    """
    if isinstance(new, Fine):
        return False
    return size_of(old) > clear * (1 + 1e-9) or size_of(new) > size_of(old) * (1 + WORTH)


def with_zones(program: Program, points: Points, zones: Mapping[int, Zone]) -> Program:
    """The program with these zones."""
    moves = list(program.moves)
    for corner, zone in zones.items():
        index = points.move[corner]
        moves[index] = replace(moves[index], zone=zone)
    return program.with_moves(tuple(moves))
