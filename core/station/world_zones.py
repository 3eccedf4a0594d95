"""Outputs that the controller itself sets while the TCP, or axes, are in a space.

World zones (ABB, ``WZBoxDef`` and ``WZDOSet``) and workspaces (KUKA, ``$WORKSPACE``,
``$AXWORKSPACE``). They watch the TCP or the axes, not the arm; the station file states them, as
programs set them up in routines that run when the controller starts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..motion.emulator.run import Run
from ..program.signal import SetSignal
from .actions import Action


@dataclass(frozen=True)
class WorldZone:
    """A space with an output.

    Args:
        name: in the station file.
        robot: whose TCP or axes are watched.
        signal: of the robot, that is set.
        inside: what it is while inside; outside it is the other.
        box: two corners in the world, m; None for none.
        ball: centre in the world and radius, m; None for none.
        axes: least and greatest value of axes by index, rad or m.
    """

    name: str
    robot: str
    signal: str
    inside: bool = True
    box: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None
    ball: tuple[tuple[float, float, float], float] | None = None
    axes: tuple[tuple[int, float, float], ...] = ()

    def holds(self, position: FloatArray, q: FloatArray) -> NDArray[np.bool_]:
        """Whether the TCP at (T, 3) m in the world, and axes (T, N), are inside."""
        found = np.ones(len(position), dtype=bool)
        if self.box is not None:
            one, other = np.array(self.box)
            low, high = np.minimum(one, other), np.maximum(one, other)
            found &= ((position >= low) & (position <= high)).all(axis=1)
        if self.ball is not None:
            centre, radius = self.ball
            found &= np.linalg.norm(position - np.array(centre), axis=1) <= radius
        for index, least, greatest in self.axes:
            found &= (q[:, index] >= least) & (q[:, index] <= greatest)
        return found


def with_zones(
    actions: Sequence[Action], zones: Sequence[WorldZone], robot: str, run: Run
) -> tuple[Action, ...]:
    """What a program does, and what zones do to its robot's outputs, in the order of its clock.

    Args:
        actions: of the program.
        zones: of the station.
        robot: its name.
        run: the program as driven.
    """
    own = [zone for zone in zones if zone.robot == robot]
    more = [action for zone in own for action in crossings(zone, run)]
    return tuple(sorted((*actions, *more), key=lambda action: action.time))


def on_at_start(zone: WorldZone, run: Run) -> bool:
    """Whether a zone's output is on before the program begins."""
    trajectory = run.trajectory
    return bool(zone.holds(trajectory.position[:1], trajectory.q[:1])[0]) == zone.inside


def crossings(zone: WorldZone, run: Run) -> Iterator[Action]:
    """What a zone does to its output while a program is driven.

    A change counts at the first sample behind it; it may come from the sample before on.
    """
    trajectory = run.trajectory
    inside = zone.holds(trajectory.position, trajectory.q)
    for k in np.flatnonzero(inside[1:] != inside[:-1]):
        on = bool(inside[k + 1]) == zone.inside
        before, behind = (float(t) for t in trajectory.t[k : k + 2])
        text = f"zone {zone.name} {'entered' if inside[k + 1] else 'left'}"
        move = int(trajectory.move[k])
        yield Action(SetSignal(zone.signal, on), behind, move, text, None, before)
