"""A loop that has waited for others: what it waited for holds afterwards, see
`core.source.execution.suppose`."""

from __future__ import annotations

from ....core.source.execution.outputs import Outputs
from ....core.source.execution.suppose import ConditionParts, Supposing
from ..syntax.traversal import calls_written, methods_in, names_in
from ..syntax.tree import Expression, Name, Operation, Unary
from ..values.evaluator import Evaluation, condition, evaluate
from ..values.scope import Scope
from ..values.values import Unknown, Value


def has_ended(run: Evaluation, outputs: Outputs, expression: Expression, scope: Scope) -> None:
    """Give variables the values with which a loop's condition does not let it go on."""

    def holds(part: Expression) -> bool | None:
        value = condition(run, part, scope)
        return None if isinstance(value, Unknown) else value

    def equate(datum: Expression, other: Expression | bool) -> bool:
        value = other if isinstance(other, bool) else evaluate(run, other, scope)
        return isinstance(datum, Name) and _give(datum.text, value, scope)

    def forget(part: Expression) -> None:
        for name in sorted(names_in(part)):
            reason = f"what '{name}' was waited for to be"
            _give(name, Unknown(reason, run.texts.span_of(part)), scope)

    Supposing(outputs, _parts, holds, equate, forget).suppose(expression, False)


def _parts(expression: Expression) -> ConditionParts[Expression]:
    asks = any(True for _ in calls_written(expression)) or any(True for _ in methods_in(expression))
    if isinstance(expression, Unary) and expression.operator == "not":
        return ConditionParts(negated=expression.operand, asks=asks)
    if not isinstance(expression, Operation):
        return ConditionParts(asks=asks)
    operators = {operator for operator, _ in expression.rest}
    operands = (expression.first, *(operand for _, operand in expression.rest))
    if operators == {"and"}:
        return ConditionParts(all_of=operands, asks=asks)
    if operators == {"or"}:
        return ConditionParts(any_of=operands, asks=asks)
    if len(operands) == 2 and operators <= {"==", "!="}:
        return ConditionParts(
            sides=(operands[0], operands[1]), equal=operators == {"=="}, asks=asks
        )
    return ConditionParts(asks=asks)


def _give(name: str, value: Value, scope: Scope) -> bool:
    """Whether there is such a variable, which has a value now that no text states."""
    cell = scope.find(name)
    if cell is None:
        return False
    cell.value = value
    cell.sources = ()
    return True
