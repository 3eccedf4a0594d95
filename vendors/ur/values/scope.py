"""Variables of a running program, and the names under which they and functions are found.

A name means the variable of the nearest enclosing function that has it, from the function's own
text outwards; an assignment to a name that is nowhere makes a variable of the function it stands
in. ``global`` makes one of the whole program, ``local`` one of the function whatever there is
outside. Source: "The URScript Programming Language", scoping rules.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from ....core.source.execution import scopes
from ....core.source.execution.scopes import near_names
from ..syntax.tree import Block, Define
from .provenance import Sources
from .values import Value

_OFFERED = 3
"""Names that a message offers."""


@dataclass(eq=False, slots=True)
class Variable:
    """One variable.

    Args:
        sources: where in the text the value stands.
        writer: name of a running thread that writes it, so that nobody knows its value.
        supposed: what its value depends on, if a way that was chosen by rule has set it.
    """

    value: Value = None
    sources: Sources = ()
    writer: str | None = None
    supposed: str = ""


@dataclass(frozen=True, slots=True)
class Function:
    """A ``def``, ``sec`` or ``thread`` and the scope that its text stands in."""

    definition: Define
    scope: Scope


@dataclass(eq=False, slots=True)
class Scope(scopes.Scope[Variable]):
    """Names of one running function; ``outer`` is the scope that the function's text stands in.

    Args:
        functions: those that its text defines, by name.
    """

    functions: dict[str, Define] = field(default_factory=dict)

    def function(self, name: str) -> Function | None:
        """The function, secondary program or thread of a name."""
        for scope in self.outwards():
            define = scope.functions.get(name)
            if define is not None:
                return Function(define, scope)
        return None

    def define(self, block: Block) -> None:
        """Make the functions known that a block defines."""
        for statement in block:
            if isinstance(statement, Define):
                self.functions[statement.name] = statement

    def own(self, name: str) -> Variable:
        """The variable of this very scope, made if there is none."""
        return self.cells.setdefault(name, Variable())

    def root(self) -> Scope:
        """The scope of the whole program."""
        *_, outermost = self.outwards()
        return outermost

    def function_names(self) -> set[str]:
        """Names of all functions that are found from here."""
        return {name for scope in self.outwards() for name in scope.functions}


def did_you_mean(name: str, known: Collection[str]) -> str:
    """``did you mean …?`` for a name, or nothing if none is near; another case is nearest."""
    near = [n for n in sorted(known) if n.casefold() == name.casefold() and n != name]
    near += near_names(name, known)
    return f"did you mean {' or '.join(near[:_OFFERED])}? " if near else ""
