"""Calls that ask for the robot's position and its kinematics.

Source: "The URScript Programming Language", modules internals and urmath.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ....core.errors import InputError, SourceError, Span
from ....core.program.tool import FLANGE, Tool
from ....core.spatial.pose import Pose
from ..syntax.tree import Argument, Call, Expression
from ..values.answers import answer, given
from ..values.arguments import bind
from ..values.evaluator import Evaluation, evaluate, plain
from ..values.located import Located
from ..values.poses import pose_of, value_of
from ..values.scope import Scope
from ..values.values import (
    PendingInverse,
    Unknown,
    UrPose,
    Value,
    ValueFault,
    describe,
    find_unknown,
    numbers,
)
from .configuration import UrConfiguration
from .position import Position
from .settings import Settings

_SIX = 6
INVERSE = "get_inverse_kin"
INVERSE_PARAMETERS = ("x", "qnear", "maxPositionError", "maxOrientationError", "tcp")
_ACTIVE = "active_tcp"


class KinematicsRun(Evaluation, Protocol):
    """What questions about the robot ask of a run."""

    settings: Settings

    @property
    def position(self) -> Position:
        """Where the robot stands."""

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of this kind was taken before."""


Ask = Callable[[KinematicsRun, Call, Scope], Located]


def _as_pose(value: Value) -> Value:
    """An answer of six numbers, where a pose is asked for."""
    return UrPose(*value) if isinstance(value, tuple) and len(value) == _SIX else value


def _tcp_pose(run: KinematicsRun, call: Call, scope: Scope) -> Located:
    return _pose(run, call, run.settings.tool)


def _flange_pose(run: KinematicsRun, call: Call, scope: Scope) -> Located:
    return _pose(run, call, FLANGE)


def _pose(run: KinematicsRun, call: Call, tool: Tool) -> Located:
    told = given(run, call, listed=False)
    if told is not None:
        return Located(_as_pose(told))
    pose = run.position.pose(tool, f"{call.name}()", run.texts.span_of(call))
    run.course.suppose(run.position.supposed or run.settings.supposed)
    return Located(_listed(run, call, pose) if isinstance(pose, Unknown) else value_of(pose))


def _listed(run: KinematicsRun, call: Call, unknown: Unknown) -> Unknown:
    """The user may say what the kinematics do not know."""
    given(run, call)
    return unknown


def _unless_told(ask: Callable[[KinematicsRun, Call, Scope], Value]) -> Ask:
    """The user's answer goes before what the kinematics say."""

    def asked(run: KinematicsRun, call: Call, scope: Scope) -> Located:
        told = given(run, call, listed=False)
        value = ask(run, call, scope) if told is None else told
        return Located(_listed(run, call, value) if isinstance(value, Unknown) else value)

    return asked


def _joints(run: KinematicsRun, call: Call, scope: Scope) -> Value:
    run.course.suppose(run.position.supposed)
    return run.position.joints(f"{call.name}()", run.texts.span_of(call))


def _tcp_offset(run: KinematicsRun, call: Call, scope: Scope) -> Located:
    if not run.settings.stated:
        return Located(answer(run, call, "the TCP of the installation"))
    run.course.suppose(run.settings.supposed)
    return Located(value_of(run.settings.tcp))


def _forward(run: KinematicsRun, call: Call, scope: Scope) -> Located:
    """``get_forward_kin(q, tcp)``; without q where the robot stands."""
    arguments = bind(call, ("q", "tcp"), 0, run.texts)
    tool = _tool(run, arguments.get("tcp"), scope)
    if isinstance(tool, Unknown):
        return Located(tool)
    if "q" not in arguments:
        return _pose(run, call, tool)
    value = plain(run, arguments["q"].value, scope)
    unknown = find_unknown(value)
    if unknown is not None:
        return Located(unknown)
    joints = numbers(value, _SIX)
    if joints is None:
        raise run.texts.error_at(
            f"get_forward_kin takes six joint values, not {describe(value)}", call
        )
    span = run.texts.span_of(call)
    pose = run.position.forward(tuple(joints), tool, "get_forward_kin", span)
    return Located(pose if isinstance(pose, Unknown) else value_of(pose))


def _has_solution(run: KinematicsRun, call: Call, scope: Scope) -> Value:
    found = solution(run, call, scope)
    span = run.texts.span_of(call)
    if isinstance(found, Unknown):
        return found
    if not run.position.has_robot:
        return Unknown(f"{call.name}, for which the robot's kinematics are needed", span)
    near = found.near if isinstance(found.near, UrConfiguration) else None
    return run.position.solve(found.pose, found.tcp, near, span) is not None


