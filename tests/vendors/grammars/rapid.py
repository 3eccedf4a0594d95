"""What a RAPID controller checks beyond the grammar when it loads modules."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache

from lark import Token, Tree

from .check import Refused, parse, plain, refuse, texts_of
from .rapid_tables import (
    ATOMS,
    FUNCTIONS,
    INSTRUCTIONS,
    PERSISTENT,
    PREDEFINED,
    RECORDS,
    SAME,
)

NAME_LENGTH = 32  # RAPID kernel, Identifiers
STRING_LENGTH = 80  # RAPID Overview, Data types: string
LINE_LENGTH = 512  # no limit is published; a backstop against runaway lines
LARGEST = 3.40282347e38  # num: single precision
HANDLES = ("triggdata", "clock", "iodev", "intnum")


@dataclass(frozen=True)
class Slot:
    """A place in an instruction's argument list; several names exclude each other."""

    names: tuple[str, ...]
    types: tuple[str | None, ...]
    optional: bool


@dataclass
class Scope:
    """Names in force: lower case to type; routines to their parameter lists."""

    data: dict[str, str]
    persistent: set[str] = field(default_factory=set)
    routines: dict[str, tuple[Slot, ...]] = field(default_factory=dict)
    functions: dict[str, str] = field(default_factory=dict)
    records: dict[str, dict[str, str]] = field(default_factory=lambda: dict(RECORDS))


def check_rapid(sources: Mapping[str, str]) -> None:
    """The modules of one task, or of several that each have an entry.

    Raises:
        Refused: the controller would not load them.
    """
    files = {
        f: t for s in (".mod", ".modx", ".sys", ".prg") for f, t in texts_of(sources, s).items()
    }
    if not files:
        raise Refused("there is no module")
    trees = {}
    for file, text in files.items():
        plain(file, text, LINE_LENGTH)
        trees[file] = parse("rapid", file, text)
    modules = [tree.children[-1] for tree in trees.values()]
    entries = [module for module in modules if "main" in _procedures(module)]
    if not entries:
        raise Refused("there is no routine 'main'")
    if len(entries) == 1:
        _check_task(modules)
        return
    shared = [module for module in modules if module not in entries]
    for module in entries:  # each is a task of its own
        _check_task([module, *shared])


def _procedures(module: Tree) -> set[str]:
    return {str(p.children[0].lower()) for p in module.find_data("procedure_declaration")}


def _check_task(modules: list[Tree]) -> None:
    scope = Scope(dict(PREDEFINED))
    for module in modules:
        _declare(module, scope)
    for module in modules:
        _check_module(module, scope)


def _declare(module: Tree, scope: Scope) -> None:
    """Take in a module's global names."""
    for token in module.scan_values(lambda v: isinstance(v, Token) and v.type == "NAME"):
        if len(token) > NAME_LENGTH:
            raise refuse(token, f"a name has {NAME_LENGTH} characters at most")
    _new(scope, module.children[0], "module")
    for definition in module.find_data("record_definition"):
        name, *components = definition.children
        _new(scope, name, "type")
        scope.records[name.lower()] = {
            c.children[1].lower(): c.children[0].lower() for c in components
        }
    for declaration in (c for c in _trees(module) if c.data == "data_declaration"):
        _declare_data(declaration.children[-1], scope, declaration)
    for declaration in (c for c in _trees(module) if c.data == "routine_declaration"):
        routine = declaration.children[-1]
        names = [c for c in routine.children if isinstance(c, Token)]
        _new(scope, names[-1], "routine")
        slots = _parameters(routine)
        if routine.data == "function_declaration":
            scope.functions[names[-1].lower()] = names[0].lower()
        elif routine.data == "procedure_declaration":
            scope.routines[names[-1].lower()] = slots


def _trees(tree: Tree) -> Iterator[Tree]:
    return (c for c in tree.children if isinstance(c, Tree))


def _new(scope: Scope, name: Token, kind: str) -> None:
    key = name.lower()
    taken = key in scope.data or key in scope.routines or key in scope.functions
    if taken or key in instructions() or key in FUNCTIONS:
        raise refuse(name, "the name is taken")
    scope.data[key] = kind


def _declare_data(tree: Tree, scope: Scope, where: Tree) -> None:
    kind, name = (c for c in tree.children if isinstance(c, Token))
    kind_key = kind.lower()
    if kind_key not in ATOMS and kind_key not in scope.records:
        raise refuse(kind, "no such type")
    _new(scope, name, kind_key)
    persistent = tree.data == "persistent_declaration"
    if persistent:
        scope.persistent.add(name.lower())
    elif kind_key in PERSISTENT:
        raise refuse(name, f"{kind_key} is declared PERS")
    dimensions = [c for c in _trees(tree) if c.data == "dimensions"]
    values = [c for c in _trees(tree) if c.data != "dimensions"]
    if persistent and not values:
        raise refuse(where, "a persistent has an initial value")
    if values:
        _check_value(values[0], kind_key, scope, len(dimensions[0].children) if dimensions else 0)


