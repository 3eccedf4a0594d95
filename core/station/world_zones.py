"""Outputs that the controller itself sets while the TCP, or axes, are in a space.

World zones (ABB, ``WZBoxDef`` and ``WZDOSet``), which programs set up in routines that run when the
controller starts, and workspaces (KUKA, ``$WORKSPACE``, ``$AXWORKSPACE``), which the station file
states. They watch the TCP or the axes, not the arm.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..motion.command.trajectory import Trajectory
from ..motion.emulator.run import Run
from ..program.signal import SetSignal
from ..program.world_zone import WorldZone
from .actions import Action

_WITHIN = 5e-5
"""s within which a crossing is located, and for which a space may be touched unseen."""
_NOTHING = 1e-9
"""m or rad by which a robot that stands on a zone's face may be said to move."""


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

    Between samples the motion cannot leave what speeds and accelerations at their ends allow: where
    that leaves it open whether the space is entered or left, it is looked at in ever shorter steps.
    """
    trajectory = run.trajectory
    for begin, end, entered in _located(zone, trajectory):
        move = int(trajectory.move[np.searchsorted(trajectory.t, begin, "right") - 1])
        text = f"zone {zone.name} {'entered' if entered else 'left'}"
        yield Action(SetSignal(zone.signal, entered == zone.inside), end, move, text, None, begin)


def _located(zone: WorldZone, trajectory: Trajectory) -> list[tuple[float, float, bool]]:
    """Crossings in their order: from when, until when (s), and whether the space is entered."""
    between = _Between(trajectory)
    begin, end = trajectory.t[:-1], trajectory.t[1:]
    first = zone.depths(trajectory.position, trajectory.q)
    one, other = first[:-1], first[1:]
    found: list[tuple[float, float, bool]] = []
    while len(begin):
        # Where no depth changes its sign, and none can meanwhile, nothing is crossed.
        room = np.abs(one) + np.abs(other) - between.fastest(begin) * (end - begin)[:, None]
        same = (one >= 0.0) == (other >= 0.0)
        kept = same & ((room > -_NOTHING) | np.isinf(one))
        outside = (kept & (one < 0.0)).any(axis=1)
        open_ = ~outside & ~kept.all(axis=1)
        begin, end, one, other = begin[open_], end[open_], one[open_], other[open_]
        short = end - begin <= _WITHIN
        before, behind = ((depths >= 0.0).all(axis=1) for depths in (one, other))
        for k in np.flatnonzero(short & (before != behind)):
            found.append((float(begin[k]), float(end[k]), bool(behind[k])))
        begin, end, one, other = begin[~short], end[~short], one[~short], other[~short]
        middle = 0.5 * (begin + end)
        half = zone.depths(*between.at(middle))
        begin, end = np.concatenate([begin, middle]), np.concatenate([middle, end])
        one, other = np.concatenate([one, half]), np.concatenate([half, other])
    return sorted(found)


class _Between:
    """A trajectory between its samples: cubics with the samples' speeds.

    Args:
        trajectory: of the whole program.
    """

    def __init__(self, trajectory: Trajectory) -> None:
        self._t = trajectory.t
        several = len(self._t) > 1
        position = trajectory.position
        speed = np.gradient(position, self._t, axis=0) if several else np.zeros_like(position)
        self._values = np.concatenate([position, trajectory.q], axis=1)
        self._speeds = np.concatenate([speed, trajectory.dq], axis=1)
        # (T − 1, 1 + N), of the TCP and the axes: the greater speed of both ends, and what twice
        # the change of speed between them would add within.
        tcp = np.linalg.norm(speed, axis=1)[:, None]
        rates = np.concatenate([tcp, np.abs(trajectory.dq)], axis=1)
        change = np.abs(np.diff(self._speeds, axis=0))
        more = np.concatenate([np.linalg.norm(change[:, :3], axis=1)[:, None], change[:, 3:]], 1)
        self._fastest = np.maximum(rates[:-1], rates[1:]) + 2.0 * more

    def _row(self, t: FloatArray) -> IntArray:
        return np.clip(np.searchsorted(self._t, t, "right") - 1, 0, len(self._t) - 2)

    def fastest(self, t: FloatArray) -> FloatArray:
        """(T, 1 + N), m/s of the TCP and speeds of the axes, that the stretches round times (T,)
        do not go beyond."""
        return np.asarray(self._fastest[self._row(t)])

    def at(self, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The TCP (T, 3) m and axes (T, N) at times (T,) s."""
        k = self._row(t)
        span = self._t[k + 1] - self._t[k]
        s = ((t - self._t[k]) / span)[:, None]
        rise = self._values[k + 1] - self._values[k]
        first, last = (span[:, None] * self._speeds[row] for row in (k, k + 1))
        bent = first + s * (3 * rise - 2 * first - last + s * (first + last - 2 * rise))
        values = self._values[k] + s * bent
        return values[:, :3], values[:, 3:]
