"""Resolves a program's waypoints: frames, configurations, stops, and which moves really move.

Where a move of the TCP arrives is found by walking down its nominal path.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...errors import FaultCause, InputError, MotionError, Note, Span
from ...program.entry_point import listed
from ...program.move import Move, MoveC, MoveJ, Opaque, Wait
from ...program.program import Program
from ...program.target import JointTarget, PoseTarget
from ...program.tool import WORLD, Tool, WorkObject
from ...program.zone import FINE, Zone
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import pose
from ...robot.model import Robot
from ...robot.work_chain import work_chain
from ..geometry.corners import Corners
from ..geometry.curves import Samples, TcpCurves
from ..geometry.layout import Layout
from ..geometry.segments import (
    ARC_SEGMENT,
    JOINT_SEGMENT,
    LINE_SEGMENT,
    Ends,
    Segments,
    make_segments,
)
from ..geometry.tcp_curves import make_tcp_curves
from ..model.blend import PARABOLA
from ..model.rules import ArcTurn, LineTurn
from .configurations import ConfigurationFinder, Label, located
from .path import Route
from .programmed_speeds import programmed
from .route_checks import check_near, half_turns, is_arc
from .tcp_samples import CONVERGED, States
from .tcp_walk import sample_tcp
from .unreachable import why_stranded

if TYPE_CHECKING:
    from ...dialect import ArcRules

_START = -1
_STRAIGHT = (
    "the three points of the arc lie on a line: it is driven as the line. Some controllers stop "
    "there: use a linear move"
)
_NOWHERE = 1e-6
"""Scale (m or rad) below which a move goes nowhere: targets are written with about that precision,
and a move of nothing would be a stop more."""


@dataclass
class MoveGroup:
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
    """Resolved moves, before those that go nowhere are dropped.

    Args:
        at_start: index of the move whose target is taken for the start; None if that is known.
        straight: indices of arcs whose points lie on a line.
    """

    at_start: int | None = None
    ends: list[Ends] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    moves: list[int] = field(default_factory=list)
    straight: list[int] = field(default_factory=list)


class RouteFinder:
    """Resolves programs for one robot.

    Args:
        robot: the robot.
        label: the vendor's label of a configuration; None where vendors have none.
        line_turn, arc_turn: how the tool turns along lines and arcs.
        arcs: which arcs the vendor's controllers drive; None for all.
        nearest: see `ConfigurationFinder`.
    """

    def __init__(
        self,
        robot: Robot,
        label: Label,
        line_turn: LineTurn,
        arc_turn: ArcTurn,
        arcs: ArcRules | None = None,
        nearest: bool = False,
    ) -> None:
        self._robot = robot
        self._arcs = arcs
        self._line_turn = line_turn
        self._arc_turn = arc_turn
        self._targets = ConfigurationFinder(robot, label, nearest)
        self._chains: dict[tuple[Tool, WorkObject], Chain] = {}

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
            raise _no_move(program)
        for i, move in enumerate(moves):
            if move.open:
                raise located(move, i, move.open, FaultCause.OPEN)
            if i not in skipped:
                check_near(move, i)
        notes: list[Note] = []
        self._targets.departures.clear()
        q = self._start(program, start, notes)
        legs = _Legs(0 if notes else None)
        for stage in self._stages(moves, skipped):
            q = self._drive(moves, stage, q, legs)
        route = self._route(program, legs, _waypoints(program), notes)
        return replace(route, left_out=tuple(sorted(skipped)))

    def _start(self, program: Program, start: JointTarget | None, notes: list[Note]) -> FloatArray:
        start = start or program.start
        rest = self._targets.rest()
        if start is not None:
            return self._targets.joints(start, rest)
        notes.append(Note("no start is known: the robot is taken to stand at the first target", 0))
        first = program.moves[0]
        if isinstance(first.target, JointTarget):
            return self._targets.joints(first.target, rest)
        return self._targets.choose(first, 0, rest)

    def starts(self, program: Program) -> tuple[JointTarget, ...]:
        """Where the robot may stand at the first target of a program that states no start.

        The one that `find` takes is the first; a target of joint values leaves no choice.

        Raises:
            MotionError: the target cannot be reached.
        """
        first = program.moves[0]
        if program.start is not None or isinstance(first.target, JointTarget):
            return ()
        return tuple(map(self._as_target, self._targets.starts(first, 0)))

    def standing_at(self, move: Move, near: JointTarget | None) -> JointTarget:
        """A robot at the target of a move, however it came there.

        Args:
            move: the programmed configuration is taken where there is a solution with it.
            near: of the solutions the nearest to it is taken; None for any.

        Raises:
            MotionError: it cannot stand there.
        """
        finder = self._targets
        q = finder.rest() if near is None else finder.joints(near, finder.rest())
        if not isinstance(move.target, JointTarget):
            plain = replace(move, target=replace(move.target, configuration=None))
            try:
                return self._as_target(finder.choose(move, 0, q))
            except MotionError:
                return self._as_target(finder.choose(plain, 0, q))
        try:
            return self._as_target(finder.joints(move.target, q))
        except InputError as error:
            raise MotionError(str(error)) from error

    def _as_target(self, q: FloatArray) -> JointTarget:
        arm = self._robot.arm_size
        return JointTarget(tuple(map(float, q[:arm])), tuple(map(float, q[arm:])))

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

    def _stages(self, moves: Sequence[Move], skipped: Collection[int]) -> list[MoveGroup]:
        stages: list[MoveGroup] = []
        for i, move in enumerate(moves):
            if i in skipped:
                continue
            try:
                chain = self.chain(move.tool, move.work_object)
            except InputError as error:
                raise located(move, i, str(error)) from error
            if not stages or stages[-1].chain is not chain:
                stages.append(MoveGroup(chain, move.tool, move.work_object, []))
            stages[-1].moves.append(i)
        return stages

    def _drive(
        self, moves: Sequence[Move], stage: MoveGroup, q: FloatArray, legs: _Legs
    ) -> FloatArray:
        """Resolve the moves of a stage from configuration q; returns where it ends."""
        ends = self._ends(moves, stage, q, legs)
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

    def _ends(self, moves: Sequence[Move], stage: MoveGroup, q: FloatArray, legs: _Legs) -> Ends:
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
                    known[k + 1] = self._targets.joints(move.target, known[k])
                    pose(stage.chain, known[k + 1], rotation[k + 1], position[k + 1])
                else:
                    known[k + 1] = self._targets.external(move.target.external, known[k])
                    matrix = move.target.pose.matrix()
                    position[k + 1], rotation[k + 1] = matrix[:3, 3], matrix[:3, :3]
            except InputError as error:
                raise located(move, i, str(error)) from error
            if isinstance(move, MoveC):
                auxiliary = move.via.pose.matrix()
                via[k], via_rotation[k] = auxiliary[:3, 3], auxiliary[:3, :3]
                follows[k] = self._arc_turn.follows(move.orientation)
                arc = is_arc(move, i, (position[k], via[k], position[k + 1]), self._arcs)
                if arc:
                    kind[k] = ARC_SEGMENT
                else:
                    legs.straight.append(i)
        pairs = np.stack([np.arange(count), np.arange(count) + 1], -1)
        prescribed = known[:, self._targets.prescribed]
        return Ends(
            kind,
            np.zeros((count, 2, size)),
            position[pairs],
            rotation[pairs],
            prescribed[pairs],
            via,
            via_rotation,
            follows,
            (kind == LINE_SEGMENT) & (self._line_turn is LineTurn.SWIVEL),
            **programmed([moves[i].speed for i in stage.moves]),
        )

    def _joint_end(self, move: Move, i: int, q: FloatArray) -> FloatArray:
        """Where a joint move from q ends."""
        if isinstance(move.target, JointTarget):
            return self._targets.joints(move.target, q)
        return self._targets.choose(move, i, q)

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
        if len(self._targets.solved) != 6:
            raise located(
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
        failed, short, reached = sample_tcp(
            chain,
            self._targets.solved,
            self._targets.prescribed,
            curves,
            Samples(sigma, index, index, index),
            q,
            states,
            pivots,
        )
        if failed >= 0:
            reason = self._targets.why_unreachable(move, q) if short > CONVERGED else None
            if reason is not None:
                raise located(move, i, f"target cannot be reached: {reason}", reason.cause)
            share, length = reached - k, float(segments.length[k])
            raise located(
                move, i, *why_stranded(self._robot, states.q[failed], share, length, short)
            )
        arrived: FloatArray = states.q[-1].copy()
        self._targets.check_arrival(move, i, arrived)
        return arrived

    def _route(
        self,
        program: Program,
        legs: _Legs,
        waypoints: dict[int, _Waypoint],
        notes: list[Note],
    ) -> Route:
        """Join the stages and drop moves that go nowhere; their stops and waits stay."""
        ends = _joined(legs.ends)
        segments = make_segments(ends)
        keep = segments.scale > _NOWHERE
        zones: list[Zone] = []
        owners: list[int] = []
        dwell = [waypoints[_START].dwell]
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
            if move != legs.at_start:
                notes.append(Note("goes nowhere: it is at its target already", move))
        notes += half_turns(segments, keep, legs.moves)
        notes += [Note(_STRAIGHT, move) for move in legs.straight]
        for move, said in self._targets.departures.items():
            target = program.moves[move].target
            assert isinstance(target, PoseTarget)
            notes.append(Note(f"configuration {target.configuration} {said}", move))
        which = np.flatnonzero(keep)
        speeds = [program.moves[legs.moves[k]].speed for k in which]
        changes = [a != b for a, b in pairwise(speeds)]
        return Route(
            self._robot,
            _rows(ends, which),
            tuple(legs.chains[k] for k in which),
            tuple(legs.moves[k] for k in which),
            tuple(zones[:-1]),
            tuple(owners[:-1]),
            np.array(dwell),
            np.array([False, *changes, False]),
            self._targets.solved,
            self._targets.prescribed,
            tuple(replace(n, span=n.span or _span(program, n.move)) for n in notes),
        )


def _span(program: Program, move: int | None) -> Span | None:
    return None if move is None else program.moves[move].statement


def _waypoints(program: Program) -> dict[int, _Waypoint]:
    """Zone and dwell at the start and at the end of every move, stopping statements included."""
    found = {_START: _Waypoint(FINE)}
    index = _START
    for statement in program.statements:
        if isinstance(statement, Wait):
            found[index] = _Waypoint(FINE, found[index].dwell + statement.duration)
        elif isinstance(statement, Opaque):
            if statement.stops:
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
    return make_tcp_curves(Layout.of(unit, corners), PARABOLA, PARABOLA).curves


def _no_move(program: Program) -> MotionError:
    reading = program.reading
    offer = "choose as the entry the routine that drives"
    if any(entry.moves for entry in program.entries):
        offer += f": {listed(program.entries)}"
    return MotionError(
        f"program {program.name!r} has no move: {offer}",
        span=None if reading is None else Span(reading.main, 1, 1, 0, 0),
    )
