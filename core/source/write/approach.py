"""The way to where a program starts, as a move that its language can say.

A program may know where the robot stands before its first move (`Program.start`): a planned one
does. No robot language has a word for that, and a robot that stands elsewhere would drive another
way. So the start is written as a first joint move, slow, since nobody knows where it comes from; a
robot that stands there already does not move.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import zip_longest

from ...dialect import Dialect
from ...program.folding import usable
from ...program.move import MoveJ
from ...program.program import Program
from ...program.section import moved
from ...program.speed import Speed
from ...program.target import JointTarget, Target
from ...program.zone import FINE
from ...robot.model import Robot

SLOW = 0.25
"""m/s, or share of what the joints can do: the reduced speed of ISO 10218."""
_SAME = 1e-9
"""rad or m."""


def approach_speed(dialect: Dialect | None, robot: Robot, pace: float = SLOW) -> Speed:
    """Of a joint move to where a program starts, as the language paces joint moves.

    Args:
        dialect: the language; None if it says everything.
        robot: whose joints are paced.
        pace: m/s, or share of what the slowest joint can do.
    """
    word = "tcp" if dialect is None else dialect.pace
    needs = frozenset() if dialect is None else dialect.joint.needs
    limits = robot.limits
    return Speed(
        tcp=pace if word == "tcp" else None,
        joint=pace * float(limits.velocity.min()) if word == "joint" else None,
        joint_fraction=pace if word == "joint_fraction" else 1.0,
        joint_acceleration=pace * float(limits.acceleration.min())
        if "joint_acceleration" in needs
        else None,
    )


def with_approach(program: Program, dialect: Dialect | None, robot: Robot) -> Program:
    """The program with a first move to its start, unless it has one, or no start is known.

    Args:
        dialect, robot: see `approach_speed`.
    """
    start = program.start
    if start is None or not program.moves:
        return program
    first = program.moves[0]
    if isinstance(first, MoveJ) and _same(first.target, start):
        return program
    frames = {part: getattr(first, part) for part in ("tool", "work_object", "load")}
    move = MoveJ(start, approach_speed(dialect, robot), FINE, **frames)
    places = range(1, len(program.statements) + 2)
    sections = moved(usable(program), places)
    return replace(program, statements=(move, *program.statements), sections=sections)


def _same(target: Target, start: JointTarget) -> bool:
    if not isinstance(target, JointTarget):
        return False
    own, others = ((*t.joints, *t.external) for t in (target, start))
    return all(abs(a - b) <= _SAME for a, b in zip_longest(own, others, fillvalue=0.0))
