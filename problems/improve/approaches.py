"""Stops that a changed program comes to, or leaves, in another direction than before.

Where a tool grips, spots or is put in, it often has to come straight in. No program says so: the
points before and behind are via points like any other, which are moved, or rounded by a larger
zone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...core.arrays import FloatArray
from ...core.door import spelt
from ...core.errors import Note
from ...core.motion.emulator.run import Run
from ...core.program.move import MoveJ
from ...core.program.zone import Fine

_NEAR = 0.02
"""m from a stop within which the direction counts."""
_APART = math.radians(10.0)
"""Between directions, from which on they are others."""


def approach_notes(before: Run, after: Run) -> list[Note]:
    """On moves of the TCP to and from stops that go another way there; nothing where other moves
    are driven than before."""
    if before.path.route.moves != after.path.route.moves:
        return []
    return [*_notes(before, after)]


def _notes(before: Run, after: Run) -> Iterator[Note]:
    route, moves = after.path.route, after.program.moves
    old, new = _ends(before), _ends(after)
    for k, i in enumerate(route.moves):
        zones = [*before.path.route.zones[k : k + 1], *route.zones[k : k + 1]]
        if not all(isinstance(zone, Fine) for zone in zones) or not moves[i].tool.robot_held:
            continue
        behind = [moves[b] for b in route.moves[k + 1 : k + 2]]
        ways = [(-1, "is approached", "before")] if k and not isinstance(moves[i], MoveJ) else []
        if behind and not isinstance(behind[0], MoveJ):
            ways.append((1, "is left", "behind"))
        for step, what, side in ways:
            turned = _turned(before, after, (old[i], new[i]), step)
            if turned > _APART:
                yield Note(
                    f"{what} in another direction than before, by {math.degrees(turned):.0f}°: if "
                    f"the tool has to go straight there, {spelt('keep')} the point {side} it",
                    i,
                    moves[i].statement,
                )


def _ends(run: Run) -> dict[int, int]:
    """The last sample of each move."""
    last = np.flatnonzero(np.diff(run.trajectory.move, append=-1))
    return dict(zip(run.trajectory.move[last].tolist(), last.tolist(), strict=True))


def _turned(before: Run, after: Run, rows: tuple[int, int], step: int) -> float:
    """rad between the directions in which samples of two runs are come to (step −1) or left."""
    one, other = _direction(before, rows[0], step), _direction(after, rows[1], step)
    if one is None or other is None:
        return 0.0
    return math.acos(float(np.clip(one @ other, -1.0, 1.0)))


def _direction(run: Run, row: int, step: int) -> FloatArray | None:
    """(3,) of unit length to where the TCP is first so far away; None where it never is."""
    position = run.trajectory.position
    away = (position[row::step] if step > 0 else position[row::-1]) - position[row]
    distance = np.linalg.norm(away, axis=1)
    far = np.flatnonzero(distance >= _NEAR)
    return None if not len(far) else np.asarray(away[far[0]] / distance[far[0]])
