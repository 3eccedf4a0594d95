"""The moves: movej, movel, movep, movec, optimovej, optimovel.

Parameters, their order and defaults: "The URScript Programming Language" / "Script Directory",
module motion.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Protocol

from ....core.door import spelt
from ....core.errors import InputError, LeftOpenError, LostError, SourceError, Span
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.move import Move, MoveC, MoveJ, MoveL
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget, Target
from ....core.program.tool import Tool
from ....core.program.zone import FINE, Radius, Zone
from ....core.source.execution.provenance import ELSEWHERE, MovePart
from ....core.source.execution.transcript import MoveParts, Transcript
from ....core.spatial.pose import Pose
from ..syntax.tree import Argument, Call, Expression
from ..values.answers import used_as
from ..values.arguments import bind
from ..values.evaluator import locate
from ..values.located import NOTHING, Located
from ..values.poses import pose_of
from ..values.provenance import Sources, covering
from ..values.scope import Scope
from ..values.values import (
    PendingInverse,
    Unknown,
    UrPose,
    Value,
    ValueFault,
    describe,
    find_unknown,
    is_number,
    numbers,
    supposed,
)
from .arcs import carried_along
from .configuration import UrConfiguration
from .kinematics import INVERSE, INVERSE_PARAMETERS, KinematicsRun, solution, to_near

_SIX = 6


@dataclass(frozen=True, slots=True)
class Signature:
    """A move's parameters.

    Args:
        targets: names of those that say where.
        others: names of the others with their defaults, in order.
        joint: whether a and v are the leading joint's.
        shares: whether a and v are shares of what the robot can do.
    """

    targets: tuple[str, ...]
    others: dict[str, float] = field(default_factory=dict)
    joint: bool = False
    shares: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """All parameters, in order."""
        return (*self.targets, *self.others)


SIGNATURES = {
    "movej": Signature(("q",), {"a": 1.4, "v": 1.05, "t": 0.0, "r": 0.0}, joint=True),
    "movel": Signature(("pose",), {"a": 1.2, "v": 0.25, "t": 0.0, "r": 0.0}),
    "movep": Signature(("pose",), {"a": 1.2, "v": 0.25, "r": 0.0}),
    "movec": Signature(("pose_via", "pose_to"), {"a": 1.2, "v": 0.25, "r": 0.0, "mode": 0.0}),
    "optimovej": Signature(("goal",), {"a": 0.3, "v": 0.3, "r": 0.0}, joint=True, shares=True),
    "optimovel": Signature(("goal",), {"a": 0.3, "v": 0.3, "r": 0.0}, joint=True, shares=True),
}
_SPEED = ("a", "v", "t")


class MovesRun(KinematicsRun, Protocol):
    """What moves ask of a run."""

    @property
    def out(self) -> Transcript:
        """What the run leaves."""

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program."""


@lru_cache(maxsize=1024)
def _speed(function: str, a: float, v: float, t: float) -> Speed:
    """The speed that a move's arguments give; programs have few."""
    if t > 0:
        return Speed(duration=t)
    if t < 0:
        raise InputError(f"the time is above zero, or zero for none, not {t:g}")
    signature = SIGNATURES[function]
    if signature.shares:
        return Speed(joint_fraction=v, joint_acceleration_fraction=a)
    if signature.joint:
        return Speed(joint=v, joint_acceleration=a)
    return Speed(tcp=v, tcp_acceleration=a)


@lru_cache(maxsize=1024)
def _blend(radius: float) -> Radius:
    return Radius(radius, radius, radius)


def move(run: MovesRun, call: Call, scope: Scope) -> Located:
    """Carry out a move; one whose target nobody knows is left out."""
    try:
        _MoveReader(run, call, scope).read()
    except LeftOpenError as error:
        run.literals.reader = ELSEWHERE
        span = run.texts.span_of(call)
        run.out.leave_out(span, error)
        run.position.left_out(span)
    return NOTHING