def _parameters(routine: Tree) -> tuple[Slot, ...]:
    slots = []
    for entry in (p for t in _trees(routine) if t.data == "parameter_list" for p in _trees(t)):
        optional = entry.data == "optional_parameter"
        choices = list(_trees(entry)) if optional else [entry]
        pairs = [[c for c in choice.children if c.type == "NAME"] for choice in choices]
        names = tuple(name.lower() for _, name in pairs)
        types = tuple(None if kind.lower() == "switch" else kind.lower() for kind, _ in pairs)
        slots.append(Slot(names, types, optional))
    return tuple(slots)


@cache
def instructions() -> dict[str, tuple[Slot, ...]]:
    """The manual's argument lists."""
    table = {}
    for line in INSTRUCTIONS.strip().splitlines():
        name, *slots = line.split(" ")
        table[name.lower()] = tuple(map(_slot, slots))
    return table


def _slot(text: str) -> Slot:
    optional = text.startswith("[")
    parts = [part.strip("[]\\").split(":") for part in text.split("|")]
    names = tuple(part[0].lower() for part in parts)
    return Slot(names, tuple(part[1] if len(part) > 1 else None for part in parts), optional)


def _check_module(module: Tree, scope: Scope) -> None:
    for declaration in (c for c in _trees(module) if c.data == "routine_declaration"):
        _check_routine(declaration.children[-1], scope)


def _check_routine(routine: Tree, scope: Scope) -> None:
    local = Scope(
        dict(scope.data), set(scope.persistent), scope.routines, scope.functions, scope.records
    )
    own: set[str] = set()

    def add(name: Token, kind: str) -> None:
        if name.lower() in own:
            raise refuse(name, "declared twice in this routine")
        own.add(name.lower())
        local.data[name.lower()] = kind

    for parameter in routine.find_data("parameter"):
        kind, name = (c for c in parameter.children if c.type == "NAME")
        add(name, kind.lower())
        local.persistent.add(name.lower())
    for declaration in (c for c in _trees(routine) if c.data == "routine_data"):
        kind, name = (c for c in declaration.children[0].children if isinstance(c, Token))
        if kind.lower() not in ATOMS and kind.lower() not in scope.records:
            raise refuse(kind, "no such type")
        add(name, kind.lower())
        values = [c for c in _trees(declaration.children[0]) if c.data != "dimensions"]
        if values:
            dims = [c for c in _trees(declaration.children[0]) if c.data == "dimensions"]
            _check_value(values[0], kind.lower(), local, len(dims[0].children) if dims else 0)
    for label in routine.find_data("label"):
        add(label.children[0], "label")
    for loop in routine.find_data("for_statement"):
        local.data[loop.children[0].lower()] = "num"
    for jump in routine.find_data("goto_statement"):
        if local.data.get(jump.children[0].lower()) != "label":
            raise refuse(jump.children[0], "no such label")
    for call in routine.find_data("procedure_call"):
        _check_call(call, local)
    for assignment in routine.find_data("assignment"):
        kind = _type_of(assignment.children[0], local)
        if kind is not None:
            _check_value(assignment.children[1], kind, local, 0)
    for tree in routine.iter_subtrees():
        if tree.data in ("variable", "function_call", "string", "number"):
            _type_of(tree, local)


def _check_call(call: Tree, scope: Scope) -> None:
    name = call.children[0]
    if isinstance(name, Tree):  # late binding: known at run time only
        return
    slots = instructions().get(name.lower(), scope.routines.get(name.lower()))
    if slots is None:
        raise refuse(name, "neither an instruction nor a procedure of the program")
    arguments = list(_trees(call.children[1])) if len(call.children) > 1 else []
    at = 0
    for argument in arguments:
        at = _place(argument, slots, at, name, scope) + 1
    for slot in slots[at:]:
        if not slot.optional:
            raise refuse(name, f"argument {slot.names[0]} is missing")


def _place(argument: Tree, slots: tuple[Slot, ...], at: int, name: Token, scope: Scope) -> int:
    """The slot that an argument fills; slots keep their order."""
    wanted = argument.children[0].lower() if argument.data != "required" else None
    for index in range(at, len(slots)):
        slot = slots[index]
        if wanted is None and not slot.optional:
            _check_value(argument.children[-1], slot.types[0], scope, 0)
            return index
        if wanted is not None and slot.optional and wanted in slot.names:
            kind = slot.types[slot.names.index(wanted)]
            has_value = len(argument.children) > 1
            if argument.data == "optional" and has_value != (kind is not None):
                raise refuse(name, f"\\{wanted} {'is a switch' if has_value else 'needs a value'}")
            if has_value and argument.data == "optional":
                _check_value(argument.children[1], kind, scope, 0)
            return index
        if not slot.optional:
            break
    raise refuse(name, f"argument {wanted or 'without a name'} has no place here")


