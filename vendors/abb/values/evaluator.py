"""Expressions → values."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ....core.errors import SourceError, Span
from ....core.source.execution.course import Course
from ....core.source.execution.provenance import ELSEWHERE
from ....core.source.text.operators import COMPARING
from ..syntax import tree
from .answers import like_signals
from .data import Globals
from .defaults import default_of, nominal
from .function_calls import SPECIAL, Special, function_value
from .located import Located
from .names import Host, Names
from .operators import OperandError, apply, negate, operand_type
from .predefined import RECORDS
from .provenance import source_of_literal
from .scope import Scope
from .types import (
    BOOL,
    NUM,
    SPEEDDATA,
    Type,
    Unknown,
    Value,
    answerable,
    check_known,
    check_type,
    describe,
    find_unknown,
    refuse_unknown,
)


class Evaluator(Names):
    """Evaluates expressions in a scope.

    Args:
        special: functions that ask the emulated robot, by lower-case name.
        signals: what signals are, by lower-case name, where a backup says so.

    Attributes:
        setting: whether what is evaluated says how the robot drives from here on: no default is
            taken for what is damaged.
    """

    def __init__(
        self,
        data: Globals,
        course: Course,
        text_of: Callable[[Span], str],
        host: Host,
        special: Mapping[str, Special],
        signals: Mapping[str, str],
    ) -> None:
        super().__init__(data, course, text_of, host, signals)
        self.setting = False
        self._assumed: dict[tuple[str, str], tuple[Span, str]] = {}  # where, and for what, first
        self._fixed: dict[int, Located] = {}
        self._checked: dict[int, tuple[Value, Type]] = {}
        self._special = {**SPECIAL, **special}

    # ------------------------------------------------------------------ values

    def evaluate(self, expression: tree.Expression, scope: Scope) -> Value:
        """The value of an expression; `Unknown` where only the controller has it.

        Raises:
            SourceError: it has none.
        """
        if isinstance(expression, tree.Number | tree.Packed | tree.Text | tree.Truth):
            return expression.value
        if isinstance(expression, tree.Name):
            return self._read_name(expression, scope)
        if isinstance(expression, tree.Aggregate):
            return tuple(self.evaluate(item, scope) for item in expression.items)
        if isinstance(expression, tree.Operation):
            return self._operation(expression, scope)
        if isinstance(expression, tree.Unary):
            operand = self.evaluate(expression.operand, scope)
            logical = expression.operator == "not"
            self.answers.used_as(expression.operand, operand, BOOL if logical else NUM)
            try:
                return negate(expression.operator, operand)
            except OperandError as error:
                raise error.at(expression.span) from None
        if isinstance(expression, tree.Call):
            return function_value(self, self._host.call_function, self._special, expression, scope)
        if isinstance(expression, tree.Unreadable):
            reason = f"what no controller takes (line {expression.span.line}: {expression.message})"
            return Unknown(reason, expression.span, lost=True)
        return _star(expression)

    def locate(self, expression: tree.Expression, scope: Scope, asking: bool = True) -> Located:
        """A value that a move takes as it stands, with its source.

        Unlike `evaluate` this does not count as a read by an expression: the caller tells
        `reads` what it does with the value.

        Args:
            asking: whether the user's answer is taken where a datum is not known.
        """
        if isinstance(expression, tree.Name):
            return self._locate_name(expression, scope, asking)
        value = self.evaluate(expression, scope)
        return Located(value, source_of_literal(expression, None), None)

    def known(self, expression: tree.Expression, scope: Scope, type_: Type, use: str) -> Value:
        """A value of a type; where it is not known, its default, with a note.

        Args:
            use: what depends on it, to stand at the beginning of a message.

        Raises:
            SourceError: it is none of the type, or not known and has no default.
        """
        value = self.assumed(self.evaluate(expression, scope), type_, use, expression.span)
        self.check(value, type_, use, expression.span)
        return value

    def assumed(self, value: Value, type_: Type, use: str, span: Span) -> Value:
        """A value with everything that is not known at its default.

        Raises:
            SourceError: there is none.
        """
        unknown = find_unknown(value)
        if unknown is None:
            return value
        taken = nominal(value, type_)
        if taken is None and unknown.lost and self.reader is ELSEWHERE and not self.setting:
            taken = default_of(type_)  # a wait, a message: nothing is driven by it
        if taken is None:
            raise refuse_unknown(unknown, use, span)
        if type_ is SPEEDDATA and isinstance(taken, tuple) and not taken[0] > 0:
            taken = RECORDS["speeddata"]["v1000"]
        shown = "its default" if isinstance(taken, tuple) else describe(taken)
        where, first = self._assumed.setdefault((unknown.reason, shown), (span, use))
        message = f"{first} depends on {unknown.reason}: {shown} is taken{answerable(unknown)}"
        self.answers.assumed(where, message)
        return taken

    def check_located(self, found: Located, type_: Type, use: str, span: Span) -> None:
        """`check`, once for each value of a datum: moves read few data many times."""
        if found.source is not None:  # a literal, all of it known
            if found.type is not type_:
                check_type(found.value, type_, use, span, found.type, self._text_of(span))
            return
        known = self._checked.get(id(found.value))
        if known is not None and known[0] is found.value and known[1] is type_:
            return
        check_known(found.value, use, span)
        check_type(found.value, type_, use, span, found.type, self._text_of(span))
        if found.cell is not None:
            self._checked[id(found.value)] = (found.value, type_)

    def fixed_value(self, name: tree.Name, type_: Type, scope: Scope) -> Located | None:
        """A constant that was found good for a use before: most moves read the same few."""
        cell = self.cell(name, scope)
        found = None if cell is None else self._fixed.get(id(cell))
        return found if found is not None and found.type is type_ else None

    def keep_fixed(self, found: Located) -> None:
        """Keep a value that is found good, if it is a constant."""
        if found.cell is not None and found.cell.constant:
            self._fixed[id(found.cell)] = found

    def number(self, expression: tree.Expression, scope: Scope, use: str) -> float:
        """A known num."""
        value = self.known(expression, scope, NUM, use)
        assert isinstance(value, float)
        return value

    def condition(self, expression: tree.Expression, scope: Scope) -> Value:
        """The value of an expression that is true or false, or not known."""
        value = self.evaluate(expression, scope)
        self.answers.used_as(expression, value, BOOL)
        return value

    def truth(self, value: Value, use: str, span: Span) -> bool:
        """A known bool."""
        if value is True or value is False:
            return value
        self.check(value, BOOL, use, span)
        raise AssertionError

    # -------------------------------------------------- operators and functions

    def _operation(self, operation: tree.Operation, scope: Scope) -> Value:
        value = self.evaluate(operation.first, scope)
        for symbol, operand in operation.rest:
            right = self.evaluate(operand, scope)
            if isinstance(value, Unknown) or isinstance(right, Unknown):
                self.answers.used_as(operation.first, value, operand_type(symbol, right))
                self.answers.used_as(operand, right, operand_type(symbol, value))
                if symbol in COMPARING:
                    self.answers.compared(value, right)
                    self.answers.compared(right, value)
            if symbol in ("=", "<>"):
                value, right = like_signals(value, right)
            try:
                value = apply(symbol, value, right)
            except OperandError as error:
                raise error.at(operation.span) from None
        return value


def _star(star: tree.Expression) -> Value:
    raise SourceError(
        "the position of '*' is not in the text: write the robtarget out, or store it with a "
        "name, and read the program again",
        star.span,
    )
