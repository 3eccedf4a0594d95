"""Answers of a user, as values of KRL: to data that nothing at hand sets, and to parts of them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ....core.program.question import Answer, QuestionKind
from ....core.source.execution.answers import Fields
from ....core.source.execution.course import About, Course
from ....core.spatial.pose import Pose
from ..syntax.tree import Name
from .angles import angles
from .data import Data
from .expected import AXIS_NAMES, EXPECTED
from .predefined import OUTPUTS
from .scope import Path, spelled
from .types import FRAME_FIELDS, PREDEFINED
from .values import Choice, Struct, Unknown, Value

_TRUTHS = frozenset({"$in", "$out", "$flag", "$cycflag"})
_IN_PRODUCTION: dict[str, Value] = {
    "$mode_op": Choice("ex"),
    **dict.fromkeys(("$t1", "$t2", "$aut"), False),
    "$ext": True,
}
"""Which mode the controller is in where nobody says it: a PLC runs it."""
_NUMBER = r"[-+]?\d*\.?\d+(?:[eE][-+]?\d+)?"
_STRUCTURE = re.compile(rf"\{{\s*[A-Za-z]\w*\s+{_NUMBER}(?:\s*,\s*[A-Za-z]\w*\s+{_NUMBER})*\s*\}}")
"""``{X 700,Y 0,Z 500}``"""


def kind_of(name: str) -> QuestionKind:
    """What a system variable tells, by its name in lower case."""
    if re.fullmatch(r"\$(rob_)?timer(_\w+)?|\$date|\$sen_\w+|\$torque\w*|\$curr_\w+", name):
        return QuestionKind.SENSOR
    return QuestionKind.SIGNAL


@dataclass(frozen=True, slots=True)
class DatumAnswers:
    """The user's answers to data."""

    course: Course
    data: Data

    def used_with(self, value: Unknown, step: str | tuple[int, ...]) -> None:
        """A component of what nobody says is used: so it is a structure that is asked for."""
        if not isinstance(step, str) or not value.key:
            return
        if step in FRAME_FIELDS:
            self.course.used_as(value.key, *EXPECTED["frame"])
        elif step.upper() in AXIS_NAMES:
            self.course.used_as(value.key, *EXPECTED["axis"])
        elif value.key.endswith(")") or "." not in value.key:
            self.course.used_with(value.key, step.upper())

    def answer(
        self, node: Name, path: Path, kind: QuestionKind | None = None, type_: str = ""
    ) -> Value | None:
        """The user's answer to a datum or a part of it.

        Args:
            kind: what is asked for; None for what comes of something else that is.
            type_: of the datum, lower case, as far as it is known.
        """
        about = None if kind is None else About(node.span, kind, *EXPECTED.get(type_, (type_,)))
        answer = self.course.value(spelled(node.text, path), about)
        return None if answer is None else answered(answer)

    def undeclared(self, node: Name, path: Path, why: str | None = None) -> Value:
        """The value of what nothing declares, or others write: an answer, or not known."""
        system = self.data.is_system(node.name)
        kind = kind_of(node.name) if system or node.name in OUTPUTS else QuestionKind.DATUM
        truths = system and node.name in _TRUTHS
        if path and path[-1] in ("x", "y", "z", "a", "b", "c"):
            self.course.used_as(spelled(node.text, path[:-1]), *EXPECTED["frame"])
        told = self.course.answers.values
        if path and told and self.course.lasting(spelled(node.text, path)) is None:
            part = self._part_of_answer(node, path)
            if part is not None:
                return part
        mode = None if why or path else _IN_PRODUCTION.get(node.name)
        asked = kind if mode is None else None
        answer = self.answer(node, path, asked, "bool" if truths else "")
        if answer is not None:
            return answer
        if mode is not None:
            return mode
        if why is None:
            why = "" if self.data.is_system(node.name) else " (declared in no file at hand)"
        text = spelled(node.text, path)
        return Unknown(f"the value of {text}{why}", node.span, key=text)

    def _part_of_answer(self, node: Name, path: Path) -> Value | None:
        """A part of what the user answers as a whole; None if it is not in an answer."""
        for cut in reversed(range(len(path))):
            answer = self.course.lasting(spelled(node.text, path[:cut]))
            if answer is None:
                continue
            value: Value | None = answered(answer)
            for step in path[cut:]:
                fields = value.fields if isinstance(value, Struct) else {}
                value = fields.get(step) if isinstance(step, str) else None
            return value
        return None


def frame_answer(example: Answer, pose: Pose) -> Answer | None:
    """A pose as a user answers a frame or a tool, mm and degrees; None where neither is asked."""
    if not isinstance(example, Fields) or [name for name, _ in example] != list("XYZABC"):
        return None
    x, y, z = (1000 * value for value in pose.position)
    turned = angles(pose.quaternion)
    return Fields(zip("XYZABC", (round(v, 3) + 0.0 for v in (x, y, z, *turned)), strict=True))


def answered(answer: Answer) -> Value:
    """A user's answer as a value; a text ``{X 700,Y 0,Z 500}`` is a structure."""
    if isinstance(answer, Fields):
        return Struct("", {name.lower(): answered(part) for name, part in answer})
    if isinstance(answer, str) and _STRUCTURE.fullmatch(answer):
        parts = (part.split() for part in answer.strip("{} ").split(","))
        return Struct("", {name.lower(): float(number) for name, number in parts})
    if isinstance(answer, str):
        return Choice(answer[1:].lower()) if answer.startswith("#") else answer
    if isinstance(answer, tuple):
        values = [answered(part) for part in answer]
        names = list(PREDEFINED["e6pos"])
        return Struct("", dict(zip(names, values, strict=False)))
    if isinstance(answer, float) and answer.is_integer() and abs(answer) < 2**31:
        return int(answer)
    return answer
