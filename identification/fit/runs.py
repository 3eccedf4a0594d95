"""Logged runs made ready for a fit: which samples count, by how much, and what goes together.

A residual of joints e (N,) at a sample becomes rows W e (N + 3,):

- w wᵀ e / (PLACE_JOINT + CLOCK v) + (I − w wᵀ) e / (PLACE_JOINT + LAG v), with w the direction in
  which the joints move and v their speed near by: where a robot is *when*, and where the joints'
  *path* is, of which a log that is off in time alone has none;
- (I − u uᵀ) J e / (PLACE + LAG V), with J the TCP's Jacobian, u the direction it moves in and V its
  speed near by: where the TCP's *path* is.

Two joints are told apart by the joints' path alone wherever both move the TCP along its path; so
much of leads would otherwise pass for an error in time.

The two constants of each are what an emulator and a log may be off by without anybody minding.
They make rows about one where a model is good, at 50 mm/s as at 1 m/s.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError
from ...core.motion.emulator.controller import Controller
from ...core.motion.model.motion_model import MotionModel
from ...core.motion.model.rules import ArcTurn
from ...core.program.program import Program
from ...core.program.tool import FLANGE, Tool
from ...core.program.zone import Radius
from ...core.robot.model import Robot
from ...core.vendor import Vendor
from ..logs.cleaning import CleanLog, clean
from ..logs.run import LoggedRun
from ..prediction import Prediction, predict
from ..tcp_path import tcp_positions
from ..time_scale import Cause, TimeScale, time_scale
from ..unplanned_stops import with_stops
from .zone_sizes import COARSE, guess, resized

PLACE, LAG = 1e-5, 1e-4
"""m and s: of the TCP's path, 0.015 mm at 50 mm/s and 0.11 mm at 1 m/s."""
PLACE_JOINT, CLOCK = 2e-5, 5e-4
"""rad (m) and s: of joints at their time."""
SAMPLES = 300
"""Samples of a run that are looked at: half of them evenly in time, half by acceleration."""
NEAR = 0.15
"""s within which a speed counts as near."""


@dataclass(frozen=True, eq=False)
class PreparedRun:
    """A run as the fit sees it.

    Args:
        run: as it was logged.
        vendor, robot: who drove.
        log: its samples with their faults marked.
        t: (K,) s, stamps of the samples that count.
        q: (K, N), their joints, put together where samples mix two cycles.
        weight: (K, M, N), rows per joint residual.
        cluster: (K,), the waypoint that each sample is nearest to in time: residuals about one are
            not independent.
        offset: s, the log's time less the emulated, at the start of the fit; see `Nuisance`.
        drift: s/s, likewise.
        size: first guess of the factor on zones that were not recorded.
        by_place: whether samples are compared with the nearest place of the emulated path, not
            with where it is at their time.
        in_zones: for each waypoint with a zone, how many samples of the log are nearer to it than
            the zone's radius.
        turn: how its log shows that the tool turns along arcs; None if it does not.
        scale: the clock or override that explains most of the log's times; None if none does.
        own_clock, override: of a clock and of a speed override that are to be found beside the
            parameters; runs share those of one name. None if they count as right, and as 100 %.
    """

    run: LoggedRun
    vendor: Vendor
    robot: Robot
    log: CleanLog
    t: FloatArray
    q: FloatArray
    weight: FloatArray
    cluster: IntArray
    offset: float
    drift: float
    size: float
    by_place: bool
    in_zones: tuple[int, ...]
    turn: ArcTurn | None = None
    scale: TimeScale | None = None
    own_clock: str | None = None
    override: str | None = None

    @property
    def name(self) -> str:
        """Of the run."""
        return self.run.name

    @property
    def clock(self) -> str | None:
        """The clock that the run shares with others of its source, or has of its own; None if it
        counts as right.

        Stamps of a virtual controller come from a simulated clock. A real one's count as right, or
        the fit would take for a clock what is the motion's; but see `clocks`.
        """
        if self.own_clock is not None:
            return self.own_clock
        virtual = self.run.real is False and self.run.source and not self.by_place
        return self.run.source if virtual else None

    def only(self, rows: NDArray[np.bool_]) -> PreparedRun:
        """The same with some of its samples (K,)."""
        return replace(
            self,
            t=self.t[rows],
            q=self.q[rows],
            weight=self.weight[rows],
            cluster=self.cluster[rows],
        )

    def program(self, size: float = 1.0) -> Program:
        """What was driven, all zones resized by a factor."""
        return resized(self.run.program, size)

    def controller(self, model: MotionModel) -> Controller:
        """What emulates it, along arcs as the log shows."""
        if self.turn is not None:
            model = replace(model, arc_turn=self.turn)
        return Controller(self.vendor, self.robot, model)

    def corrected(self, clock: float) -> CleanLog:
        """The log as a true clock would have stamped it."""
        t = self.log.t
        return replace(self.log, t=t[0] + clock * (t - t[0]), period=clock * self.log.period)


