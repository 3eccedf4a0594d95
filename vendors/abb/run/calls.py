"""Arguments of the program's own routines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ....core.errors import SourceError, Span
from ....core.program.question import QuestionKind
from ..syntax.tree import Argument, Expression, Name, Number, Parameter, Routine
from ..values.arguments import check_count
from ..values.defaults import default_of
from ..values.evaluator import Evaluator
from ..values.scope import Scope, Variable, unknown_name
from ..values.types import Foreign, Type, Unknown, find_unknown, interpreted


def present(arguments: Iterable[Argument], scope: Scope) -> Iterator[Argument]:
    """Arguments but those handed on (``\\Option?parameter``) from absent parameters."""
    for argument in arguments:
        if not argument.conditional or not isinstance(argument.value, Name):
            yield argument
            continue
        cell = scope.find(argument.value.name)
        if cell is None or cell.present:
            switch = cell is not None and cell.type == Foreign("switch")
            value = None if switch else argument.value
            yield replace(argument, value=value, conditional=False)


def pass_arguments(
    evaluator: Evaluator,
    routine: Routine,
    arguments: tuple[Argument, ...],
    caller: Scope,
    scope: Scope,
    span: Span,
) -> list[tuple[Variable, Name]]:
    """Arguments, evaluated in ``caller``, become cells of the routine's ``scope``.

    Returns:
        Cells whose values go back, after the routine, to the elements and components that were
        passed by reference.

    Raises:
        SourceError: they do not fit the routine's parameters.
    """
    pairs = _matched(routine, arguments, span)
    back: list[tuple[Variable, Name]] = []
    for parameter, argument in pairs:
        type_ = evaluator.data.type(parameter.type, scope.home, parameter.span)
        with evaluator.course.apart():
            cell = _parameter(evaluator, parameter, type_, argument, caller)
            cell.supposed = cell.supposed or evaluator.course.supposed
        scope.cells[parameter.name] = cell
        value = argument.value
        if parameter.mode != "in" and isinstance(value, Name) and value.path:
            back.append((cell, _fixed(evaluator, value, caller)))
    _leave_absent(evaluator, routine, scope)
    return back


def leave_open(evaluator: Evaluator, routine: Routine, scope: Scope) -> None:
    """The cells of a routine that nobody calls: what its arguments are is asked."""
    for parameter in needed_by(routine):
        span = parameter.span
        type_ = evaluator.data.type(parameter.type, scope.home, span)
        value = evaluator.answers.ask_by(parameter.text, span, type_, (), QuestionKind.DATUM)
        if value is None:
            reason = f"the argument {parameter.text} of {routine.text}"
            value = Unknown(reason, span, parameter.text, default_of(type_))
        scope.cells[parameter.name] = Variable(parameter.text, type_, value=value)
    _leave_absent(evaluator, routine, scope)


def _leave_absent(evaluator: Evaluator, routine: Routine, scope: Scope) -> None:
    """The cells of the parameters that are not given."""
    for parameter in routine.parameters:
        if parameter.name not in scope.cells:
            type_ = evaluator.data.type(parameter.type, scope.home, parameter.span)
            scope.cells[parameter.name] = Variable(
                parameter.text, type_, value=False, present=False
            )


def needed_by(routine: Routine) -> list[Parameter]:
    """The parameters that must be given."""
    return [p for p in routine.parameters if not p.optional]


def _fixed(evaluator: Evaluator, name: Name, caller: Scope) -> Name:
    """A name with its indices as they are now: the routine may change what they are made of."""

    def index(expression: Expression) -> Expression:
        value = evaluator.evaluate(expression, caller)
        return Number(expression.span, value) if type(value) is float else expression

    path = tuple(s if isinstance(s, str) else tuple(map(index, s)) for s in name.path)
    return replace(name, path=path)


def _matched(
    routine: Routine, arguments: tuple[Argument, ...], span: Span
) -> list[tuple[Parameter, Argument]]:
    """Parameters and the arguments given for them.

    Raises:
        SourceError: there are too few or too many, or of other names.
    """
    required = needed_by(routine)
    values = [a for a in arguments if a.option is None]
    check_count(routine.text, len(required), len(values), span)
    for parameter, argument in zip(required, values, strict=True):
        if argument.parameter not in (None, parameter.name):
            raise SourceError(
                f"this argument of {routine.text} is {parameter.text}, not {argument.parameter}",
                argument.span,
            )
    given = {a.option: a for a in arguments if a.option is not None}
    optional = {p.name: p for p in routine.parameters if p.optional}
    for option in given:
        if option not in optional:
            raise SourceError(unknown_name(f"argument of {routine.text}", option, optional), span)
    pairs = list(zip(required, values, strict=True))
    return [*pairs, *((optional[option], argument) for option, argument in given.items())]


def _parameter(
    evaluator: Evaluator, parameter: Parameter, type_: Type, argument: Argument, caller: Scope
) -> Variable:
    expression = argument.value
    if expression is None:
        if parameter.type != "switch":
            raise SourceError(f"\\{parameter.text} needs a value", argument.span)
        return Variable(parameter.text, type_, value=True)
    if parameter.mode != "in" or parameter.dimensions:
        return _referred(evaluator, parameter, type_, expression, caller)
    found = evaluator.locate(expression, caller, asking=not isinstance(type_, Foreign))
    evaluator.answers.used_as(expression, found.value, type_)
    if find_unknown(found.value) is None:
        evaluator.check(found.value, type_, f"parameter {parameter.text}", expression.span)
    name = found.cell.name if found.cell is not None else parameter.text
    return Variable(
        name,
        type_,
        value=interpreted(found.value, type_, expression.span),
        source=found.source,
        predefined=found.predefined,
    )


def _referred(
    evaluator: Evaluator, parameter: Parameter, type_: Type, expression: Expression, caller: Scope
) -> Variable:
    """The caller's own datum, for parameters that the routine may write, and for arrays."""
    if not isinstance(expression, Name):
        if parameter.dimensions and parameter.mode == "in":
            return _anonymous(evaluator, parameter, type_, expression, caller)
        raise SourceError(
            f"parameter {parameter.text} is passed by reference: it takes a datum here, and no "
            "computed value",
            expression.span,
        )
    cell = evaluator.cell(expression, caller)
    if cell is None or expression.path:
        # A signal, an element, a component: of a signal it counts which one it is.
        found = evaluator.locate(expression, caller, asking=cell is not None)
        return Variable(expression.text, type_, value=found.value, source=found.source)
    evaluator.settle(cell)
    if parameter.dimensions not in (0, len(cell.dimensions)) and cell.value is not None:
        raise SourceError(
            f"parameter {parameter.text} is an array of {parameter.dimensions} dimensions, and "
            f"{cell.name} has {len(cell.dimensions)}",
            expression.span,
        )
    if parameter.mode == "in":
        return replace(cell, overwritten=set(cell.overwritten), elements={}, constant=False)
    return cell


def _anonymous(
    evaluator: Evaluator, parameter: Parameter, type_: Type, expression: Expression, caller: Scope
) -> Variable:
    """An array that is written out, or that a function returns."""
    value = evaluator.evaluate(expression, caller)
    sizes: list[int] = []
    inner = value
    while len(sizes) < parameter.dimensions and isinstance(inner, tuple):
        sizes.append(len(inner))
        inner = inner[0]
    return Variable(parameter.text, type_, value=value, dimensions=tuple(sizes))
