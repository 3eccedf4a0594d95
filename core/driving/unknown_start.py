"""Programs of which nobody says where the robot stands before their first move."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from ..door import spelt
from ..errors import FlybyError, Note, ParseError
from ..program.assumed_places import supposed_from_start
from ..program.program import Program
from ..program.target import JointTarget
from ..source.reading import leads_somewhere

if TYPE_CHECKING:
    from ..robot.model import Robot

_TURNED = math.radians(7.0)
"""rad towards zero by which each axis is elsewhere than in the ready posture."""


def from_ready_posture(
    read: Callable[[JointTarget | None], Program], start: JointTarget | None, robot: Robot
) -> Program:
    """A program that may ask where the robot stands before its first move, or go to one place only.

    Where nobody says where the robot stands, and that keeps the program from being driven, it is
    taken to begin in the robot's ready posture, with a note.

    Args:
        read: reads it from a start.
        start: that the user gives.
        robot: that it is for.

    Raises:
        FlybyError: it cannot be read from there either; what keeps it from being read without.
    """
    if start is not None:
        return read(start)
    failed: FlybyError | None = None
    without: Program | None = None
    try:
        without = read(None)
    except ParseError:
        raise
    except FlybyError as error:
        failed = error
    known = without is not None and len(without.moves) > _open(without)
    still = known and without is not None and not leads_somewhere(without)
    if without is not None and not still and not _open(without):
        return without
    from ..robot.ready_posture import ready_posture  # late: kinematics take time

    posture = ready_posture(robot)
    program = None
    ready = () if posture is None else posture
    for turn in (0.0, _TURNED) if ready else ():
        # A program that sets one axis may set it to where the ready posture has it.
        now = tuple(value - math.copysign(turn, value) for value in ready[: robot.arm_size])
        at = JointTarget(now, ready[robot.arm_size :])
        with suppress(FlybyError):
            other = read(at)
            leads = leads_somewhere(other, at)
            if leads or (program is None and not still):
                program, start = other, at
            if leads:
                break
    if program is None or (without is not None and not still and _open(program) >= _open(without)):
        if without is None:
            assert failed is not None
            raise failed
        return without
    axes = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    assert start is not None
    stands = (*start.joints, *start.external)
    shown = ", ".join(joint.shown(value) for joint, value in zip(axes, stands, strict=True))
    why = (
        "no move leads from one place that is known to another"
        if still
        else "the program asks where the robot stands before its first move"
    )
    note = Note(
        f"{why}: the robot is taken to stand at {shown} before; {spelt('start')} says where it does"
    )
    program = supposed_from_start(program, without)
    return replace(program, notes=(note, *program.notes))


def _open(program: Program) -> int:
    """Moves of which nobody knows where they go."""
    return sum(bool(move.open) for move in program.moves)
