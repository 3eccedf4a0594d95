"""What the expressions say that stand as targets of motion instructions.

A target that is not known in all is taken for what is known of it, with a note. Those of relative
motions are steps from the place where the robot is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from ....core.errors import LeftOpenError, SourceError, Span
from ....core.source.execution.provenance import ELSEWHERE
from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Expression, Flat, MotionInstruction, Name
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.frames import frame_of, pose_of
from ..values.provenance import Sources
from ..values.scope import Scope
from ..values.types import AXES, FRAME_FIELDS, POSES, KrlTypeError, convert
from ..values.values import (
    Placement,
    Struct,
    Unknown,
    Value,
    find_unknown,
    shown,
    supposed,
    unplaced,
)
from .position import Position
from .targets import AXIS_NUMBERS, POSE_NUMBERS, ReadTarget, Targets, is_axes


@dataclass(frozen=True, slots=True)
class TargetExpressions:
    """Reads targets of motion instructions.

    Args:
        data: of the program.
        evaluator: of its expressions.
        targets: completes what they say.
        position: where the robot is.
        transcript: of the moves before.
    """

    data: Data
    evaluator: Evaluator
    targets: Targets
    position: Position
    transcript: Transcript
    _literals: dict[tuple[int, bool, bool], ReadTarget] = field(default_factory=dict)

    def read(
        self,
        motion: MotionInstruction,
        expression: Expression,
        scope: Scope,
        placement: Placement,
        joint: bool,
        via: bool = False,
    ) -> ReadTarget:
        """What one point of a motion is.

        Args:
            joint: whether the axes go there on their own, rather than the TCP.
            via: whether it is the auxiliary point of an arc.

        Raises:
            SourceError: it is no place, or not known.
            LeftOpenError: it goes on from a place that nobody knows.
        """
        key = (id(expression), joint, via)
        if key in self._literals:
            return self._literals[key]
        span = expression.span
        value, open_ = self._value(motion, expression, scope)
        if motion.word.endswith("_rel"):
            found = self._relative(motion, value, placement, via, span)
            return replace(found, supposed=open_ or self.position.supposed)
        if is_axes(value):
            found = self.targets.joints(value, span)
        else:
            found = self.targets.pose(value, placement, joint, via, span)
        if open_:
            found = replace(found, supposed=open_)
        if found.filled:
            found = replace(found, supposed=found.supposed or self.position.supposed)
            self._depends_on_last()
        elif isinstance(expression, Flat):
            self._literals[key] = found  # loops come by often
        return found

    def _value(
        self, motion: MotionInstruction, expression: Expression, scope: Scope
    ) -> tuple[Struct, str]:
        """What stands as a target, and what it depends on that the text does not say."""
        span = expression.span
        self.evaluator.reader = self.transcript.move_index
        course = self.evaluator.course
        course.supposed = ""
        value = self.evaluator.evaluate(expression, scope)
        self.evaluator.reader = ELSEWHERE
        what = f"the target of {motion.word.upper()}"
        if isinstance(value, Struct) and not value.fields and isinstance(expression, Name):
            value = self.evaluator.names.unset(expression, scope, value.type)
        self.evaluator.used_as(value, "target" if "ptp" in motion.word else "e6pos")
        unknown = find_unknown(value)
        if unknown is not None:
            value = self._supposed(value, unknown, what, span)
        if isinstance(value, Unknown):
            if isinstance(expression, Name) and self.data.find(expression.name, scope) is None:
                raise self.evaluator.undeclared(expression, scope, "point")
            self.evaluator.check_known(value, what, span)
        if not isinstance(value, Struct):
            raise SourceError(f"{what} is a position or axis values, not {shown(value)}", span)
        reason = course.supposed if unknown is None else unknown.reason
        open_ = reason and f"{what} depends on {reason}"
        if value.type == "":
            return self._typed(value, "e6axis" if is_axes(value) else "e6pos", span), open_
        if value.type in AXES or value.type in POSES:
            return value, open_
        raise SourceError(f"{what} is a position or axis values, not {shown(value)}", span)

    def _supposed(self, value: Value, unknown: Unknown, what: str, span: Span) -> Value:
        """A target that is not known in all, as far as there are values to take it for."""
        taken = supposed(value)
        open_ = find_unknown(taken)
        if open_ is not None:
            return value if isinstance(taken, Unknown) else taken
        self.transcript.notes.count(
            f"{what} depends on {unknown.reason}, which the text does not say: what is known "
            f"of it, or 0, is taken; {unknown.answerable}",
            span,
        )
        return unplaced(taken)

    def _typed(self, value: Struct, kind: str, span: Span) -> Struct:
        """An aggregate without a type as what its components make it."""
        types = self.data.types
        if value.fields.keys() <= types[kind].keys():
            # `Targets` wants numbers, and says so.
            return Struct(kind, value.fields, value.label, value.shipped, value.moved_by)
        try:
            typed = convert(value, kind, types)
        except KrlTypeError as error:
            raise SourceError(str(error), span) from None
        assert isinstance(typed, Struct)
        return typed

    def _relative(
        self, motion: MotionInstruction, value: Struct, placement: Placement, via: bool, span: Span
    ) -> ReadTarget:
        """The present target and a step."""
        self.evaluator.check_known(value, f"the target of {motion.word.upper()}", span)
        self.evaluator.reader = self.transcript.move_index
        self.evaluator.note_reads(value)
        self.evaluator.reader = ELSEWHERE
        self._depends_on_last()
        axes = is_axes(value)
        present = self.position.axes(span) if axes else self.position.pose(placement, span)
        if isinstance(present, Unknown):
            raise LeftOpenError(f"{motion.word.upper()} goes on from {present.reason}", span)
        summed = dict(present.fields)
        names = AXIS_NUMBERS if axes else (*FRAME_FIELDS, *POSE_NUMBERS[8:])
        for name in names:
            step = value.fields.get(name)
            if step is not None:
                summed[name] = _sum(summed.get(name, 0.0), step)
        if axes:
            return self.targets.joints(Struct("e6axis", summed), span)
        if motion.frame == "tool":
            summed.update(frame_of(pose_of(present.fields) @ pose_of(value.fields)).fields)
        elif any(value.fields.get(name, 0) != 0 for name in "abc"):
            turn = pose_of({n: v for n, v in value.fields.items() if n in "abc"})
            turned = frame_of(turn @ pose_of(present.fields)).fields
            summed.update({name: turned[name] for name in "abc"})
        for name in "st":
            summed.pop(name, None)
            if name in value.fields:
                summed[name] = value.fields[name]
        joint = "ptp" in motion.word
        found = self.targets.pose(Struct("e6pos", summed), placement, joint, via, span)
        return replace(found, sources=Sources(()))

    def _depends_on_last(self) -> None:
        """The last target's numbers are read by the move that comes now as well."""
        if self.transcript.parts:
            self.read_by_expression(self.transcript.parts[-1].target.sources)

    def read_by_expression(self, sources: Iterable[object]) -> None:
        """The move that comes now reads numbers beside those that it is patched by."""
        for source in sources:
            if source is not None:
                self.evaluator.reads.by_expression(source, self.transcript.move_index)  # type: ignore[arg-type]


def _sum(present: Value, step: Value) -> float:
    assert isinstance(step, int | float) and isinstance(present, int | float)
    return float(present) + float(step)
