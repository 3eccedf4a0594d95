"""Resolves a program's waypoints: frames, configurations, and which moves really move.

Along joint moves the configuration of a pose target is chosen among all solutions of inverse
kinematics; along moves of the TCP it is where a walk down the nominal path arrives.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, MotionError, Note, Span
from ..program.move import ArcOrientation, Move, MoveC, MoveJ, Opaque, Wait
from ..program.program import Program
from ..program.target import Configuration, JointTarget, PoseTarget
from ..program.tool import WORLD, Tool, WorkObject
from ..program.zone import FINE, Zone
from ..robot.assembly import assemble
from ..robot.chain import Chain
from ..robot.chain_kernels import pose
from ..robot.inverse import UnreachableError
from ..robot.model import Robot
from ..robot.work_chain import work_chain
from ..spatial.pose import Pose
from .layout import Layout
from .model import MotionModel
from .path import Route
from .segments import (
    ARC_SEGMENT,
    JOINT_SEGMENT,
    LINE_SEGMENT,
    Ends,
    Segments,
    make_segments,
)
from .tcp_curves import make_tcp_curves
from .tcp_samples import SINGULAR, Samples, States, TcpCurves, sample_tcp
from .zones import Corners

FloatArray = NDArray[np.float64]
Label = Callable[[Robot, FloatArray], Configuration | None]

_COLLINEAR = 1e-6
_NOWHERE = 1e-9
"""Scale (m or rad) below which a move goes nowhere."""
_MATCH = 1e-9
_REDUNDANT = 2
"""The third axis of a seven-axis arm moves linearly along moves of the TCP (as KUKA's E1 does)."""


@dataclass
class Stage:
    """Moves in a row that share one tool and one work object."""

    chain: Chain
    tool: Tool
    work_object: WorkObject
    moves: list[int]


@dataclass(frozen=True)
class _Waypoint:
    """A resolved end of a move: what happens there."""

    zone: Zone
    dwell: float = 0.0


@dataclass
class _Legs:
    """Resolved moves, before those that go nowhere are dropped."""

    ends: list[Ends] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    moves: list[int] = field(default_factory=list)


class RouteFinder:
    """Resolves programs for one robot.

    Args:
        robot: the robot.
        label: the vendor's label of a configuration; None where vendors have none.
    """

    def __init__(self, robot: Robot, label: Label) -> None:
        self._robot = robot
        self._label = label
        self._chains: dict[tuple[Tool, WorkObject], Chain] = {}
        redundant = [_REDUNDANT] if robot.arm_size == 7 else []
        self.prescribed = np.array(
            redundant + list(range(robot.arm_size, robot.size)), dtype=np.int64
        )
        arm = range(robot.arm_size)
        self.solved = np.array([j for j in arm if j not in redundant], dtype=np.int64)

    def find(
        self, program: Program, start: JointTarget | None, skipped: Collection[int] = ()
    ) -> Route:
        """The route of a program.

        Args:
            program: the program.
            start: where the robot stands; None for the program's own start, or else the first
                move's target.
            skipped: indices of moves whose waypoint is left out.

        Raises:
            MotionError: no move, or a target, configuration or arc that cannot be driven,
                naming the move.
        """
        moves = program.moves
        if not moves:
            raise MotionError(f"program {program.name!r} has no move")
        notes: list[Note] = []
        q = self._start(program, start, notes)
        legs = _Legs()
        for stage in self._stages(moves, skipped):
            q = self._drive(moves, stage, q, legs)
        return self._route(program, legs, _waypoints(program), q, notes)

    def _start(self, program: Program, start: JointTarget | None, notes: list[Note]) -> FloatArray:
        start = start or program.start
        rest = np.zeros(self._robot.size)
        rest[:] = np.clip(0.0, self._robot.limits.lower, self._robot.limits.upper)
        if start is not None:
            return self._joints(start, rest, None)
        first = program.moves[0]
        notes.append(Note("no start is known: the robot is taken to stand at the first target", 0))
        if isinstance(first.target, JointTarget):
            return self._joints(first.target, rest, first)
        return self._choose(first, 0, rest)

    def _joints(self, target: JointTarget, before: FloatArray, move: Move | None) -> FloatArray:
        """The configuration of a joint target; axes that it does not name keep their values."""
        if len(target.joints) != self._robot.arm_size:
            raise InputError(
                f"a joint target has {len(target.joints)} values, {self._robot.name} has "
                f"{self._robot.arm_size} joints"
            )
        q = before.copy()
        q[: self._robot.arm_size] = target.joints
        self._external(target.external, q)
        return q

    def _external(self, values: Sequence[float], q: FloatArray) -> None:
        room = self._robot.size - self._robot.arm_size
        if len(values) > room:
            raise InputError(
                f"a target names {len(values)} external axes, {self._robot.name} has {room}"
            )
        q[self._robot.arm_size : self._robot.arm_size + len(values)] = values

    def chain(self, tool: Tool, work_object: WorkObject) -> Chain:
        """The chain of a tool and a work object, one object for equal ones."""
        key = tool, work_object
        if key not in self._chains:
            self._chains[key] = work_chain(self._robot, tool, work_object)
        return self._chains[key]

    def world_chain(self, tool: Tool, work_object: WorkObject) -> Chain:
        """The chain that a trajectory's TCP is given by.

        It starts in the world; for a stationary tool, which does not move there, in the work
        object.
        """
        return self.chain(tool, WORLD) if tool.robot_held else self.chain(tool, work_object)

    def _stages(self, moves: Sequence[Move], skipped: Collection[int]) -> list[Stage]:
        stages: list[Stage] = []
        for i, move in enumerate(moves):
            if i in skipped:
                continue
            try:
                chain = self.chain(move.tool, move.work_object)
            except InputError as error:
                raise _at(move, i, str(error)) from error
            if not stages or stages[-1].chain is not chain:
                stages.append(Stage(chain, move.tool, move.work_object, []))
            stages[-1].moves.append(i)
        return stages

    def _drive(self, moves: Sequence[Move], stage: Stage, q: FloatArray, legs: _Legs) -> FloatArray:
        """Resolve the moves of a stage from configuration q; returns where it ends."""
        ends = self._ends(moves, stage, q)
        curves: TcpCurves | None = None
        segments: Segments | None = None
        for k, i in enumerate(stage.moves):
            move = moves[i]
            ends.q[k, 0] = q
            if ends.kind[k] == JOINT_SEGMENT:
                q = self._joint_end(move, i, q)
            else:
                if curves is None or segments is None:
                    segments = make_segments(ends)
                    curves = _nominal(segments)
                q = self._walk(move, i, k, stage.chain, segments, curves, q)
            ends.q[k, 1] = q
        legs.ends.append(ends)
        legs.chains += [stage.chain] * len(stage.moves)
        legs.moves += stage.moves
        return q

    def _ends(self, moves: Sequence[Move], stage: Stage, q: FloatArray) -> Ends:
        """Poses and prescribed axes at the ends of the stage's moves; configurations to come."""
        count, size = len(stage.moves), self._robot.size
        known = np.empty((count + 1, size))
        known[0] = q
        position, rotation = np.empty((count + 1, 3)), np.empty((count + 1, 3, 3))
        pose(stage.chain, np.ascontiguousarray(q), rotation[0], position[0])
        kind = np.empty(count, dtype=np.int64)
        via, follows = np.zeros((count, 3)), np.zeros(count, dtype=bool)
        via_rotation = np.tile(np.eye(3), (count, 1, 1))
        for k, i in enumerate(stage.moves):
            move = moves[i]
            kind[k] = JOINT_SEGMENT if isinstance(move, MoveJ) else LINE_SEGMENT
            try:
                if isinstance(move.target, JointTarget):
                    known[k + 1] = self._joints(move.target, known[k], move)
                    pose(stage.chain, known[k + 1], rotation[k + 1], position[k + 1])
                else:
                    known[k + 1] = known[k]
                    self._external(move.target.external, known[k + 1])
                    matrix = move.target.pose.matrix()
                    position[k + 1], rotation[k + 1] = matrix[:3, 3], matrix[:3, :3]
            except InputError as error:
                raise _at(move, i, str(error)) from error
            if isinstance(move, MoveC):
                kind[k] = ARC_SEGMENT
                auxiliary = move.via.pose.matrix()
                via[k], via_rotation[k] = auxiliary[:3, 3], auxiliary[:3, :3]
                follows[k] = move.orientation is ArcOrientation.FOLLOWS_ARC
                _check_arc(move, i, position[k], via[k], position[k + 1])
        pairs = np.stack([np.arange(count), np.arange(count) + 1], -1)
        prescribed = known[:, self.prescribed]
        return Ends(
            kind,
            np.zeros((count, 2, size)),
            position[pairs],
            rotation[pairs],
            prescribed[pairs],
            via,
            via_rotation,
            follows,
        )

    def _joint_end(self, move: Move, i: int, q: FloatArray) -> FloatArray:
        if isinstance(move.target, JointTarget):
            return self._joints(move.target, q, move)
        return self._choose(move, i, q)

    def _choose(self, move: Move, i: int, before: FloatArray) -> FloatArray:
        """The configuration of a joint move's pose target."""
        target = move.target
        assert isinstance(target, PoseTarget)
        q = before.copy()
        self._external(target.external, q)
        flange = self._flange(move, target.pose, q)
        external = tuple(q[self._robot.arm_size :])
        try:
            solutions = self._robot.inverse(flange, external)
        except UnreachableError as error:
            raise _at(move, i, f"target cannot be reached: {error}") from error
        options = []
        for solution in solutions:
            for arm in self._robot.turns(solution.q):
                full = q.copy()
                full[: self._robot.arm_size] = arm
                options.append(full)
        return self._pick(move, i, options, before)

    def _pick(
        self, move: Move, i: int, options: Sequence[FloatArray], before: FloatArray
    ) -> FloatArray:
        """The option with the programmed configuration that is nearest to ``before``."""
        distance = [float(np.abs(q - before).sum()) for q in options]
        wanted = move.target.configuration if isinstance(move.target, PoseTarget) else None
        if wanted is None:
            return options[int(np.argmin(distance))]
        labels = [self._label(self._robot, q) for q in options]
        misses = [math.inf if name is None else wanted.mismatch(name) for name in labels]
        best = min(range(len(options)), key=lambda k: (misses[k], distance[k]))
        if wanted.exact and misses[best] > _MATCH:
            known = sorted({str(name) for name in labels})
            raise _at(
                move,
                i,
                f"configuration {wanted} contradicts the pose; the robot reaches it with "
                f"{', '.join(known)}",
            )
        return options[best]

    def _flange(self, move: Move, target: Pose, q: FloatArray) -> Pose:
        """The flange in the world that puts the TCP on a target in the work object."""
        tool, work_object = move.tool, move.work_object
        if work_object.robot_held:
            return tool.tcp @ target.inverse() @ work_object.pose.inverse()
        if work_object.moved_by is None:
            return work_object.pose @ target @ tool.tcp.inverse()
        stages = self._robot.frame_stages(work_object.moved_by)
        carrier = np.eye(4)
        pose(assemble([*stages, work_object.pose]), q, carrier[:3, :3], carrier[:3, 3])
        return Pose.from_matrix(carrier) @ target @ tool.tcp.inverse()

    def _walk(
        self,
        move: Move,
        i: int,
        k: int,
        chain: Chain,
        segments: Segments,
        curves: TcpCurves,
        q: FloatArray,
    ) -> FloatArray:
        """Where the arm arrives that follows the nominal path of segment k from q."""
        if len(self.solved) != 6:
            raise _at(
                move,
                i,
                f"{self._robot.name} has {self._robot.arm_size} joints; only arms with six or "
                "seven can follow a path of the TCP",
            )
        turn = np.linalg.norm(segments.turn_a[k]) + np.linalg.norm(segments.turn_b[k])
        steps = 1 + int(max(segments.length[k] / 0.1, float(turn) / 0.2, segments.angle[k] / 0.2))
        sigma = k + np.linspace(0.0, 1.0, steps + 1)
        index = np.full(steps + 1, k, dtype=np.int64)
        states = States.zeros(steps + 1, self._robot.size)
        pivots = np.ones(steps + 1)
        failed, error = sample_tcp(
            chain,
            self.solved,
            self.prescribed,
            curves,
            Samples(sigma, index, index, index),
            q,
            states,
            pivots,
        )
        if failed >= 0:
            raise self._lost(move, i, failed / steps, error, float(pivots[failed]))
        arrived: FloatArray = states.q[-1].copy()
        wanted = move.target.configuration if isinstance(move.target, PoseTarget) else None
        if wanted is not None:
            label = self._label(self._robot, arrived)
            if label is not None and wanted.exact and wanted.mismatch(label) > _MATCH:
                raise _at(
                    move,
                    i,
                    f"configuration {wanted} contradicts the path: the arm arrives with {label}; "
                    "use a joint move, or programme the configuration it arrives with",
                )
        return arrived

    def _lost(self, move: Move, i: int, share: float, error: float, pivots: float) -> MotionError:
        where = f"{100 * share:.0f} % of the way along"
        if pivots < SINGULAR:
            return _at(move, i, f"the path runs into a singular configuration {where}")
        try:
            assert isinstance(move.target, PoseTarget)
            self._robot.inverse(self._flange(move, move.target.pose, np.zeros(self._robot.size)))
        except UnreachableError as reason:
            return _at(move, i, f"target cannot be reached: {reason}")
        except AssertionError:
            pass
        return _at(
            move, i, f"the arm leaves its reach {where}, {1e3 * error:.3g} mm short of the path"
        )

    def _route(
        self,
        program: Program,
        legs: _Legs,
        waypoints: dict[int, _Waypoint],
        q: FloatArray,
        notes: list[Note],
    ) -> Route:
        """Join the stages and drop moves that go nowhere; their stops and waits stay."""
        ends = _joined(legs.ends)
        keep = make_segments(ends).scale > _NOWHERE
        zones: list[Zone] = []
        owners: list[int] = []
        dwell = [0.0]
        for kept, move in zip(keep, legs.moves, strict=True):
            here = waypoints[move]
            if kept:
                zones.append(here.zone)
                owners.append(move)
                dwell.append(here.dwell)
                continue
            dwell[-1] += here.dwell
            if zones and (here.zone == FINE or zones[-1] == FINE):
                zones[-1] = FINE
            elif zones:
                zones[-1], owners[-1] = here.zone, move
            notes.append(Note("goes nowhere: it is at its target already", move))
        which = np.flatnonzero(keep)
        speeds = [program.moves[legs.moves[k]].speed for k in which]
        changes = [a != b for a, b in pairwise(speeds)]
        return Route(
            _rows(ends, which),
            tuple(legs.chains[k] for k in which),
            tuple(legs.moves[k] for k in which),
            tuple(zones[:-1]),
            tuple(owners[:-1]),
            np.array(dwell),
            np.array([False, *changes, False]),
            self.solved,
            self.prescribed,
            tuple(replace(n, span=n.span or _span(program, n.move)) for n in notes),
        )


def _span(program: Program, move: int | None) -> Span | None:
    origin = None if move is None else program.moves[move].origin
    return None if origin is None else origin.statement


def _at(move: Move, index: int, message: str) -> MotionError:
    span = None if move.origin is None else move.origin.statement
    return MotionError(message, index, span)


def _check_arc(move: Move, i: int, start: FloatArray, via: FloatArray, end: FloatArray) -> None:
    a, b = via - start, end - start
    sizes = np.linalg.norm(a), np.linalg.norm(b), np.linalg.norm(end - via)
    if min(sizes) < 1e-6:
        raise _at(
            move,
            i,
            "two of the three points of the arc are the same (nearer than 0.001 mm): an arc needs "
            "three different points",
        )
    if np.linalg.norm(np.cross(a, b)) < _COLLINEAR * sizes[0] * sizes[1]:
        raise _at(
            move,
            i,
            "the three points of the arc lie on a line: move the auxiliary point, or use a "
            "linear move",
        )


def _waypoints(program: Program) -> dict[int, _Waypoint]:
    """Zone and dwell at the end of every move, waits and stopping statements included."""
    found: dict[int, _Waypoint] = {}
    index = -1
    for statement in program.statements:
        if isinstance(statement, Wait):
            if index >= 0:
                found[index] = _Waypoint(FINE, found[index].dwell + statement.duration)
        elif isinstance(statement, Opaque):
            if statement.stops and index >= 0:
                found[index] = replace(found[index], zone=FINE)
        else:
            index += 1
            found[index] = _Waypoint(statement.zone)
    return found


def _joined(parts: Sequence[Ends]) -> Ends:
    return Ends(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in Ends.__dataclass_fields__
        )
    )


def _rows(ends: Ends, which: NDArray[np.int64]) -> Ends:
    return Ends(*(getattr(ends, name)[which] for name in Ends.__dataclass_fields__))


def _nominal(segments: Segments) -> TcpCurves:
    """Curves on which segment k spans σ from k to k + 1, without zones."""
    count = len(segments.scale)
    corners = Corners(np.zeros(count - 1, dtype=np.int64), np.zeros((count - 1, 3, 2)), [])
    unit = replace(segments, scale=np.ones(count))
    return make_tcp_curves(Layout.of(unit, corners), MotionModel()).curves