class _MoveReader:
    """Reads one call of a move."""

    def __init__(self, run: MovesRun, call: Call, scope: Scope) -> None:
        self.run = run
        self.call = call
        self.scope = scope
        self.texts = run.texts
        self.signature = SIGNATURES[call.name]
        names = self.signature.names
        self.given = bind(call, names, len(self.signature.targets), run.texts)
        self.span = run.texts.span_of(call)
        self.unsettled = ""
        self.supposed = ""
        self.tool = self._tool()

    def read(self) -> None:
        """Put the move at the end of the program."""
        run = self.run
        run.literals.reader = run.out.move_index
        try:
            *vias, last = [self._target(self.given[name]) for name in self.signature.targets]
        except LeftOpenError:
            self._ask_numbers()
            raise
        numbers_ = {name: self._number(name) for name in self.signature.others}
        values = {name: value for name, (value, _) in numbers_.items()}
        sources = {name: found.sources for name, (_, found) in numbers_.items()}
        speed, zone = self._speed(values), self._zone(values["r"])
        parts = MoveParts(
            self.span,
            last[1],
            self._part(_SPEED, sources),
            self._part(("r",), sources),
            vias[0][1] if vias else None,
        )
        common = speed, zone, self.tool, run.position.base
        run.literals.reader = ELSEWHERE
        if vias:
            run.emit_move(self._arc(vias[0][0], last[0], values["mode"], common), parts)
            return
        kind = MoveJ if self.call.name in ("movej", "optimovej") else MoveL
        self._note_kind()
        move = kind(last[0], *common, unsettled=self.unsettled, supposed=self.supposed)
        run.emit_move(move, parts)

    def _ask_numbers(self) -> None:
        """How a move is driven of which nobody knows where to is asked at once, too."""
        for name in self.signature.others:
            if name in self.given:
                expression = self.given[name].value
                value = locate(self.run, expression, self.scope).value
                used_as(self.run, expression, value, "number")

    def _tool(self) -> Tool:
        settings = self.run.settings
        if settings.unknown is not None:
            self._taken("the TCP of the move", settings.unknown, "the one before")
        self._suppose("the TCP of the move", settings.supposed)
        if settings.load_lost is not None:
            lost = self._refusal("the payload of the move", settings.load_lost, self.span)
            self.unsettled = lost.message
        if not settings.stated:
            self.run.out.notes.once(
                "tcp",
                "no set_tcp stands before the first move: the flange is taken for the TCP, where "
                "a controller has the TCP of its installation; write set_tcp(p[…]) before it",
                self.span,
            )
        return settings.tool

    # ------------------------------------------------------------------- targets

    def _target(self, argument: Argument) -> tuple[Target, MovePart]:
        expression = argument.value
        span = self.texts.span_of(expression)
        if self._is_inverse(expression):
            assert isinstance(expression, Call)
            return self._inverse(expression, span)
        name = argument.name or "target"
        found = self._located(expression, f"the {name} of {self.call.name}")
        value = found.value
        used_as(self.run, expression, value, "goal")
        if isinstance(value, PendingInverse):
            return self._solution(value), MovePart(span)
        value = self._known(value, f"the {name} of {self.call.name}", span)
        sources = () if value is not found.value else found.sources
        part = MovePart(span, covering(sources, _SIX) if sources else ())
        if isinstance(value, UrPose):
            pose = self._pose(value, expression)
            return PoseTarget(pose, name=found.name), part
        values = numbers(value, _SIX)
        if values is None:
            raise SourceError(
                f"the {name} of {self.call.name} is a pose p[x, y, z, rx, ry, rz] or six joint "
                f"values, not {describe(value)}",
                span,
            )
        return JointTarget(tuple(values), name=found.name), part

    def _located(self, expression: Expression, what: str) -> Located:
        """A value that the path of the move depends on."""
        self.run.course.supposed = ""
        found = locate(self.run, expression, self.scope)
        self._suppose(what, self.run.course.supposed)
        return found

    def _suppose(self, what: str, reason: str) -> None:
        """What the path of the move depends on is taken for something; nothing if ``reason`` is
        empty."""
        if reason:
            self.supposed = self.supposed or f"{what} depends on {reason}"

    def _is_inverse(self, expression: Expression) -> bool:
        """Whether the target is ``get_inverse_kin(…)`` itself, whose pose can be kept."""
        return (
            isinstance(expression, Call)
            and expression.name == INVERSE
            and self.scope.function(INVERSE) is None
        )

    def _inverse(self, call: Call, span: Span) -> tuple[Target, MovePart]:
        given = bind(call, INVERSE_PARAMETERS, 1, self.texts)
        if "tcp" in given:
            self.run.course.supposed = ""
            found = solution(self.run, call, self.scope)
            self._suppose(f"the target of {self.call.name}", self.run.course.supposed)
            if isinstance(found, Unknown):
                raise self._refusal(f"the target of {self.call.name}", found, span)
            return self._solution(found), MovePart(span)
        goal = self._located(given["x"].value, f"the pose of {INVERSE}")
        used_as(self.run, given["x"].value, goal.value, "pose")
        value = self._known(goal.value, f"the pose of {INVERSE}", span)
        pose = self._pose(value, given["x"].value)
        sources = covering(goal.sources if value is goal.value else (), _SIX)
        near = None
        if "qnear" in given:
            self.run.course.supposed = ""
            near = locate(self.run, given["qnear"].value, self.scope)
            reason = self.run.course.supposed
            if reason != self.run.position.supposed:  # near to itself an arm is anyhow
                self._suppose("qnear", reason)
        unknown = None if near is None else find_unknown(near.value)
        here = near is None or self.run.position.is_here(near.value)
        if unknown is not None and not here:
            self._taken("qnear", unknown, "the solution nearest to where the robot comes from")
        if near is None or here or unknown is not None:
            kept = sources if any(sources) else ()
            return PoseTarget(pose, name=goal.name), MovePart(span, kept)
        configuration = to_near(self.run, near.value, given["qnear"].value)
        sources = (*sources, *covering(near.sources, _SIX))
        target = PoseTarget(pose, configuration, name=goal.name)
        return target, MovePart(span, sources if any(sources) else ())

    def _solution(self, found: PendingInverse) -> PoseTarget:
        """The pose that inverse kinematics was asked for, for the TCP in force."""
        pose = found.pose
        if found.tcp != self.tool.tcp:
            pose = pose @ found.tcp.inverse() @ self.tool.tcp
        near = found.near
        return PoseTarget(pose, near if isinstance(near, UrConfiguration) else None)

    def _pose(self, value: object, expression: Expression) -> Pose:
        try:
            return pose_of(value, "the target")  # type: ignore[arg-type]
        except (ValueFault, InputError) as error:
            raise self.texts.error_at(error, expression) from None

    def _known(self, value: Value, what: str, span: Span) -> Value:
        """A value, or what a move takes it for.

        Raises:
            LeftOpenError: there is nothing to take it for.
        """
        unknown = find_unknown(value)
        if unknown is None:
            return value
        taken = supposed(value)
        if find_unknown(taken) is not None:
            raise self._refusal(what, unknown, span)
        self._taken(what, unknown, "what it is with zero for that")
        return taken

    def _taken(self, what: str, unknown: Unknown, taken: str, alters: bool = True) -> None:
        """Say what a move takes something for that is not known.

        Args:
            alters: whether the move's path depends on it.

        Raises:
            LeftOpenError: it is something that a damaged line would have set.
        """
        if unknown.damaged:
            raise self._refusal(what, unknown, self.span)
        if alters:
            self._suppose(what, unknown.reason)
        self.run.out.notes.count(
            f"{what} depends on {unknown.reason}, which the text does not say: {taken} is taken; "
            f"answer it in a file ({spelt('answers')}), [values]; `flyby ask` lists its name",
            self.span,
        )

    def _refusal(self, what: str, unknown: Unknown, span: Span) -> LeftOpenError:
        if unknown.damaged:
            return LostError(f"{what} depends on {unknown.reason}: mend that line", span)
        return LeftOpenError(
            f"{what} depends on {unknown.reason}: answer it in a file ({spelt('answers')}), "
            "[values], where `flyby ask` lists its name, or take the move out",
            span,
        )

    # ------------------------------------------------------------- speed and zone

    def _number(self, name: str) -> tuple[float, Located]:
        argument = self.given.get(name)
        if argument is None:
            return self.signature.others[name], Located(None)
        self.run.course.supposed = ""
        found = locate(self.run, argument.value, self.scope)
        if name not in _SPEED:
            self._suppose(f"'{name}' of {self.call.name}", self.run.course.supposed)
        if not is_number(found.value):
            span = self.texts.span_of(argument)
            unknown = find_unknown(found.value)
            used_as(self.run, argument.value, found.value, "number")
            if unknown is not None:
                taken = supposed(found.value)
                number = float(taken) if is_number(taken) else self.signature.others[name]
                what = f"'{name}' of {self.call.name}"
                try:
                    self._taken(what, unknown, f"{number:g}", name not in _SPEED)
                except LostError as error:
                    self.unsettled = self.unsettled or error.message
                return number, Located(None)
            raise SourceError(
                f"'{name}' of {self.call.name} is a number, not {describe(found.value)}", span
            )
        return float(found.value), found

    def _speed(self, values: dict[str, float]) -> Speed:
        a, v, t = (values.get(name, 0.0) for name in _SPEED)
        try:
            return _speed(self.call.name, a, v, t)
        except InputError as error:
            raise SourceError(
                f"{self.call.name} with a={a:g}, v={v:g}, t={t:g}: {error}", self.span
            ) from None

    def _zone(self, radius: float) -> Zone:
        if radius == 0:
            return FINE
        try:
            return _blend(radius)
        except InputError:
            raise SourceError(
                f"the blend radius of {self.call.name} is zero m or more, not {radius:g}",
                self.span,
            ) from None

    def _part(self, names: tuple[str, ...], sources: dict[str, Sources]) -> MovePart:
        """Of some arguments; where none is written, the place where they could be."""
        written = [self.given[name] for name in names if name in self.given]
        if not written:
            close = self.call.end - 1
            return MovePart(self.texts.span(close, close))
        start, end = min(a.start for a in written), max(a.end for a in written)
        own = [covering(sources.get(name, ()), 1)[0] for name in names]
        return MovePart(self.texts.span(start, end), tuple(own) if any(own) else ())

    # ---------------------------------------------------------------------- arcs

    def _arc(self, via: Target, end: Target, mode: float, common: tuple[object, ...]) -> Move:
        if mode not in (0.0, 1.0):
            raise SourceError(f"the mode of movec is 0 or 1, not {mode:g}", self.span)
        middle, target = self._as_pose(via), self._as_pose(end)
        if mode == 0.0:
            orientation = ArcOrientation.FIXED_FRAME
        else:
            orientation = ArcOrientation.FOLLOWS_ARC
            target = self._turned_along(middle, target)
        return MoveC(
            target,
            *common,  # type: ignore[arg-type]
            via=middle,
            orientation=orientation,
            unsettled=self.unsettled,
            supposed=self.supposed,
        )

    def _as_pose(self, target: Target) -> PoseTarget:
        if isinstance(target, PoseTarget):
            return target
        what = f"the pose of the joint values in {self.call.name}"
        pose = self.run.position.forward(target.joints, self.tool, what, self.span)
        if isinstance(pose, Unknown):
            raise self._refusal("the arc", pose, self.span)
        return PoseTarget(pose)

    def _turned_along(self, via: PoseTarget, target: PoseTarget) -> PoseTarget:
        """Mode 1 keeps the orientation to the arc that it has at the start."""
        start = self.run.position.pose(self.tool, "the start of the arc", self.span)
        if isinstance(start, Unknown):
            raise self._refusal("movec with mode=1", start, self.span)
        turned = carried_along(start, via.pose.position, target.pose.position)
        if turned is None:
            return target  # no arc: planning says so
        return PoseTarget(Pose(target.pose.position, turned), name=target.name)

    def _note_kind(self) -> None:
        name = self.call.name
        if name == "movep":
            message = "movep is read as movel with the same speed and blend radius"
        elif self.signature.shares:
            message = (
                f"{name} is read as {name.removeprefix('opti')} with shares of the joints' limits"
            )
        else:
            return
        self.run.out.notes.once(name, message, self.span)
