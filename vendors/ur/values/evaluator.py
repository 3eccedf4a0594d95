"""Expressions → values, and assignments."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ....core.errors import SourceError, Span
from ....core.source.execution.answers import Answer, Course
from ....core.source.execution.provenance import ELSEWHERE, Reads
from ..syntax.texts import Texts
from ..syntax.tree import (
    Aggregate,
    Call,
    Constant,
    Expression,
    Index,
    Member,
    MethodCall,
    Name,
    Number,
    Numbers,
    Operation,
    Run,
    Text,
    Unary,
)
from .elements import element, whole
from .located import Host, Located
from .operators import apply, negate, truth
from .provenance import Literal, Sources, element_source, literal
from .scope import Scope
from .values import Solution, Struct, Unknown, UrPose, Value, ValueFault, checked, describe

_POSE = 6
_WRITTEN = {"pi": math.pi, "true": True, "false": False}
"""Names that stand for a value where no variable has them."""


class Evaluator:
    """Evaluates expressions in a scope.

    Args:
        texts: where places are looked up.
        course: answers for what the text leaves open.
        host: carries out calls.
    """

    def __init__(self, texts: Texts, course: Course, host: Host) -> None:
        self.texts = texts
        self.reads = Reads()
        self.reader = ELSEWHERE
        self._course = course
        self._host = host
        self._literals: dict[int, Literal | None] = {}
        self._by_type: dict[type, Callable[[Any, Scope], Value]] = {
            Number: _constant,
            Text: _constant,
            Constant: _constant,
            Numbers: self._numbers,
            Aggregate: self._aggregate,
            Name: self._read,
            Index: self._read,
            Member: self._member,
            Call: self._read,
            MethodCall: host.method,
            Run: host.start_thread,
            Unary: self._unary,
            Operation: self._operation,
        }
        self._locators: dict[type, Callable[[Any, Scope], Located]] = {
            Number: self._locate_literal,
            Numbers: self._locate_literal,
            Name: self._locate_name,
            Aggregate: self._locate_aggregate,
            Index: self._locate_index,
            Call: host.call,
        }

    # ------------------------------------------------------------------ values

    def evaluate(self, expression: Expression, scope: Scope) -> Value:
        """The value of an expression; `Unknown` where only the controller has it.

        Raises:
            SourceError: it has none.
        """
        return self._by_type[type(expression)](expression, scope)

    def locate(self, expression: Expression, scope: Scope) -> Located:
        """A value that is taken as it stands, with its sources.

        Unlike `evaluate` this does not count as a read by an expression: the caller tells
        `reads` what it does with the value.
        """
        locate = self._locators.get(type(expression))
        if locate is None:
            return Located(self.evaluate(expression, scope))
        return locate(expression, scope)

    def condition(self, expression: Expression, scope: Scope) -> bool | Unknown:
        """An expression as a condition.

        Raises:
            SourceError: it is neither true nor false.
        """
        value = self.evaluate(expression, scope)
        if isinstance(value, bool | Unknown):
            return value
        try:
            return truth(value)
        except ValueFault as fault:
            raise self.fault(fault, expression) from None

    def plain(self, expression: Expression, scope: Scope) -> Value:
        """The value of an expression, in which inverse kinematics has its numbers."""
        value = self.evaluate(expression, scope)
        return self._host.joints(value) if isinstance(value, Solution) else value

    def consume(self, sources: Sources) -> None:
        """An expression computes with values that have sources."""
        for source in sources:
            if source is not None:
                self.reads.by_expression(source, self.reader)

    def span(self, node: Expression) -> Span:
        """Where an expression stands."""
        return self.texts.span(node.start, node.end)

    def fault(self, fault: ValueFault, node: Expression, what: str = "") -> SourceError:
        """The error of values that do not go together, with its place."""
        return SourceError(f"{what}{fault}", self.span(node))

    # ------------------------------------------------------------------- names

    def _read(self, expression: Name | Index | Call, scope: Scope) -> Value:
        """A value that an expression computes with."""
        found = self.locate(expression, scope)
        if found.sources:
            self.consume(found.sources)
        return found.value

    def _locate_name(self, name: Name, scope: Scope) -> Located:
        cell = scope.find(name.text)
        if cell is None:
            return Located(self._undeclared(name))
        if cell.writer is not None:
            return Located(self._open(name, f"'{name.text}', which thread {cell.writer} writes"))
        value = cell.value
        if isinstance(value, Unknown):
            answer = self._course.value(name.text)
            return Located(value if answer is None else answered(answer))
        return Located(value, cell.sources, name.text if cell.sources else None)

    def _undeclared(self, name: Name) -> Value:
        if name.text in _WRITTEN:
            return _WRITTEN[name.text]
        return self._open(
            name, f"'{name.text}', which the program does not declare (an installation variable?)"
        )

    def _open(self, name: Name, reason: str) -> Value:
        answer = self._course.value(name.text)
        return Unknown(reason, self.span(name)) if answer is None else answered(answer)

    def _locate_index(self, index: Index, scope: Scope) -> Located:
        base = self.locate(index.base, scope)
        value = base.value
        places: list[int] = []
        try:
            for expression in index.indices:
                place = self.plain(expression, scope)
                if isinstance(value, Solution):
                    value = self._host.joints(value)
                if isinstance(place, Unknown) or isinstance(value, Unknown):
                    self.consume(base.sources)
                    return Located(value if isinstance(value, Unknown) else place)
                value = element(value, place)
                places.append(whole(place))
        except ValueFault as fault:
            raise self.fault(fault, index) from None
        if len(places) != 1 or not isinstance(base.value, tuple) or not base.sources:
            self.consume(base.sources)
            return Located(value)
        source = element_source(base.sources, len(base.value), places[0])
        return Located(value, () if source is None else (source,))

    def _member(self, member: Member, scope: Scope) -> Value:
        value = self.evaluate(member.base, scope)
        if isinstance(value, Unknown):
            return value
        if not isinstance(value, Struct) or member.name not in value.names:
            raise self.no_member(member, value)
        return value.get(member.name)

    def no_member(self, member: Member, value: Value) -> SourceError:
        """The error that a value has no such part."""
        parts = f", which has {', '.join(value.names)}" if isinstance(value, Struct) else ""
        return SourceError(
            f"there is no part '{member.name}' in {describe(value)}{parts}", self.span(member)
        )

    # -------------------------------------------------------------- lists, operators

    def _locate_literal(self, expression: Number | Numbers, scope: Scope) -> Located:
        return Located(self.evaluate(expression, scope), (self._literal(expression),))

    def _literal(self, expression: Expression) -> Literal | None:
        key = expression.start
        if key not in self._literals:
            self._literals[key] = literal(expression, self.texts)
        return self._literals[key]

    def _numbers(self, expression: Numbers, scope: Scope) -> Value:
        return self._listed(expression, expression.values)

    def _aggregate(self, aggregate: Aggregate, scope: Scope) -> Value:
        return self._listed(aggregate, tuple([self.plain(e, scope) for e in aggregate.items]))

    def _locate_aggregate(self, aggregate: Aggregate, scope: Scope) -> Located:
        found = [self.locate(item, scope) for item in aggregate.items]
        values = [
            self._host.joints(f.value) if isinstance(f.value, Solution) else f.value for f in found
        ]
        sources: list[Literal | None] = []
        for item in found:
            single = item.sources[0] if len(item.sources) == 1 else None
            if single is None:
                self.consume(item.sources)
            sources.append(single)
        value = self._listed(aggregate, tuple(values))
        return Located(value, tuple(sources) if any(sources) else ())

    def _listed(self, node: Numbers | Aggregate, values: tuple[Value, ...]) -> Value:
        if node.pose:
            if len(values) != _POSE:
                raise SourceError(
                    f"a pose has six numbers, p[x, y, z, rx, ry, rz], not {len(values)}",
                    self.span(node),
                )
            return UrPose(*values)
        try:
            return checked(values)
        except ValueFault as fault:
            raise self.fault(fault, node) from None

    def _unary(self, unary: Unary, scope: Scope) -> Value:
        try:
            return negate(unary.operator, self.plain(unary.operand, scope))
        except ValueFault as fault:
            raise self.fault(fault, unary) from None

    def _operation(self, operation: Operation, scope: Scope) -> Value:
        value = self.plain(operation.first, scope)
        for symbol, operand in operation.rest:
            if _decided(symbol, value):
                continue  # controllers need not look at the rest either
            right = self.plain(operand, scope)
            try:
                value = apply(symbol, value, right)
            except ValueFault as fault:
                raise self.fault(fault, operation) from None
            if isinstance(value, tuple):
                self._host.work(len(value), self.span(operation))
        return value


def _constant(node: Number | Text | Constant, scope: Scope) -> Value:
    return node.value


def _decided(symbol: str, left: Value) -> bool:
    return (symbol == "and" and left is False) or (symbol == "or" and left is True)


def answered(answer: Answer) -> Value:
    """A user's answer as a value; ``"p[…]"`` is a pose."""
    if isinstance(answer, tuple):
        return tuple([answered(part) for part in answer])
    if isinstance(answer, float) and answer.is_integer() and abs(answer) < 2**53:
        return int(answer)
    if isinstance(answer, str) and answer.startswith("p[") and answer.endswith("]"):
        try:
            return UrPose(*[float(part) for part in answer[2:-1].split(",")])
        except (ValueError, TypeError):
            return answer
    return answer
