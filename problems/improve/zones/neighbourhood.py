"""The emulated path round single waypoints, for trial zones, without the rest of the program.

A zone changes the path on the two segments next to its waypoint and nowhere else, as long as no
vendor's rule makes neighbours shrink. So a trial needs these two segments alone; trials of many
waypoints are laid behind one another, with stops between, and emulated in one go.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numba import njit

from ....core.arrays import FloatArray, IntArray
from ....core.errors import MotionError
from ....core.motion.geometry.corners import STOP
from ....core.motion.geometry.pieces import Sampling
from ....core.motion.geometry.segments import Ends, make_segments
from ....core.motion.geometry.zones import ZonePlanner
from ....core.motion.model.motion_model import MotionModel
from ....core.motion.path.building import build_path
from ....core.motion.path.path import Path, Route
from ....core.program.zone import FINE, Zone
from ....core.robot.kinematics.chain import Chain
from ....core.robot.model import Robot

LIMIT_SLACK = 1e-6
"""rad or m by which a joint may pass its limit: rounding of programmed values."""
TRIAL = Sampling(step=0.05, turn=0.15, joint=0.15, blend=10, halvings=0)
"""Fine enough that quintics between samples stand for the path."""


@dataclass(frozen=True)
class CornerPath:
    """The path over the two segments at a waypoint, for one zone.

    Args:
        left, right: (K,), σ at both ends of each interval, counted from the waypoint.
        sample: (K,), index of the sample at the interval's left end; the next one is at its right.
        q, dq, ddq: (S, N), configurations and their derivatives with respect to σ.
        extent: how far on σ the zone reaches before and after the waypoint, in any channel.
        passed: whether the robot passes without stopping.
    """

    left: FloatArray
    right: FloatArray
    sample: IntArray
    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    extent: tuple[float, float]
    passed: bool

    def at(self, sigma: FloatArray) -> FloatArray:
        """Configurations (K, N) at σ (K,) from the waypoint."""
        q = np.empty((len(sigma), self.q.shape[1]))
        interpolate(self.left, self.right, self.sample, self.q, self.dq, self.ddq, sigma, q)
        return q

    def inside(self) -> FloatArray:
        """The samples (M, N) inside the zone."""
        last = np.concatenate([self.sample, self.sample[-1:] + 1])
        sigma = np.concatenate([self.left, self.right[-1:]])
        within = (sigma >= -self.extent[0]) & (sigma <= self.extent[1])
        return np.asarray(self.q[last[within]])


@njit(cache=True, error_model="numpy")
def interpolate(
    left: FloatArray,
    right: FloatArray,
    sample: IntArray,
    q: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    sigma: FloatArray,
    out: FloatArray,
) -> None:
    """Write the quintics that meet the samples and their derivatives, at ``sigma`` (K,)."""
    for i in range(sigma.size):
        k = np.searchsorted(left, sigma[i], side="right") - 1
        k = min(max(k, 0), left.size - 1)
        s, length = sample[k], right[k] - left[k]
        z = min(max((sigma[i] - left[k]) / length, 0.0), 1.0)
        for j in range(q.shape[1]):
            p0, v0, a0 = q[s, j], length * dq[s, j], length**2 * ddq[s, j]
            d = q[s + 1, j] - p0
            v1, a1 = length * dq[s + 1, j], length**2 * ddq[s + 1, j]
            c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
            c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
            c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1
            out[i, j] = p0 + z * (v0 + z * (0.5 * a0 + z * (c3 + z * (c4 + z * c5))))


class Neighbourhoods:
    """Emulates trial zones at single corners of a route.

    Args:
        robot: whose joints must stay within their ranges.
        route: the whole program's.
        model: the controller's.
        sampling: how densely trials are sampled.
    """

    def __init__(
        self, robot: Robot, route: Route, model: MotionModel, sampling: Sampling = TRIAL
    ) -> None:
        self._robot = robot
        self._route = route
        self._model = model
        self._sampling = sampling

    def paths(self, trials: Sequence[tuple[int, Zone]]) -> list[CornerPath | MotionError]:
        """The path of each trial.

        Args:
            trials: corner (waypoint i + 1 of the route) and its zone.

        Returns:
            The paths; where the arm cannot follow one, the reason.
        """
        if not trials:
            return []
        try:
            path = build_path(self._chained(trials), self._model, self._sampling)
        except MotionError as error:
            if len(trials) == 1:
                return [error]
            return [self.paths([trial])[0] for trial in trials]
        return [self._within_ranges(_part(path, k), trial) for k, trial in enumerate(trials)]

    def kinds(self, trials: Sequence[tuple[int, Zone]]) -> IntArray:
        """(K,), what the corner of each trial is; see `flyby.core.motion.geometry.corners`."""
        if not trials:
            return np.zeros(0, dtype=np.int64)
        route = self._chained(trials)
        segments = make_segments(route.ends)
        planner = ZonePlanner(segments, route.chains, self._model, route.moves, route.robot.limits)
        return planner.corners(route.zones).kind[::2]

    def _within_ranges(self, path: CornerPath, trial: tuple[int, Zone]) -> CornerPath | MotionError:
        """The path, unless a joint leaves its range in the zone."""
        limits, q = self._robot.limits, path.inside()
        beyond = np.maximum(limits.lower - q, q - limits.upper).max(axis=0, initial=0.0)
        axis = int(np.argmax(beyond))
        if beyond[axis] <= LIMIT_SLACK:
            return path
        name = self._robot.axis_names[axis]
        return MotionError(f"joint {name} would leave its range", self._route.moves[trial[0]])

    def _chained(self, trials: Sequence[tuple[int, Zone]]) -> Route:
        """The segments of all trials behind one another, with stops between."""
        whole = self._route
        rows = np.array([[i, i + 1] for i, _ in trials]).ravel()
        zones: list[Zone] = []
        chains: list[Chain] = []
        for i, zone in trials:
            zones += [zone, FINE]
            chains += _copies(whole.chains[i], whole.chains[i + 1])
        moves = tuple(whole.moves[k] for k in rows)
        return replace(
            whole,
            ends=Ends(*(getattr(whole.ends, field.name)[rows] for field in fields(Ends))),
            chains=tuple(chains),
            moves=moves,
            zones=tuple(zones[:-1]),
            zone_moves=moves[:-1],
            dwell=np.zeros(len(rows) + 1),
            paces=np.zeros(len(rows) + 1, dtype=bool),
            notes=(),
        )


def _copies(before: Chain, after: Chain) -> list[Chain]:
    """Chains equal to these and to no other trial's.

    Chains are told apart by identity, and inverse kinematics starts anew where they change.
    """
    first = Chain(*before)
    return [first, first if before is after else Chain(*after)]


def _part(path: Path, number: int) -> CornerPath:
    """What belongs to one trial."""
    segment, layout, pieces = 2 * number, path.layout, path.pieces
    mine = np.flatnonzero((pieces.segment == segment) | (pieces.segment == segment + 1))
    first, last = int(mine[0]), int(mine[-1]) + 1
    sample = pieces.interval_samples[pieces.first_interval[first] : pieces.first_interval[last]]
    begin, end = int(pieces.first_sample[first]), int(pieces.first_sample[last])
    at = layout.waypoint[segment + 1]
    before, after = layout.extent[segment].max(axis=0)
    return CornerPath(
        path.sigma[sample] - at,
        path.sigma[sample + 1] - at,
        sample - begin,
        path.states.q[begin:end],
        path.states.dq[begin:end],
        path.states.ddq[begin:end],
        (float(before), float(after)),
        bool(path.corners.kind[segment] != STOP),
    )