def _same(kind: str) -> str:
    return SAME.get(kind, kind)


def _check_value(tree: Tree, kind: str | None, scope: Scope, dimensions: int) -> None:
    """A value of the type, or of an array of it."""
    if dimensions:
        if tree.data != "aggregate":
            raise refuse(tree, "an array's value is an aggregate")
        for child in tree.children:
            _check_value(child, kind, scope, dimensions - 1)
        return
    if kind is None or kind in HANDLES:
        return
    if tree.data == "aggregate":
        components = scope.records.get(kind)
        if components is None or len(components) != len(tree.children):
            raise refuse(tree, f"{len(tree.children)} components do not make a {kind}")
        for child, part in zip(tree.children, components.values(), strict=True):
            _check_value(child, part, scope, 0)
        _check_numbers(tree, kind)
        return
    found = _type_of(tree, scope)
    if found is not None and _same(found) != _same(kind) and not _signal_by_value(found, kind):
        raise refuse(tree, f"{found} where {kind} is expected")
    if kind in PERSISTENT and tree.data == "variable":
        name = tree.children[0].lower()
        if name not in scope.persistent and name not in PREDEFINED:
            raise refuse(tree.children[0], f"{kind} is declared PERS")


def _signal_by_value(found: str, kind: str) -> bool:
    return {found, kind} <= {"num", "dnum"}


def _check_numbers(tree: Tree, kind: str) -> None:
    """Ranges that the data types state, where the numbers are literals."""
    values = [_literal(child) for child in tree.children]
    unit = kind != "orient" or None in values or abs(math.hypot(*values) - 1.0) <= 1e-3
    if not unit:  # "must be normalised"
        raise refuse(tree, "the quaternion is not normalised")
    if kind == "speeddata" and any(v is not None and v < 0 for v in values):
        raise refuse(tree, "a speed is below zero")
    if kind == "zonedata":
        if any(v is not None and v < 0 for v in values[1:]):
            raise refuse(tree, "a zone is below zero")
        tcp, others = values[1], values[2:4]
        if tcp is not None and any(v is not None and v < tcp for v in others):
            raise refuse(tree, "pzone_ori and pzone_eax are at least pzone_tcp")
    if kind == "confdata":
        if any(v is not None and v != round(v) for v in values):
            raise refuse(tree, "configurations are whole numbers")
        if values[3] is not None and not 0 <= values[3] <= 7:
            raise refuse(tree, "cfx is 0 to 7")
    if kind == "loaddata" and values[0] is not None and values[0] <= 0:
        raise refuse(tree, "a load's mass is above zero")


def _literal(tree: Tree) -> float | None:
    if tree.data == "number" and re.fullmatch(r"[0-9.eE+-]+", tree.children[0]):
        return float(tree.children[0])
    if tree.data == "signed":
        inner = _literal(tree.children[1])
        return inner if inner is None or tree.children[0] == "+" else -inner
    return None


def _type_of(tree: Tree, scope: Scope) -> str | None:
    """The type of an expression as far as it is plain; None if not.

    Raises:
        Refused: a name is not declared, a number too large, a string too long.
    """
    match tree.data:
        case "number":
            value = _literal(tree)
            if value is not None and value > LARGEST:
                raise refuse(tree, "the number is too large for num")
            return "num"
        case "string":
            if len(tree.children[0]) - 2 > STRING_LENGTH:
                raise refuse(tree, f"a string has {STRING_LENGTH} characters at most")
            return "string"
        case "boolean":
            return "bool"
        case "signed" | "group":
            return _type_of(tree.children[-1], scope)
        case "variable":
            kind = scope.data.get(tree.children[0].lower())
            if kind is None or kind in ("module", "type", "routine", "label"):
                if tree.children[0].lower() in scope.functions:
                    return None
                raise refuse(tree.children[0], "not declared")
            return kind
        case "element":
            return _type_of(tree.children[0], scope)
        case "component":
            kind = _type_of(tree.children[0], scope)
            if kind is None:
                return None
            part = scope.records.get(kind, {}).get(tree.children[1].lower())
            if part is None:
                raise refuse(tree.children[1], f"{kind} has no such component")
            return part
        case "function_call":
            name = tree.children[0].lower()
            if name not in FUNCTIONS and name not in scope.functions:
                raise refuse(tree.children[0], "no such function")
            return scope.functions.get(name, FUNCTIONS.get(name))
    return None
