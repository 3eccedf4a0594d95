"""Orientations that a record does not state, as the log shows them.

On a line the tool turns evenly, but in zones it blends from one turn to the next and passes a
waypoint's orientation at a distance. So each leg's turn, as seen outside of zones, is carried on to
its ends, and what the two legs at a waypoint say is averaged.
"""

from __future__ import annotations

import numpy as np

from ...core.arrays import FloatArray
from ...core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

_CLEAR = 0.2
"""Share of a leg that must lie outside of its zones."""
_NEAR = 2e-3
"""m from a leg within which a sample is on it."""


def orientations_at(
    points: FloatArray, reach: FloatArray, position: FloatArray, rotation: FloatArray
) -> FloatArray:
    """Orientations (W, 3, 3) at the waypoints of a path of lines.

    Where no leg at a waypoint shows enough, it is that of the nearest sample.

    Args:
        points: (W, 3) m, waypoints, the start among them.
        reach: (W,) m, how far the blend of orientations may reach from each.
        position: (T, 3) m, of the logged TCP, in the order of time.
        rotation: (T, 3, 3), of the tool.
    """
    away = np.linalg.norm(position[None] - points[:, None], axis=2)
    nearest = _in_order(away)
    found: list[list[FloatArray]] = [[] for _ in points]
    for leg in range(len(points) - 1):
        rows = np.arange(nearest[leg], nearest[leg + 1] + 1)
        ends = _carried_on(points[leg : leg + 2], reach[leg : leg + 2], position[rows])
        if ends is None:
            continue
        (a, b), (la, lb) = rows[list(ends[0])], ends[1]
        turn = rotation_vector(rotation[a].T @ rotation[b]) / (lb - la)
        found[leg].append(rotation[a] @ matrix_from_rotation_vector(-la * turn))
        found[leg + 1].append(rotation[a] @ matrix_from_rotation_vector((1.0 - la) * turn))
    return np.stack(
        [_mean(said) if said else rotation[k] for said, k in zip(found, nearest, strict=True)]
    )


def _in_order(away: FloatArray) -> list[int]:
    """Indices of the samples nearest to waypoints, never falling, from distances (W, T)."""
    found, begin = [], 0
    for distances in away:
        begin += int(np.argmin(distances[begin:]))
        found.append(begin)
    return found


def _carried_on(
    ends: FloatArray, reach: FloatArray, position: FloatArray
) -> tuple[tuple[int, int], tuple[float, float]] | None:
    """First and last sample of a leg outside of its zones, and their shares of the leg."""
    step = ends[1] - ends[0]
    length = float(np.linalg.norm(step))
    if length == 0.0:
        return None
    share = (position - ends[0]) @ step / length**2
    off = np.linalg.norm(position - ends[0] - share[:, None] * step, axis=1)
    clear = (share * length > reach[0]) & ((1.0 - share) * length > reach[1]) & (off < _NEAR)
    rows = np.flatnonzero(clear)
    if len(rows) < 2 or share[rows[-1]] - share[rows[0]] < _CLEAR:
        return None
    a, b = int(rows[0]), int(rows[-1])
    return (a, b), (float(share[a]), float(share[b]))


def _mean(rotations: list[FloatArray]) -> FloatArray:
    """Halfway between one or two rotations."""
    first, last = rotations[0], rotations[-1]
    return np.asarray(first @ matrix_from_rotation_vector(0.5 * rotation_vector(first.T @ last)))
