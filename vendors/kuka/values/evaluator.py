"""Expressions → values, and assignments."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from ....core.door import spelt
from ....core.errors import LeftOpenError, SourceError, Span
from ....core.program.question import QuestionKind
from ....core.source.execution.course import About, Course
from ....core.source.execution.provenance import ELSEWHERE, Reads
from ....core.source.execution.scopes import unknown_name
from ....core.source.text.operators import COMPARING
from ..syntax import tree
from .advance_run import AdvanceRun
from .answers import answered
from .assignments import Assignment
from .data import Data
from .elements import Names, Position
from .expected import EXPECTED
from .functions import COMPUTED, computed
from .literals import flat_literal, number_literal, numeral
from .operators import OperandError, apply, negate
from .provenance import LeafSource
from .scope import Scope
from .values import (
    Choice,
    Leaf,
    Root,
    Struct,
    Unknown,
    Value,
    copied,
    find_unknown,
    leaf_of,
    leaves_in,
    left_open,
    shown,
    supposed,
)

CallFunction = Callable[[tree.Call, Scope], Value | None]


class Evaluator:
    """Evaluates expressions in a scope.

    Args:
        call: the value of a function of the program or of the inline forms; None if there is none
            of that name.
        position: where the robot is: ``pose`` or ``axes``.
        advance: is stopped by reading some system variables.
    """

    def __init__(
        self,
        data: Data,
        course: Course,
        call: CallFunction,
        position: Position,
        advance: AdvanceRun,
    ) -> None:
        self.data = data
        self.course = course
        self.reads = Reads()
        self.reader = ELSEWHERE
        self._call = call
        self.names = Names(self, data, course, position, advance)
        self.assign = Assignment(data, self.names).assign
        self._evaluate: dict[type, Callable[..., Value]] = {
            tree.Flat: lambda node, scope, datum: flat_literal(node, datum),
            tree.Aggregate: self._aggregate,
            tree.Operation: self._operation,
            tree.Unary: self._unary,
            tree.Call: self._function,
            tree.Ambiguous: self._ambiguous,
        }

    # ------------------------------------------------------------------- expressions

    def evaluate(
        self, expression: tree.Expression, scope: Scope, datum: str | None = None
    ) -> Value:
        """The value of an expression.

        Args:
            datum: the datum that a literal becomes the value of.

        Raises:
            SourceError: it has none.
        """
        if isinstance(expression, tree.Name):
            return self.names.value(expression, scope)
        if isinstance(expression, tree.Number):
            return number_literal(expression, datum)
        if isinstance(expression, tree.Truth | tree.Text):
            return expression.value
        if isinstance(expression, tree.Constant):
            return Choice(expression.name)
        return self._evaluate[type(expression)](expression, scope, datum)

    def known(self, expression: tree.Expression, scope: Scope, use: str) -> Value:
        """A value that something depends on.

        Raises:
            SourceError: only the running controller knows it; ``use`` says what needs it.
        """
        value = self.evaluate(expression, scope)
        if find_unknown(value) is not None:
            self.check_known(value, use, expression.span)
        return value

    def check_known(self, value: Value, use: str, span: Span) -> None:
        """Refuse a value that is not known.

        Raises:
            SourceError: it is not.
        """
        unknown = find_unknown(value)
        if unknown is not None:
            raise left_open(use, unknown, span)

    def used_as(self, value: Value | None, type_name: str) -> None:
        """What nobody has set is used as a value of a type: so it is asked for."""
        if isinstance(value, Unknown) and value.key:
            self.course.used_as(value.key, *EXPECTED[type_name])

    def number(self, expression: tree.Expression, scope: Scope, use: str) -> float:
        """A known number.

        Raises:
            SourceError: it is none.
        """
        if isinstance(expression, tree.Name):
            self.used_as(self.names.value(expression, scope), "real")
        value = self.known(expression, scope, use)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SourceError(f"{use} is a number, not {shown(value)}", expression.span)
        return value

    def _aggregate(self, node: tree.Aggregate, scope: Scope, datum: str | None) -> Value:
        """An aggregate with structures or expressions in it; its numbers belong to one literal."""
        root = Root(node.source, node.start, node.end, datum)
        return self._nested(node, scope, root, "")

    def _nested(self, node: tree.Aggregate, scope: Scope, root: Root, prefix: str) -> Struct:
        made: dict[str, Value] = {}
        for name, item in node.items:
            component = f"{prefix}{name}"
            if isinstance(item, tree.Number):
                root.leaves[component] = (item.start, item.end)
                made[name] = numeral(item.value, Leaf(root, component))
            elif isinstance(item, tree.Flat):
                made[name] = flat_literal(item, None, root, f"{component}.")
            elif isinstance(item, tree.Aggregate):
                made[name] = self._nested(item, scope, root, f"{component}.")
            else:
                made[name] = copied(self.evaluate(item, scope))
        return Struct(node.type or "", made)

    def _operation(self, operation: tree.Operation, scope: Scope, _: str | None) -> Value:
        value, node = self._operand(operation.first, scope), operation.first
        for symbol, operand in operation.rest:
            right = self._operand(operand, scope)
            self.used(symbol, node, value, right)
            self.used(symbol, operand, right, value)
            node = operation
            try:
                value = apply(symbol, value, right)
            except OperandError as error:
                raise error.at(operation.span) from None
        return value

    def used(self, symbol: str, node: tree.Expression, value: Value, other: Value) -> None:
        """What an operator says of the type of a datum that nobody has set."""
        if not isinstance(node, tree.Name | tree.Call) or not isinstance(value, Unknown):
            return
        if symbol in ("and", "or", "exor") or isinstance(other, bool):
            self.used_as(value, "bool")
        elif symbol == ":":
            self.used_as(value, "frame")
        elif isinstance(other, Choice):
            shown_as = f"#{other.name.upper()}"
            self.course.used_as(value.key, f"a constant, as {shown_as}", shown_as)
        elif isinstance(other, int | float):
            self.used_as(value, "real" if isinstance(other, float) else "int")
        if symbol in COMPARING and not (isinstance(node, tree.Name) and _is_part(node, value)):
            self._compared(value, other)

    def _compared(self, value: Value, other: Value) -> None:
        """What was asked is compared with a value."""
        if not isinstance(value, Unknown) or not value.key:
            return
        if isinstance(other, Choice):
            self.course.compared(value.key, f"#{other.name.upper()}")
        elif isinstance(other, bool | str):
            self.course.compared(value.key, other)
        elif isinstance(other, int | float):
            self.course.compared(value.key, float(other))

    def _operand(self, expression: tree.Expression, scope: Scope) -> Value:
        """A value that is computed with: the literal it came from is read by an expression."""
        if isinstance(expression, tree.Number):
            return expression.value
        value = self.evaluate(expression, scope)
        self.note_reads(value)
        return value

    def note_reads(self, value: Value) -> None:
        """An expression computes with a value."""
        if isinstance(value, Struct):
            for _, inner in leaves_in(value):
                self.reads.by_expression(LeafSource(inner), self.reader)
            return
        leaf = leaf_of(value)
        if leaf is not None:
            self.reads.by_expression(LeafSource(leaf), self.reader)

    def _unary(self, node: tree.Unary, scope: Scope, _: str | None) -> Value:
        operand = self._operand(node.operand, scope)
        if isinstance(node.operand, tree.Name):
            self.used_as(operand, "bool" if node.operator == "not" else "real")
        try:
            return negate(node.operator, operand)
        except OperandError as error:
            raise error.at(node.span) from None

    def _ambiguous(self, node: tree.Ambiguous, scope: Scope, _: str | None) -> Value:
        try:
            return self.evaluate(node.manual, scope)
        except SourceError:
            return self.evaluate(node.usual, scope)

    # --------------------------------------------------------------------- functions

    def _function(self, call: tree.Call, scope: Scope, _: str | None) -> Value:
        value = self._call(call, scope)
        if value is not None:
            return value
        if call.name in COMPUTED:
            arguments = [self._operand(a, scope) for a in call.arguments if a is not None]
            unknown = next(filter(None, map(find_unknown, arguments)), None)
            if unknown is not None:
                if call.name == "strcomp":
                    self._compared(*arguments[:2])
                    self._compared(*arguments[1::-1])
                return replace(unknown, here=None, held=self._held(call.name, arguments))
            try:
                return computed(call.name, arguments)
            except OperandError as error:
                raise error.at(call.span, f"{call.text}: ") from None
        return self.unknown_function(call, scope)

    @staticmethod
    def _held(name: str, arguments: list[Value]) -> Value | None:
        """What motion takes the value of a function for."""
        known = [supposed(argument) for argument in arguments]
        if any(find_unknown(argument) is not None for argument in known):
            return None
        try:
            return computed(name, known)
        except OperandError:
            return None

    def unknown_function(self, call: tree.Call, scope: Scope) -> Value:
        """What a function gives that is not at hand: an answer, or a value that is not known."""
        about = About(call.span, brought_by(call.name))
        text = self.data.text(call.span)
        answer = self.course.value(text, about)
        if answer is not None:
            return answered(answer)
        return Unknown(f"the value of {call.text}()", call.span, key=text)

    def undeclared(self, node: tree.Name, scope: Scope, kind: str) -> LeftOpenError:
        """The error that a datum is declared nowhere."""
        known = self.data.names(scope)
        offer = (
            "declare it, name the .dat that does (the program's own, or $config.dat), or say it in "
            f"a file ({spelt('answers')}; `flyby ask` writes one)"
        )
        keeper = self.data.library.keeper_of(node.name)
        if keeper is not None:
            offer = (
                f"{keeper} declares it for its own program alone; write PUBLIC behind its DEFDAT "
                f"and GLOBAL before the declaration, or {offer}"
            )
        return LeftOpenError(unknown_name(kind, node.text, known, offer), node.span)


def _is_part(node: tree.Name, value: Unknown) -> bool:
    """Whether a component is read of what is asked as a whole."""
    last = node.path[-1] if node.path else None
    return isinstance(last, str) and not value.key.lower().endswith(f".{last}")


def brought_by(name: str) -> QuestionKind:
    """What a function brings that is not at hand, by its name in lower case."""
    if re.match(r"krl_f|c(read|open|write)|eki_|eth|xml|sread", name):
        return QuestionKind.CHANNEL
    if re.match(r"msg|dialog|exists_krl|get_?msg", name):
        return QuestionKind.OPERATOR
    if re.match(r"rsi|sensor|ts_|touch|search|mess", name):
        return QuestionKind.SENSOR
    return QuestionKind.DATUM
