"""The emulator: drives a program as a vendor's controller would."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import FaultCause, MotionError, Note
from ...program.move import Move
from ...program.program import Program
from ...program.target import JointTarget
from ...robot.joint import JointKind
from ...robot.kinematics.chain_kernels import fill_quaternions
from ...robot.model import Robot
from ...vendor import Vendor
from ..command.commanded_motion import commanded_motion, stretches
from ..command.smoothing import Smoothing, smoothing_at
from ..command.trajectory import Trajectory, sample_times
from ..geometry.pieces import Sampling
from ..model.consumption import SQUARED_TORQUE, Consumption
from ..model.motion_model import MotionModel
from ..model.torque import WITHOUT_LIMIT
from ..path.building import build_path
from ..path.no_move import goes_nowhere
from ..path.path import OverlapError, Path
from ..path.route import RouteFinder
from ..timing.arc_length import ArcLength
from ..timing.energy import Energy, energy, loads_of
from ..timing.limits import SegmentLimits
from ..timing.programmed_durations import stamp_programmed
from ..timing.rests import InPosition
from ..timing.start_ramp import StartRamp
from ..timing.timing import Settling, Timing, along_path, stamp_path
from ..timing.torque import torque_shares
from ..timing.torque_rows import Shares
from .limit_violations import excesses, torque_excesses, torques_taken
from .ranges import check_path, check_standing
from .run import Run

_SKIPS = 10_000
_STARTS = 64
"""Configurations tried of a first target: a six-axis arm has eight solutions, and turns of them."""
_TRIED_MOVES = 20_000
"""Moves planned to find a start, about: some seconds."""
_DEPENDS_ON_START = (FaultCause.LIMIT, FaultCause.SINGULARITY, FaultCause.CONFIGURATION)
_DEGREES = 180 / np.pi


@dataclass(frozen=True)
class _Attempt:
    """A plan from some configuration of the first target, or why there is none."""

    start: JointTarget | None
    path: Path | None
    error: MotionError | None = None


class Controller:
    """Emulates one vendor's controller for one robot.

    Args:
        vendor: whose configurations and rules apply.
        robot: the robot, with its external axes.
        model: the motion model; None for the vendor's own of this robot.
        sampling: how densely paths are sampled; None for what the model's accuracy calls for.
    """

    def __init__(
        self,
        vendor: Vendor,
        robot: Robot,
        model: MotionModel | None = None,
        sampling: Sampling | None = None,
    ) -> None:
        self._vendor = vendor
        self.robot = robot
        self.model = vendor.motion_of(robot) if model is None else model
        self.sampling = _sampling(self.model) if sampling is None else sampling
        arcs = None if vendor.speaks is None else vendor.speaks.arcs
        self._last_limits: SegmentLimits | None = None
        self._undriven: tuple[Program, _Attempt] | None = None
        turns = self.model.line_turn, self.model.arc_turn
        self._routes = RouteFinder(robot, vendor.label, *turns, arcs, vendor.nearest)

    def with_model(self, model: MotionModel) -> Controller:
        """The same controller, driving otherwise."""
        return Controller(self._vendor, self.robot, model, self.sampling)

    def with_robot(self, robot: Robot) -> Controller:
        """The same controller of another robot, driven by the same model."""
        return Controller(self._vendor, robot, self.model, self.sampling)

    def run(
        self,
        program: Program,
        start: JointTarget | None = None,
        period: float | None = None,
        override: float = 1.0,
        beyond: float = 0.0,
    ) -> Run:
        """Plan, stamp and sample a program.

        Args:
            program: what to drive.
            start: where the robot stands; None for the program's own start, else its first target.
            period: s between samples; None for the controller's own.
            override: share of all speeds, as an operator sets it; see `stamp_slower`.
            beyond: s after the end of what is commanded that the trajectory has as well.

        Raises:
            MotionError: the program cannot be driven; the message names the move.
        """
        path = self.plan(program, start)
        timing = self.stamp(program, path)
        if override != 1.0:
            timing = self.stamp_slower(program, timing, override)
        trajectory = self.sample(program, timing, period, beyond)
        notes = (
            *program.notes,
            *path.notes,
            *self._duration_notes(program, timing),
            *self._jerk_notes(program),
            *self._excess_notes(program, timing, trajectory),
        )
        return Run(program, path, timing, trajectory, notes)

    def plan(self, program: Program, start: JointTarget | None = None) -> Path:
        """The geometry of a program's path.

        Where nobody says where the robot stands, it stands at its first target, in the first of
        its configurations there from which the program can be driven.

        Raises:
            MotionError: the program cannot be driven; the message names the move.
        """
        if start is not None or program.start is not None:
            return self._plan(program, start)
        made = self._from_some_start(program)
        self._undriven = None if made.error is None else (program, made)
        if made.error is not None:
            raise made.error
        assert made.path is not None
        return made.path

    def furthest_start(self, program: Program) -> JointTarget | None:
        """Where the robot stands for a program that cannot be driven, to come furthest.

        Returns:
            None for where `plan` takes it to stand by itself.
        """
        if program.start is not None:
            return None
        known = self._undriven  # as `plan` has met it just now
        made = known[1] if known and known[0] is program else self._from_some_start(program)
        return made.start

    def _from_some_start(self, program: Program) -> _Attempt:
        """Plan from one configuration of the first target after the other, until one will do."""
        try:
            return _Attempt(None, self._plan(program, None))
        except MotionError as error:
            furthest = _Attempt(None, None, error)
            if not self._depends_on_start(program, error):
                return furthest
        tries = min(_STARTS, max(8, _TRIED_MOVES // len(program.moves)))
        for start in self._other_starts(program)[:tries]:
            try:
                path = self._plan(program, start)
            except MotionError as error:
                assert furthest.error is not None
                if (error.move or 0) > (furthest.error.move or 0):
                    furthest = _Attempt(start, None, error)
            else:
                notes = (_stands(self.robot, start), *path.notes)
                return _Attempt(start, replace(path, notes=notes))
        return furthest

    def _depends_on_start(self, program: Program, error: MotionError) -> bool:
        if error.cause is FaultCause.REACH and error.move is not None:
            try:  # A path that leaves the reach of one configuration may be within another's.
                self._routes.standing_at(program.moves[error.move], None)
            except MotionError:
                return False
            return True
        return error.cause in _DEPENDS_ON_START

    def _other_starts(self, program: Program) -> Sequence[JointTarget]:
        """Where the robot may stand at the first target, but for the first guess."""
        try:
            return self._routes.starts(program)[1:]
        except MotionError:
            return ()

    def standing_at(self, move: Move, near: JointTarget | None) -> JointTarget:
        """A robot at the target of a move; see `RouteFinder.standing_at`.

        Raises:
            MotionError: it cannot stand there.
        """
        at = self._routes.standing_at(move, near)
        check_standing(self.robot, np.array([*at.joints, *at.external]))
        return at

    def _plan(self, program: Program, start: JointTarget | None) -> Path:
        skipped: list[int] = []
        notes: list[Note] = []
        for _ in range(_SKIPS):
            route = self._routes.find(program, start, skipped)
            if not route.moves:
                nowhere = _left_out(skipped) if skipped else goes_nowhere(program, start)
                raise _located(nowhere, program)
            try:
                path = build_path(route, self.model, self.sampling)
            except OverlapError as overlap:
                for corner in overlap.corners:
                    move = route.moves[corner]
                    skipped.append(move)
                    notes.append(
                        Note(
                            "its blend overlaps a neighbouring one: this waypoint is left out",
                            move,
                        )
                    )
                continue
            except MotionError as error:
                raise _located(error, program) from error
            try:
                check_path(self.robot, program, path, (start or program.start) is not None)
            except MotionError as error:
                raise _located(error, program) from None
            return replace(path, notes=(*notes, *path.notes)) if notes else path
        raise MotionError("the blends of this program overlap beyond remedy")

    def stamp(self, program: Program, path: Path) -> Timing:
        """When the robot is where on a path.

        Raises:
            MotionError: the limits do not let it move.
        """
        try:
            limits = self._limits(program, path)
            along = along_path(path, self.robot.limits.acceleration)
            return self.stamp_within(program, path, along, limits, self._shares(along))
        except MotionError as error:
            raise _located(error, program) from error

    def _limits(self, program: Program, path: Path) -> SegmentLimits:
        """The limits of a path's segments; those of the last path where they are the same."""
        speeds = [move.speed for move in self._moves(program, path)]
        segments, known = path.segments, self._last_limits
        if known is not None and known.hold(speeds, segments):
            return known
        self._last_limits = SegmentLimits.of(self.robot, self.model, speeds, segments)
        return self._last_limits

    def stamp_within(
        self,
        program: Program,
        path: Path,
        along: ArcLength,
        limits: SegmentLimits,
        shares: Shares | None,
    ) -> Timing:
        """When the robot is where on a path, within other limits than its own.

        Args:
            program: whose path it is; times that it programs are held.
            path: the geometry.
            along: its samples, over the parameter that is stamped.
            limits: of its segments.
            shares: (S, L), what share of its torque's limit each joint takes; None if none is
                limited.

        Raises:
            MotionError: the limits do not let it move.
        """
        durations = [move.speed.duration for move in self._moves(program, path)]
        settling, ramp = self.settling(program, path), self.model.duration.ramp
        return stamp_programmed(path, along, limits, shares, settling, durations, ramp)

    def stamp_slower(self, program: Program, timing: Timing, share: float) -> Timing:
        """The timing of the same path at a share of its speeds; accelerations are as they were.

        Args:
            program: that was stamped.
            timing: of its path.
            share: of all limits of speed, those included that hold programmed durations.
        """
        segments = range(len(timing.path.route.moves))
        limits = timing.limits.with_velocities_scaled(segments, share)
        settling = self.settling(program, timing.path)
        known = timing.path_limits
        return stamp_path(timing.path, timing.along, limits, known.shares, settling, known)

    def _shares(self, along: ArcLength) -> Shares | None:
        """What shares of the torques' limits the path takes, if the model has any."""
        if self.model.torque == WITHOUT_LIMIT:
            return None
        return torque_shares(self.model.torque, self.robot, *along.states[:3])

    def sample(
        self,
        program: Program,
        timing: Timing,
        period: float | None = None,
        beyond: float = 0.0,
    ) -> Trajectory:
        """The motion of links and motors, smoothed in time where the vendor does, each period.

        Args:
            program: that was stamped.
            timing: of its path.
            period: s between samples; None for the controller's own.
            beyond: s after the end of what is commanded: servos come to rest later.
        """
        period = self.model.period if period is None else period
        smoothing = self.smoothing(program, timing.path)
        t = sample_times(0.0, timing.duration + beyond, period)
        found = commanded_motion(self.robot, self.model, smoothing, timing, t)
        path = timing.path
        last = len(path.route.moves) - 1
        segment = np.searchsorted(path.layout.waypoint, found.sigma, "right") - 1
        segment = np.clip(segment, 0, last)
        tcp = self._tcp(self._moves(program, path), segment, t, found.links[0])
        moves = np.array(path.route.moves, dtype=np.int64)[segment]
        return Trajectory(t, *found.links, *tcp, found.sigma, moves, found.lead)

    def energy(
        self, program: Program, timing: Timing, consumption: Consumption = SQUARED_TORQUE
    ) -> Energy:
        """The energy of a stamped path, before smoothing; see `energy` and what it raises."""
        return energy(self.robot, timing, loads_of(program, timing.path), consumption)

    def _moves(self, program: Program, path: Path) -> list[Move]:
        return [program.moves[i] for i in path.route.moves]

    def smoothing(self, program: Program, path: Path) -> Smoothing:
        """What is done to the commanded joints in time: as the gentlest move's jerk needs it."""
        return self._smoothing_at(self._gentlest(program, path), path)

    def _gentlest(self, program: Program, path: Path) -> float:
        """The least share of the jerk limit that a move is programmed with."""
        return min(move.speed.jerk_fraction for move in self._moves(program, path))

    def _smoothing_at(self, jerk_fraction: float, path: Path) -> Smoothing:
        return smoothing_at(self.model, jerk_fraction, path.segments.joint_moves_alone)

    def smoothing_window(self, program: Program, path: Path) -> float:
        """Length in s of what one smoothed sample depends on."""
        return self.smoothing(program, path).window

    def settling(self, program: Program, path: Path) -> Settling:
        """How long a stamped path rests for what follows it in time."""
        gentlest = self._gentlest(program, path)
        ramp = self.model.ramp_at(gentlest)
        window = self._smoothing_at(gentlest, path).window + ramp
        wait = self.model.settling
        stop = window if wait is None else min(wait, window)
        start = StartRamp(self.model.start_ramp)
        waited = self._in_position(window)
        return Settling(stop, window, ramp, start, waited, self.model.servo.rest)

    def _in_position(self, averaged: float) -> InPosition | None:
        """What ends waits at stops early, where commands are averaged over so many seconds."""
        near, time = self.model.in_position, self.model.in_position_time
        return None if near == 0.0 else InPosition(near, averaged if time is None else time)

    def _tcp(
        self, moves: Sequence[Move], segment: IntArray, t: FloatArray, q: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """TCP in the world; of a stationary tool, in the work object."""
        position, quaternion = np.empty((len(q), 3)), np.empty((len(q), 4))
        chains = [self._routes.world_chain(move.tool, move.work_object) for move in moves]
        owner = np.array([id(chain) for chain in chains])[segment]
        for stretch in stretches(t):
            changes = stretch.start + 1 + np.flatnonzero(np.diff(owner[stretch]))
            for first, last in pairwise([stretch.start, *map(int, changes), stretch.stop]):
                chain, part = chains[segment[first]], slice(first, last)
                fill_quaternions(chain, q[part], quaternion[part], position[part])
        return position, quaternion

    def _excess_notes(self, program: Program, timing: Timing, trajectory: Trajectory) -> list[Note]:
        """Moves on which the motion as stamped passes what is programmed or the robot's limits."""
        path, names = timing.path, self.robot.axis_names
        speeds = [move.speed for move in self._moves(program, path)]
        limits = timing.limits
        if any(speed.duration is not None for speed in speeds):
            # What holds a time is no limit that would matter.
            limits = SegmentLimits.of(self.robot, self.model, speeds, path.segments)
        notes = excesses(timing, limits, names)
        if self.model.torque == WITHOUT_LIMIT:
            return notes
        at = trajectory.t, trajectory.move
        shares = torques_taken(self.model.torque, self.robot, timing, *at)
        return notes + torque_excesses(shares, names)

    def _jerk_notes(self, program: Program) -> list[Note]:
        if self.model.jerk is not None or self.model.ramp > 0.0:
            return []
        for index, move in enumerate(program.moves):
            if move.speed.jerk_fraction < 1.0:
                return [
                    Note(
                        "a reduced jerk (AccSet ramp) is programmed from here on; this motion "
                        "model states no jerk, so it is emulated without",
                        index,
                    )
                ]
        return []

    def _duration_notes(self, program: Program, timing: Timing) -> list[Note]:
        notes = []
        moves = self._moves(program, timing.path)
        for k, spent in enumerate(timing.segment_durations()):
            wanted = moves[k].speed.duration
            if wanted is not None and abs(spent - wanted) > 1e-3 * wanted:
                notes.append(
                    Note(
                        f"programmed to take {wanted:g} s, but the robot needs {spent:.4g} s",
                        timing.path.route.moves[k],
                    )
                )
        return notes


def _sampling(model: MotionModel) -> Sampling:
    """What is known of times calls for speeds that are resolved; the rest is as before."""
    if model.torque != WITHOUT_LIMIT:
        return Sampling(step=0.01, approach=6)
    return Sampling() if model.start_ramp == 0.0 else Sampling(step=0.01, joint=0.02)


def _stands(robot: Robot, start: JointTarget) -> Note:
    """What is said of a start that was found by trying."""
    arm = zip(robot.joints, start.joints, strict=True)
    shown = [
        f"{_DEGREES * q:.1f}°" if joint.kind is JointKind.REVOLUTE else f"{1e3 * q:.1f} mm"
        for joint, q in arm
    ]
    return Note(
        "no start is known: the robot is taken to stand at the first target with its joints at "
        f"{', '.join(shown)}, as it cannot drive the program from the solution tried first",
        0,
    )


def _left_out(waypoints: Sequence[int]) -> MotionError:
    return MotionError(
        "its blend overlaps a neighbouring one, so that the controller leaves the waypoint out, "
        "and nothing is left that goes anywhere: make the blend smaller, or a stop",
        min(waypoints),
    )


def _located(error: MotionError, program: Program) -> MotionError:
    """The same error with the move's place in the source."""
    if error.move is None or error.span is not None:
        return error
    origin = program.moves[error.move].origin
    if origin is None:
        return error
    return MotionError(error.message, error.move, origin.statement, error.cause)
