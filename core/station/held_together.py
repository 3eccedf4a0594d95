"""Parts that two robots carry together: on such moves no hand moves in the part."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError, UnknownNameError
from .station import ClockPace, HeldTogether, StationRobot
from .synchronised import Together, TogetherMove, own_span

_PLACES = 100
"""Of a move at which both hands are looked at, evenly in time."""
_SAME, _TURNED = 2e-3, math.radians(1.0)
"""m and rad that a hand may move in the part."""


def check_held_together(
    declared: HeldTogether,
    members: Mapping[str, StationRobot],
    paces: Mapping[str, ClockPace],
    together: Sequence[Together],
) -> None:
    """Both hands keep where they are in the part.

    Args:
        declared: the part.
        members: robots with their programs as driven.
        paces: at which moves that are made together are driven.
        together: these.

    Raises:
        InputError: the part is never carried on such moves, or a hand moves in it; it names both
            lines.
    """
    holder, other = members[declared.holder], members[declared.other]
    moves = list(_carrying(declared, holder, together))
    where = f"held_together of {declared.holder}.{declared.part}: "
    if not moves:
        raise InputError(
            f"{where}{declared.holder} makes no move together with {declared.other} while it has it"
        )
    first: FloatArray | None = None
    for one, two in moves:
        seen = _seen(holder, other, paces, one, two)
        first = seen[0] if first is None else first
        off = np.linalg.norm(seen[:, :3, 3] - first[:3, 3], axis=1)
        turns = np.einsum("ji,njk->nik", first[:3, :3], seen[:, :3, :3])
        traces = np.clip(0.5 * (np.trace(turns, axis1=1, axis2=2) - 1.0), -1.0, 1.0)
        turned = np.arccos(traces)
        if off.max() > _SAME or turned.max() > _TURNED:
            raise InputError(
                f"{where}{two.said} moves its hand by {1e3 * off.max():.1f} mm and "
                f"{math.degrees(turned.max()):.1f}° against that of {one.said}: both have to drive "
                f"one way with the part, to {1e3 * _SAME:g} mm and {math.degrees(_TURNED):g}°"
            )


def _carrying(
    declared: HeldTogether, holder: StationRobot, together: Sequence[Together]
) -> Iterator[tuple[TogetherMove, TogetherMove]]:
    """Moves of both on which the holder has the part."""
    arrangements = () if holder.handling is None else holder.handling.arrangements
    known = {placed.name for arrangement in arrangements[:1] for placed in arrangement}
    if declared.part not in known:
        raise UnknownNameError(f"part of the cell of {declared.holder}", declared.part, known)
    for each in together:
        blocks = each.of(declared.holder), each.of(declared.other)
        if blocks[0] is None or blocks[1] is None:
            continue
        for one, two in zip(blocks[0].moves, blocks[1].moves, strict=True):
            placed = next(p for p in arrangements[one.index] if p.name == declared.part)
            if placed.held:
                yield one, two


def _seen(
    holder: StationRobot,
    other: StationRobot,
    paces: Mapping[str, ClockPace],
    one: TogetherMove,
    two: TogetherMove,
) -> FloatArray:
    """(T, 4, 4), the other's flange in the holder's, along a move."""
    frames = []
    for member, move in ((holder, one), (other, two)):
        pace, trajectory = paces[member.name], member.run.trajectory
        edges = pace.passed(np.array(own_span(member.run, move.index)))
        own = pace.own_at(np.linspace(edges[0], edges[1], _PLACES + 1))
        q = np.stack([np.interp(own, trajectory.t, column) for column in trajectory.q.T], -1)
        R, p = member.cell.robot.forward(q)
        frame = np.tile(np.eye(4), (len(q), 1, 1))
        frame[:, :3, :3], frame[:, :3, 3] = R, p
        frames.append(frame)
    return np.asarray(np.linalg.inv(frames[0]) @ frames[1])
