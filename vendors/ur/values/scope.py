"""Variables of a running program, and the names under which they and functions are found.

A name means the variable of the nearest enclosing function that has it, from the function's own
text outwards; an assignment to a name that is nowhere makes a variable of the function it stands
in. ``global`` makes one of the whole program, ``local`` one of the function whatever there is
outside. Source: "The URScript Programming Language", scoping rules.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ..syntax.tree import Block, Define
from .provenance import Sources
from .values import Value


@dataclass(eq=False, slots=True)
class Cell:
    """One variable.

    Args:
        value: what it holds.
        sources: where in the text the value stands.
        writer: name of a running thread that writes it, so that nobody knows its value.
    """

    value: Value = None
    sources: Sources = ()
    writer: str | None = None


@dataclass(frozen=True, slots=True)
class Function:
    """A ``def``, ``sec`` or ``thread`` and the scope that its text stands in."""

    definition: Define
    scope: Scope


@dataclass(eq=False, slots=True)
class Scope:
    """Names of one running function; what is not found is looked up in ``outer``.

    Args:
        where: for notes: the function's name.
        outer: the scope that the function's text stands in; None for the whole program.
        cells: its variables by name.
        functions: those that its text defines, by name.
    """

    where: str
    outer: Scope | None = None
    cells: dict[str, Cell] = field(default_factory=dict)
    functions: dict[str, Define] = field(default_factory=dict)

    def find(self, name: str) -> Cell | None:
        """The variable of a name."""
        scope: Scope | None = self
        while scope is not None:
            cell = scope.cells.get(name)
            if cell is not None:
                return cell
            scope = scope.outer
        return None

    def function(self, name: str) -> Function | None:
        """The function, secondary program or thread of a name."""
        scope: Scope | None = self
        while scope is not None:
            define = scope.functions.get(name)
            if define is not None:
                return Function(define, scope)
            scope = scope.outer
        return None

    def define(self, block: Block) -> None:
        """Make the functions known that a block defines."""
        for statement in block:
            if isinstance(statement, Define):
                self.functions[statement.name] = statement

    def values(self) -> list[Value]:
        """Values of all variables that are found from here."""
        return [cell.value for scope in self._outwards() for cell in scope.cells.values()]

    def own(self, name: str) -> Cell:
        """The variable of this very scope, made if there is none."""
        return self.cells.setdefault(name, Cell())

    def root(self) -> Scope:
        """The scope of the whole program."""
        *_, outermost = self._outwards()
        return outermost

    def function_names(self) -> set[str]:
        """Names of all functions that are found from here."""
        return {name for scope in self._outwards() for name in scope.functions}

    def _outwards(self) -> Iterator[Scope]:
        """This scope and all that enclose it."""
        scope: Scope | None = self
        while scope is not None:
            yield scope
            scope = scope.outer


def near_names(name: str, known: Iterable[str]) -> str:
    """``did you mean …?`` for a name, or nothing if none is near; upper and lower case aside."""
    spelled = {other.casefold(): other for other in sorted(known)}
    matches = difflib.get_close_matches(name.casefold(), spelled, n=3, cutoff=0.75)
    near = [spelled[match] for match in matches]
    return f"did you mean {' or '.join(near)}? " if near else ""