def prepare(run: LoggedRun, vendor: Vendor, robot: Robot, model: MotionModel) -> PreparedRun:
    """Make a run ready.

    Args:
        run: as it was logged.
        vendor, robot: who drove.
        model: as the fit begins with.

    Raises:
        InputError: the run is another robot's, or its log does not belong to its program.
    """
    if run.robot != robot.name:
        raise InputError(f"{run.name}: a run of {run.robot}, not of {robot.name}: wrong robot")
    log = clean(run)
    controller, size = Controller(vendor, robot, model), 1.0
    if run.zones_known:
        found = predict(controller, run.name, run.program, log, COARSE)
    else:
        program, size, found = guess(controller, run.name, run.program, log)
        run = replace(run, program=program)
    scale = None
    if run.timed and run.zones_known and not (run.real is False and run.source):
        scale = time_scale(controller, found, COARSE)
    if scale is not None and scale.cause is Cause.OVERRIDE:
        found = predict(controller, run.name, run.program, log, COARSE, scale.value)
    if found.stops:
        run = replace(run, program=with_stops(run.program, found.stops))
    rows = found.alignment.rows
    at = found.alignment.time
    chosen = _chosen(found)
    rows, at = rows[chosen], at[chosen]
    q = found.log.q[rows]
    window = controller.smoothing(run.program, found.driven.path).window + found.driven.timing.ramp
    middle = at - 0.5 * window
    offset = float(np.median(log.t[rows] - (1 + found.alignment.drift) * middle))
    return PreparedRun(
        run,
        vendor,
        robot,
        log,
        log.t[rows],
        q,
        _weights(found, q, at),
        np.searchsorted(_between_waypoints(found), at),
        offset,
        found.alignment.drift,
        size,
        not run.timed,
        _in_zones(found),
        found.turn,
        scale,
    )


def shown_turn(runs: Sequence[PreparedRun]) -> ArcTurn | None:
    """How most logs show that the tool turns along arcs, those of a robot first; None if none
    does."""
    shown = [run for run in runs if run.turn is not None]
    robots = [run for run in shown if run.run.real is not False]
    counted = Counter(run.turn for run in robots or shown)
    return counted.most_common(1)[0][0] if counted else None


def _chosen(found: Prediction) -> IntArray:
    """Which of the samples on the path are looked at."""
    count = len(found.alignment.rows)
    if count <= SAMPLES:
        return np.arange(count)
    trajectory = found.driven.trajectory
    pull = np.linalg.norm(trajectory.ddq_motor, axis=1)
    reach = max(1, round(0.02 / COARSE))
    at = np.interp(
        found.alignment.time, trajectory.t, maximum_filter1d(pull, reach, mode="nearest")
    )
    busy = np.cumsum(at) / max(float(at.sum()), 1e-30)
    share = (np.arange(SAMPLES // 2) + 0.5) / (SAMPLES // 2)
    by_pull = np.searchsorted(busy, share)
    evenly = np.round(np.linspace(0, count - 1, SAMPLES // 2)).astype(np.int64)
    return np.unique(np.concatenate([np.clip(by_pull, 0, count - 1), evenly]))


def _weights(found: Prediction, q: FloatArray, at: FloatArray) -> FloatArray:
    """(K, N + 3, N), see the module."""
    trajectory = found.driven.trajectory
    w, joint_speed = _directions(trajectory.t, trajectory.dq_motor, at)
    step = np.gradient(found.residuals.line, trajectory.t, axis=0)
    u, speed = _directions(trajectory.t, step, at)
    J = tcp_jacobian(found.robot, found.driven.program.moves[0].tool, q)
    across = J - u[:, :, None] * np.einsum("ki,kij->kj", u, J)[:, None, :]
    across /= (PLACE + LAG * speed)[:, None, None]
    along = w[:, :, None] * w[:, None, :]
    joints = along / (PLACE_JOINT + CLOCK * joint_speed)[:, None, None]
    joints += (np.eye(q.shape[1]) - along) / (PLACE_JOINT + LAG * joint_speed)[:, None, None]
    return np.concatenate([joints, across], axis=1)


def _directions(
    t: FloatArray, velocity: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Unit directions (K, N) of motion at times, none at rest, and speeds (K,) near by."""
    speed = np.linalg.norm(velocity, axis=1)
    direction = np.where((speed > 1e-4)[:, None], velocity / np.maximum(speed, 1e-12)[:, None], 0.0)
    unit = np.stack([np.interp(at, t, column) for column in direction.T], -1)
    return unit, np.interp(at, t, _near(speed))


def _near(speed: FloatArray) -> FloatArray:
    """The greatest near by of speeds at samples `COARSE` apart."""
    return np.asarray(maximum_filter1d(speed, 2 * round(NEAR / COARSE) + 1, mode="nearest"))


def tcp_jacobian(robot: Robot, tool: Tool, q: FloatArray) -> FloatArray:
    """(K, 3, N), of the TCP in the world; of a tool that stands still, of the flange."""
    J = robot.jacobian(q)
    rotation, _ = robot.forward(q)
    arm = rotation @ np.array(_held(tool).tcp.position)
    return np.asarray(J[:, :3] + np.cross(J[:, 3:], arm[:, :, None], axis=1))


def _between_waypoints(found: Prediction) -> FloatArray:
    """(M − 1,) s, halfway between the times at which the emulation passes its waypoints."""
    trajectory, path = found.driven.trajectory, found.driven.path
    passed = np.interp(path.layout.waypoint, trajectory.sigma, trajectory.t)
    return np.asarray(0.5 * (passed[1:] + passed[:-1]))


def _held(tool: Tool) -> Tool:
    return tool if tool.robot_held else FLANGE


def _in_zones(found: Prediction) -> tuple[int, ...]:
    """How many samples of the log are in each zone."""
    path, moves = found.driven.path, found.driven.program.moves
    counts = []
    for segment, index in enumerate(path.route.moves[:-1]):
        zone = moves[index].zone
        if not isinstance(zone, Radius) or zone.tcp == 0.0:
            continue
        at = tcp_positions(found.robot, _held(moves[index].tool), path.route.ends.q[segment, 1:])
        away = np.linalg.norm(found.residuals.tcp - at, axis=1)
        counts.append(int((away < zone.tcp).sum()))
    return tuple(counts)
