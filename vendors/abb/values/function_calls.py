"""Calls of functions: the program's own, RAPID's, and those that ask the running controller."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.source.execution.course import Course
from ....core.source.execution.outputs import Outputs
from ....core.source.text.files import SourceText
from ..syntax.cursor import Cursor
from ..syntax.expressions import parse_expression
from ..syntax.lexer import END, tokenize
from ..syntax.tree import Argument, Call, Expression, Name, Routine
from .answers import TypedAnswers, kind_brought_by
from .arguments import check_count
from .data import Globals
from .defaults import carried, default_of, nominal
from .elements import array_mismatch
from .functions import COMPUTED, IN_PRODUCTION, OF_THE_ARM, STATE, euler_zyx
from .located import Located
from .operators import OperandError, is_vector
from .outputs import READING
from .provenance import constant, source_of_literal
from .scope import Scope, Variable, unknown_name
from .types import NUM, Type, Unknown, Value, find_unknown, mismatch


class Evaluates(Protocol):
    """What functions need of the evaluator; see `Evaluator`."""

    data: Globals
    course: Course
    answers: TypedAnswers
    outputs: Outputs

    def evaluate(self, expression: Expression, scope: Scope) -> Value:
        """The value of an expression."""

    def locate(self, expression: Expression, scope: Scope, asking: bool = True) -> Located:
        """The same, with the place that it was read from."""

    def check(self, value: Value, type_: Type, use: str, span: Span) -> None:
        """Refuse a value that is not known, or of another type."""

    def assumed(self, value: Value, type_: Type, use: str, span: Span) -> Value:
        """A value with everything that is not known at its default."""

    def as_index(self, value: Value, span: Span) -> int:
        """A known value as an index."""

    def cell(self, name: Name, scope: Scope) -> Variable | None:
        """The datum of a name."""

    def settle(self, cell: Variable) -> Value:
        """The value of a datum."""

    def assign(self, target: Name, value: Value, scope: Scope) -> None:
        """``target := value``"""

    def fill(self, target: Name, unknown: Unknown, scope: Scope, by: str) -> None:
        """A datum gets the user's answer, or what is not known."""

    def output(self, signal: Expression | None, asked: Span, scope: Scope) -> Value | None:
        """What the program has set an output to."""


CallFunction = Callable[[Routine, Call, Scope], Value]
Special = Callable[[Evaluates, Call, Scope], Value]


def function_value(
    evaluator: Evaluates,
    run: CallFunction,
    special: Mapping[str, Special],
    call: Call,
    scope: Scope,
) -> Value:
    """The value of a call; the user's answer where it is not known.

    Args:
        special: functions whose arguments are no plain values, by lower-case name.

    Raises:
        SourceError: it has none.
    """
    value = _value(evaluator, run, special, call, scope)
    if not isinstance(value, Unknown):
        return value
    kind = kind_brought_by(call.name) if value.key == evaluator.answers.key(call.span) else None
    answer = evaluator.answers.ask(call.span, STATE.get(call.name), kind=kind)
    return value if answer is None else answer


def _value(
    evaluator: Evaluates,
    run: CallFunction,
    special: Mapping[str, Special],
    call: Call,
    scope: Scope,
) -> Value:
    data = evaluator.data
    own = data.routine(call.name, scope.home)
    if own is None:
        special_ = special.get(call.name)
        if special_ is not None:
            return special_(evaluator, call, scope)
        if call.name in COMPUTED:
            return _computed(evaluator, call, scope)
        if call.name in READING and call.arguments:
            held = evaluator.output(call.arguments[0].value, call.span, scope)
            if held is not None:
                return held
        if call.name in IN_PRODUCTION:
            answer = evaluator.answers.ask(call.span, None)
            return IN_PRODUCTION[call.name] if answer is None else answer
        if call.name in OF_THE_ARM:
            stated = evaluator.answers.stated(f"{call.name}()")
            if stated is not None:
                answer = evaluator.answers.ask(call.span, NUM)
                return stated if answer is None else answer
            return Unknown(
                f"what {call.text}() is of this arm",
                call.span,
                evaluator.answers.key(call.span),
                OF_THE_ARM[call.name],
            )
        if call.name in STATE:
            key = evaluator.answers.key(call.span)
            return Unknown(f"the value of {key}", call.span, key, default_of(STATE[call.name]))
        own = data.fetched_routine(call.name, scope.home, call.span)
    if own is None:
        return _missing(evaluator, call)
    if own.kind != "func":
        raise SourceError(f"{own.text} is no function but a {own.kind.upper()}", call.span)
    return run(own, call, scope)


