"""Calls of functions that compute: those of the language, methods of lists, ``struct``."""

from __future__ import annotations

from ....core.errors import InputError
from ..syntax.tree import Argument, Call, MethodCall, Name
from .arguments import bind
from .assignments import store
from .evaluator import Evaluation, evaluate, plain
from .functions import COMPUTED, SHAPES, Computed
from .lists import METHODS, Items
from .located import Located
from .scope import Scope
from .values import Struct, Unknown, UrPose, Value, ValueFault, describe, find_unknown, supposed


def compute(run: Evaluation, call: Call, scope: Scope) -> Value:
    """What a function of `COMPUTED` gives; unknown if one of its arguments is.

    Raises:
        SourceError: it has no value for these arguments.
    """
    computed = COMPUTED[call.name]
    required = len(computed.parameters) - computed.optional
    given = bind(call, computed.parameters, required, run.texts)
    values: list[Value] = []
    for name in computed.parameters:
        if name not in given:
            break
        values.append(plain(run, given[name].value, scope))
    whole = call.name in SHAPES
    span = run.texts.span_of(call)
    run.work(computed.cost, span)
    for value in values:
        unknown = find_unknown(value) if not whole else value
        if isinstance(unknown, Unknown):
            return Unknown(
                unknown.reason,
                unknown.span,
                _held(call.name, computed, values),
                unknown.damaged,
            )
        if isinstance(value, tuple):
            run.work(len(value), span)
    return _applied(run, computed, values, call)


_SHIFTED = frozenset({"pose_trans", "pose_add", "pose_sub"})
_NO_SHIFT = UrPose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def _held(name: str, computed: Computed, values: list[Value]) -> Value:
    """What a move takes a value for: by what a pose is shifted counts as nothing where nobody knows
    it."""
    known = [supposed(value) for value in values]
    if name in _SHIFTED and len(known) > 1:
        shift = known[1]
        if isinstance(shift, UrPose):
            known[1] = UrPose(*(0.0 if isinstance(v, Unknown) else v for v in shift))
        elif isinstance(shift, Unknown):
            known[1] = _NO_SHIFT
    if any(find_unknown(value) is not None for value in known):
        return None
    try:
        return computed(*known)
    except (ValueFault, InputError, ValueError, ArithmeticError, TypeError):
        return None


def _applied(run: Evaluation, computed: Computed, values: list[Value], call: Call) -> Value:
    try:
        return computed(*values)
    except (ValueFault, InputError) as fault:
        raise run.texts.stop_at(f"{call.name}: {fault}", call) from None
    except (ValueError, ArithmeticError):
        shown = ", ".join(map(describe, values))
        raise run.texts.stop_at(f"{call.name}({shown}) has no finite value", call) from None


def list_method(
    run: Evaluation, call: MethodCall, items: Items, arguments: list[Value], scope: Scope
) -> Value:
    """What a method of `METHODS` gives; the list is changed where it stands.

    Raises:
        SourceError: the list has no such element, or the method takes other arguments.
    """
    run.work(len(items), run.texts.span_of(call))
    try:
        changed, value = METHODS[call.name](items, *arguments)
    except ValueFault as fault:
        raise run.texts.stop_at(f"{call.name}: {fault}", call) from None
    except TypeError:
        raise run.texts.error_at(
            f"the method '{call.name}' does not take {len(arguments)} arguments", call
        ) from None
    if changed is not None and isinstance(call.base, Name):
        store(run, call.base, Located(changed), scope)
    return value


def struct(run: Evaluation, call: Call, scope: Scope) -> Located:
    """``struct(name=value, …)``

    Raises:
        SourceError: a part has no name, or that of another one.
    """
    names: list[str] = []
    values: list[Value] = []
    for argument in call.arguments:
        names.append(_part_name(run, argument, names))
        values.append(evaluate(run, argument.value, scope))
    return Located(Struct(tuple(names), tuple(values)))


def _part_name(run: Evaluation, argument: Argument, before: list[str]) -> str:
    if argument.name is None:
        raise run.texts.error_at("the parts of a struct have names: struct(name=value)", argument)
    if argument.name in before:
        raise run.texts.error_at(f"the struct has '{argument.name}' twice", argument)
    return argument.name
