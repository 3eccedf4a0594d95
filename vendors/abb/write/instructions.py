"""Moves and motion settings as instructions: one rule of syntax a function.

Section names are those of the "RAPID Reference Manual", instructions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ....core.errors import InputError
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.move import Move, MoveC, MoveJ, MoveL
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD
from ..values.records import load_record
from .events import Said
from .formatting import literal
from .numbers import number
from .operands import Operand, Operands

Line = tuple[Operand, ...]
"""Text, and data whose names are not given yet."""

LEAST_SHARES = (0.2, 0.1)
"""``AccSet`` takes a smaller acceleration or ramp as this much."""


def move_line(move: Move, said: Said, operands: Operands, places: Sequence[Line] = ()) -> Line:
    """The move instruction.

    Args:
        said: the instruction's name, and what its events add to it.
        places: where it goes to and through, where that is not the move's own target.

    Raises:
        InputError: RAPID cannot say it.
    """
    if move.tool.robot_held == move.work_object.robot_held:
        raise InputError(
            f"one of tool {move.tool.name} and work object {move.work_object.name} is held by the "
            "robot and the other stands still; here both are alike"
        )
    if places:
        points = tuple(part for place in reversed(places) for part in (",", *place))[1:]
    elif isinstance(move.target, JointTarget):
        points = _joint_point(move, move.target, operands)
    else:
        points = _points(move, move.target, operands)
    return (f"{said.verb} ", *points, *_tail(move, said, operands))


def _joint_point(move: Move, target: JointTarget, operands: Operands) -> Line:
    """``ToJointPos`` (MoveAbsJ)."""
    if not isinstance(move, MoveJ):
        raise InputError(
            f"RAPID's {type(move).__name__} takes a robtarget, not joint values: give it the pose"
        )
    return (operands.jointtarget(target),)


def _points(move: Move, target: PoseTarget, operands: Operands) -> Line:
    """``ToPoint`` (MoveJ, MoveL), ``CirPoint, ToPoint`` (MoveC)."""
    if isinstance(move, MoveC):
        # Under ConfL \Off the configuration of neither point is looked at.
        via = move.via if target.configuration else replace(move.via, configuration=None)
        return (operands.robtarget(via), ",", operands.robtarget(target))
    return (operands.robtarget(target),)


def _tail(move: Move, said: Said, operands: Operands) -> Line:
    r"""``, Speed [\T] [,Trigg_1 [\T2] …], Zone, Tool [\WObj] [, Signal, Value];``"""
    duration = move.speed.duration
    frame: Line = ("\\WObj:=", operands.work_object(move.work_object))
    triggers = [
        part
        for number_, trigger in enumerate(said.triggers, 1)
        for part in ("," if number_ == 1 else f"\\T{number_}:=", trigger)
    ]
    return (
        *(",", operands.speed(move.speed)),
        "" if duration is None else f"\\T:={number(duration)}",
        *triggers,
        *(",", operands.zone(move.zone)),
        *(",", operands.tool(move.tool)),
        *(() if move.work_object == WORLD else frame),
        f"{said.output};",
    )


class WrittenSettings:
    """What holds until it is changed.

    Args:
        known: whether it is what a program starts with; else nothing is known.
    """

    def __init__(self, known: bool = True) -> None:
        self._load = literal(load_record(None)) if known else ""
        self._held: dict[str, str] = (
            {}
            if not known
            else {
                "ConfJ": "ConfJ \\On;",
                "ConfL": "ConfL \\On;",
                "AccSet": "AccSet 100,100;",
                "PathAccLim": "PathAccLim FALSE,FALSE;",
                "CirPathMode": "CirPathMode \\PathFrame;",
            }
        )

    def changes(self, move: Move, operands: Operands) -> list[Line]:
        """The instructions that must stand before a move."""
        changed: list[Line] = []
        for setting in (_monitoring, _singularity, _circle, _acceleration, _path_acceleration):
            text = setting(move)
            instruction = text.partition(" ")[0]
            if text and self._held.get(instruction) != text:
                self._held[instruction] = text
                changed.append((text,))
        return [*changed, *self._grip_load(move, operands)]

    def _grip_load(self, move: Move, operands: Operands) -> list[Line]:
        """``GripLoad Load``; under another name the same load changes nothing."""
        load = literal(load_record(move.load))
        if load == self._load:
            return []
        self._load = load
        return [("GripLoad ", operands.load(move.load), ";")]


def _monitoring(move: Move) -> str:
    r"""``ConfJ``, ``ConfL`` ``\On|\Off``: off where the target names no configuration."""
    if not isinstance(move.target, PoseTarget):
        return ""
    instruction = "ConfJ" if isinstance(move, MoveJ) else "ConfL"
    return f"{instruction} \\{'Off' if move.target.configuration is None else 'On'};"


def _singularity(move: Move) -> str:
    r"""``SingArea \Off``: TCP moves keep to the programmed orientation."""
    return "SingArea \\Off;" if isinstance(move, MoveL | MoveC) else ""


def _circle(move: Move) -> str:
    """``CirPathMode``: how the tool turns along arcs."""
    if not isinstance(move, MoveC):
        return ""
    follows = move.orientation is ArcOrientation.FOLLOWS_ARC
    return f"CirPathMode \\{'PathFrame' if follows else 'ObjectFrame'};"


def _acceleration(move: Move) -> str:
    """``AccSet Acc, Ramp`` in percent."""
    if move.speed.acceleration_override != 1.0:
        raise InputError(
            "RAPID has no words for an override of all accelerations "
            "(Speed.acceleration_override): give Speed.joint_acceleration_fraction"
        )
    shares = (move.speed.joint_acceleration_fraction, move.speed.jerk_fraction)
    for share, least, what in zip(shares, LEAST_SHARES, ("acceleration", "jerk"), strict=True):
        if share < least:
            raise InputError(f"AccSet goes down to {least:.0%} of the {what}, not {share:.1%}")
    acceleration, ramp = (number(100 * share) for share in shares)
    return f"AccSet {acceleration},{ramp};"


def _path_acceleration(move: Move) -> str:
    r"""``PathAccLim AccLim [\AccMax], DecelLim [\DecelMax]`` in m/s²."""
    limit = move.speed.tcp_acceleration
    if limit is None:
        return "PathAccLim FALSE,FALSE;"
    return f"PathAccLim TRUE\\AccMax:={number(limit)},TRUE\\DecelMax:={number(limit)};"
