"""Data of a running program: cells with values, and the names under which they are found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from ....core.source.execution import scopes
from ..syntax.tree import Declaration, Routine
from .provenance import Literal
from .types import Type, Value


@dataclass(eq=False, slots=True)
class Variable:
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
        writer, awaited: see `core.source.execution.suppose.SharedDatum`.
        supposed: what its value depends on, if a way that was chosen by rule has set it.
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
    writer: str | None = None
    awaited: bool = False
    supposed: str = ""


@dataclass(eq=False, slots=True)
class Home:
    """What a module keeps to itself (``LOCAL``) beside its data, by lower-case name."""

    module: str
    routines: dict[str, Routine] = field(default_factory=dict)
    types: dict[str, Type] = field(default_factory=dict)


NOWHERE = Home("")


@dataclass(eq=False, slots=True)
class Scope(scopes.Scope[Variable]):
    """Names (lower case) and their cells.

    Args:
        home: the module that the text belongs to.
    """

    home: Home = NOWHERE

    def inner(self, where: str) -> Scope:
        """An empty scope inside this one."""
        return Scope(where, {}, self, self.home)

    def names(self) -> set[str]:
        """All names that are found from here, as declared."""
        return {cell.name for scope in self.outwards() for cell in scope.cells.values()}


class Snapshot:
    """Data as they are now.

    Args:
        cells: which; those whose values have not been evaluated yet do not count.
    """

    def __init__(self, cells: Iterable[Variable]) -> None:
        self._held = [
            (cell, cell.value, dict(cell.elements)) for cell in cells if cell.value is not None
        ]

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        return any(
            cell.elements != elements or (cell.value is not value and cell.value != value)
            for cell, value, elements in self._held
        )


ELSEWHERE = "if it stands in another module, name that file too, or put it beside this one"


def unknown_name(kind: str, name: str, known: Iterable[str], otherwise: str = ELSEWHERE) -> str:
    """The message for a name that is not declared, with the nearest ones that are."""
    return scopes.unknown_name(kind, name, known, otherwise)
