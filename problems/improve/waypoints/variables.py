"""The numbers of a program that an optimisation changes, as one vector.

Data that several moves read are one set of variables; what they are, `parts` says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.motion.gradients.derivatives import ProgramGradient
from ....core.program.move import Move
from ....core.program.program import Program
from ....core.program.target import JointTarget
from ....core.program.zone import ContourFraction, Radius, VendorZone
from ....core.robot.model import Robot
from ..rounding import Rounding
from .changeable import Selection
from .options import WaypointTask
from .oriented import OrientedPoint
from .parts import JointPoint, PosePoint, ProgramPart, ZonePart, ZoneRadius, ZoneShare
from .point_limits import PointBox, PointLimit

_LEAST_SHARE = 0.5
"""Share of a zone's lower bound that is left at least where rounding asks for a smaller one."""
_LIMIT_MARGIN = 1e-6
"""rad or m that joint targets keep from the joints' limits."""


class ProgramVariables:
    """A program's variables.

    Args:
        program: as it was given.
        parts: of the vector, in order.

    Attributes:
        offsets: (len(parts) + 1,), where each part begins.
        lower, upper, scale, start: (n,).
    """

    def __init__(self, program: Program, parts: Sequence[ProgramPart]) -> None:
        self.program = program
        self.parts = tuple(parts)
        self.offsets = np.concatenate([[0], np.cumsum([part.size for part in parts])]).astype(int)
        empty = [np.zeros(0)]
        self.lower = np.concatenate([part.bounds()[0] for part in parts] or empty)
        self.upper = np.concatenate([part.bounds()[1] for part in parts] or empty)
        self.scale = np.concatenate([part.scale() for part in parts] or empty)
        self.start = np.clip(
            np.concatenate([part.values() for part in parts] or empty), self.lower, self.upper
        )

    @property
    def size(self) -> int:
        """Number of variables."""
        return int(self.offsets[-1])

    @cached_property
    def free(self) -> IntArray:
        """Indices of those that have room between their bounds."""
        return np.flatnonzero(self.lower < self.upper)

    def columns(self, part: int) -> slice:
        """Where the values of one part stand."""
        return slice(self.offsets[part], self.offsets[part + 1])

    def of(self, part: int, x: FloatArray) -> FloatArray:
        """The values of one part."""
        return x[self.columns(part)]

    def applied(self, x: FloatArray) -> Program:
        """The program with these values."""
        return self._with(x, lambda part, move, values: part.applied(move, values))

    def written(self, x: FloatArray, rounding: Rounding) -> Program:
        """The program with numbers near these values, as a person would write them."""
        return self._with(x, lambda part, move, values: part.written(move, values, rounding))

    def _with(
        self, x: FloatArray, changed: Callable[[ProgramPart, Move, FloatArray], Move]
    ) -> Program:
        moves = list(self.program.moves)
        for index, part in enumerate(self.parts):
            for i in part.moves:
                moves[i] = changed(part, moves[i], self.of(index, x))
        return self.program.with_moves(tuple(moves))

    def with_chosen_zones(self, x: FloatArray, rounding: Rounding) -> ProgramVariables:
        """The same with each radius held at the predefined one that is nearest below x."""
        least = min(rounding.predefined, key=lambda zone: zone.tcp)
        parts: list[ProgramPart] = []
        for index, part in enumerate(self.parts):
            if isinstance(part, ZoneRadius):
                zone = rounding.zone(Radius(float(self.of(index, x)[0])))
                part = ZoneRadius(part.moves, zone if isinstance(zone, Radius) else least, True)
            parts.append(part)
        return ProgramVariables(self.program, parts)

    def with_smaller_zone(self, x: FloatArray, move: int, by: float) -> FloatArray:
        """Values x with a smaller zone at a move, by m or a share; x if it has none here. What
        rounding takes from a leg that is no longer than the least zone is taken from the zone."""
        smaller = x.copy()
        for index, part in enumerate(self.parts):
            if isinstance(part, ZonePart) and move in part.moves:
                own = self.offsets[index]
                smaller[own] = max(smaller[own] - by, _LEAST_SHARE * self.lower[own])
        return smaller

    def gradient(self, made: ProgramGradient, x: FloatArray) -> FloatArray:
        """(n,) from the gradient with respect to the program's parameters."""
        found = [part.gradient(made, self.of(k, x)) for k, part in enumerate(self.parts)]
        return np.concatenate(found or [np.zeros(0)])


def make_variables(
    program: Program, robot: Robot, selection: Selection, task: WaypointTask
) -> ProgramVariables:
    """The variables of a selection: of every via point its target, then its zone."""
    parts: list[ProgramPart] = [_point(program, robot, group, task) for group in selection.points]
    for group in selection.zones:
        zone = program.moves[group[0]].zone
        if isinstance(zone, ContourFraction | VendorZone):
            parts.append(ZoneShare(group, zone))
        elif isinstance(zone, Radius):
            parts.append(ZoneRadius(group, zone))
    order = sorted(range(len(parts)), key=lambda k: (parts[k].moves[0], k))
    return ProgramVariables(program, [parts[k] for k in order])


def _point(
    program: Program, robot: Robot, group: tuple[int, ...], task: WaypointTask
) -> ProgramPart:
    target = program.moves[group[0]].target
    limits = [task.limits.get(i, task.limit) for i in group]
    turns = [turn for i in group if (turn := task.turn_at(i)) is not None]
    if isinstance(target, JointTarget):
        return _joint_point(target, robot, group, task, limits, min(turns, default=np.inf))
    shift = np.full(3, np.inf)
    for limit in limits:
        position = getattr(limit, "position", None)
        if position is not None:
            shift = np.minimum(shift, position)
    return PosePoint(group, target, shift, min(turns, default=np.inf))


def _joint_point(
    target: JointTarget,
    robot: Robot,
    group: tuple[int, ...],
    task: WaypointTask,
    limits: Sequence[PointLimit],
    turn: float,
) -> JointPoint:
    axes = task.free_axes(robot)
    now = np.array(target.joints)[axes]
    lower = robot.limits.lower[axes] + _LIMIT_MARGIN
    upper = robot.limits.upper[axes] - _LIMIT_MARGIN
    for limit in limits:
        if isinstance(limit, PointBox) and limit.joints is not None:
            ranges = np.array(limit.joints)[axes]
            lower, upper = np.maximum(lower, now - ranges), np.minimum(upper, now + ranges)
    bounds = np.minimum(lower, now), np.maximum(upper, now)
    if turn == 0.0:
        return OrientedPoint(group, target, tuple(axes), *bounds, robot.arm_chain)
    return JointPoint(group, target, tuple(axes), *bounds)