def solution(run: KinematicsRun, call: Call, scope: Scope) -> PendingInverse | Unknown:
    """What ``get_inverse_kin(x, qnear, maxPositionError, maxOrientationError, tcp)`` finds."""
    arguments = bind(call, INVERSE_PARAMETERS, 1, run.texts)
    value = evaluate(run, arguments["x"].value, scope)
    unknown = find_unknown(value)
    tool = _tool(run, arguments.get("tcp"), scope)
    if unknown is not None:
        return unknown
    if isinstance(tool, Unknown):
        return tool
    near = _near(run, call, arguments.get("qnear"), scope)
    if isinstance(near, Unknown):
        return near
    pose = _checked_pose(run, value, arguments["x"].value)
    return PendingInverse(pose, tool.tcp, near, run.texts.span_of(call))


def _near(
    run: KinematicsRun, call: Call, qnear: Argument | None, scope: Scope
) -> UrConfiguration | Unknown | None:
    """What a solution shall be near to; None where nobody knows where the robot stands."""
    if qnear is not None:
        nearby = evaluate(run, qnear.value, scope)
        if run.position.is_here(nearby):
            return None
        if find_unknown(nearby) is not None:
            return None
        return to_near(run, nearby, qnear.value)
    if not (run.position.has_robot and run.position.known):
        return None
    here = run.position.joints(call.name, run.texts.span_of(call))
    return None if isinstance(here, Unknown) else UrConfiguration(here)


def to_near(run: KinematicsRun, value: Value, node: Expression) -> UrConfiguration:
    """A ``qnear``: six joint values.

    Raises:
        SourceError: it is something else.
    """
    if isinstance(value, PendingInverse):
        value = joints_of(run.position, value)
    unknown = find_unknown(value)
    joints = numbers(value, _SIX)
    if joints is None or isinstance(value, UrPose):
        what = f"depends on {unknown.reason}" if unknown else f"is {describe(value)}"
        raise run.texts.error_at(f"qnear takes six joint values, but it {what}", node)
    return UrConfiguration(tuple(joints))


def joints_of(position: Position, found: PendingInverse) -> Value:
    """The joint values of a solution.

    Raises:
        SourceError: the pose cannot be reached.
    """
    if not position.has_robot:
        return Unknown(
            "get_inverse_kin, for which the robot's kinematics are needed (name the robot)",
            found.span,
        )
    near = found.near if isinstance(found.near, UrConfiguration) else None
    joints = position.solve(found.pose, found.tcp, near, found.span)
    if joints is None:
        raise SourceError(
            "get_inverse_kin: the pose cannot be reached by this robot with this TCP", found.span
        )
    return joints


def _tool(run: KinematicsRun, argument: Argument | None, scope: Scope) -> Tool | Unknown:
    """The TCP that a call names; the one in force if it names none."""
    if argument is None:
        return run.settings.tool
    value = evaluate(run, argument.value, scope)
    unknown = find_unknown(value)
    if unknown is not None:
        return unknown
    if isinstance(value, str):
        if value == _ACTIVE:
            return run.settings.tool
        run.note_once(
            f"tcp {value}",
            f"the TCP '{value}' of the installation is not known: the one in force is taken",
            run.texts.span_of(argument),
        )
        return run.settings.tool
    return Tool("tcp", _checked_pose(run, value, argument.value))


def _checked_pose(run: KinematicsRun, value: Value, node: Expression) -> Pose:
    try:
        return pose_of(value, "the argument")
    except (ValueFault, InputError) as fault:
        raise run.texts.stop_at(fault, node) from None


KINEMATICS: dict[str, Ask] = {
    **dict.fromkeys(
        ("get_actual_tcp_pose", "get_target_tcp_pose", "get_target_waypoint", "tool_pose"),
        _tcp_pose,
    ),
    **dict.fromkeys(("get_actual_tool_flange_pose", "get_target_tool_flange_pose"), _flange_pose),
    **dict.fromkeys(
        (
            "get_actual_joint_positions",
            "get_target_joint_positions",
            "get_joint_positions",
            "get_actual_joint_positions_history",
        ),
        _unless_told(_joints),
    ),
    # What stands behind a move is read when the robot has come to rest.
    "is_steady": _unless_told(lambda run, call, scope: True),
    "get_tcp_offset": _tcp_offset,
    "get_forward_kin": _forward,
    INVERSE: _unless_told(solution),
    "get_inverse_kin_has_solution": _unless_told(_has_solution),
}
"""Function that asks for the robot's position or kinematics → what carries it out."""
