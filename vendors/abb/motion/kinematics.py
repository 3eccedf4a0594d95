"""Functions that ask the emulated robot: where it stands, with which tool, in which frame.

"RAPID Reference Manual", functions CRobT, CJointT, CPos, CTool, CWObj, CalcRobT, CalcJointT,
ORobT, MirPos, CSpeedOverride. Positions are those of the last commanded target (`Position`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ....core.errors import FlybyError, MotionError, SourceError
from ....core.program.tool import WORLD, Tool, WorkObject
from ....core.spatial.pose import Pose
from ....core.spatial.rotation import quaternion_from_matrix
from ..syntax.tree import Call, Expression, Invoke
from ..values.arguments import check_count
from ..values.errors import NUMBERS, OUT_OF_REACH, ProgramError
from ..values.function_calls import Evaluates, Special
from ..values.located import Located
from ..values.records import Record, pose_record, tool_record, work_object_record
from ..values.scope import Scope
from ..values.types import (
    JOINTTARGET,
    POSE,
    ROBTARGET,
    TOOLDATA,
    WOBJDATA,
    Type,
    Unknown,
    Value,
    find_unknown,
)
from .position import Position
from .settings import SettingsInForce
from .targets import Converter, points_nowhere

FULL_OVERRIDE = 100.0


@dataclass(frozen=True, slots=True)
class RobotFunctions:
    """The functions, by lower-case name."""

    position: Position
    convert: Converter
    settings: SettingsInForce

    def table(self) -> dict[str, Special]:
        """name → function."""
        return {
            "crobt": self._robtarget,
            "cpos": self._cpos,
            "cjointt": self._jointtarget,
            "ctool": lambda evaluator, call, scope: tool_record(self.position.tool),
            "cwobj": lambda evaluator, call, scope: work_object_record(self.position.work_object),
            "calcrobt": self._forward,
            "calcjointt": self._backward,
            "orobt": self._undisplaced,
            "mirpos": self._mirrored,
            "cspeedoverride": lambda evaluator, call, scope: FULL_OVERRIDE,
        }

    # ---------------------------------------------------------------- what it asks

    def _robtarget(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        if any(a.option in ("taskref", "taskname") for a in call.arguments):
            return self._unknown(evaluator, call, "that of another task")
        tool = self._tool(evaluator, self._option(call, "tool"), scope)
        frame = self._frame(evaluator, self._option(call, "wobj"), scope)
        where, displacement = self.position, self.settings.now.displacement
        return self._told(evaluator, call, lambda: where.robtarget(tool, frame, displacement))

    def present_robtarget(
        self,
        evaluator: Evaluates,
        tool: Expression | None,
        frame: Expression | None,
        scope: Scope,
        invoke: Invoke,
    ) -> Record:
        """Where the robot stands, without program displacement.

        Raises:
            SourceError: it is not known.
        """
        a = self._tool(evaluator, tool, scope)
        b = self._frame(evaluator, frame, scope, None if tool is None else WORLD)
        record = self._asked(invoke, lambda: self.position.robtarget(a, b, None))
        if record is not None:
            evaluator.course.suppose(self.position.supposed)
            return record
        raise SourceError(
            f"{invoke.text} takes the robot's present position, which is not known here: name the "
            "robot, or give the position with \\ExeP",
            invoke.span,
        )

    def _cpos(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        value = self._robtarget(evaluator, call, scope)
        return value if isinstance(value, Unknown) else self._tuple(value)[0]

    def _jointtarget(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        return self._told(evaluator, call, self.position.jointtarget)

    def _forward(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        """``CalcRobT(jointtarget, Tool [\\WObj])``"""

        def ask(value: Value, tool: Tool, frame: WorkObject) -> Record | None:
            target = self.convert.joint_target(value, None, False, call.span)
            return self._asked(call, lambda: self.position.robtarget_at(target, tool, frame))

        return self._converted(evaluator, call, scope, JOINTTARGET, ask)

    def _backward(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        """``CalcJointT(robtarget, Tool [\\WObj])``: a pose out of reach is the program's error."""

        def ask(value: Value, tool: Tool, frame: WorkObject) -> Record | None:
            target = self.convert.pose_target(value, None, True, call.span)
            try:
                return self.position.jointtarget_at(target, tool, frame)
            except FlybyError as error:
                number = NUMBERS[OUT_OF_REACH]
                said = error.message if isinstance(error, MotionError) else str(error)
                raise ProgramError(f"{call.text}: {said}", call.span, number) from None

        return self._converted(evaluator, call, scope, ROBTARGET, ask)

    def _converted(
        self,
        evaluator: Evaluates,
        call: Call,
        scope: Scope,
        type_: Type,
        ask: Callable[[Value, Tool, WorkObject], Record | None],
    ) -> Value:
        """A position of one kind as one of the other."""
        given, tool_given = self._required(call, 2)
        value = evaluator.evaluate(given, scope)
        tool = self._tool(evaluator, tool_given, scope)
        frame = self._frame(evaluator, self._option(call, "wobj"), scope, WORLD)
        unset = type_ is ROBTARGET and points_nowhere(value)
        if find_unknown(value) is not None or unset:
            return self._unknown(evaluator, call, "of values that are not known")
        self._check(evaluator, value, type_, call)
        record = ask(value, tool, frame)
        return self._unknown(evaluator, call, None) if record is None else record

    # ------------------------------------------------------------------- geometry

    def _undisplaced(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        """``ORobT(point)``: as it is without program displacement."""
        (point,) = self._required(call, 1)
        value = evaluator.evaluate(point, scope)
        displacement = self.settings.now.displacement
        if displacement is None or find_unknown(value) is not None:
            return value
        self._check(evaluator, value, ROBTARGET, call)
        trans, rot, *rest = self._tuple(value)
        moved = displacement @ self.convert.pose((trans, rot), call.span)
        return (*pose_record(moved), *rest)

    def _mirrored(self, evaluator: Evaluates, call: Call, scope: Scope) -> Value:
        """``MirPos(point, plane [\\WObj] [\\MirY])``: in the xy plane of a frame."""
        point, plane = self._required(call, 2)
        values = [evaluator.evaluate(e, scope) for e in (point, plane)]
        frame = self._frame(evaluator, self._option(call, "wobj"), scope, WORLD)
        if find_unknown(tuple(values)) is not None:
            return self._unknown(evaluator, call, "of values that are not known")
        self._check(evaluator, values[0], ROBTARGET, call)
        mirror = self._plane(evaluator, values[1], call)
        trans, rot, *rest = self._tuple(values[0])
        pose = self.convert.pose((trans, rot), call.span)
        seen = mirror.inverse() @ frame.pose @ pose
        keeps_y = not any(a.option == "miry" for a in call.arguments)
        back = frame.pose.inverse() @ mirror @ _mirror(seen, keeps_y)
        return (*pose_record(back), *rest)

    def _plane(self, evaluator: Evaluates, value: Value, call: Call) -> Pose:
        if isinstance(value, tuple) and len(value) == len(WOBJDATA.components):
            self._check(evaluator, value, WOBJDATA, call)
            _, _, _, user, frame = value
            convert = self.convert
            return convert.pose(user, call.span) @ convert.pose(frame, call.span)
        self._check(evaluator, value, POSE, call)
        return self.convert.pose(value, call.span)

    # -------------------------------------------------------------------- helpers

    def _told(self, evaluator: Evaluates, call: Call, ask: Callable[[], Record | None]) -> Value:
        record = self._asked(call, ask)
        evaluator.course.suppose(self.position.supposed)
        return self._unknown(evaluator, call, None) if record is None else record

    @staticmethod
    def _asked(call: Call | Invoke, ask: Callable[[], Record | None]) -> Record | None:
        try:
            return ask()
        except SourceError:
            raise
        except MotionError as error:
            if error.span is None or error.move is None:
                raise SourceError(f"{call.text}: {error.message}", call.span) from None
            raise SourceError(
                f"move {error.move + 1}: {error.message}; {call.text} at {call.span} asks where "
                "the robot stands after it",
                error.span,
            ) from None
        except FlybyError as error:
            raise SourceError(f"{call.text}: {error}", call.span) from None

    def _unknown(self, evaluator: Evaluates, call: Call, why: str | None) -> Unknown:
        if why is None:
            unmoved = "the robot has not moved yet: give a start"
            why = "name the robot" if self.position.robot is None else unmoved
            # Of a place no default is taken: numbers made of it are open, as the place itself is.
            return self._not_known(evaluator, call, why, lost=True)
        return self._not_known(evaluator, call, why)

    @staticmethod
    def _not_known(evaluator: Evaluates, call: Call, why: str, lost: bool = False) -> Unknown:
        key = evaluator.answers.key(call.span)
        return Unknown(f"the value of {call.text}() ({why})", call.span, key, lost=lost)

    @staticmethod
    def _option(call: Call, name: str) -> Expression | None:
        return next((a.value for a in call.arguments if a.option == name), None)

    @staticmethod
    def _required(call: Call, count: int) -> list[Expression]:
        found = [a.value for a in call.arguments if a.option is None and a.value is not None]
        check_count(call.text, count, len(found), call.span)
        return found

    def _tool(self, evaluator: Evaluates, given: Expression | None, scope: Scope) -> Tool:
        if given is None:
            return self.position.tool
        found = self._located(evaluator, given, TOOLDATA, scope)
        evaluator.check(found.value, TOOLDATA, "the tool", given.span)
        return self.convert.tool(found, given)

    @staticmethod
    def _located(evaluator: Evaluates, given: Expression, type_: Type, scope: Scope) -> Located:
        """A tool or frame; where it is not known, its default."""
        found = evaluator.locate(given, scope)
        if find_unknown(found.value) is None:
            return found
        evaluator.answers.used_as(given, found.value, type_)
        use = "the tool" if type_ is TOOLDATA else "the work object"
        value = evaluator.assumed(found.value, type_, use, given.span)
        return replace(found, value=value)

    def _frame(
        self,
        evaluator: Evaluates,
        given: Expression | None,
        scope: Scope,
        default: WorkObject | None = None,
    ) -> WorkObject:
        if given is None:
            return self.position.work_object if default is None else default
        found = self._located(evaluator, given, WOBJDATA, scope)
        evaluator.check(found.value, WOBJDATA, "the work object", given.span)
        return self.convert.work_object(found, given)

    @staticmethod
    def _check(evaluator: Evaluates, value: Value, type_: Type, call: Call) -> None:
        evaluator.check(value, type_, call.text, call.span)

    @staticmethod
    def _tuple(value: Value) -> Record:
        assert isinstance(value, tuple)
        return value


def _mirror(pose: Pose, keeps_y: bool) -> Pose:
    """A pose mirrored in the xy plane: the tool's z and one more axis are mirrored, and the third
    one makes the frame right-handed."""
    x, y, z = pose.position
    flip = np.diag([1.0, 1.0, -1.0])
    axes = flip @ pose.matrix()[:3, :3]
    if keeps_y:
        axes[:, 1] = np.cross(axes[:, 2], axes[:, 0])
    else:
        axes[:, 0] = np.cross(axes[:, 1], axes[:, 2])
    w, i, j, k = (float(v) for v in quaternion_from_matrix(axes))
    return Pose((x, y, -z), (w, i, j, k))
