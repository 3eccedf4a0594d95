"""The path that a search begins with: through the user's corners, straight, or planned."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .....core.arrays import FloatArray
from .....core.errors import InputError, MotionError
from ...planning.free_space import FreeSpace
from ...planning.search import quickest_path
from ..motion.first_guess import Polyline
from ..task.task import MotionTask
from .surroundings import Surroundings

_ROOM = 1e-3
"""m beyond the clearance that planned paths keep, so that the proof ends."""
_SEED, _TRIES, _SECONDS = 0, 3, 20.0


def opening(
    task: MotionTask, around: Surroundings | None, vias: Sequence[ArrayLike] | None
) -> Polyline:
    """Straight joint lines to begin along, whose corners are stops.

    Args:
        task: what is asked.
        around: what to keep clear of; None for nothing.
        vias: corners (c, N) on each leg; None for straight lines, or planned ones where straight
            ones are not free.

    Raises:
        InputError: corners do not fit the task, or OMPL is needed and not installed.
        MotionError: no path was found.
    """
    if vias is not None:
        return Polyline.through(task, _checked(task, vias))
    if around is None:
        return Polyline.direct(task)
    return Polyline.through(task, _planned(task, around))


def _checked(task: MotionTask, vias: Sequence[ArrayLike]) -> list[FloatArray]:
    if len(vias) != task.legs:
        raise InputError(
            f"corners of {len(vias)} legs were given; there are {task.legs} between waypoints"
        )
    found = [np.asarray(rows, dtype=float) for rows in vias]
    for k, rows in enumerate(found):
        if rows.size and (rows.ndim != 2 or rows.shape[1] != task.robot.size):
            raise InputError(
                f"corners of leg {k + 1} have shape {rows.shape}; a row has the "
                f"{task.robot.size} axes of {task.robot.name}"
            )
        if not np.isfinite(rows).all():
            raise InputError(f"corners of leg {k + 1} are not finite")
    return found


def _planned(task: MotionTask, around: Surroundings) -> list[FloatArray]:
    """Corners of a free path for each leg; none where the straight line is free."""
    size, robot = task.robot.arm_size, task.robot
    external = tuple(map(float, np.asarray(task.start)[size:]))
    space = FreeSpace(around.scene, around.clearance, external)
    stations, corners = task.stations, []
    for k in range(task.legs):
        ends = stations[k : k + 2, :size]
        # With external axes on the move the proof of the first motion tells.
        if (stations[k : k + 2, size:] != external).any() or space.joins(*ends):
            corners.append(np.zeros((0, robot.size)))
            continue
        corners.append(space.configurations(_path(task, around, ends, external, k)[1:-1]))
    return corners


def _path(
    task: MotionTask, around: Surroundings, ends: FloatArray, external: tuple[float, ...], leg: int
) -> FloatArray:
    """(c, n), a free path of the arm between two configurations (2, n)."""
    still = sorted(set(range(task.robot.arm_size)) - set(task.moving.tolist()))
    if still:
        raise MotionError(
            f"the straight way of leg {leg + 1} does not keep the clearance, and paths are planned "
            f"for whole arms, but joint {task.robot.axis_names[still[0]]} is to stand still: give "
            "corners of a free path (vias)"
        )
    for room in (_ROOM, 0.0):
        space = FreeSpace(around.scene, around.clearance + room, external)
        if all(space.keeps(q) for q in ends):
            break
    path = quickest_path(task.robot.joints, space, [ends[0]], [ends[1]], _SEED, _TRIES, _SECONDS)
    if path is None:
        raise MotionError(
            f"no free path was found for leg {leg + 1} in {_SECONDS:g} s; give corners of one "
            "(vias), or a smaller clearance"
        )
    return np.array(path)
