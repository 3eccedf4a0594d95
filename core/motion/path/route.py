"""Resolves a program's waypoints: frames, configurations, stops, and which moves really move.

Where a move of the TCP arrives is found by walking down its nominal path.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ...arrays import FloatArray
from ...errors import FaultCause, InputError, MotionError, Note, Span
from ...program.assumed_places import doubtful_places
from ...program.move import Move, MoveC, MoveJ
from ...program.program import Program
from ...program.target import JointTarget, PoseTarget
from ...program.tool import WORLD, Tool, WorkObject
from ...robot.kinematics.chain import Chain
from ...robot.kinematics.chain_kernels import fill_poses
from ...robot.model import Robot
from ...robot.work_chain import work_chain
from ..configurations.finder import ConfigurationFinder, Label
from ..configurations.remarks import Remarks
from ..configurations.targets import located
from ..geometry.segments import (
    ARC_SEGMENT,
    JOINT_SEGMENT,
    LINE_SEGMENT,
    Ends,
    make_segments,
)
from ..model.rules import ArcTurn, LineTurn
from .following import Nominal, PathFollower
from .kept_route import with_other_numbers
from .no_move import no_move
from .path import Route
from .programmed_speeds import programmed
from .route_checks import arm_angle_notes, check_near, half_turns, is_arc
from .route_legs import NOWHERE, MoveEnd, RouteLegs, move_ends_of, rows_of

if TYPE_CHECKING:
    from ...dialect import ArcRules

_STRAIGHT = (
    "the three points of the arc lie on a line: it is driven as the line. Some controllers stop "
    "there: use a linear move"
)


@dataclass
class MoveGroup:
    """Moves in a row that share one tool and one work object."""

    chain: Chain
    tool: Tool
    work_object: WorkObject
    moves: list[int]


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
        self._finder = ConfigurationFinder(robot, label, nearest)
        self._targets = self._finder.targets
        self._follower = PathFollower(robot, self._finder)
        self._chains: dict[tuple[Tool, WorkObject], Chain] = {}
        self._last: tuple[Tool, WorkObject, Chain] | None = None
        self._known: tuple[Program, Route] | None = None

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
            raise no_move(program)
        plain = start is None and not skipped
        if plain and self._known is not None:
            again = with_other_numbers(*self._known, program)
            if again is not None:
                self._known = program, again
                return again
        before: Move | None = None
        for i, move in enumerate(moves):
            if move.open or move.unsettled:
                raise _left_open(move, i)
            if i not in skipped:
                check_near(move, i, before)
                before = move
        notes: list[Note] = []
        self._finder.remarks = Remarks(doubtful_places(program))
        q = self._start(program, start, notes)
        legs = RouteLegs(0 if notes else None)
        for stage in self._stages(moves, skipped):
            q = self._drive(moves, stage, q, legs)
        route = self._route(program, legs, move_ends_of(program), notes)
        if plain:
            self._known = program, route
        return replace(route, left_out=tuple(sorted(skipped))) if skipped else route

    def _start(self, program: Program, start: JointTarget | None, notes: list[Note]) -> FloatArray:
        start = start or program.start
        rest = self._targets.rest()
        if start is not None:
            return self._targets.joints(start, rest)
        notes.append(Note("no start is known: the robot is taken to stand at the first target", 0))
        first = program.moves[0]
        if isinstance(first.target, JointTarget):
            return self._targets.joints(first.target, rest)
        return self._finder.choose(first, 0, rest)

    def starts(self, program: Program) -> tuple[JointTarget, ...]:
        """Where the robot may stand at the first target of a program that states no start.

        The one that `find` takes is the first; a target of joint values leaves no choice.

        Raises:
            MotionError: the target cannot be reached.
        """
        first = program.moves[0]
        if program.start is not None or isinstance(first.target, JointTarget):
            return ()
        self._finder.remarks = Remarks(doubtful_places(program))
        return tuple(map(self._as_target, self._finder.starts(first, 0)))

    def standing_at(self, move: Move, near: JointTarget | None) -> JointTarget:
        """A robot at the target of a move, however it came there.

        Args:
            move: the programmed configuration is taken where there is a solution with it.
            near: of the solutions the nearest to it is taken; None for any.

        Raises:
            MotionError: it cannot stand there, or nobody knows where that is.
        """
        if move.open:
            raise _left_open(move, 0)
        finder, targets = self._finder, self._targets
        q = targets.rest() if near is None else targets.joints(near, targets.rest())
        if not isinstance(move.target, JointTarget):
            plain = replace(move, target=replace(move.target, configuration=None))
            try:
                found = finder.choose(move, 0, q)
            except MotionError:
                found = finder.choose(plain, 0, q)
            if near is not None and not isinstance(move, MoveJ):
                finder.check_posture(move, found, q)
            return self._as_target(found)
        try:
            return self._as_target(targets.joints(move.target, q))
        except InputError as error:
            raise MotionError(str(error)) from error

    def _as_target(self, q: FloatArray) -> JointTarget:
        arm = self._robot.arm_size
        return JointTarget(tuple(map(float, q[:arm])), tuple(map(float, q[arm:])))

    def chain(self, tool: Tool, work_object: WorkObject) -> Chain:
        """The chain of a tool and a work object, one object for equal ones."""
        if self._last is not None and self._last[0] is tool and self._last[1] is work_object:
            return self._last[2]  # of most moves; a key takes longer to make than a move to drive
        key = tool, work_object
        if key not in self._chains:
            self._chains[key] = work_chain(self._robot, tool, work_object)
        self._last = tool, work_object, self._chains[key]
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
            if (
                not stages
                or stages[-1].chain is not chain
                or _turns_third(moves[stages[-1].moves[-1]])
            ):
                stages.append(MoveGroup(chain, move.tool, move.work_object, []))
            stages[-1].moves.append(i)
        return stages

    def _drive(
        self, moves: Sequence[Move], stage: MoveGroup, q: FloatArray, legs: RouteLegs
    ) -> FloatArray:
        """Resolve the moves of a stage from configuration q; returns where it ends."""
        ends = self._ends(moves, stage, q, legs)
        solutions = self._solutions(moves, stage, ends)
        nominal: Nominal | None = None
        k, count = 0, len(stage.moves)
        while k < count:
            if ends.kind[k] == JOINT_SEGMENT:
                i = stage.moves[k]
                ends.q[k, 0] = q
                q = ends.q[k, 1] = self._joint_end(moves[i], i, q, solutions.get(k))
                k += 1
                continue
            nominal = Nominal(stage.chain, stage.moves, ends) if nominal is None else nominal
            after = k + 1
            while after < count and ends.kind[after] != JOINT_SEGMENT:
                after += 1
            q = self._follower.follow(moves, nominal, range(k, after), q)
            k = after
        legs.ends.append(ends)
        legs.chains += [stage.chain] * count
        legs.moves += stage.moves
        return q

    def _ends(
        self, moves: Sequence[Move], stage: MoveGroup, q: FloatArray, legs: RouteLegs
    ) -> Ends:
        """Poses and prescribed axes at the ends of the stage's moves; configurations to come."""
        count, size = len(stage.moves), self._robot.size
        known = np.empty((count + 1, size))
        known[0] = q
        position, rotation = np.empty((count + 1, 3)), np.empty((count + 1, 3, 3))
        fill_poses(stage.chain, known[:1], rotation[:1], position[:1])
        kind = np.empty(count, dtype=np.int64)
        via, follows = np.zeros((count, 3)), np.zeros(count, dtype=bool)
        via_rotation = np.zeros((count, 3, 3))
        via_rotation[:, [0, 1, 2], [0, 1, 2]] = 1.0
        for k, i in enumerate(stage.moves):
            move = moves[i]
            kind[k] = JOINT_SEGMENT if isinstance(move, MoveJ) else LINE_SEGMENT
            try:
                if isinstance(move.target, JointTarget):
                    known[k + 1] = self._targets.joints(move.target, known[k])
                    end = slice(k + 1, k + 2)
                    fill_poses(stage.chain, known[end], rotation[end], position[end])
                else:
                    if kind[k] != JOINT_SEGMENT and move.target.arm_angle is not None:
                        known[k + 1] = self._finder.led(move, i, known[k])
                        legs.led.append(i)
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
        pairs = np.arange(count)[:, None] + np.array([0, 1])
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

    def _solutions(
        self, moves: Sequence[Move], stage: MoveGroup, ends: Ends
    ) -> dict[int, FloatArray | None]:
        """What `Targets.solutions` finds at the poses that the stage's joint moves end at."""
        targets = [moves[i].target for i in stage.moves]
        which = [
            k
            for k in np.flatnonzero(ends.kind == JOINT_SEGMENT).tolist()
            if isinstance(target := targets[k], PoseTarget) and target.arm_angle is None
        ]
        if not which:
            return {}
        at = np.tile(np.eye(4), (len(which), 1, 1))
        at[:, :3, :3], at[:, :3, 3] = ends.rotation[which, 1], ends.position[which, 1]
        q = np.zeros((len(which), self._robot.size))
        q[:, self._targets.prescribed] = ends.prescribed[which, 1]
        found = self._targets.solutions(stage.tool, stage.work_object, at, q)
        return dict(zip(which, found, strict=True))

    def _joint_end(self, move: Move, i: int, q: FloatArray, known: FloatArray | None) -> FloatArray:
        """Where a joint move from q ends, of which the arm's solutions may be known."""
        if isinstance(move.target, JointTarget):
            return self._targets.joints(move.target, q)
        return self._finder.choose(move, i, q, known)

    def _route(
        self,
        program: Program,
        legs: RouteLegs,
        waypoints: dict[int, MoveEnd],
        notes: list[Note],
    ) -> Route:
        """Join the stages and drop moves that go nowhere; their stops and waits stay."""
        ends = legs.joined()
        segments = make_segments(ends)
        keep = segments.scale > NOWHERE
        passed = legs.passed(keep, waypoints, notes)
        notes += half_turns(segments, keep, legs.moves, self._follower.turned)
        notes += [Note(_STRAIGHT, move) for move in legs.straight]
        notes += arm_angle_notes(self._robot, program, legs.led, self._finder.remarks.uneven)
        notes += self._finder.remarks.notes(program.moves)
        which = np.flatnonzero(keep)
        speeds = [program.moves[legs.moves[k]].speed for k in which]
        changes = [a != b for a, b in pairwise(speeds)]
        return Route(
            self._robot,
            rows_of(ends, which),
            tuple(legs.chains[k] for k in which),
            tuple(legs.moves[k] for k in which),
            tuple(passed.zones[:-1]),
            tuple(passed.owners[:-1]),
            np.array(passed.dwell),
            np.array([False, *changes, False]),
            self._targets.solved,
            self._targets.prescribed,
            tuple(replace(n, span=n.span or _span(program, n.move)) for n in notes),
        )


def _left_open(move: Move, index: int) -> MotionError:
    cause = FaultCause.ERROR if move.stops else FaultCause.OPEN
    return located(move, index, move.open or move.unsettled, cause)


def _turns_third(move: Move) -> bool:
    """Whether a move's end tells where the third axis stands, which the moves after it begin from,
    before it is driven."""
    target = move.target
    return (
        isinstance(move, MoveJ) and isinstance(target, PoseTarget) and target.arm_angle is not None
    )


def _span(program: Program, move: int | None) -> Span | None:
    return None if move is None else program.moves[move].statement
