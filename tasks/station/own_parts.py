"""Parts of a station: each belongs to the cell of the robot that picks it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import combinations
from typing import TYPE_CHECKING

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...core.handling.arrangement import PlacedPart
    from ...core.station.station import StationRobot
    from ...core.station.station_file import StationFile

_SAME = 0.01
"""m within which two parts are one that two cells have."""


def check_own_parts(file: StationFile, members: Iterable[StationRobot]) -> None:
    """No part is in the cells of two robots: it would be in two places.

    Raises:
        InputError: one is, as it lies where another robot puts it down, or takes it.
    """
    for one, other in combinations(members, 2):
        for mine in _lying(one):
            for theirs in _lying(other):
                if _is_one(mine, theirs):
                    raise InputError(
                        f"{file.file}: {mine.name!r} of {one.name} lies where {theirs.name!r} of "
                        f"{other.name} does: a part that one robot hands to another, or that two "
                        "of them handle, is not followed. Leave it in the cell of one of them; or "
                        f"let it leave the first one's cell where it is put down (leaves = true), "
                        "and say in [allow] of the station what may touch it: pairs = "
                        f'[["{one.name}.{mine.part.name}", "{other.name}.{theirs.part.name}"]]'
                    )


def _lying(member: StationRobot) -> Iterator[PlacedPart]:
    """Where the parts of a robot's cell lie in turn."""
    known = set()
    for arrangement in () if member.handling is None else member.handling.arrangements:
        for placed in arrangement:
            key = placed.name, placed.carrier, placed.pose
            if not placed.held and not placed.gone and key not in known:
                known.add(key)
                yield placed


def _is_one(one: PlacedPart, other: PlacedPart) -> bool:
    near = math.dist(one.pose.position, other.pose.position) < _SAME
    return near and one.carrier == other.carrier
