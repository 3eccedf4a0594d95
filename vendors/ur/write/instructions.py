"""Moves and settings as statements: one rule of syntax a function.

Names of arguments, their order and units: "The URScript Programming Language", modules motion
and internals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.errors import InputError
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.move import Move, MoveC, MoveJ, MoveL
from ....core.program.places import Destination, Vector, rounded
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import WORLD, WorkObject
from ....core.robot.model import Robot
from .declarations import Declarations, Line
from .formatting import comment, listing, number, pose_literal
from .joint_speeds import with_leading_speed
from .operands import (
    Operands,
    blend,
    frame_in_base,
    gives_shares,
    qnear,
    shares,
    speed_arguments,
)
from .options import ShareStyle
from .payload import NO_PAYLOAD, payload
from .positions import Standpoint

_NO_INERTIA = listing([0.0] * 6)


class Phrases:
    """Writes the moves of one script."""

    def __init__(self, robot: Robot, program: Program, shares: ShareStyle) -> None:
        self._robot = robot
        self._shares = shares
        self._standpoint = Standpoint(robot, program)
        self.operands = Operands(robot)

    @property
    def declarations(self) -> Declarations:
        """The data that the moves name."""
        return self.operands.declarations

    def in_base(self, place: Destination, frame: WorkObject) -> Destination:
        """A place whose stretches are along the axes of the robot's base.

        Args:
            frame: the work object along whose axes they are.
        """
        found = frame_in_base(frame, self._robot.base)
        if found is None:
            return place

        def turned(stretch: Vector) -> Vector:
            x, y, z = found.matrix()[:3, :3] @ np.array(stretch)
            return rounded((float(x), float(y), float(z)))

        steps = tuple((level, turned(by)) for level, by in place.steps)
        return replace(place, offset=turned(place.offset), steps=steps)

    def move(self, move: Move, places: Sequence[Line] = ()) -> Line:
        """The call that drives the next move.

        Args:
            places: where it goes to and through, where that is not the move's own target.

        Raises:
            InputError: URScript cannot say it.
        """
        line = self._line(move, places)
        self._standpoint.moved(move)
        return line

    def passed(self, move: Move) -> None:
        """A move is driven by a line that is written already."""
        self._standpoint.moved(move)

    def _line(self, move: Move, places: Sequence[Line]) -> Line:
        if isinstance(move, MoveC):
            return self._arc(move, places)
        goal = _goal(move, self.operands, places)
        if self._shares is ShareStyle.OPTIMOVE and gives_shares(move.speed):
            function = "optimovej" if isinstance(move, MoveJ) else "optimovel"
            return _call(function, goal, shares(move), move)
        if isinstance(move, MoveJ):
            made = with_leading_speed(move, self._robot, self._standpoint)
            return _call("movej", goal, speed_arguments(made), move)
        return _call("movel", goal, speed_arguments(move), move)

    def _arc(self, move: MoveC, places: Sequence[Line]) -> Line:
        """``movec(pose_via, pose_to, a, v, r, mode)``; mode 0 turns the tool from pose to pose.

        In mode 1 its orientation is fixed relative to the arc's tangent.
        """
        if move.speed.duration is not None:
            raise InputError("URScript's movec takes no time: give the move a TCP speed")
        if not isinstance(move.target, PoseTarget):
            raise InputError("an arc ends at a pose, not at joint values: give it the pose")
        if places:
            end, via = places
        else:
            via = (self.operands.pose(move.via, move.work_object),)
            end = (self.operands.pose(move.target, move.work_object),)
        speed = speed_arguments(move)
        if move.orientation is ArcOrientation.FIXED_FRAME:
            return _call("movec", (*via, ", ", *end), speed, move)
        self._standpoint.check_following(move)
        return _call("movec", (*via, ", ", *end), speed, move, ", mode=1")


def _call(function: str, goal: Line, speed: str, move: Move, more: str = "") -> Line:
    """``movej(q, a, v, t, r)``, ``movel(pose, a, v, t, r)``."""
    radius = blend(move.zone)
    return (f"{function}(", *goal, ", ", speed, f", {radius}" if radius else "", f"{more})")


def _goal(move: MoveJ | MoveL, operands: Operands, places: Sequence[Line]) -> Line:
    """Joint values, or a pose; with ``qnear`` through ``get_inverse_kin(x, qnear)``.

    Moves of the TCP keep the solution that they begin with: it needs no name.
    """
    if isinstance(move.target, JointTarget):
        return places[0] if places else (operands.joints(move.target),)
    pose = places[0] if places else (operands.pose(move.target, move.work_object),)
    if isinstance(move, MoveL) or move.target.configuration is None:
        return pose
    return ("get_inverse_kin(", *pose, ", ", qnear(move.target.configuration), ")")


class WrittenSettings:
    """What holds until it is changed.

    A controller starts with the TCP and payload of its installation: the TCP is always set before
    the first move, and the payload as soon as the program states one.

    Args:
        known: whether it is what a program starts with; else nothing is known.
    """

    def __init__(self, known: bool = True) -> None:
        self._tcp = ""
        self._payload_set = _payload_call(*NO_PAYLOAD) if known else ""
        self._work_object = WORLD

    def changes(self, move: Move) -> list[str]:
        """The lines that must stand before a move.

        Raises:
            InputError: the tool stands still.
        """
        if not move.tool.robot_held:
            raise InputError(
                f"tool {move.tool.name} stands still, but URScript moves the TCP of a tool that "
                "the robot holds"
            )
        return [*self._frame(move), *self._tool(move), *self._payload(move)]

    def _frame(self, move: Move) -> list[str]:
        """Where targets are converted into the robot's base, a comment says so."""
        if move.work_object == self._work_object:
            return []
        self._work_object = move.work_object
        if move.work_object == WORLD:
            return comment("targets of the robot's base")
        return comment(f"targets of work object {move.work_object.name}, in the robot's base")

    def _tool(self, move: Move) -> list[str]:
        """``set_tcp(pose)``: the TCP in the flange's frame."""
        call = f"set_tcp({pose_literal(move.tool.tcp)})"
        if call == self._tcp:
            return []
        self._tcp = call
        return [call]

    def _payload(self, move: Move) -> list[str]:
        """``set_target_payload`` of all that the flange carries, in its frame."""
        call = _payload_call(*payload(move.tool, move.load))
        if call == self._payload_set:
            return []
        self._payload_set = call
        return [call]


def _payload_call(mass: float, centre: Sequence[float], tensor: Sequence[float]) -> str:
    """``set_target_payload(m, cog, inertia)``.

    Inertia about the centre of gravity: Ixx, Iyy, Izz, Ixy, Ixz, Iyz in kg m².
    """
    call = f"set_target_payload({number(mass)}, {listing(centre)}"
    inertia = listing(tensor)
    return f"{call})" if inertia == _NO_INERTIA else f"{call}, {inertia})"
