"""KRL's declarations and constants: names, types, components, ranges."""

from __future__ import annotations

from dataclasses import dataclass, field

from lark import Token, Tree

from .check import refuse
from .krl_tables import AXIS_TARGETS, CONFIG, ENUMERATIONS, ROUTINES, STRUCTURES, TARGETS

LARGEST = {"REAL": 3.4e38, "INT": 2**31 - 1}


@dataclass
class Scope:
    """Names in force, in upper case, each with its type (None where that does not matter)."""

    data: dict[str, str | None]
    structures: dict[str, dict[str, str]] = field(default_factory=lambda: dict(STRUCTURES))
    enumerations: dict[str, set[str]] = field(
        default_factory=lambda: {k: set(v.split()) for k, v in ENUMERATIONS.items()}
    )
    routines: dict[str, tuple[int, int]] = field(default_factory=lambda: dict(ROUTINES))


def tokens(tree: Tree, kind: str) -> list[Token]:
    return [c for c in tree.children if isinstance(c, Token) and c.type == kind]


def enter(entry: Tree, scope: Scope) -> None:
    """Take in a declaration, of a data list or a routine."""
    match entry.data:
        case "struc":
            _structure(entry, scope)
        case "enum":
            name, *values = tokens(entry, "NAME")
            scope.enumerations[name.upper()] = {f"#{v.upper()}" for v in values}
        case "signal":
            _new(scope, tokens(entry, "NAME")[0], None)
        case "external":
            scope.routines[tokens(entry, "NAME")[-1].upper()] = (0, 99)
        case "data":
            kind = _kind(entry, scope)
            for declared in (c for c in entry.children if isinstance(c, Tree)):
                if declared.data == "declared":
                    _new(scope, declared.children[0], kind)
            names = tokens(entry, "NAME")
            if names:  # a data list's single name, with its value
                _new(scope, names[0], kind)
                check_constant(entry.children[-1], kind, scope, whole=True)
        case "element":
            name = entry.children[0]
            if name.upper() not in scope.data:
                raise refuse(name, "not declared")
            check_constant(entry.children[-1], scope.data[name.upper()], scope, whole=True)


def _kind(entry: Tree, scope: Scope) -> str:
    for child in entry.children:
        if isinstance(child, Token) and child.type == "TYPE":
            return child.upper()
        if isinstance(child, Tree) and child.data == "type":
            kind = child.children[0].upper()
            known = {"INT", "REAL", "BOOL", "CHAR", "BASIS_SUGG_T", "CB"}
            if (
                kind not in known
                and kind not in scope.structures
                and kind not in scope.enumerations
            ):
                raise refuse(child.children[0], "no such type")
            return str(kind)
    raise refuse(entry, "a declaration without a type")


def _structure(entry: Tree, scope: Scope) -> None:
    fields, kind = {}, None
    for part in (c for c in entry.children if isinstance(c, Tree) and c.data == "field"):
        types = [c for c in part.children if isinstance(c, Tree) and c.data == "type"]
        kind = str(types[0].children[0].upper()) if types else kind
        fields[tokens(part, "NAME")[0].upper()] = kind
    scope.structures[tokens(entry, "NAME")[0].upper()] = fields


def _new(scope: Scope, name: Token, kind: str | None) -> None:
    if name.startswith("$"):
        raise refuse(name, "names with $ are the system's")
    if name.upper() in scope.data and name.upper() not in CONFIG:
        raise refuse(name, "declared twice")
    scope.data[name.upper()] = kind


def check_constant(value: object, kind: str | None, scope: Scope, whole: bool = False) -> None:
    """A constant of the type.

    Args:
        whole: a datum that is driven to or set whole has all its Cartesian or axis components.
    """
    if kind is None or (isinstance(value, Token) and value.type in ("NAME", "TYPE")):
        return
    if isinstance(value, Tree) and value.data in ("dimensions", "type"):
        return
    if isinstance(value, Tree) and value.data == "aggregate":
        check_aggregate(value, kind, scope, whole)
        return
    number = number_of(value)
    if number is not None:
        if kind not in LARGEST:
            raise refuse(value, f"a number where {kind} is expected")
        if abs(number) > LARGEST[kind]:
            raise refuse(value, f"too large for {kind}")
        if kind == "INT" and number != round(number):
            raise refuse(value, "a whole number is expected")
        return
    found = {"STRING": "CHAR", "BITS": "INT"}.get(getattr(value, "type", ""))
    if isinstance(value, Token) and value.type == "ENUMERATOR":
        values = scope.enumerations.get(kind)
        if values is None or value.upper() not in values:
            raise refuse(value, f"no value of {kind}")
        return
    if isinstance(value, Tree) and value.data == "boolean":
        found = "BOOL"
    if found is not None and found != kind:
        raise refuse(value, f"{found} where {kind} is expected")


def number_of(value: object) -> float | None:
    if isinstance(value, Tree) and value.data == "number":
        return float(value.children[0])
    if isinstance(value, Tree) and value.data == "negative":
        return -float(value.children[1]) if value.children[0] == "-" else float(value.children[1])
    if isinstance(value, Tree) and value.data == "signed" and value.children[0] in ("+", "-"):
        inner = number_of(value.children[1])
        return inner if inner is None or value.children[0] == "+" else -inner
    return None


def check_aggregate(value: Tree, kind: str, scope: Scope, whole: bool) -> None:
    parts = scope.structures.get(kind)
    if parts is None:
        raise refuse(value, f"an aggregate where {kind} is expected")
    named = [c for c in value.children if isinstance(c, Token)]
    if named and named[0].upper() != kind:
        raise refuse(named[0], f"{kind} is expected")
    seen = set()
    for member in (c for c in value.children if isinstance(c, Tree)):
        name = member.children[0].upper()
        if name not in parts or name in seen:
            raise refuse(member.children[0], f"no component of {kind}, or twice")
        seen.add(name)
        check_constant(member.children[-1], parts[name], scope, whole)
    needed = {n for n in parts if n in "XYZABC" or n in ("A1", "A2", "A3", "A4", "A5", "A6")}
    if whole and kind in TARGETS | AXIS_TARGETS and not needed <= seen:
        raise refuse(value, f"{', '.join(sorted(needed - seen))} missing")
    for name, low, high in (("S", 0, 31), ("T", 0, 4095)):
        for member in (c for c in value.children if isinstance(c, Tree)):
            number = number_of(member.children[-1])
            named = member.children[0].upper() == name and number is not None
            if named and not low <= number <= high:
                raise refuse(member, f"{name} is {low} to {high}")
