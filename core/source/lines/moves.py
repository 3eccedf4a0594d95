"""Moves of what a line says of them, and arcs that stand on several lines."""

from __future__ import annotations

from typing import Generic, TypeVar

from ...errors import InputError
from ...program.arc_orientation import ArcOrientation
from ...program.event import Event
from ...program.move import Move, MoveC, MoveJ, MoveL
from ...program.speed import Speed
from ...program.target import JointTarget, PoseTarget, Target
from ...program.tool import FLANGE, WORLD, Tool, WorkObject
from ...program.zone import Zone

Point = TypeVar("Point")


def made_move(
    kind: str,
    target: Target,
    speed: Speed,
    zone: Zone,
    tool: Tool = FLANGE,
    work_object: WorkObject = WORLD,
    via: Target | None = None,
    events: tuple[Event, ...] = (),
    turning: ArcOrientation = ArcOrientation.FIXED_FRAME,
) -> Move:
    """A joint move (``J``), a line (``L``) or an arc (``C``).

    Args:
        via: the auxiliary point of an arc.
        turning: how the tool turns along an arc.

    Raises:
        InputError: a line or an arc goes to joint values.
    """
    if kind == "J":
        return MoveJ(target, speed, zone, tool, work_object, events=events)
    if isinstance(target, JointTarget):
        raise InputError("lines and arcs to joint values are not emulated: give a pose")
    if kind == "L":
        return MoveL(target, speed, zone, tool, work_object, events=events)
    if not isinstance(via, PoseTarget):
        raise InputError("arcs through joint values are not emulated: give a pose")
    return MoveC(
        target, speed, zone, tool, work_object, events=events, via=via, orientation=turning
    )


class ArcPoints(Generic[Point]):
    """Arcs of one point a line: the first is where they begin, then one on the way and one at an
    end, in turn; another kind of move ends them."""

    def __init__(self) -> None:
        self._count = 0
        self._middle: Point | None = None

    def end(self) -> None:
        """Another kind of move stands here.

        Raises:
            InputError: an arc has no end.
        """
        if self._middle is not None:
            raise InputError("the arc before has no end: such arcs have three points")
        self._count = 0

    @property
    def open(self) -> bool:
        """Whether the point on the way is still to come."""
        return self._middle is None

    def begin(self) -> None:
        """The robot stands where the arc begins."""
        self._count = 1

    def add(self, point: Point) -> tuple[str, Point | None]:
        """How a point is driven to: ``L`` to where the arc begins, ``C`` with what is driven
        through, ``""`` if it is that."""
        self._count += 1
        if self._count == 1:
            return "L", None
        if self._count % 2 == 0:
            self._middle = point
            return "", None
        middle, self._middle = self._middle, None
        return "C", middle
