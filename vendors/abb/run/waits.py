"""``WaitUntil``: what was waited for holds afterwards.

A wait is taken as satisfied at once. Where the condition is about the program's own data (a flag
that another task or a trap routine sets), they have the values then that satisfy it: those that it
states, else values that are not known.
"""

from __future__ import annotations

from ..syntax.traversal import calls_in, names_in
from ..syntax.tree import Call, Expression, Invoke, Name, Operation, Unary
from ..values.arguments import bind
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
    _suppose(run, condition, True, scope)


def _suppose(run: Keeping, condition: Expression, holds: bool, scope: Scope) -> None:
    """Give data the values with which a condition that does not hold does (or does not)."""
    if any(call.name not in READING for call in calls_in(condition)):
        return
    outputs = run.evaluator.outputs
    outputs.asked.clear()
    value = run.evaluator.evaluate(condition, scope)
    if value is holds or isinstance(value, Unknown):
        return
    asked = frozenset(outputs.asked)
    if isinstance(condition, Unary) and condition.operator == "not":
        _suppose(run, condition.operand, not holds, scope)
    elif isinstance(condition, Operation) and _all_must(condition, holds):
        for operand in (condition.first, *(operand for _, operand in condition.rest)):
            _suppose(run, operand, holds, scope)
    elif not _stated(run, condition, holds, scope):
        outputs.forget(asked)
        _forget(run, condition, scope)


def _all_must(condition: Operation, holds: bool) -> bool:
    """Whether every part of a conjunction, or of a disjunction, is to be the same."""
    word = "and" if holds else "or"
    return all(operator == word for operator, _ in condition.rest)


def _stated(run: Keeping, condition: Expression, holds: bool, scope: Scope) -> bool:
    """``flag`` and ``n = 1`` say which value the datum has."""
    if isinstance(condition, Name):
        return _give(run, condition, holds, scope)
    if not isinstance(condition, Operation) or len(condition.rest) != 1:
        return False
    operator, second = condition.rest[0]
    if operator != ("=" if holds else "<>"):
        return False
    return any(
        _give(run, datum, run.evaluator.evaluate(other, scope), scope)
        for datum, other in ((condition.first, second), (second, condition.first))
    )


def _give(run: Keeping, datum: Expression, value: Value, scope: Scope) -> bool:
    """Whether a datum, or an output, could be given a value."""
    if isinstance(datum, Call) and datum.name in READING:
        datum = next((a.value for a in datum.arguments if a.value is not None), datum)
    if not isinstance(datum, Name):
        return False
    name = run.evaluator.signal(datum, scope)
    if name is not None:
        run.evaluator.outputs.write(name, float(value) if isinstance(value, float | bool) else None)
        return True
    cell = scope.find(datum.name)
    if cell is None or cell.constant:
        return False
    run.evaluator.assign(datum, value, scope)
    return True


def _forget(run: Keeping, condition: Expression, scope: Scope) -> None:
    """What a condition is about has been changed by others, to what is not known."""
    for name in sorted(names_in(condition)):
        datum = Name(condition.span, name, name)
        _give(run, datum, Unknown(f"what '{name}' was waited for to be", condition.span), scope)
