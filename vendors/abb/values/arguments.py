"""The arguments of an instruction against what the instruction takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.source.text.arguments import wrong_count
from ....core.source.text.quick import quick
from ..syntax.tree import Expression, Invoke
from .scope import Scope, unknown_name


class Numbers(Protocol):
    """Gives the number that an expression is."""

    def number(self, expression: Expression, scope: Scope, use: str) -> float:
        """See `Evaluator.number`."""


@quick(frozen=True, slots=True)
class Bound:
    """The arguments of one instruction.

    Args:
        text: the instruction's name.
        names: of the required arguments, for messages.
        required: in order.
        options: optional arguments by lower-case name; None for a switch.
        option_spans: where each option stands.
    """

    text: str
    span: Span
    names: tuple[str, ...]
    required: tuple[Expression, ...]
    options: dict[str, Expression | None]
    option_spans: dict[str, Span]

    def value(self, index: int) -> Expression:
        """A required argument."""
        return self.required[index]

    def named(self, name: str) -> Expression:
        """A required argument by its name."""
        return self.required[self.names.index(name)]

    def option(self, name: str) -> Expression:
        """The value of an optional argument that must have one.

        Raises:
            SourceError: it is missing, or given as a switch.
        """
        value = self.options.get(name)
        if value is None:
            raise SourceError(f"{self.text}: \\{name} needs a value", self.span)
        return value

    def number(self, evaluator: Numbers, index: int, scope: Scope) -> float:
        """A required argument that is a known num."""
        return evaluator.number(self.required[index], scope, self.use(index))

    def use(self, index: int) -> str:
        """A required argument, to stand at the beginning of a message."""
        return f"{self.text}, argument {self.names[index]}"


def check_count(text: str, wanted: int, given: int, span: Span, names: Sequence[str] = ()) -> None:
    """Refuse too few or too many required arguments.

    Raises:
        SourceError: the numbers differ.
    """
    if given != wanted:
        raise SourceError(f"{text} {wrong_count(wanted, given, names)}", span)


def bind(invoke: Invoke, names: Sequence[str], options: Sequence[str]) -> Bound:
    """The arguments of ``invoke``, required ones called ``names``.

    Raises:
        SourceError: there are too few or too many, or an option that the instruction has not.
    """
    required = [a.value for a in invoke.arguments if a.option is None and a.value is not None]
    check_count(invoke.text, len(names), len(required), invoke.span, names)
    given: dict[str, Expression | None] = {}
    spans: dict[str, Span] = {}
    for argument in invoke.arguments:
        if argument.option is None:
            continue
        if argument.option not in options:
            message = unknown_name(f"argument of {invoke.text}", argument.option, options)
            raise SourceError(message, argument.span)
        given[argument.option] = argument.value
        spans[argument.option] = argument.span
    return Bound(invoke.text, invoke.span, tuple(names), tuple(required), given, spans)
