"""What a program's modules declare: data types, routines and data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

from ....core.errors import Note, SourceError, Span
from ....core.source.text.nodes import Unreadable, same_form
from ..syntax.tree import AliasDefinition, Declaration, Module, RecordDefinition, Routine
from .library import Library
from .predefined import CONSTANTS, ERRNO, RECORDS, USER_CLOCK, USER_NUMBERS
from .scope import Home, Scope, Variable
from .types import BUILT_IN, NUM, Foreign, RecordType, Type, Unknown


class Globals:
    """The declarations of a program.

    Names of a routine hide those of its module, which hide those that all modules share, which
    hide those of the controller. What nobody declares is looked for in the library.

    Args:
        modules: loaded from the beginning.
        library: modules that are taken in when they are needed.
        mended: whether a name that is declared twice, which no controller takes, is read all the
            same: the first routine and type are kept, and of a datum whose declarations differ
            nobody knows the value.

    Attributes:
        errno: holds the error that a handler is run for.

    Raises:
        SourceError: a name is declared twice, and that is not mended.
    """

    def __init__(
        self, modules: Sequence[Module], library: Library, *, mended: bool = False
    ) -> None:
        self.modules: list[Module] = []
        self.notes: list[Note] = []
        self.routines: dict[str, Routine] = {}
        self.types: dict[str, Type] = dict(BUILT_IN)
        self._library = library
        self._mended = mended
        self._missed: set[str] = set()
        self._names: set[str] = set()
        self._definitions: dict[str, Span] = {}
        controller = _controller()
        self.errno = controller.cells[ERRNO]
        self._shared = Scope("", outer=controller)
        self._scopes: dict[int, Scope] = {}
        self._load(modules)

    # ------------------------------------------------------------------- looking up

    def routine(self, name: str, home: Home) -> Routine | None:
        """A routine that is loaded and seen from a module."""
        return home.routines.get(name) or self.routines.get(name)

    def fetched_routine(self, name: str, home: Home, span: Span) -> Routine | None:
        """The same, from the library if need be."""
        return self.routine(name, home) or (
            self.routines.get(name) if self._fetch(name, span) else None
        )

    def routine_of(self, module: str, name: str, span: Span) -> Routine | None:
        """A routine of a module that is named with it, its own (``LOCAL``) ones included."""
        if not any(m.name == module for m in self.modules):
            self._fetch(name, span)
        own = (r for m in self.modules if m.name == module for r in m.routines)
        return next((r for r in own if r.name == name), None)

    def fetched_cell(self, name: str, span: Span) -> Variable | None:
        """A datum of the library, for a name that no scope knows."""
        return self._shared.cells.get(name) if self._fetch(name, span) else None

    def type(self, name: str, home: Home, span: Span) -> Type:
        """A data type; `Foreign` if nobody declares it."""
        found = home.types.get(name) or self.types.get(name)
        if found is None and self._fetch(name, span):
            found = self.types.get(name)
        if found is None:
            found = self.types[name] = Foreign(name)
        return found

    def scope_of(self, routine: Routine) -> Scope:
        """The scope in which a routine's own names are not found."""
        return self._scopes[id(routine)]

    def scopes(self) -> list[Scope]:
        """Those of all modules."""
        return [self._shared, *{id(scope): scope for scope in self._scopes.values()}.values()]

    def hint(self, name: str) -> str | None:
        """Why a module beside the program, which declares a name, was not taken in."""
        return self._library.hint(name)

    def routine_names(self, kind: str) -> list[str]:
        """Names of all routines of a kind, as declared."""
        return [r.text for m in self.modules for r in m.routines if r.kind == kind]

    def module_of(self, routine: Routine) -> Module:
        """The module that declares a routine."""
        return next(m for m in self.modules if any(r is routine for r in m.routines))

    # ---------------------------------------------------------------------- loading

    def declare(self, declaration: Declaration, scope: Scope) -> Variable:
        """A new cell of a routine; its value is evaluated when it is first read."""
        cell = scope.cells[declaration.name] = self._cell(declaration, scope)
        return cell

    def _cell(self, declaration: Declaration, scope: Scope) -> Variable:
        return Variable(
            declaration.text,
            self.type(declaration.type, scope.home, declaration.span),
            constant=declaration.kind == "const",
            pending=declaration,
            scope=scope,
            persistent=declaration.kind == "pers",
            declared=declaration,
        )

    def _fetch(self, name: str, span: Span) -> bool:
        """Take a module in that declares a name; False if there is none."""
        if name in self._missed:
            return False
        found = self._library.take(name, span, {m.name for m in self.modules}, self._names)
        if found is None:
            self._missed.add(name)
            return False
        modules, note = found
        self.notes += [] if note is None else [note]
        self._load(modules)
        return True

    def _load(self, modules: Sequence[Module]) -> None:
        homes = [Home(module.text) for module in modules]
        pairs = list(zip(modules, homes, strict=True))
        self.modules += modules
        for module, home in pairs:
            self._add_types(module, home)
        for module, home in pairs:
            self._add_routines(module, home)
        for module, home in pairs:
            own = Scope(f"MODULE {module.text}", {}, self._shared, home)
            for declaration in module.declarations:
                self._add_datum(declaration, own)
            for routine in module.routines:
                self._scopes[id(routine)] = own

    def _add_routines(self, module: Module, home: Home) -> None:
        for routine in module.routines:
            table = home.routines if routine.local else self.routines
            before = table.get(routine.name)
            if before is not None:
                self._twice(routine.text, routine.span, before.span, "the first is kept")
                continue
            table[routine.name] = routine
            if not routine.local:
                self._names.add(routine.name)

    def _add_datum(self, declaration: Declaration, own: Scope) -> None:
        scope = own if declaration.local else self._shared
        before = scope.cells.get(declaration.name)
        if before is not None and before.declared is not None:
            declaration = self._doubled(before.declared, declaration)
        # What is evaluated later sees its own module's names, wherever the datum is found.
        scope.cells[declaration.name] = self._cell(declaration, own)
        if not declaration.local:
            self._names.add(declaration.name)

    def _doubled(self, first: Declaration, second: Declaration) -> Declaration:
        """What is read of two declarations of one datum."""
        if same_form(first.value, second.value) and first.type == second.type:
            self._twice(second.text, second.span, first.span, "both are the same")
            return first
        then = f"which value {first.text} has is not known"
        message = self._twice(second.text, second.span, first.span, then)
        return replace(first, value=Unreadable(second.span, message))

    def _twice(self, name: str, span: Span, first: Span, then: str) -> str:
        """Say that a name is declared twice.

        Raises:
            SourceError: that is not mended.
        """
        where = f"at line {first.line}"
        if first.file != span.file:
            where = f"in {first.file}, line {first.line}"
        message = f"{name} is declared twice: first {where}"
        if not self._mended:
            raise SourceError(message, span)
        text = f"{message}: no controller takes this; {then}"
        self.notes.append(Note(text, span=span, damage=True))
        return message

    def _add_types(self, module: Module, home: Home) -> None:
        """Declared types may use those that are declared before them."""
        for definition in module.types:
            table = home.types if definition.local else self.types
            if definition.name in table and not isinstance(table[definition.name], Foreign):
                first = self._definitions.get(definition.name, definition.span)
                self._twice(f"type {definition.name}", definition.span, first, "the first is kept")
                continue
            self._definitions.setdefault(definition.name, definition.span)
            table[definition.name] = self._type(definition, home)
            if not definition.local:
                self._names.add(definition.name)

    def _type(self, definition: RecordDefinition | AliasDefinition, home: Home) -> Type:
        if isinstance(definition, AliasDefinition):
            return self.type(definition.type, home, definition.span)
        components: dict[str, Type] = {}
        for type_name, name in definition.components:
            if name in components:
                raise SourceError(f"component {name} is declared twice", definition.span)
            components[name] = self.type(type_name, home, definition.span)
        return RecordType(definition.name, MappingProxyType(components))


def _controller() -> Scope:
    """The controller's own data."""
    scope = Scope("")
    for type_name, records in RECORDS.items():
        for name, record in records.items():
            scope.cells[name] = Variable(
                name, BUILT_IN[type_name], value=record, constant=True, predefined=name
            )
    for name, (type_, value) in CONSTANTS.items():
        scope.cells[name] = Variable(name, type_, value=value, constant=True, predefined=name)
    for name in USER_NUMBERS:
        scope.cells[name] = Variable(name, NUM, value=0.0)
    scope.cells[ERRNO] = Variable("ERRNO", NUM, value=0.0, constant=True)
    clock = Unknown(f"'{USER_CLOCK}', a clock", Span("", 1, 1, 0, 0))
    scope.cells[USER_CLOCK] = Variable(USER_CLOCK, Foreign("clock"), value=clock)
    return scope
