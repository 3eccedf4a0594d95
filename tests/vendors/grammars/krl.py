"""What a KSS controller checks beyond the grammar when it loads and starts a program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import PurePath

from lark import Token, Tree

from .check import Refused, parse, plain, refuse, texts_of
from .krl_declarations import (
    Scope,
    check_aggregate,
    check_constant,
    enter,
    number_of,
    tokens,
)
from .krl_tables import (
    ARRAYS,
    AXIS_TARGETS,
    CONFIG,
    ENUMERATIONS,
    RANGES,
    READ_ONLY,
    ROUTINES,
    SYSTEM,
    TARGETS,
)

NAME_LENGTH = 24  # Quickguide KRL-Syntax, "Names in KRL"
LINE_LENGTH = 512  # no limit is published; a backstop against runaway lines
CRITERIA = {"C_DIS": "$APO.CDIS", "C_ORI": "$APO.CORI", "C_VEL": "$APO.CVEL", "C_PTP": "$APO.CPTP"}


def check_krl(sources: Mapping[str, str]) -> None:
    """Source files with their data lists.

    Raises:
        Refused: the controller would not load or start them.
    """
    # A .sub runs in the submit interpreter; its text is that of a source file.
    src = texts_of(sources, ".src") | texts_of(sources, ".sub")
    dat = texts_of(sources, ".dat")
    if not src:
        raise Refused("there is no source file")
    trees: dict[str, tuple[Tree, Tree | None]] = {}
    lists = {_stem(file): (file, text) for file, text in dat.items()}
    for file, text in src.items():
        plain(file, text, LINE_LENGTH)
        tree, data = parse("krl_src", file, _ended(text)), None
        if _stem(file) in lists:
            name, inner = lists.pop(_stem(file))
            plain(name, inner, LINE_LENGTH)
            data = parse("krl_dat", name, _ended(inner))
        trees[file] = tree, data
    if lists:
        raise Refused(f"{', '.join(lists)}: a data list without its source file")
    public = Scope({})
    for file, (tree, data) in trees.items():
        _check_names(file, tree, data)
        first = _routines(tree)[0]
        public.routines[_routine_name(first).upper()] = _arity(first)
        if data is not None:
            _enter_globals(data, public)
    for tree, data in trees.values():
        _check_module(tree, data, public)


def _enter_globals(data: Tree, public: Scope) -> None:
    """What a data list lends to other modules."""
    for entry in data.children:
        if isinstance(entry, Tree) and tokens(entry, "GLOBAL"):
            if not tokens(data, "PUBLIC"):
                raise refuse(entry, "GLOBAL needs a data list that is PUBLIC")
            enter(entry, public)


def _stem(file: str) -> str:
    return PurePath(file).stem.upper()


def _ended(text: str) -> str:
    return text if text.endswith("\n") else text + "\n"


def _routines(tree: Tree) -> list[Tree]:
    return [routine.children[0] for routine in _in_order(tree, "routine")]


def _in_order(tree: Tree, *kinds: str) -> Iterator[Tree]:
    """Subtrees in the order of the text."""
    for child in tree.children:
        if isinstance(child, Tree):
            if child.data in kinds:
                yield child
            yield from _in_order(child, *kinds)


def _routine_name(routine: Tree) -> Token:
    return tokens(routine, "NAME")[-1]


def _arity(routine: Tree) -> tuple[int, int]:
    lists = [c for c in routine.children if isinstance(c, Tree) and c.data == "parameters"]
    return 0, len(lists[0].children) if lists else 0


def _check_names(file: str, tree: Tree, data: Tree | None) -> None:
    for part in (tree, data):
        if part is None:
            continue
        for token in part.scan_values(lambda v: isinstance(v, Token) and v.type == "NAME"):
            if len(token) > NAME_LENGTH:
                raise refuse(token, f"a name has {NAME_LENGTH} characters at most")
    first = _routines(tree)[0]
    if _routine_name(first).upper() != _stem(file):
        raise refuse(_routine_name(first), f"the first routine of {file} is called as the file")
    if data is not None and tokens(data, "NAME")[0].upper() != _stem(file):
        raise refuse(tokens(data, "NAME")[0], f"the data list of {file} is called as the file")


def _check_module(tree: Tree, data: Tree | None, public: Scope) -> None:
    scope = Scope(
        {**SYSTEM, **CONFIG, **public.data},
        dict(public.structures),
        dict(public.enumerations),
        dict(public.routines),
    )
    if data is not None:
        for entry in data.children:
            if isinstance(entry, Tree) and not tokens(entry, "GLOBAL"):
                enter(entry, scope)
    own: set[str] = set()
    for routine in _routines(tree):
        name = _routine_name(routine)
        if name.upper() in own or name.upper() in ROUTINES:
            raise refuse(name, "the name is taken")
        own.add(name.upper())
        scope.routines[name.upper()] = _arity(routine)
    for routine in _routines(tree):
        _check_routine(routine, scope)


def _check_routine(routine: Tree, module: Scope) -> None:
    scope = Scope(
        dict(module.data),
        dict(module.structures),
        dict(module.enumerations),
        dict(module.routines),
    )
    local = Scope({}, scope.structures, scope.enumerations, scope.routines)
    kinds: dict[str, str | None] = {}
    for parameter in _in_order(routine, "parameter"):
        kinds[parameter.children[0].upper()] = None
    for child in routine.children:
        if isinstance(child, Tree):
            enter(child, local)
    for name, kind in local.data.items():
        if name in kinds:
            kinds[name] = kind
            continue
        if name in scope.data:
            raise Refused(f"{name}: declared in the data list as well")
        scope.data[name] = kind
    scope.data.update(kinds)
    _check_labels(routine)
    for tree in _in_order(routine, "variable", "call", "call_statement"):
        if tree.data == "variable":
            _type_of(tree, scope)
        else:
            _check_call(tree, scope)
    _check_settings(routine, scope)


def _check_labels(routine: Tree) -> None:
    labels = [t.children[0].upper() for t in _in_order(routine, "label")]
    if len(labels) != len(set(labels)):
        raise refuse(routine, "a label stands twice")
    for jump in _in_order(routine, "goto"):
        if jump.children[0].upper() not in labels:
            raise refuse(jump.children[0], "no such label")


def _type_of(variable: Tree, scope: Scope) -> str | None:
    """The type of a variable, component by component."""
    parts: list[Token] = [c for c in variable.children if isinstance(c, Token)]
    name = parts[0].upper()
    if name not in scope.data:
        raise refuse(parts[0], "not declared")
    kind = scope.data[name]
    _check_index(variable, name)
    for part in parts[1:]:
        if kind is None:
            return None
        components = scope.structures.get(kind)
        if components is None or part.upper() not in components:
            raise refuse(part, f"no component of {kind}")
        kind = components[part.upper()]
    return kind


def _check_index(variable: Tree, name: str) -> None:
    if name not in ARRAYS:
        return
    indices = [c for c in variable.children if isinstance(c, Tree)]
    if not indices:
        raise refuse(variable, f"{name} is an array")
    number = number_of(indices[0].children[0]) if indices[0].children else None
    if number is not None and not 1 <= number <= ARRAYS[name]:
        raise refuse(variable, f"{name} has elements 1 to {ARRAYS[name]}")


def _check_call(call: Tree, scope: Scope) -> None:
    name = call.children[0]
    if name.upper() not in scope.routines:
        if call.data == "call" and name.upper() in scope.data:
            return
        raise refuse(name, "no such routine")
    arguments = call.children[1].children
    _, most = scope.routines[name.upper()]
    if len(arguments) > most:
        raise refuse(name, f"{most} arguments at most")
    if name.upper() == "BAS":
        _check_bas(call, arguments)


def _check_bas(call: Tree, arguments: list[object]) -> None:
    command = arguments[0]
    if not (isinstance(command, Token) and command.upper() in ENUMERATIONS["BAS_COMMAND"].split()):
        raise refuse(call, "BAS takes one of its commands")
    number = number_of(arguments[1]) if len(arguments) > 1 else None
    ranges = {"#TOOL": (0, 16), "#BASE": (0, 32), "#VEL_PTP": (1, 100), "#ACC_PTP": (1, 100)}
    low, high = ranges.get(str(command.upper()), (0, 1e6))
    if number is None or not low <= number <= high:
        raise refuse(call, f"{command} takes {low} to {high}")


def _check_settings(routine: Tree, scope: Scope) -> None:
    """What must be set before it is used, in the order of the text."""
    done: set[str] = set()
    kinds = ("assignment", "call_statement", "ptp", "lin", "circ", "with_part")
    for statement in _in_order(routine, *kinds):
        if statement.data == "call_statement":
            if statement.children[0].upper() == "BAS":
                done |= {"$TOOL", "$BASE", "$VEL.CP", *CRITERIA.values(), "$VEL_AXIS", "$ACC.CP"}
        elif statement.data in ("assignment", "with_part"):
            for target, value in zip(
                statement.children[::2], statement.children[1::2], strict=True
            ):
                done |= _check_assignment(target, value, scope)
        else:
            _check_motion(statement, scope, done)


def _check_assignment(target: Tree, value: object, scope: Scope) -> set[str]:
    path = ".".join(c.upper() for c in target.children if isinstance(c, Token))
    kind = _type_of(target, scope)
    root = path.split(".")[0]
    if root in READ_ONLY:
        raise refuse(target, "the system sets this variable")
    whole = root in ("$TOOL", "$BASE", "TOOL_DATA", "BASE_DATA")
    indexed = any(isinstance(c, Tree) for c in target.children)
    if not (indexed and root not in SYSTEM and root not in CONFIG and kind == "CHAR"):
        check_constant(value, kind, scope, whole)
    if isinstance(value, Tree) and value.data == "variable":
        found = _type_of(value, scope)
        if None not in (kind, found) and found != kind and not _converts(found, kind):
            raise refuse(value, f"{found} where {kind} is expected")
    number = number_of(value)
    if number is not None and path in RANGES:
        low, high = RANGES[path]
        if not low <= number <= high:
            raise refuse(target, f"{path} is {low} to {high}, not {number}")
    if kind in ("CP", "APO") and isinstance(value, Tree) and value.data == "aggregate":
        return {f"{path}.{m.children[0].upper()}" for m in value.children if isinstance(m, Tree)}
    return {path}


def _converts(found: str | None, kind: str | None) -> bool:
    poses, numbers = TARGETS, {"INT", "REAL"}
    return {found, kind} <= poses or {found, kind} <= numbers or {found, kind} <= AXIS_TARGETS


def _check_motion(motion: Tree, scope: Scope, done: set[str]) -> None:
    targets = [
        c
        for c in motion.children
        if isinstance(c, Tree) and c.data in ("variable", "aggregate", "expr", "call", "group")
    ]
    relative = str(motion.children[0]).upper().endswith("_REL")
    count = 2 if motion.data == "circ" else 1
    for target in targets[:count]:
        _check_target(motion, target, scope, relative)
    if len(targets) < count:
        raise refuse(motion, "a target is missing")
    axes = motion.data == "ptp" and _target_kind(targets[0], scope) in AXIS_TARGETS
    for needed in () if axes else ("$TOOL", "$BASE"):
        if needed not in done:
            raise refuse(motion, f"{needed} is not set yet")
    if motion.data != "ptp" and "$VEL.CP" not in done:
        raise refuse(motion, "$VEL.CP is not set yet")
    for word in (c for c in motion.children if isinstance(c, Token)):
        if word.upper() in CRITERIA and CRITERIA[word.upper()] not in done:
            raise refuse(word, f"{CRITERIA[word.upper()]} is not set: there is no approximation")


def _target_kind(target: Tree, scope: Scope) -> str | None:
    if target.data == "variable":
        return _type_of(target, scope)
    if target.data == "aggregate":
        names = {m.children[0].upper() for m in target.children if isinstance(m, Tree)}
        return "E6AXIS" if "A1" in names or "A2" in names else "E6POS"
    return None


def _check_target(motion: Tree, target: Tree, scope: Scope, relative: bool) -> None:
    kind = _target_kind(target, scope)
    if kind is None:
        return
    allowed = TARGETS | AXIS_TARGETS if motion.data == "ptp" else TARGETS
    if kind not in allowed:
        raise refuse(motion, f"{motion.children[0]} does not drive to {kind}")
    if target.data == "aggregate":
        check_aggregate(target, kind, scope, whole=False)
