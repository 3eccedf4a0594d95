"""What a program's modules declare: data types, routines and data."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

from ....core.errors import SourceError
from .evaluator import Evaluator
from .predefined import RECORDS
from .scope import Cell, Scope
from .syntax import AliasDefinition, Module, RecordDefinition, Routine
from .types import BUILT_IN, NUM, Foreign, RecordType, Type


class Globals:
    """The declarations of a program.

    Names of one module hide those of the controller; several modules share one name space.

    Raises:
        SourceError: a name is declared twice.
    """

    def __init__(self, modules: Sequence[Module]) -> None:
        self.modules = tuple(modules)
        self.types = _types(modules)
        self.procedures: dict[str, Routine] = {}
        self.functions: dict[str, Routine] = {}
        tables = {"proc": self.procedures, "func": self.functions, "trap": {}}
        taken: dict[str, Routine] = {}
        for module in modules:
            for routine in module.routines:
                if routine.name in taken:
                    first = taken[routine.name].span
                    raise SourceError(
                        f"{routine.text} is declared twice: first at line {first.line}",
                        routine.span,
                    )
                taken[routine.name] = routine
                tables[routine.kind][routine.name] = routine
        self._scope = Scope("", outer=_controller())

    def declare(self, evaluator: Evaluator) -> None:
        """Make cells of all data; their values are evaluated when they are read."""
        for module in self.modules:
            for declaration in module.declarations:
                before = self._scope.cells.get(declaration.name)
                if before is not None:
                    raise SourceError(f"{declaration.text} is declared twice", declaration.span)
                evaluator.declare(declaration, self._scope)

    def scope_of(self, routine: Routine) -> Scope:
        """The scope in which a routine's own names are not found."""
        return self._scope


def _controller() -> Scope:
    """The controller's own data."""
    scope = Scope("")
    for type_name, records in RECORDS.items():
        for name, record in records.items():
            scope.cells[name] = Cell(
                name, BUILT_IN[type_name], value=record, constant=True, predefined=name
            )
    scope.cells["pi"] = Cell("pi", NUM, value=3.141592653589793, constant=True, predefined="pi")
    return scope


def _types(modules: Sequence[Module]) -> dict[str, Type]:
    """Built-in and declared types; a declared one may use those that are declared before it."""
    types: dict[str, Type] = dict(BUILT_IN)
    for module in modules:
        for definition in module.types:
            if definition.name in types:
                raise SourceError(f"type {definition.name} is declared twice", definition.span)
            types[definition.name] = _type(definition, types)
    return types


def _type(definition: RecordDefinition | AliasDefinition, types: dict[str, Type]) -> Type:
    if isinstance(definition, AliasDefinition):
        return types.get(definition.type, Foreign(definition.type))
    components: dict[str, Type] = {}
    for type_name, name in definition.components:
        if name in components:
            raise SourceError(f"component {name} is declared twice", definition.span)
        components[name] = types.get(type_name, Foreign(type_name))
    return RecordType(definition.name, MappingProxyType(components))
