"""Parts of a station: each belongs to the cell of the robot that picks it, or is handed over."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations
from typing import TYPE_CHECKING

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...core.arrays import FloatArray
    from ...core.handling.arrangement import PlacedPart
    from ...core.station.station import StationRobot
    from ...core.station.station_file import StationFile

_SAME = 0.01
"""m within which the boxes round two parts are one that two cells have."""


def check_own_parts(file: StationFile, members: Iterable[StationRobot]) -> None:
    """No part is in the cells of two robots, unless it is handed over: it would be in two places.

    Raises:
        InputError: one is, as it lies where another robot puts it down, or takes it.
    """
    handed = [{(each.giver, each.given), (each.taker, each.taken)} for each in file.hand_overs]
    for one, other in combinations(members, 2):
        for mine in _lying(one):
            for theirs in _lying(other):
                if {(one.name, mine.name), (other.name, theirs.name)} in handed:
                    continue
                if _is_one(mine, theirs):
                    raise InputError(
                        f"{file.file}: {mine.name!r} of {one.name} lies where {theirs.name!r} of "
                        f"{other.name} does: if one robot hands it to the other, say so in the "
                        f'station file: [[hand_over]] with part = "{one.name}.{mine.name}" and '
                        f'to = "{other.name}.{theirs.name}", the one that has it first; else leave '
                        "it in the cell of one of them"
                    )


def _lying(member: StationRobot) -> Iterator[PlacedPart]:
    """Where the parts of a robot's cell lie in turn."""
    known = set()
    handling = member.handling
    for arrangement in () if handling is None else (*handling.arrangements, handling.last):
        for placed in arrangement:
            key = placed.name, placed.carrier, placed.pose
            if not placed.held and not placed.gone and key not in known:
                known.add(key)
                yield placed


def _is_one(one: PlacedPart, other: PlacedPart) -> bool:
    """Whether two parts fill one space: the origin of a shape may be anywhere in it, or beside."""
    return one.carrier == other.carrier and bool((abs(_box(one) - _box(other)) < _SAME).all())


def _box(placed: PlacedPart) -> FloatArray:
    """(2, 3) m, the lowest and the highest corner of the box round a part."""
    import numpy as np

    turned = placed.pose.matrix()
    corners = placed.part.geometry.corners @ turned[:3, :3].T + turned[:3, 3]
    return np.stack([corners.min(axis=0), corners.max(axis=0)])
