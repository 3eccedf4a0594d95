"""Functions that ask for the robot's kinematics: coupled bases, ``FORWARD`` and ``INVERSE``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ....core.errors import SourceError
from ....core.program.target import JointTarget, PoseTarget
from ....core.robot.model import Robot
from ..syntax.tree import Call, Name
from ..values.evaluator import Evaluator
from ..values.frames import frame_of, null_frame
from ..values.scope import Scope
from ..values.values import Struct, Unknown, Value, find_unknown, supposed
from .frames import Placements
from .inline_forms import Function
from .position import Position
from .tables import Tables
from .targets import Targets

_UNREACHABLE = 1
"""An error; which number means what is not known, and programs ask whether it is 0."""


@dataclass(frozen=True, slots=True)
class Kinematics:
    """The functions.

    Args:
        robot: None if none is named.
    """

    robot: Robot | None
    evaluator: Evaluator
    placements: Placements
    targets: Targets
    position: Position
    tables: Tables

    def functions(self) -> Mapping[str, Function]:
        """By lower-case name."""
        return {
            "ek": self.coupled,
            "eb": self.coupled,
            "forward": self.forward,
            "inverse": self.inverse,
        }

    def coupled(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``EK(root, type, offset)``: a base on the robot's table.

        Of a robot that has no table, or several that this may mean, it stands still.
        """
        offset = supposed(arguments[2]) if len(arguments) > 2 and arguments[2] else None
        made = offset if isinstance(offset, Struct) else null_frame()
        root = supposed(arguments[0]) if arguments and arguments[0] else None
        known = isinstance(root, Struct) and find_unknown(root) is None
        return self.tables.base_on(
            root if known and isinstance(root, Struct) else None, made, call.text, call.span
        )

    def forward(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``FORWARD(axes, error)``: the pose of ``$TOOL`` in ``$BASE``."""
        axes = arguments[0] if arguments else None
        pose = None
        if (unknown := self._unknown(call, axes, 1, scope)) is not None:
            return unknown
        if self.robot is not None and isinstance(axes, Struct):
            placement = self.placements.current(call.span)
            target = self.targets.joints(axes, call.span).target
            assert isinstance(target, JointTarget)
            pose = self.position.forward(target, placement)
        if pose is None:
            return Unknown(f"the value of {call.text} (name the robot)", call.span)
        self._error(call, 1, 0, scope)
        return frame_of(pose, "e6pos")

    def inverse(self, call: Call, arguments: list[Value | None], scope: Scope) -> Value:
        """``INVERSE(position, near, error)``"""
        position = arguments[0] if arguments else None
        found = None
        if (unknown := self._unknown(call, position, 2, scope)) is not None:
            return unknown
        if self.robot is not None and isinstance(position, Struct):
            placement = self.placements.current(call.span)
            target = self.targets.pose(position, placement, True, False, call.span).target
            assert isinstance(target, PoseTarget)
            near = arguments[1] if len(arguments) > 1 else None
            start = None
            if isinstance(near, Struct) and find_unknown(near) is None:
                joints = self.targets.joints(near, call.span).target
                assert isinstance(joints, JointTarget)
                start = joints
            try:
                found = self.position.backward(target, placement, start, call.span)
            except SourceError as error:
                if start is None or not self._error(call, 2, _UNREACHABLE, scope):
                    raise
                reason = f"what {call.text} gives for a pose that it finds no axes for"
                self.evaluator.data.note(
                    "inverse",
                    f"{call.text}: {error.message}; its last argument is {_UNREACHABLE}",
                    call.span,
                )
                return Unknown(reason, call.span)
        if found is None:
            return Unknown(f"the value of {call.text} (name the robot)", call.span)
        self._error(call, 2, 0, scope)
        return found

    def _unknown(self, call: Call, given: Value | None, at: int, scope: Scope) -> Unknown | None:
        """What a call gives for a place of which something is not known: nor is its error."""
        unknown = None if given is None else find_unknown(given)
        if unknown is not None:
            self._error(call, at, unknown, scope)
        return unknown

    def _error(self, call: Call, at: int, number: int | Unknown, scope: Scope) -> bool:
        """The argument ``at`` takes the number of an error, 0 for none; whether there is one."""
        takes = call.arguments[at] if at < len(call.arguments) else None
        if not isinstance(takes, Name):
            return False
        self.evaluator.assign(takes, number, scope, call.span)
        return True
