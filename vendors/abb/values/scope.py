"""Data of a running program: cells with values, and the names under which they are found."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass, field

from ..syntax.tree import Declaration, Routine
from .provenance import Literal
from .types import Type, Value


@dataclass(eq=False, slots=True)
class Cell:
    """One datum.

    Args:
        name: as it stands in its declaration.
        type: of the datum, or of its elements if it is an array.
        value: None until ``pending`` is evaluated.
        dimensions: sizes of an array, empty for a single value.
        constant: a ``CONST``.
        source: the literal that the value stands in, until it is assigned.
        pending: the declaration that still has to be evaluated.
        scope: where the names of ``pending`` are looked up.
        present: False for an optional parameter that was not given.
        overwritten: elements of an array that were assigned, which have no source any more.
        predefined: name of the controller's own datum whose value it has, until it is assigned.
        persistent: a ``PERS``.
        declared: its declaration, None for the controller's own data and parameters.
        elements: of an array: those written since it was last looked at as a whole. To make a new
            value of all for each of them would take a large array's time.
    """

    name: str
    type: Type
    value: Value | None = None
    dimensions: tuple[int, ...] = ()
    constant: bool = False
    source: Literal | None = None
    pending: Declaration | None = None
    scope: Scope | None = None
    present: bool = True
    overwritten: set[tuple[int, ...]] = field(default_factory=set)
    predefined: str | None = None
    persistent: bool = False
    declared: Declaration | None = None
    elements: dict[tuple[int, ...], Value] = field(default_factory=dict)


@dataclass(eq=False, slots=True)
class Home:
    """What a module keeps to itself (``LOCAL``) beside its data, by lower-case name."""

    module: str
    routines: dict[str, Routine] = field(default_factory=dict)
    types: dict[str, Type] = field(default_factory=dict)


NOWHERE = Home("")


@dataclass(eq=False, slots=True)
class Scope:
    """Names and their cells; what is not found is looked up in ``outer``.

    Args:
        where: for messages and notes: ``PROC pick``, ``MODULE main``.
        home: the module that the text belongs to.
    """

    where: str
    cells: dict[str, Cell] = field(default_factory=dict)
    outer: Scope | None = None
    home: Home = NOWHERE

    def find(self, name: str) -> Cell | None:
        """The cell that a name (lower case) stands for."""
        scope: Scope | None = self
        while scope is not None:
            cell = scope.cells.get(name)
            if cell is not None:
                return cell
            scope = scope.outer
        return None

    def inner(self, where: str) -> Scope:
        """An empty scope inside this one."""
        return Scope(where, {}, self, self.home)

    def names(self) -> set[str]:
        """All names that are found from here, as declared."""
        found: set[str] = set()
        scope: Scope | None = self
        while scope is not None:
            found.update(cell.name for cell in scope.cells.values())
            scope = scope.outer
        return found


ELSEWHERE = "if it stands in another module, name that file too, or put it beside this one"


def unknown_name(kind: str, name: str, known: Iterable[str], otherwise: str = ELSEWHERE) -> str:
    """The message for a name that is not declared, with the nearest ones that are."""
    spellings = {k.lower(): k for k in known if k.lower() != name.lower()}
    near = difflib.get_close_matches(name.lower(), spellings, n=3, cutoff=0.6)
    offer = f"did you mean {' or '.join(spellings[n] for n in near)}? If not: " if near else ""
    return f"unknown {kind} '{name}': {offer}{otherwise}"