def _missing(evaluator: Evaluates, call: Call) -> Unknown:
    """The value of a function of which nobody has the text; it is taken to move nothing."""
    evaluator.outputs.forget()
    known = [*evaluator.data.routine_names("func"), *COMPUTED]
    hint = evaluator.data.hint(call.name)
    reason = unknown_name("function", call.text, known, hint or "its text is not at hand")
    return Unknown(f"an {reason}", call.span, evaluator.answers.key(call.span))


def _computed(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    function, types, options = COMPUTED[call.name]
    required = [a.value for a in call.arguments if a.option is None and a.value is not None]
    check_count(call.text, len(types), len(required), call.span)
    given = {a.option: a.value for a in call.arguments if a.option is not None}
    for option in given:
        if option not in options:
            raise SourceError(f"{call.text}: \\{option} is not supported", call.span)
    values = [evaluator.evaluate(e, scope) for e in required]
    for option in options:
        if option in given and given[option] is None:
            values.append(1.0)
            continue
        expression = given.get(option)
        values.append(0.0 if expression is None else evaluator.evaluate(expression, scope))
    unknown = find_unknown(tuple(values))
    if unknown is not None:
        for expression_, value, type_ in zip(required, values, types, strict=False):
            evaluator.answers.used_as(expression_, value, type_)
        kinds = (*types, *[NUM] * len(options))
        known = [nominal(value, kind) for value, kind in zip(values, kinds, strict=True)]
        return carried(unknown, lambda: _of_defaults(function, known))
    for value, type_ in zip(values, (*types, *[NUM] * len(options)), strict=True):
        wrong = mismatch(value, type_) if type_ is not None else None
        if wrong is not None:
            raise SourceError(f"{call.text}: {wrong}", call.span)
    try:
        return _checked(function(*values))
    except OperandError as error:
        raise error.at(call.span, call.text) from None
    except (ValueError, ArithmeticError):
        raise SourceError(
            f"{call.text} has no finite value for these arguments", call.span
        ) from None


def _of_defaults(function: Callable[..., Value], values: Sequence[Value | None]) -> Value | None:
    """The value of a function with everything that is not known at its default."""
    if None in values:
        return None
    try:
        return _checked(function(*values))
    except OperandError:
        return None


def _dim(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``Dim(array, n)``: size of the n-th dimension."""
    array = _only_name(call, 2)
    cell = evaluator.cell(array, scope)
    if cell is None:
        raise SourceError(unknown_name("array", array.text, scope.names()), array.span)
    evaluator.settle(cell)
    which = call.arguments[1].value
    value = evaluator.evaluate(which, scope) if which is not None else 0.0
    if isinstance(value, Unknown):
        return value
    index = evaluator.as_index(value, call.span)
    if not 1 <= index <= len(cell.dimensions):
        raise SourceError(
            f"{cell.name} has {len(cell.dimensions)} dimensions, not {index}", call.span
        )
    return float(cell.dimensions[index - 1])


def _euler(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``EulerZYX(\\X, orient)``"""
    switches = [a.option for a in call.arguments if a.option is not None]
    required = [a.value for a in call.arguments if a.option is None and a.value is not None]
    if len(switches) != 1 or switches[0] not in ("x", "y", "z") or len(required) != 1:
        raise SourceError("EulerZYX takes \\X, \\Y or \\Z and an orient", call.span)
    value = evaluator.evaluate(required[0], scope)
    unknown = find_unknown(value)
    if unknown is not None:
        return unknown
    if not is_vector(value, 4):
        raise SourceError("EulerZYX takes an orient", call.span)
    assert isinstance(value, tuple)
    try:
        return euler_zyx(switches[0], value)
    except OperandError as error:
        raise error.at(call.span, call.text) from None


def _datum(evaluator: Evaluates, call: Call, scope: Scope) -> Variable:
    """The datum that is a function's only argument."""
    name = _only_name(call, 1)
    cell = evaluator.cell(name, scope)
    if cell is None:
        raise SourceError(unknown_name("datum", name.text, scope.names()), name.span)
    return cell


def _read_value(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``StrToVal(text, datum)``: whether the text is a value of the datum, which it becomes."""
    given = [a.value for a in call.arguments]
    if len(given) != 2 or given[0] is None or not isinstance(given[1], Name):
        raise SourceError("StrToVal takes a string and a datum", call.span)
    text = evaluator.evaluate(given[0], scope)
    if isinstance(text, Unknown):
        evaluator.fill(given[1], text, scope, call.name)
        return text
    found = evaluator.locate(given[1], scope, asking=False)
    value = literal_value(text) if isinstance(text, str) else None
    sizes = found.cell.dimensions if found.cell is not None and not given[1].path else ()
    if value is None or found.type is None or array_mismatch(value, found.type, sizes):
        return False
    evaluator.assign(given[1], value, scope)
    return True


def _test_and_set(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``TestAndSet(flag)``: takes a flag that is free; nobody else takes it here."""
    name = _only_name(call, 1)
    before = evaluator.evaluate(name, scope)
    if isinstance(before, Unknown):
        return before
    evaluator.assign(name, True, scope)
    return before is False


def _present(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``Present(parameter)``"""
    name = _only_name(call, 1)
    cell = scope.find(name.name)
    if cell is None:
        raise SourceError(unknown_name("parameter", name.text, scope.names()), name.span)
    return cell.present


def _module_exists(evaluator: Evaluates, call: Call, scope: Scope) -> Value:
    """``ModExist("module")``"""
    given = [evaluator.evaluate(a.value, scope) for a in call.arguments if a.value is not None]
    if len(given) != 1 or isinstance(given[0], Unknown):
        return Unknown(f"the value of {call.text}()", call.span, evaluator.answers.key(call.span))
    return str(given[0]).lower() in {module.name for module in evaluator.data.modules}


def _only_name(call: Call, count: int) -> Name:
    arguments: tuple[Argument, ...] = call.arguments
    first = arguments[0].value if arguments else None
    if len(arguments) != count or not isinstance(first, Name) or first.path:
        raise SourceError(f"{call.text} takes a datum as its first argument", call.span)
    return first


def literal_value(text: str) -> Value | None:
    """The value of a text that is a literal; None if it is none."""
    try:
        cursor = Cursor(tokenize(SourceText(text, "")))
        expression = parse_expression(cursor)
    except SourceError:
        return None
    if cursor.kind != END or source_of_literal(expression, None) is None:
        return None
    return constant(expression)


def _checked(value: Value) -> Value:
    if isinstance(value, float) and value - value != 0.0:
        raise OverflowError
    return float(value) if type(value) is int else value


SPECIAL: dict[str, Special] = {
    "present": _present,
    "dim": _dim,
    "eulerzyx": _euler,
    "strtoval": _read_value,
    "testandset": _test_and_set,
    "argname": lambda evaluator, call, scope: _datum(evaluator, call, scope).name,
    "modexist": _module_exists,
    "ispers": lambda evaluator, call, scope: _datum(evaluator, call, scope).persistent,
    "isvar": lambda evaluator, call, scope: not _datum(evaluator, call, scope).persistent,
    "type": lambda evaluator, call, scope: _datum(evaluator, call, scope).type.name,
}
"""Functions whose arguments are data or switches, by lower-case name."""
