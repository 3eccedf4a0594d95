"""Moves of what a line says of them, and arcs that stand on several lines."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from ...errors import InputError
from ...program.arc_orientation import ArcOrientation
from ...program.event import Event
from ...program.move import Move, MoveC, MoveJ, MoveL
from ...program.speed import Speed
from ...program.target import JointTarget, PoseTarget, Target
from ...program.tool import FLANGE, WORLD, Tool, WorkObject
from ...program.zone import Zone
from ...spatial.pose import Pose
from .statements import Operand

_GROUPS = ("speed", "unit", "share", "pace", "zone", "word", "size", "behind", "tool", "frame")
"""What a motion says beside where it goes."""


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


def said(move: Move) -> tuple[str, tuple[Target, ...]]:
    """``J``, ``L`` or ``C`` of a move, and its targets in the order in which they are named."""
    targets = (move.via, move.target) if isinstance(move, MoveC) else (move.target,)
    return type(move).__name__[-1], targets


def counted_on(target: Target, before: Move | None, tool: Tool, work_object: WorkObject) -> Target:
    """Where a motion goes whose numbers count from the position before (``INC``).

    Args:
        target: of its numbers: what is added to joint values, or to x, y, z, and turned.
        before: the motion before; None if nobody knows it.
        tool, work_object: of the motion.

    Raises:
        InputError: the position before is of another kind, or is not known.
    """
    here = None if before is None else before.target
    if isinstance(target, JointTarget) and isinstance(here, JointTarget):
        pairs = zip(target.joints, here.joints, strict=True)
        return JointTarget(tuple(a + b for a, b in pairs))
    same = before is not None and (before.tool, before.work_object) == (tool, work_object)
    if not (isinstance(target, PoseTarget) and isinstance(here, PoseTarget) and same):
        raise InputError(
            "it counts from the position before, which is none of the same kind in the same "
            "frames, or is not known"
        )
    x, y, z = (a + b for a, b in zip(here.pose.position, target.pose.position, strict=True))
    turned = Pose(quaternion=target.pose.quaternion) @ Pose(quaternion=here.pose.quaternion)
    return replace(target, pose=Pose((x, y, z), turned.quaternion))


def said_beside(found: re.Match[str]) -> dict[str, str]:
    """What a motion says beside where it goes, by group."""
    given = found.groupdict()
    return {one: " ".join((given.get(one) or "").split()) for one in _GROUPS}


def said_otherwise(via: Mapping[str, str], end: Mapping[str, str]) -> str:
    """What to note of an arc whose auxiliary point is said on a line of its own; its zone says
    nothing, since arcs pass such points.

    Raises:
        InputError: that point is one of another tool or frame.
    """
    other = [one for one in _GROUPS if via.get(one) and via[one].upper() != end[one].upper()]
    if "tool" in other or "frame" in other:
        raise InputError(
            "the line of its auxiliary point names another tool or frame: an arc has one"
        )
    if not {"speed", "unit", "share"} & {*other}:
        return ""
    said = " ".join(via[one] for one in ("speed", "unit", "share") if via[one])
    return f"the line of its auxiliary point says {said}: all of the arc is driven as its end says"


class ArcPoints:
    """Arcs of one point a line: the first is where they begin, then one on the way and one at an
    end, in turn; another kind of move ends them."""

    def __init__(self) -> None:
        self._count = 0
        self._middle: Operand | None = None
        self._before = ""

    def end(self, called: str) -> None:
        """Another kind of move stands here, to a fixed point of this name, or to none (``""``).

        Raises:
            InputError: an arc has no end.
        """
        if self._middle is not None:
            raise InputError("the arc before has no end: such arcs have three points")
        self._count, self._before = 0, called

    def add(self, point: Operand, called: str) -> tuple[str, Operand | None]:
        """How a point is driven to: ``L`` to where the arc begins, ``C`` with what is driven
        through, ``""`` if it is that, or the fixed point at which the robot stands already."""
        stands = called != "" and called == self._before and self._middle is None
        self._count, self._before = 1 if stands else self._count + 1, called
        if self._count == 1:
            return "" if stands else "L", None
        if self._count % 2 == 0:
            self._middle = point
            return "", None
        middle, self._middle = self._middle, None
        return "C", middle
