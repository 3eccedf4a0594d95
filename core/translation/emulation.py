"""One program on one robot, emulated: what the other robot's program is measured against."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..errors import MotionError
from ..motion.emulator.controller import Controller
from ..motion.geometry.pieces import Sampling
from ..motion.model.motion_model import MotionModel
from ..motion.model.rules import Overlap
from ..motion.path.building import build_path
from ..motion.path.path import OverlapError, Path, Route
from ..motion.path.programmed_speeds import with_programmed
from ..motion.path.route import RouteFinder
from ..motion.timing.timing import Timing
from ..program.move import Move
from ..program.program import Program
from ..program.target import JointTarget
from ..robot.model import Robot
from ..vendor import Vendor


@dataclass(frozen=True)
class Party:
    """One of the two sides of a translation."""

    vendor: Vendor
    robot: Robot

    @cached_property
    def model(self) -> MotionModel:
        """How the vendor's controller drives the robot."""
        return self.vendor.motion_of(self.robot)

    @cached_property
    def routes(self) -> RouteFinder:
        """Resolves waypoints."""
        arcs = None if self.vendor.speaks is None else self.vendor.speaks.arcs
        turns = self.model.line_turn, self.model.arc_turn
        return RouteFinder(self.robot, self.vendor.label, *turns, arcs, self.vendor.nearest)

    def start(self, program: Program) -> JointTarget | None:
        """Where the emulator takes the robot to stand at first; None for where the program says.

        Raises:
            MotionError: the program cannot be driven from anywhere.
        """
        if program.start is not None:
            return None
        q = Controller(self.vendor, self.robot).plan(program).route.ends.q[0, 0].tolist()
        arm = self.robot.arm_size
        return JointTarget(tuple(q[:arm]), tuple(q[arm:]))

    def route(self, program: Program, start: JointTarget | None = None) -> Route:
        """The route, on which the speed may change at every waypoint.

        Raises:
            MotionError: a move that cannot be driven, or none that goes anywhere.
        """
        found = self.routes.find(program, start)
        if not found.moves:
            raise MotionError(
                "the program goes nowhere: every move ends where the robot stands; there is "
                "nothing to translate"
            )
        return replace(found, paces=np.ones(len(found.moves) + 1, dtype=np.bool_))

    def path(self, route: Route, program: Program, model: MotionModel | None = None) -> Path:
        """The path along a route of at least one segment.

        Raises:
            OverlapError: blends overlap.
            MotionError: a stretch that the arm cannot follow, with the move's place.
        """
        try:
            return build_path(route, model or self.model, Sampling())
        except OverlapError:
            raise
        except MotionError as error:
            raise placed(error, program) from error

    def repaced(self, path: Path, program: Program) -> Path:
        """The path of a program that has other speeds now, where corners depend on them: blends of
        joint moves that are planned in time (`motion.geometry.timed_blends`).

        Raises:
            MotionError: a stretch that the arm cannot follow.
        """
        if self.model.joint.kind != "quintic":
            return path
        # While speeds are sought blends that overlap shrink: none may leave a waypoint out.
        overlap = Overlap.SHRINK if self.model.overlap is Overlap.SKIP else self.model.overlap
        model = replace(self.model, overlap=overlap)
        return self.path(with_programmed(path.route, program), program, model)

    def timing(self, program: Program, path: Path) -> Timing:
        """When the robot is where.

        Raises:
            MotionError: the limits do not let it move.
        """
        return Controller(self.vendor, self.robot).stamp(program, path)


def placed(error: MotionError, program: Program) -> MotionError:
    """The same error with the move's place in the source, if it is known."""
    if error.move is None or error.span is not None:
        return error
    return MotionError(error.message, error.move, program.moves[error.move].statement)


def waypoints(route: Route, count: int, start: FloatArray | None = None) -> FloatArray:
    """The configurations (count, N) at the ends of a program's moves.

    Args:
        route: the program's; moves that go nowhere are not in it.
        start: (N,) where the robot stands, for a route without a segment.
    """
    q = route.ends.q[0, 0] if len(route.moves) else start
    assert q is not None
    found = np.empty((count, len(q)))
    segment = {move: k for k, move in enumerate(route.moves)}
    for i in range(count):
        q = route.ends.q[segment[i], 1] if i in segment else q
        found[i] = q
    return found


@dataclass(frozen=True)
class Peaks:
    """What each of M segments takes and reaches.

    Args:
        duration: (M,) s of motion and settling; zones are divided at the waypoint's middle.
        joint: (M, N) rad/s or m/s, greatest joint speeds.
        tcp, turn: (M,) m/s and rad/s, greatest speed of the TCP and rate of turn.
        tcp_acceleration: (M,) m/s², greatest change of the TCP's speed along the path.
    """

    duration: FloatArray
    joint: FloatArray
    tcp: FloatArray
    turn: FloatArray
    tcp_acceleration: FloatArray

    @classmethod
    def of(cls, timing: Timing) -> Peaks:
        """The peaks of a stamped path."""
        states, stamp, segment = timing.along.states, timing.stamp, timing.interval_segments
        left = timing.path.pieces.interval_samples
        count = len(timing.path.route.moves)
        change = (stamp.x[1:] - stamp.x[:-1]) / (2 * timing.along.spacing)
        joint, peaks = np.zeros((count, states.dq.shape[1])), np.zeros((3, count))
        for knot, sample in ((0, left), (1, left + 1)):
            square = stamp.x[knot : len(stamp.x) - 1 + knot]
            rate = np.sqrt(square)
            np.maximum.at(joint, segment, np.abs(states.dq[sample]) * rate[:, None])
            for row, part in enumerate((slice(0, 3), slice(3, 6))):
                size = np.linalg.norm(states.v[sample, part], axis=1)
                np.maximum.at(peaks[row], segment, size * rate)
            v, a = states.v[sample, :3], states.a[sample, :3]
            size = np.linalg.norm(v, axis=1)
            bend = np.sum(v * a, axis=1) / np.where(size > 0, size, 1.0)
            np.maximum.at(peaks[2], segment, np.abs(size * change + bend * square))
        return cls(timing.settled_durations(), joint, *peaks)


@dataclass(frozen=True)
class EmulatedProgram:
    """A program on the old robot.

    Args:
        segment: index of the segment of each move that is driven.
        change: (M, N), how far each segment turns the joints.
        length: (M,) m of TCP path where that is a line or arc.
    """

    party: Party
    moves: Sequence[Move]
    segment: Mapping[int, int]
    peaks: Peaks
    change: FloatArray
    length: FloatArray

    @classmethod
    def of(cls, party: Party, program: Program, path: Path) -> EmulatedProgram:
        """A program along its path."""
        ends = path.route.ends
        return cls(
            party,
            program.moves,
            {move: k for k, move in enumerate(path.route.moves)},
            Peaks.of(party.timing(program, path)),
            ends.q[:, 1] - ends.q[:, 0],
            path.segments.length,
        )
