"""Tools, work objects and home positions, as the modules of a backup declare them.

A controller saves its persistent data with the values that they had; what is declared without a
value is not initialised.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from ....core.backup.contents import BackupNotes
from ....core.errors import InputError
from ....core.program.target import JointTarget
from ....core.program.tool import Tool, WorkObject
from ....core.robot.model import Robot
from ..motion.external_axes import axis_kinds
from ..motion.targets import UNDEFINED_MASS
from ..syntax import tree
from ..values.predefined import NAMES
from ..values.records import (
    LOAD0,
    NO_AXIS,
    PER_METRE,
    UNUSED_AXIS,
    Record,
    carried,
    tool_value,
    work_object_value,
)
from ..values.types import BUILT_IN, RecordType, Value, mismatch
from .modules import ModuleFile

_HOME = ("home", "park", "safe", "grundst")
"""What names of home positions hold."""

T = TypeVar("T", Tool, WorkObject, JointTarget)


@dataclass
class Declared:
    """What the tasks of a backup declare, by name; of two tasks' own data by task and name."""

    tools: dict[str, Tool] = field(default_factory=dict)
    frames: dict[str, WorkObject] = field(default_factory=dict)
    homes: dict[str, JointTarget] = field(default_factory=dict)

    def add(
        self, task: str, files: Sequence[ModuleFile], robot: Robot | None, notes: BackupNotes
    ) -> None:
        """What a task's modules declare.

        Args:
            task: its name.
            files: of its modules.
            robot: that it moves; None if it is not known, and then external axes have no value.
            notes: where is said which values make no sense.
        """
        makers: dict[str, Callable[[tree.Declaration, str], None]] = {
            "tooldata": lambda one, file: _keep(self.tools, task, one, file, _tool, notes),
            "wobjdata": lambda one, file: _keep(
                self.frames, task, one, file, lambda value, name: _frame(value, name, robot), notes
            ),
            "jointtarget": lambda one, file: _keep(
                self.homes, task, one, file, lambda value, name: _home(value, name, robot), notes
            ),
        }
        for file in files:
            for module in file.modules:
                for one in module.declarations:
                    if one.type in makers and one.value is not None and not one.dimensions:
                        makers[one.type](one, file.name)


def _keep(
    found: dict[str, T],
    task: str,
    one: tree.Declaration,
    file: str,
    make: Callable[[Record, str], T | None],
    notes: BackupNotes,
) -> None:
    """A datum by its name; where another task has one of that name, by the task's too."""
    if one.name in NAMES or one.value is None:
        return
    value = _literal(one.value)
    type_ = BUILT_IN[one.type]
    if value is None or not isinstance(type_, RecordType) or not isinstance(value, tuple):
        return
    try:
        wrong = mismatch(value, type_)
        if wrong is not None:
            raise InputError(wrong)
        made = make(value, one.text)
    except InputError as error:
        notes.add(f"{one.type} {one.text} is passed over: {error}", file, one.span.line)
        return
    if made is not None and found.setdefault(one.text, made) != made:
        found[f"{task}/{one.text}"] = made


def _literal(value: tree.Expression) -> Value | None:
    """The value of an expression of literals alone; None of any other."""
    if isinstance(value, tree.Packed):
        return value.value
    if isinstance(value, tree.Number | tree.Truth | tree.Text):
        return value.value
    if isinstance(value, tree.Unary) and value.operator == "-":
        operand = _literal(value.operand)
        return -operand if isinstance(operand, float) else None
    if isinstance(value, tree.Aggregate):
        items = [_literal(item) for item in value.items]
        return None if any(item is None for item in items) else tuple(items)
    return None


def _tool(value: Record, name: str) -> Tool:
    held, frame, load = value
    return tool_value((held, frame, LOAD0 if load[0] == UNDEFINED_MASS else load), name)


def _frame(value: Record, name: str, robot: Robot | None) -> WorkObject:
    if not value[1] and not value[2]:
        raise InputError("ufprog is FALSE, and ufmec names no unit")
    made = work_object_value(value, name)
    driven = () if robot is None else [axis.name for axis in robot.external_axes]
    return carried(made) if made.moved_by in driven else made


def _home(value: Record, name: str, robot: Robot | None) -> JointTarget | None:
    """A jointtarget that is called like a home position; None of any other."""
    if not any(word in name.casefold() for word in _HOME):
        return None
    arm, external = value
    if any(abs(degrees) >= UNUSED_AXIS for degrees in arm):
        raise InputError("an axis of the arm has no value (9E9)")
    used = []
    for kind, at in zip(axis_kinds(robot) or (), external, strict=False):
        if kind == NO_AXIS:
            continue
        if abs(at) >= UNUSED_AXIS:
            break
        used.append(at / PER_METRE if kind == "linear" else math.radians(at))
    return JointTarget(tuple(map(math.radians, arm)), tuple(used), name)
