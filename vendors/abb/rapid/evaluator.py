"""Expressions → values, and assignments."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ....core.errors import SourceError, Span
from ....core.source.provenance import ELSEWHERE, Reads
from .elements import array_mismatch, check_index, component, default_value, item, replaced
from .functions import COMPUTED, STATE, euler_zyx
from .operators import OperandError, apply, is_vector, negate
from .provenance import Literal, source_of_literal
from .scope import Cell, Scope, unknown_name
from .syntax import (
    Aggregate,
    Argument,
    Call,
    Declaration,
    Expression,
    Name,
    Number,
    Operation,
    Routine,
    Star,
    Text,
    Truth,
    Unary,
)
from .types import NUM, Foreign, Type, Unknown, Value, find_unknown, interpreted, mismatch

CallFunction = Callable[[Routine, Call, Scope], Value]


@dataclass(frozen=True, slots=True)
class Located:
    """A value together with the place of the text that it was read from.

    Args:
        cell: the datum, None if the expression is no plain datum.
        predefined: name of the controller's own datum that the value is.
    """

    value: Value
    source: Literal | None
    cell: Cell | None
    predefined: str | None = None


class Evaluator:
    """Evaluates expressions in a scope.

    Args:
        types: data types by name.
        functions: the program's own functions by name.
        call: runs one of them.
    """

    def __init__(
        self, types: Mapping[str, Type], functions: Mapping[str, Routine], call: CallFunction
    ) -> None:
        self.types = types
        self.functions = functions
        self.reads = Reads()
        self.reader = ELSEWHERE
        self._checked: dict[int, tuple[Value, Type]] = {}
        self._call = call
        self._special: dict[str, Callable[[Call, Scope], Value]] = {
            "present": _present,
            "dim": self._dim,
            "eulerzyx": self._euler,
        }

    # ------------------------------------------------------------------ values

    def evaluate(self, expression: Expression, scope: Scope) -> Value:
        """The value of an expression; `Unknown` where only the controller has it.

        Raises:
            SourceError: it has none.
        """
        if isinstance(expression, Number | Text | Truth):
            return expression.value
        if isinstance(expression, Name):
            return self._read_name(expression, scope)
        if isinstance(expression, Aggregate):
            return tuple(self.evaluate(item, scope) for item in expression.items)
        if isinstance(expression, Operation):
            return self._operation(expression, scope)
        if isinstance(expression, Unary):
            operand = self.evaluate(expression.operand, scope)
            try:
                return negate(expression.operator, operand)
            except OperandError as error:
                raise SourceError(str(error), expression.span) from None
        if isinstance(expression, Call):
            return self._function(expression, scope)
        return _star(expression)

    def locate(self, expression: Expression, scope: Scope) -> Located:
        """A value that a move takes as it stands, with its source.

        Unlike `evaluate` this does not count as a read by an expression: the caller tells
        `reads` what it does with the value.
        """
        if isinstance(expression, Name):
            return self._locate_name(expression, scope)
        value = self.evaluate(expression, scope)
        return Located(value, source_of_literal(expression, None), None)

    def known(self, expression: Expression, scope: Scope, type_: Type, use: str) -> Value:
        """A value that must be known and of a type.

        Args:
            use: what depends on it, to stand at the beginning of a message.

        Raises:
            SourceError: it is not.
        """
        value = self.evaluate(expression, scope)
        self.check(value, type_, use, expression.span)
        return value

    def check(self, value: Value, type_: Type, use: str, span: Span) -> None:
        """Raises:
        SourceError: a value is not known, or not of a type.
        """
        unknown = find_unknown(value)
        if unknown is not None:
            raise SourceError(
                f"{use} depends on {unknown.reason}: what only the running controller knows "
                "cannot be followed; put a fixed value in its place",
                span,
            )
        wrong = mismatch(value, type_)
        if wrong is not None:
            raise SourceError(f"{use}: {wrong}", span)

    def check_located(self, found: Located, type_: Type, use: str, span: Span) -> None:
        """`check`, once for each value of a datum: moves read few data many times."""
        known = self._checked.get(id(found.value))
        if known is not None and known[0] is found.value and known[1] is type_:
            return
        self.check(found.value, type_, use, span)
        if found.cell is not None:
            self._checked[id(found.value)] = (found.value, type_)

    def number(self, expression: Expression, scope: Scope, use: str) -> float:
        """A known num."""
        value = self.known(expression, scope, NUM, use)
        assert isinstance(value, float)
        return value

    # -------------------------------------------------------------------- data

    def declare(self, declaration: Declaration, scope: Scope) -> Cell:
        """A new cell; its value is evaluated when it is first read."""
        type_ = self.types.get(declaration.type, Foreign(declaration.type))
        cell = Cell(
            declaration.text,
            type_,
            constant=declaration.kind == "const",
            pending=declaration,
            scope=scope,
        )
        scope.cells[declaration.name] = cell
        return cell

    def settle(self, cell: Cell) -> Value:
        """The value of a cell, evaluated now if it was not yet."""
        declaration, scope = cell.pending, cell.scope
        if declaration is None:
            assert cell.value is not None
            return cell.value
        if scope is None:
            raise SourceError(f"the value of {cell.name} depends on itself", declaration.span)
        cell.scope = None  # while it is evaluated
        sizes = tuple(self._size(d, scope) for d in declaration.dimensions)
        cell.dimensions = sizes
        cell.value, cell.source, cell.predefined = self._initial(
            declaration, cell.type, sizes, scope
        )
        cell.pending = None
        return cell.value

    def _size(self, expression: Expression, scope: Scope) -> int:
        size = self.number(expression, scope, "the size of an array")
        if size < 1 or size != int(size):
            raise SourceError(f"an array has one element or more, not {size:g}", expression.span)
        return int(size)

    def _initial(
        self, declaration: Declaration, type_: Type, sizes: tuple[int, ...], scope: Scope
    ) -> tuple[Value, Literal | None, str | None]:
        if isinstance(type_, Foreign):
            reason = f"'{declaration.text}', a {type_.name}"
            return Unknown(reason, declaration.span), None, None
        if declaration.value is None:
            return default_value(declaration, type_, sizes), None, None
        found = self.locate(declaration.value, scope)
        value = found.value
        wrong = array_mismatch(value, type_, sizes)
        if wrong is not None:
            raise SourceError(f"{declaration.text}: {wrong}", declaration.value.span)
        source = found.source
        if source is not None and source.datum is None:
            source = Literal(source.expression, source.root, declaration.text)
        return value, source, found.predefined

    def assign(self, target: Name, value: Value, scope: Scope) -> None:
        """``target := value``

        Raises:
            SourceError: the target is not declared, constant, or of another type.
        """
        cell = scope.find(target.name)
        if cell is None:
            raise SourceError(unknown_name("datum", target.text, scope.names()), target.span)
        if cell.constant:
            raise SourceError(f"{cell.name} is a constant and cannot be assigned", target.span)
        old = self.settle(cell)
        path = self._path(target, scope)
        if not path:
            wrong = array_mismatch(value, cell.type, cell.dimensions)
            if wrong is not None:
                raise SourceError(f"{target.text}: {wrong}", target.span)
            cell.value = interpreted(value, cell.type, target.span)
            cell.source, cell.predefined = None, None
            return
        cell.value = replaced(old, cell, path, value, target)
        cell.predefined = None
        first = path[0]
        if isinstance(first, tuple):
            cell.overwritten.add(first)
        else:
            cell.source = None

    # ------------------------------------------------------------------- names

    def _read_name(self, name: Name, scope: Scope) -> Value:
        found = self._locate_name(name, scope)
        if found.source is not None:
            self.reads.by_expression(found.source, self.reader)
        return found.value

    def _locate_name(self, name: Name, scope: Scope) -> Located:
        cell = scope.find(name.name)
        if cell is None:
            reason = f"'{name.text}', which is not declared in this module (a signal?)"
            return Located(Unknown(reason, name.span), None, None)
        if not cell.present:
            raise SourceError(f"the optional argument {cell.name} was not given", name.span)
        value = self.settle(cell)
        if not name.path:
            source = None if cell.overwritten else cell.source
            return Located(value, source, cell, cell.predefined)
        path = self._path(name, scope)
        source = None if path[0] in cell.overwritten else cell.source
        type_: Type = cell.type
        dimensions = cell.dimensions
        for step in path:
            if isinstance(step, tuple):
                check_index(step, dimensions, name)
                dimensions = ()
                label = "{" + ",".join(str(i) for i in step) + "}"
                for place, index in enumerate(step):
                    value = item(value, index - 1)
                    shown = label if place == len(step) - 1 else ""
                    source = source.part(index - 1, shown) if source else None
            else:
                position, type_ = component(step, type_, dimensions, name)
                value = item(value, position)
                source = source.part(position, f".{step}") if source else None
        return Located(value, source, cell)

    def _path(self, name: Name, scope: Scope) -> list[str | tuple[int, ...]]:
        return [
            step if isinstance(step, str) else tuple(self._index(e, scope) for e in step)
            for step in name.path
        ]

    def _index(self, expression: Expression, scope: Scope) -> int:
        index = self.number(expression, scope, "an index")
        if index != int(index):
            raise SourceError(f"an index is a whole number, not {index:g}", expression.span)
        return int(index)

    # -------------------------------------------------- operators and functions

    def _operation(self, operation: Operation, scope: Scope) -> Value:
        value = self.evaluate(operation.first, scope)
        for symbol, operand in operation.rest:
            right = self.evaluate(operand, scope)
            try:
                value = apply(symbol, value, right)
            except OperandError as error:
                raise SourceError(str(error), operation.span) from None
        return value

    def _function(self, call: Call, scope: Scope) -> Value:
        own = self.functions.get(call.name)
        if own is not None:
            return self._call(own, call, scope)
        special = self._special.get(call.name)
        if special is not None:
            return special(call, scope)
        if call.name in COMPUTED:
            return self._computed(call, scope)
        if call.name in STATE:
            return Unknown(f"the value of {call.text}()", call.span)
        known = [routine.text for routine in self.functions.values()] + sorted(COMPUTED)
        raise SourceError(unknown_name("function", call.text, known), call.span)

    def _computed(self, call: Call, scope: Scope) -> Value:
        function, types, options = COMPUTED[call.name]
        required = [a.value for a in call.arguments if a.option is None and a.value is not None]
        if len(required) != len(types):
            raise SourceError(
                f"{call.text} takes {len(types)} arguments, not {len(required)}", call.span
            )
        given = {a.option: a.value for a in call.arguments if a.option is not None}
        for option in given:
            if option not in options:
                raise SourceError(f"{call.text}: \\{option} is not supported", call.span)
        values = [self.evaluate(e, scope) for e in required]
        for option in options:
            expression = given.get(option)
            values.append(0.0 if expression is None else self.evaluate(expression, scope))
        unknown = find_unknown(tuple(values))
        if unknown is not None:
            return unknown
        for value, type_ in zip(values, (*types, *[NUM] * len(options)), strict=True):
            wrong = mismatch(value, type_) if type_ is not None else None
            if wrong is not None:
                raise SourceError(f"{call.text}: {wrong}", call.span)
        try:
            return _checked(function(*values))
        except OperandError as error:
            raise SourceError(f"{call.text}: {error}", call.span) from None
        except (ValueError, ArithmeticError):
            raise SourceError(
                f"{call.text} has no finite value for these arguments", call.span
            ) from None

    def _dim(self, call: Call, scope: Scope) -> Value:
        """``Dim(array, n)``: size of the n-th dimension."""
        array = _only_name(call, 2)
        cell = scope.find(array.name)
        if cell is None:
            raise SourceError(unknown_name("array", array.text, scope.names()), array.span)
        self.settle(cell)
        which = call.arguments[1].value
        index = self._index(which, scope) if which is not None else 0
        if not 1 <= index <= len(cell.dimensions):
            raise SourceError(
                f"{cell.name} has {len(cell.dimensions)} dimensions, not {index}", call.span
            )
        return float(cell.dimensions[index - 1])

    def _euler(self, call: Call, scope: Scope) -> Value:
        """``EulerZYX(\\X, orient)``"""
        switches = [a.option for a in call.arguments if a.option is not None]
        required = [a.value for a in call.arguments if a.option is None and a.value is not None]
        if len(switches) != 1 or switches[0] not in ("x", "y", "z") or len(required) != 1:
            raise SourceError("EulerZYX takes \\X, \\Y or \\Z and an orient", call.span)
        value = self.evaluate(required[0], scope)
        unknown = find_unknown(value)
        if unknown is not None:
            return unknown
        if not is_vector(value, 4):
            raise SourceError("EulerZYX takes an orient", call.span)
        assert isinstance(value, tuple)
        try:
            return euler_zyx(switches[0], value)
        except OperandError as error:
            raise SourceError(f"EulerZYX: {error}", call.span) from None


def _present(call: Call, scope: Scope) -> Value:
    """``Present(parameter)``"""
    name = _only_name(call, 1)
    cell = scope.find(name.name)
    if cell is None:
        raise SourceError(unknown_name("parameter", name.text, scope.names()), name.span)
    return cell.present


def _only_name(call: Call, count: int) -> Name:
    arguments: tuple[Argument, ...] = call.arguments
    first = arguments[0].value if arguments else None
    if len(arguments) != count or not isinstance(first, Name) or first.path:
        raise SourceError(f"{call.text} takes a datum as its first argument", call.span)
    return first


def _star(star: Star) -> Value:
    raise SourceError(
        "the position of '*' is not in the text: write the robtarget out, or store it with a "
        "name, and read the program again",
        star.span,
    )


def _checked(value: Value) -> Value:
    if isinstance(value, float) and value - value != 0.0:
        raise OverflowError
    return float(value) if type(value) is int else value
