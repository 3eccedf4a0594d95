"""``WAIT FOR``: what was waited for holds afterwards, see `core.source.execution.suppose`."""

from __future__ import annotations

from contextlib import suppress

from ....core.errors import SourceError
from ....core.source.execution.course import Course
from ....core.source.execution.suppose import ConditionParts, Supposing
from ..syntax.traversal import calls_in, data_in
from ..syntax.tree import Ambiguous, Expression, Name, Operation, Unary
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.predefined import MOTION, NEVER_KNOWN, OUTPUTS
from ..values.scope import Scope
from ..values.values import Unknown, unplaced


class Waited:
    """Gives the program's own data and outputs the values that they were waited for to have.

    Args:
        data: of the program.
        evaluator: for the condition.
        course: what the user answers in turn is asked once.
    """

    def __init__(self, data: Data, evaluator: Evaluator, course: Course) -> None:
        self._data = data
        self._evaluator = evaluator
        self._course = course

    def suppose(self, condition: Expression, scope: Scope) -> None:
        """Take a condition as fulfilled.

        Raises:
            SourceError: it has no value.
        """
        outputs = self._data.outputs
        if self._asks(condition):
            mark = outputs.mark()
            if self._evaluator.evaluate(condition, scope) is False:
                outputs.forget(outputs.asked_since(mark))
        self.ended(condition, scope, True)

    def ended(self, condition: Expression, scope: Scope, truth: bool) -> None:
        """Give data the values with which a condition is what it was waited for to be.

        Raises:
            SourceError: it has no value.
        """
        Supposing(
            self._data.outputs,
            lambda part: self._parts(part, scope),
            lambda part: self._holds(part, scope),
            lambda datum, other: self._equate(datum, other, scope),
            lambda part: self._forget(part, scope),
            lambda part: filter(None, (self._data.find(d.name, scope) for d in data_in(part))),
        ).wait(condition, truth)

    def _asks(self, condition: Expression) -> bool:
        """Whether it can only be evaluated once."""
        answered = any(self._course.changing(self._data.text(d.span)) for d in data_in(condition))
        return answered or any(True for _ in calls_in(condition))

    def _parts(self, condition: Expression, scope: Scope) -> ConditionParts[Expression]:
        asks = self._asks(condition)
        if isinstance(condition, Ambiguous):
            condition = self._meant(condition, scope)
        if isinstance(condition, Unary) and condition.operator == "not":
            return ConditionParts(negated=condition.operand, asks=asks)
        if not isinstance(condition, Operation):
            return ConditionParts(asks=asks)
        operators = {operator for operator, _ in condition.rest}
        operands = (condition.first, *(operand for _, operand in condition.rest))
        if operators == {"and"}:
            return ConditionParts(all_of=operands, asks=asks)
        if operators == {"or"}:
            return ConditionParts(any_of=operands, asks=asks)
        if len(operands) == 2 and operators <= {"==", "<>"}:
            return ConditionParts(
                sides=(operands[0], operands[1]), equal=operators == {"=="}, asks=asks
            )
        return ConditionParts(asks=asks)

    def _meant(self, condition: Ambiguous, scope: Scope) -> Expression:
        try:
            self._evaluator.evaluate(condition.manual, scope)
        except SourceError:
            return condition.usual
        return condition.manual

    def _holds(self, condition: Expression, scope: Scope) -> bool | None:
        value = self._evaluator.evaluate(condition, scope)
        return None if isinstance(value, Unknown) else value is True

    def _equate(self, datum: Expression, other: Expression | bool, scope: Scope) -> bool:
        if not isinstance(datum, Name) or not self._is_own(datum, scope):
            return False
        value = other if isinstance(other, bool) else self._evaluator.evaluate(other, scope)
        cell = self._data.find(datum.name, scope)
        awaited = cell is not None and cell.awaited
        self._evaluator.assign(datum, unplaced(value), scope, datum.span).awaited = awaited
        return True

    def _forget(self, condition: Expression, scope: Scope) -> None:
        """Others have changed what a condition is about, to what is not known."""
        for datum in data_in(condition):
            if datum.name not in OUTPUTS and self._is_own(datum, scope):
                unknown = Unknown(f"what {datum.text} was waited for to be", datum.span)
                with suppress(SourceError):  # a type that must be known, as a character's
                    self._evaluator.assign(datum, unknown, scope, datum.span)

    def _is_own(self, datum: Name, scope: Scope) -> bool:
        """Whether it is the program's to set, and no motion depends on it unsaid."""
        if datum.name in OUTPUTS:
            return True
        if datum.name in MOTION or datum.name in NEVER_KNOWN:
            return False
        cell = self._data.find(datum.name, scope)
        if cell is None or cell.constant:
            return False
        return cell.signal is None or cell.signal[0].name in OUTPUTS
