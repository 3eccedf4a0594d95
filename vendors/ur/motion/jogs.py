"""``speedj`` and ``speedl`` whose speed and time are known: moves over speed times time.

The controller speeds up to a speed, keeps it, and goes on with the program after the time ``t``;
the next statement stops it, as ``stopl`` does. Driven is a move from rest to rest, which leads over
speed times time where it slows down as it has sped up. A call that goes on with the same
speed makes the move longer, as in loops that drive by steps.

From one speed of the TCP the controller goes over to the next with the acceleration of the second
call, in |v₂ − v₁| / a: on a parabola round the corner in which the lines of both speeds meet, v₁
and v₂ times half that time away from its ends. The robot stops between two speeds where it turns
back, turns the tool, or has no time to reach the second, and between speeds of joints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ....core.errors import InputError, Span
from ....core.program.move import Move, MoveJ, MoveL
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.zone import FINE, Radius, Zone
from ....core.source.execution.provenance import MovePart
from ....core.source.execution.transcript import MoveParts
from ....core.spatial.pose import Pose
from ..syntax.tree import Call
from ..values.arguments import bind
from ..values.evaluator import plain
from ..values.poses import pose_of
from ..values.scope import Scope
from ..values.values import Unknown, is_number, numbers
from .moves import MovesRun

PARAMETERS = {"speedj": ("qd", "a", "t"), "speedl": ("xd", "a", "t", "aRot")}
_ACCELERATION = {"speedj": 1.4, "speedl": 1.2}
_SIX = 6
_NEAR = 2e-4
"""m by which the path of a transition may be off."""


@dataclass(frozen=True, slots=True)
class Jog:
    """A jog as it is driven so far.

    Args:
        start: joint values, or the TCP in the robot's base.
        seconds: that it has lasted, were it driven from rest to rest.
        index: of its move.
    """

    name: str
    vector: tuple[float, ...]
    accelerations: tuple[float, float]
    start: tuple[float, ...] | Pose
    seconds: float
    index: int

    def goes_on(
        self, same: tuple[str, tuple[float, ...], tuple[float, float]], run: JogsRun
    ) -> bool:
        """Whether a call makes this one longer: nothing has moved or stopped the robot since."""
        alike = (self.name, self.vector, self.accelerations) == same
        return alike and self.drives(run)

    def drives(self, run: JogsRun) -> bool:
        """Whether nothing has moved or stopped the robot since."""
        return self.index == run.out.move_index - 1 and not run.out.stopped

    @property
    def own_ramp(self) -> float:
        """s from rest to its speed."""
        return float(np.linalg.norm(self.vector[:3])) / self.accelerations[0]

    def ramp_to(self, other: Jog) -> float | None:
        """s in which a line goes over to that of another speed; None where the robot stops."""
        v, w = np.array(self.vector), np.array(other.vector)
        if not (self.name == other.name == "speedl") or v[3:].any() or w[3:].any() or v @ w < 0:
            return None
        ramp = float(np.linalg.norm(w - v)) / other.accelerations[0]
        reached = self.seconds >= max(self.own_ramp, ramp + self.own_ramp / 2.0)
        return ramp if reached and other.seconds >= max(ramp, other.own_ramp) else None


class JogsRun(MovesRun, Protocol):
    """What jogs ask of a run.

    Attributes:
        jogged: the last one; None if there was none.
    """

    jogged: Jog | None


def jog(run: JogsRun, call: Call, scope: Scope) -> bool:
    """Drive by a call; whether it was, as speed, time and place are known."""
    given = bind(call, PARAMETERS[call.name], 1, run.texts)
    values = {name: plain(run, argument.value, scope) for name, argument in given.items()}
    vector = numbers(values[PARAMETERS[call.name][0]], _SIX)
    a = values.get("a", _ACCELERATION[call.name])
    turning, seconds = values.get("aRot", a), values.get("t", 0.0)
    if vector is None or not (is_number(a) and is_number(turning) and is_number(seconds)):
        return False
    if min(a, turning, seconds) <= 0 or not any(vector):
        return False
    span = run.texts.span_of(call)
    same = (call.name, tuple(vector), (float(a), float(turning)))
    last = run.jogged
    if last is not None and last.goes_on(same, run):
        run.jogged = Jog(*same, last.start, last.seconds + float(seconds), last.index)
        longer = _move(run, run.jogged)
        run.out.replace_last_move(longer)
        run.position.moved(longer, span)
        return True
    if last is not None and last.drives(run):
        following = Jog(*same, last.start, float(seconds), run.out.move_index)
        ramp = last.ramp_to(following)
        if ramp is not None:
            _go_over(run, last, following, ramp, span)
            return True
    start = _start(run, call.name, span)
    if isinstance(start, Unknown):
        return False
    found = Jog(*same, start, float(seconds), run.out.move_index)
    part = MovePart(span)
    try:
        run.emit_move(_move(run, found), MoveParts(span, part, part, part))
    except InputError as error:
        raise run.texts.error_at(f"{call.name}: {error}", call) from None
    run.jogged = found
    run.out.notes.once(
        call.name,
        f"{call.name} with a known speed and time is driven from rest to rest, with its own "
        "acceleration at both ends, over speed times time",
        span,
    )
    return True


def _start(run: JogsRun, name: str, span: Span) -> tuple[float, ...] | Pose | Unknown:
    if name == "speedj":
        found = run.position.joints("the start of speedj", span)
        return found if isinstance(found, Unknown) else tuple(found)
    return run.position.pose(run.settings.tool, "the start of speedl", span)


def _go_over(run: JogsRun, last: Jog, following: Jog, ramp: float, span: Span) -> None:
    """Drive on from one speed to the next, through the corner in which their lines meet.

    Where these are nearly along each other the zone is larger than what is driven on the parabola:
    small blends of the emulator slow the robot down, which this transition does not.
    """
    v, w = (np.array(jog.vector[:3]) for jog in (last, following))
    old, new = float(np.linalg.norm(v)), float(np.linalg.norm(w))
    to_corner = replace(last, seconds=last.seconds - last.own_ramp / 2.0 + ramp / 2.0)
    angle = math.atan2(float(np.linalg.norm(np.cross(v, w))), float(v @ w))
    shorter = min(old * to_corner.seconds, new * following.seconds)
    straight = min(4.0 * _NEAR / max(angle, 1e-9), shorter / 2.0)
    corner = _move(run, to_corner, Radius(max(max(old, new) * ramp / 2.0, straight)))
    run.out.replace_last_move(corner)
    run.position.moved(corner, span)
    start = run.position.pose(run.settings.tool, "the start of speedl", span)
    assert isinstance(start, Pose)
    seconds = following.seconds + following.own_ramp / 2.0 - ramp / 2.0
    run.jogged = replace(following, start=start, seconds=seconds)
    part = MovePart(span)
    run.emit_move(_move(run, run.jogged), MoveParts(span, part, part, part))


def _move(run: JogsRun, jog: Jog, zone: Zone = FINE) -> Move:
    """From where it began over all the time that it has lasted."""
    vector = np.array(jog.vector)
    a, turning = jog.accelerations
    common = zone, run.settings.tool, run.position.base
    supposed = run.course.supposed or run.position.supposed or run.settings.supposed
    if isinstance(jog.start, Pose):
        line, turn = (float(np.linalg.norm(part)) for part in (vector[:3], vector[3:]))
        share, turned = _share(line, a, jog.seconds), _share(turn, turning, jog.seconds)
        turn_by = pose_of((0.0, 0.0, 0.0, *(vector[3:] * turned * jog.seconds).tolist()), "xd")
        goal = turn_by @ Pose(quaternion=jog.start.quaternion)
        position = np.array(jog.start.position) + vector[:3] * share * jog.seconds
        target = PoseTarget(Pose(tuple(position.tolist()), goal.quaternion))
        speed = Speed(
            tcp=line * share or None,
            tcp_acceleration=a if line else None,
            reorientation=turn * turned or None,
            reorientation_acceleration=turning if turn else None,
        )
        return MoveL(target, speed, *common, supposed=supposed)
    leading = float(np.max(np.abs(vector)))
    share = _share(leading, a, jog.seconds)
    ends = np.array(jog.start) + vector * share * jog.seconds
    speed = Speed(joint=leading * share, joint_acceleration=a)
    return MoveJ(JointTarget(tuple(ends.tolist())), speed, *common, supposed=supposed)


def _share(speed: float, acceleration: float, seconds: float) -> float:
    """What share of a speed is reached in a time."""
    return min(1.0, acceleration * seconds / speed) if speed else 1.0
