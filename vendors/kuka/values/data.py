"""The data of a program: where a name is looked up, and what declarations make."""

from __future__ import annotations

from collections.abc import Iterable

from ....core.errors import Note, SourceError, Span
from ....core.source.execution.outputs import Outputs
from ..syntax.tree import (
    Assign,
    Declaration,
    EnumDefinition,
    Expression,
    Name,
    Number,
    SignalDeclaration,
    Statement,
    StrucDefinition,
)
from .library import SHIPPED, Library
from .predefined import ALIASES, CONSTANTS, initial
from .scope import Module, Scope, Variable
from .types import PREDEFINED, default
from .values import Array, Pending, Struct, Value

_LARGEST = 100_000


class Data:
    """All data within reach, by name."""

    def __init__(self, library: Library) -> None:
        self.library = library
        self.types: dict[str, dict[str, str]] = {k: dict(v) for k, v in PREDEFINED.items()}
        self.system = initial()
        for name in CONSTANTS:
            self.system[name].constant = True
        self.notes: list[Note] = []
        self.outputs = Outputs()
        self._implicit: dict[str, Variable] = {}
        self._missing: dict[str, Variable | None] = {}
        for module in (*library.config, library.main):
            self.declare_module(module)

    # ---------------------------------------------------------------------- look-ups

    def find(self, name: str, scope: Scope) -> Variable | None:
        """The cell that a name (lower case) means in a scope; None if nothing declares it."""
        cell = scope.cells.get(name) or scope.module.cells.get(name)
        if cell is not None:
            return cell
        name = ALIASES.get(name, name)
        return self.system.get(name) or self._implicit.get(name) or self._elsewhere(name)

    def _elsewhere(self, name: str) -> Variable | None:
        for module in self.library.config:
            cell = module.cells.get(name)
            if cell is not None:
                return cell
        if name not in self._missing:
            self._missing[name] = self._shared(name)
        return self._missing[name]

    def _shared(self, name: str) -> Variable | None:
        """A datum that another module declares GLOBAL."""
        if name.startswith("$"):
            return None
        for module in self.library.global_modules():
            self.declare_module(module)
            cell = module.cells.get(name)
            if cell is not None and name in module.shared:
                return cell
        return None

    def named(self, names: frozenset[str], scopes: Iterable[Scope]) -> list[Variable]:
        """The cells of these names (lower case) in scopes, in modules and among the system's."""
        groups = [*(scope.cells for scope in scopes), self.system, self._implicit]
        groups += [module.cells for module in self.library.modules()]
        found = (group[name] for name in sorted(names) for group in groups if name in group)
        return list({id(cell): cell for cell in found}.values())

    def implicit(self, name: Name) -> Variable:
        """A cell for a name that nothing declares and that is assigned to.

        System variables are declared nowhere; other names are noted.
        """
        if not self.is_system(name.name):
            self.note(
                "assigned",
                f"{name.text} is declared in no file at hand: it is taken as declared elsewhere",
                name.span,
            )
        key = ALIASES.get(name.name, name.name)
        return self._implicit.setdefault(key, Variable(name.text))

    def note(self, kind: str, message: str, span: Span) -> None:
        """A note on a name."""
        if not any(kind == "assigned" and n.message == message for n in self.notes):
            self.notes.append(Note(message, span=span))

    @staticmethod
    def is_system(name: str) -> bool:
        """Whether a name is a system variable's."""
        return name.startswith("$") and name not in ALIASES

    def names(self, scope: Scope) -> set[str]:
        """Names that are found from a scope, as declared."""
        groups = [scope.cells, scope.module.cells, *(m.cells for m in self.library.config)]
        return {cell.name for group in groups for cell in group.values()}

    def text(self, span: Span) -> str:
        """The text of a place."""
        return self.library.texts[span.file][span.start : span.end]

    # ------------------------------------------------------------------ declarations

    def declare_module(self, module: Module) -> None:
        """Declare a module's data lists, once."""
        if module.declared:
            return
        module.declared = True
        for data_list in module.lists:
            for statement in data_list.body.statements:
                self._declare_in(module, statement)

    def _declare_in(self, module: Module, statement: Statement) -> None:
        shipped = module.stem == SHIPPED
        if isinstance(statement, Declaration):
            cell = self.cell(statement, module)
            cell.shipped = shipped
            if statement.value is not None:
                cell.value = Pending(statement.value, module.stem)
            module.cells.setdefault(statement.name, cell)
            if statement.shared:
                module.shared.add(statement.name)
        elif isinstance(statement, Assign):
            self._preset(module, statement, shipped)
        else:
            self.define(statement, module.cells)
            if isinstance(statement, SignalDeclaration):
                module.shared.add(statement.name)

    def _preset(self, module: Module, statement: Assign, shipped: bool) -> None:
        """``XP[3]={…}`` and ``NAME[]="…"`` in a data list."""
        target = statement.target
        cell = module.cells.get(target.name)
        if cell is None:
            if target.name.startswith("$"):
                return
            cell = module.cells[target.name] = Variable(target.text, shipped=shipped)
        pending = Pending(statement.value, module.stem)
        indices = [step for step in target.path if isinstance(step, tuple)]
        index = _constant_indices(indices[0]) if len(target.path) == 1 and indices else ()
        if index == ():
            if len(target.path) <= 1:
                cell.value = pending
            return
        if not isinstance(cell.value, Array):
            cell.value = Array(cell.type, (None,) * len(index))
        cell.value.items[index] = pending

    def define(self, statement: Statement, cells: dict[str, Variable]) -> None:
        """A structure, an enumeration (whose constants need none) or a signal."""
        if isinstance(statement, StrucDefinition):
            self.types[statement.name] = {
                name: type_ if not dimensions else ""
                for type_, name, dimensions in statement.components
            }
        elif isinstance(statement, SignalDeclaration):
            signal = (statement.first, statement.last)
            cells[statement.name] = Variable(statement.text, signal=signal)
        elif not isinstance(statement, EnumDefinition):
            return

    def cell(self, declaration: Declaration, module: Module) -> Variable:
        """The cell of a declaration, with nothing assigned to it yet.

        Raises:
            SourceError: an array's size is no whole number above zero, or too large.
        """
        type_name = declaration.type
        value: Value | None = None
        sizes = declaration.dimensions
        if sizes and not (type_name == "char" and len(sizes) == 1):
            found = tuple(self._size(size, module) for size in sizes)
            value = Array(type_name, found)
        elif not sizes and type_name != "char":
            made = default(type_name, self.types)
            value = made if isinstance(made, Struct) else None
        return Variable(declaration.text, type_name, value, declaration.constant)

    def _size(self, size: Expression | None, module: Module) -> int | None:
        if size is None:
            return None
        value: object = size.value if isinstance(size, Number) else None
        if isinstance(size, Name):
            cell = module.cells.get(size.name)
            pending = cell.value if cell is not None else None
            if isinstance(pending, Pending) and isinstance(pending.expression, Number):
                value = pending.expression.value
            else:
                return None
        if not isinstance(value, int) or not 1 <= value <= _LARGEST:
            raise SourceError(f"an array has 1 to {_LARGEST} items", size.span)
        return value


def _constant_indices(indices: tuple[Expression | None, ...]) -> tuple[int, ...]:
    return tuple(i.value for i in indices if isinstance(i, Number) and isinstance(i.value, int))
