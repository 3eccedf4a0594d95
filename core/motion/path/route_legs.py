"""A program's resolved moves, leg by leg, and what happens at the waypoints between them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import Note
from ...program.move import Opaque, Wait
from ...program.program import Program
from ...program.zone import FINE, Fine, Zone
from ...robot.kinematics.chain import Chain
from ..geometry.segments import Ends

NOWHERE = 1e-6
"""Scale (m or rad) below which a move goes nowhere: targets are written with about that precision,
and a move of nothing would be a stop more."""
START = -1
"""The index of the move that would end where the program begins."""


@dataclass(frozen=True)
class MoveEnd:
    """A resolved end of a move: what happens there."""

    zone: Zone
    dwell: float = 0.0


class MoveEnds(NamedTuple):
    """What happens where moves that go somewhere end.

    Args:
        zones: at the end of each.
        owners: indices of the moves whose zones these are.
        dwell: s, at the start and at the end of each.
    """

    zones: list[Zone]
    owners: list[int]
    dwell: list[float]


@dataclass
class RouteLegs:
    """Resolved moves, before those that go nowhere are dropped.

    Args:
        at_start: index of the move whose target is taken for the start; None if that is known.
        straight: indices of arcs whose points lie on a line.
        led: indices of moves of the TCP to an arm angle.
    """

    at_start: int | None = None
    ends: list[Ends] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    moves: list[int] = field(default_factory=list)
    straight: list[int] = field(default_factory=list)
    led: list[int] = field(default_factory=list)

    def joined(self) -> Ends:
        """The ends of all."""
        if len(self.ends) == 1:
            return self.ends[0]
        names = Ends.__dataclass_fields__
        return Ends(*(np.concatenate([getattr(e, name) for e in self.ends]) for name in names))

    def passed(
        self, keep: Iterable[bool], waypoints: Mapping[int, MoveEnd], notes: list[Note]
    ) -> MoveEnds:
        """What happens at waypoints when moves that go nowhere are dropped: their stops and waits
        stay.

        Args:
            keep: (M,), which moves go somewhere.
            waypoints: see `move_ends_of`.
            notes: on moves that are dropped, added.
        """
        zones: list[Zone] = []
        owners: list[int] = []
        dwell = [waypoints[START].dwell]
        for kept, move in zip(keep, self.moves, strict=True):
            here = waypoints[move]
            if kept:
                zones.append(here.zone)
                owners.append(move)
                dwell.append(here.dwell)
                continue
            dwell[-1] += here.dwell
            if zones and any(isinstance(zone, Fine) for zone in (here.zone, zones[-1])):
                zones[-1] = FINE
            elif zones:
                zones[-1], owners[-1] = here.zone, move
            if move != self.at_start:
                notes.append(Note("goes nowhere: it is at its target already", move))
        return MoveEnds(zones, owners, dwell)


def rows_of(ends: Ends, which: NDArray[np.int64]) -> Ends:
    """Some of the ends."""
    if len(which) == len(ends.kind):
        return ends
    return Ends(*(getattr(ends, name)[which] for name in Ends.__dataclass_fields__))


def move_ends_of(program: Program) -> dict[int, MoveEnd]:
    """Zone and dwell at the start and at the end of every move, stopping statements included."""
    found = {START: MoveEnd(FINE)}
    index = START
    for statement in program.statements:
        if isinstance(statement, Wait):
            found[index] = MoveEnd(FINE, found[index].dwell + statement.duration)
        elif isinstance(statement, Opaque):
            if statement.stops:
                found[index] = replace(found[index], zone=FINE)
        else:
            index += 1
            found[index] = MoveEnd(statement.zone)
    return found
