"""Arguments of calls, by position and by name."""

from __future__ import annotations

from collections.abc import Sequence

from ..syntax.texts import Texts
from ..syntax.tree import Argument, Call, MethodCall
from .scope import did_you_mean


def bind(
    call: Call | MethodCall, parameters: Sequence[str], required: int, texts: Texts
) -> dict[str, Argument]:
    """The arguments of a call by the names of the parameters.

    Args:
        parameters: names in order.
        required: how many of the first ones must be given.

    Raises:
        SourceError: too many, one twice, an unknown name, or a required one missing.
    """
    given: dict[str, Argument] = {}
    for place, argument in enumerate(call.arguments):
        name = argument.name
        if name is None and place < len(parameters):
            name = parameters[place]
        if name is None or name not in parameters or name in given:
            message = _misfit(call, parameters, name)
            raise texts.error(message, argument.start, argument.end)
        given[name] = argument
    for name in parameters[:required]:
        if name not in given:
            message = f"{call.name} needs the argument '{name}': {_form(call, parameters)}"
            raise texts.error(message, call.start, call.end)
    return given


def _misfit(call: Call | MethodCall, parameters: Sequence[str], name: str | None) -> str:
    """Why an argument cannot be given; None is one too many."""
    if name is None:
        count = _count(len(parameters))
        return f"{call.name} takes {count}, not {len(call.arguments)}: {_form(call, parameters)}"
    if name in parameters:
        return f"{call.name}: the argument '{name}' is given twice"
    offer = did_you_mean(name, parameters)
    return f"{call.name} has no argument '{name}': {offer}{_form(call, parameters)}"


def _form(call: Call | MethodCall, parameters: Sequence[str]) -> str:
    return f"{call.name}({', '.join(parameters)})"


def _count(count: int) -> str:
    return "no argument" if count == 0 else "1 argument" if count == 1 else f"{count} arguments"
