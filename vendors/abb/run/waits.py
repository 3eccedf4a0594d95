"""``WaitUntil``: what was waited for holds afterwards.

A wait is taken as satisfied at once. Where the condition is about the program's own data (a flag
that another task or a trap routine sets), they have the values then that satisfy it: those that it
states, else values that are not known.
"""

from __future__ import annotations

from ....core.source.execution.suppose import ConditionParts, Supposing
from ..syntax.traversal import calls_in, names_in
from ..syntax.tree import Call, Expression, Invoke, Name, Operation, Unary
from ..values.arguments import bind
from ..values.evaluator import Evaluator
from ..values.outputs import READING
from ..values.scope import Scope
from ..values.types import Unknown, Value
from .handlers import Keeping

WAIT_UNTIL = "waituntil"
_OPTIONS = ("inpos", "maxtime", "timeflag", "pollrate", "visualize", "header", "message")
_LOOKS = ("msgarray", "wrap", "icon", "image", "visualizetime", "uiactivesignal", "errornumber")


def wait_until(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """``WaitUntil [\\InPos] Cond [\\MaxTime] [\\TimeFlag] …`` ("RAPID Reference Manual")."""
    condition = bind(invoke, ("Cond",), (*_OPTIONS, *_LOOKS)).value(0)
    run.keep(invoke, scope)
    suppose(run.evaluator, condition, scope)


def suppose(evaluator: Evaluator, condition: Expression, scope: Scope, truth: bool = True) -> None:
    """Give data the values with which a condition that was waited for is what it was to be."""
    Supposing(
        evaluator.outputs,
        _parts,
        lambda part: _holds(evaluator, part, scope),
        lambda datum, other: _equate(evaluator, datum, other, scope),
        lambda part: _forget(evaluator, part, scope),
        lambda part: filter(None, map(scope.find, names_in(part))),
    ).wait(condition, truth)


def _parts(condition: Expression) -> ConditionParts[Expression]:
    """What a condition is made of; it is evaluated once if it calls more than outputs."""
    asks = any(call.name not in READING for call in calls_in(condition))
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
    if len(operands) == 2 and operators <= {"=", "<>"}:
        return ConditionParts(sides=(operands[0], operands[1]), equal=operators == {"="}, asks=asks)
    return ConditionParts(asks=asks)


def _holds(evaluator: Evaluator, condition: Expression, scope: Scope) -> bool | None:
    value = evaluator.evaluate(condition, scope)
    return None if isinstance(value, Unknown) else value is True


def _equate(
    evaluator: Evaluator, datum: Expression, other: Expression | bool, scope: Scope
) -> bool:
    value = other if isinstance(other, bool) else evaluator.evaluate(other, scope)
    return _give(evaluator, datum, value, scope)


def _give(evaluator: Evaluator, datum: Expression, value: Value, scope: Scope) -> bool:
    """Whether a datum, or an output, could be given a value."""
    if isinstance(datum, Call) and datum.name in READING:
        datum = next((a.value for a in datum.arguments if a.value is not None), datum)
    if not isinstance(datum, Name):
        return False
    name = evaluator.signal(datum, scope)
    if name is not None:
        evaluator.outputs.write(name, float(value) if isinstance(value, float | bool) else None)
        return True
    cell = scope.find(datum.name)
    if cell is None or cell.constant:
        return False
    awaited = cell.awaited
    evaluator.assign(datum, value, scope)
    cell.awaited = awaited
    return True


def _forget(evaluator: Evaluator, condition: Expression, scope: Scope) -> None:
    """What a condition is about has been changed by others, to what is not known."""
    for name in sorted(names_in(condition)):
        datum = Name(condition.span, name, name)
        _give(
            evaluator, datum, Unknown(f"what '{name}' was waited for to be", condition.span), scope
        )
