"""Expressions → values.

The functions here take the run that an expression is evaluated in as `Evaluation`: what it knows,
and what it does with calls.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

from ....core.errors import SourceError, Span
from ....core.program.question import QuestionKind
from ....core.source.execution.course import About, Course
from ....core.source.text.operators import COMPARING
from ..syntax import tree
from ..syntax.texts import Texts
from .answers import answered, used_as
from .elements import element, whole
from .located import Located
from .operators import apply, negate, truth
from .provenance import Literal, SourceReads, element_source
from .scope import Scope
from .values import PendingInverse, Struct, Unknown, UrPose, Value, ValueFault, checked, describe

_POSE = 6
_WRITTEN = {"pi": math.pi, "true": True, "false": False}
"""Names that stand for a value where no variable has them."""


class Evaluation(Protocol):
    """What an expression asks of the run that it belongs to."""

    @property
    def texts(self) -> Texts:
        """Where places are looked up."""

    @property
    def course(self) -> Course:
        """Answers for what the text leaves open."""

    @property
    def literals(self) -> SourceReads:
        """Who reads which literals."""

    def call(self, call: tree.Call, scope: Scope) -> Located:
        """The value of a function."""

    def method(self, call: tree.MethodCall, scope: Scope) -> Value:
        """The value of a method."""

    def start_thread(self, run: tree.StartThread, scope: Scope) -> Value:
        """Start a thread; its handle."""

    def joints(self, solution: PendingInverse) -> Value:
        """The numbers of an inverse-kinematics solution."""

    def work(self, amount: int, span: Span) -> None:
        """Count what copying a list of so many elements costs."""


def evaluate(run: Evaluation, expression: tree.Expression, scope: Scope) -> Value:
    """The value of an expression; `Unknown` where only the controller has it.

    Raises:
        SourceError: it has none.
    """
    return _EVALUATORS[type(expression)](run, expression, scope)


def locate(run: Evaluation, expression: tree.Expression, scope: Scope) -> Located:
    """A value that is taken as it stands, with its sources.

    Unlike `evaluate` this does not count as a read by an expression: the caller tells
    `SourceReads` what it does with the value.
    """
    found = _LOCATORS.get(type(expression))
    if found is None:
        return Located(evaluate(run, expression, scope))
    return found(run, expression, scope)


def condition(run: Evaluation, expression: tree.Expression, scope: Scope) -> bool | Unknown:
    """An expression as a condition.

    Raises:
        SourceError: it is neither true nor false.
    """
    value = evaluate(run, expression, scope)
    if isinstance(value, bool | Unknown):
        used_as(run, expression, value, "truth")
        return value
    try:
        return truth(value)
    except ValueFault as fault:
        raise run.texts.stop_at(fault, expression) from None


def plain(run: Evaluation, expression: tree.Expression, scope: Scope) -> Value:
    """The value of an expression, in which inverse kinematics has its numbers."""
    value = evaluate(run, expression, scope)
    return run.joints(value) if isinstance(value, PendingInverse) else value


def no_member(run: Evaluation, member: tree.Member, value: Value) -> SourceError:
    """The error that a value has no such part."""
    parts = f", which has {', '.join(value.names)}" if isinstance(value, Struct) else ""
    return run.texts.error_at(
        f"there is no part '{member.name}' in {describe(value)}{parts}", member
    )


# -------------------------------------------------------------------------- names


def _read(run: Evaluation, expression: tree.Name | tree.Index | tree.Call, scope: Scope) -> Value:
    """A value that an expression computes with."""
    found = locate(run, expression, scope)
    if found.sources:
        run.literals.consume(found.sources)
    return found.value


def _locate_name(run: Evaluation, name: tree.Name, scope: Scope) -> Located:
    cell = scope.find(name.text)
    if cell is None:
        return Located(_undeclared(run, name))
    if cell.writer is not None:
        return Located(_open(run, name, f"'{name.text}', which thread {cell.writer} writes"))
    if cell.supposed:
        run.course.suppose(cell.supposed)
    value = cell.value
    if isinstance(value, Unknown):
        answer = run.course.value(name.text)
        return Located(value if answer is None else answered(answer))
    return Located(value, cell.sources, name.text if cell.sources else None)


def _undeclared(run: Evaluation, name: tree.Name) -> Value:
    if name.text in _WRITTEN:
        return _WRITTEN[name.text]
    reason = f"'{name.text}', which the program does not declare (an installation variable?)"
    return _open(run, name, reason)


def _open(run: Evaluation, name: tree.Name, reason: str) -> Value:
    answer = run.course.value(name.text, About(run.texts.span_of(name), QuestionKind.DATUM))
    if answer is None:
        return Unknown(reason, run.texts.span_of(name), key=name.text)
    return answered(answer)


def _locate_index(run: Evaluation, index: tree.Index, scope: Scope) -> Located:
    base = locate(run, index.base, scope)
    value = base.value
    places: list[int] = []
    try:
        for expression in index.indices:
            place = plain(run, expression, scope)
            if isinstance(value, PendingInverse):
                value = run.joints(value)
            if isinstance(value, Unknown):
                run.literals.consume(base.sources)
                return Located(_unknown_element(run, value, place, len(index.indices)))
            if isinstance(place, Unknown):
                run.literals.consume(base.sources)
                return Located(place)
            value = element(value, place)
            places.append(whole(place))
    except ValueFault as fault:
        raise run.texts.stop_at(fault, index) from None
    if len(places) != 1 or not isinstance(base.value, tuple) or not base.sources:
        run.literals.consume(base.sources)
        return Located(value)
    source = element_source(base.sources, len(base.value), places[0])
    return Located(value, () if source is None else (source,))


def _unknown_element(run: Evaluation, value: Unknown, place: Value, depth: int) -> Unknown:
    """What stands ``depth`` indices deep, the first of which is ``place``, in what is not known."""
    if value.key and not value.depth and type(place) is int:
        run.course.element_read(value.key, place + 1)
    return replace(value, depth=value.depth + depth)


def _member(run: Evaluation, member: tree.Member, scope: Scope) -> Value:
    value = evaluate(run, member.base, scope)
    if isinstance(value, Unknown):
        return value
    if not isinstance(value, Struct) or member.name not in value.names:
        raise no_member(run, member, value)
    return value.get(member.name)


# ---------------------------------------------------------- lists, calls, operators


def _constant(
    run: Evaluation, node: tree.Number | tree.Text | tree.Constant, scope: Scope
) -> Value:
    return node.value


def _locate_literal(
    run: Evaluation, expression: tree.Number | tree.Numbers, scope: Scope
) -> Located:
    return Located(evaluate(run, expression, scope), (run.literals.literal(expression),))


def _aggregate(run: Evaluation, aggregate: tree.Aggregate, scope: Scope) -> Value:
    values = [plain(run, item, scope) for item in aggregate.items]
    return _listed(run, aggregate, tuple(values))


def _locate_aggregate(run: Evaluation, aggregate: tree.Aggregate, scope: Scope) -> Located:
    found = [locate(run, item, scope) for item in aggregate.items]
    values = [
        run.joints(f.value) if isinstance(f.value, PendingInverse) else f.value for f in found
    ]
    sources: list[Literal | None] = []
    for item in found:
        single = item.sources[0] if len(item.sources) == 1 else None
        if single is None:
            run.literals.consume(item.sources)
        sources.append(single)
    value = _listed(run, aggregate, tuple(values))
    return Located(value, tuple(sources) if any(sources) else ())


def _listed(
    run: Evaluation, node: tree.Numbers | tree.Aggregate, values: tuple[Value, ...]
) -> Value:
    if node.pose:
        if len(values) != _POSE:
            raise run.texts.error_at(
                f"a pose has six numbers, p[x, y, z, rx, ry, rz], not {len(values)}", node
            )
        if isinstance(node, tree.Aggregate):
            for item, value in zip(node.items, values, strict=True):
                used_as(run, item, value, "number")
        return UrPose(*values)
    try:
        return checked(values)
    except ValueFault as fault:
        raise run.texts.stop_at(fault, node) from None


def _unary(run: Evaluation, unary: tree.Unary, scope: Scope) -> Value:
    try:
        return negate(unary.operator, plain(run, unary.operand, scope))
    except ValueFault as fault:
        raise run.texts.stop_at(fault, unary) from None


def _operation(run: Evaluation, operation: tree.Operation, scope: Scope) -> Value:
    value = plain(run, operation.first, scope)
    for symbol, operand in operation.rest:
        if _decided(symbol, value):
            continue  # controllers need not look at the rest either
        right = plain(run, operand, scope)
        if isinstance(value, Unknown) or isinstance(right, Unknown):
            _operated(run, operation.first, value, symbol, right)
            _operated(run, operand, right, symbol, value)
        try:
            value = apply(symbol, value, right)
        except ValueFault as fault:
            raise run.texts.stop_at(fault, operation) from None
        if isinstance(value, tuple):
            run.work(len(value), run.texts.span_of(operation))
    return value


_LOGICAL = frozenset({"and", "or", "xor"})
_KINDS = {bool: "truth", str: "text", int: "number", float: "number", UrPose: "pose"}


def _operated(
    run: Evaluation, expression: tree.Expression, value: Value, symbol: str, other: Value
) -> None:
    """What is not known is of the kind of what it is compared or computed with."""
    kind = "truth" if symbol in _LOGICAL else _KINDS.get(type(other))
    if isinstance(value, Unknown) and kind is not None:
        used_as(run, expression, value, kind)
        if symbol in COMPARING and value.key and not value.depth:
            if isinstance(other, bool | str):
                run.course.compared(value.key, other)
            elif isinstance(other, int | float):
                run.course.compared(value.key, float(other))


def _decided(symbol: str, left: Value) -> bool:
    return (symbol == "and" and left is False) or (symbol == "or" and left is True)


_EVALUATORS: dict[type, Callable[[Evaluation, Any, Scope], Value]] = {
    tree.Number: _constant,
    tree.Text: _constant,
    tree.Constant: _constant,
    tree.Numbers: lambda run, node, scope: _listed(run, node, node.values),
    tree.Aggregate: _aggregate,
    tree.Name: _read,
    tree.Index: _read,
    tree.Member: _member,
    tree.Call: _read,
    tree.MethodCall: lambda run, call, scope: run.method(call, scope),
    tree.StartThread: lambda run, start, scope: run.start_thread(start, scope),
    tree.Unary: _unary,
    tree.Operation: _operation,
}
_LOCATORS: dict[type, Callable[[Evaluation, Any, Scope], Located]] = {
    tree.Number: _locate_literal,
    tree.Numbers: _locate_literal,
    tree.Name: _locate_name,
    tree.Aggregate: _locate_aggregate,
    tree.Index: _locate_index,
    tree.Call: lambda run, call, scope: run.call(call, scope),
}
