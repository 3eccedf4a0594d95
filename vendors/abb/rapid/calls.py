"""Arguments of the program's own routines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ....core.errors import SourceError, Span
from .evaluator import Evaluator
from .scope import Cell, Scope, unknown_name
from .syntax import Argument, Expression, Name, Parameter, Routine
from .types import Foreign, find_unknown, interpreted


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
) -> None:
    """Arguments, evaluated in ``caller``, become cells of the routine's ``scope``.

    Raises:
        SourceError: they do not fit the routine's parameters.
    """
    required = [p for p in routine.parameters if not p.optional]
    values = [a for a in arguments if a.option is None]
    if len(values) != len(required):
        raise SourceError(
            f"{routine.text} takes {len(required)} arguments, not {len(values)}", span
        )
    given = {a.option: a for a in arguments if a.option is not None}
    optional = {p.name: p for p in routine.parameters if p.optional}
    for option in given:
        if option not in optional:
            raise SourceError(unknown_name(f"argument of {routine.text}", option, optional), span)
    for parameter, argument in zip(required, values, strict=True):
        scope.cells[parameter.name] = _parameter(evaluator, parameter, argument, caller)
    for name, parameter in optional.items():
        passed = given.get(name)
        if passed is None:
            type_ = evaluator.types.get(parameter.type, Foreign(parameter.type))
            scope.cells[name] = Cell(name, type_, value=False, present=False)
        else:
            scope.cells[name] = _parameter(evaluator, parameter, passed, caller)


def _parameter(
    evaluator: Evaluator, parameter: Parameter, argument: Argument, caller: Scope
) -> Cell:
    expression = argument.value
    type_ = evaluator.types.get(parameter.type, Foreign(parameter.type))
    if expression is None:
        if parameter.type != "switch":
            raise SourceError(f"\\{parameter.name} needs a value", argument.span)
        return Cell(parameter.name, type_, value=True)
    by_reference = parameter.mode != "in"
    if by_reference or parameter.dimensions:
        return _referred(evaluator, parameter, expression, caller)
    found = evaluator.locate(expression, caller)
    unknown = find_unknown(found.value)
    if unknown is None:
        evaluator.check(found.value, type_, f"\\{parameter.name}", expression.span)
    name = found.cell.name if found.cell is not None else parameter.name
    return Cell(
        name,
        type_,
        value=interpreted(found.value, type_, expression.span),
        source=found.source,
        predefined=found.predefined,
    )


def _referred(
    evaluator: Evaluator, parameter: Parameter, expression: Expression, caller: Scope
) -> Cell:
    """The caller's own datum, for parameters that the routine may write, and for arrays."""
    cell = caller.find(expression.name) if isinstance(expression, Name) else None
    if cell is None or (isinstance(expression, Name) and expression.path):
        raise SourceError(
            f"parameter {parameter.name} is passed by reference: it takes the name of a whole "
            "datum here",
            expression.span,
        )
    evaluator.settle(cell)
    return cell
