"""What a UR controller checks beyond the grammar when it compiles and runs a program."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from lark import Token, Tree

from .check import Refused, parse, plain, refuse, texts_of
from .urscript_tables import LISTS, NOT_NEGATIVE, POSES, POSITIVE, SIGNATURES

LINE_LENGTH = 1024  # no limit is published for files; a backstop against runaway lines
LARGEST_INTEGER = 2**31 - 1
"Integers have 32 bits (Script Manual, Numbers, Variables, and Types)."


@dataclass(frozen=True)
class Signature:
    """Parameters in order, and how many of them have no default."""

    parameters: tuple[str, ...]
    required: int


def check_urscript(sources: Mapping[str, str]) -> None:
    """Every script by itself.

    Raises:
        Refused: the controller would not compile it, or stop at its start.
    """
    files = texts_of(sources, ".script")
    if not files:
        raise Refused("there is no script")
    for file, text in files.items():
        plain(file, text, LINE_LENGTH)
        tree = parse("urscript", file, text if text.endswith("\n") else text + "\n")
        _check_program(tree)


@cache
def functions() -> dict[str, Signature]:
    """The manual's functions."""
    table = {}
    for line in SIGNATURES.strip().splitlines():
        name, _, rest = line.partition("(")
        parameters = [part.strip() for part in rest.rstrip(")").split(",") if part.strip()]
        required = sum("=" not in part for part in parameters)
        table[name] = Signature(tuple(p.split("=")[0] for p in parameters), required)
    return table


def _check_program(tree: Tree) -> None:
    programs = [c for c in tree.children if isinstance(c, Tree) and c.data == "function"]
    if not programs:
        raise Refused("a program is a function, def name(): … end")
    known = dict(functions())
    for function in tree.iter_subtrees():
        if function.data in ("function", "thread", "section"):
            name = function.children[0]
            if name in functions() or (name in known):
                raise refuse(name, "the name is taken")
            known[name] = _signature(function)
    names = {str(name) for name in _assigned(tree)}
    for function in tree.find_data("parameter"):
        names.add(str(function.children[0]))
    for name in names & set(functions()):
        raise Refused(f"{name} is a function of URScript and cannot be a variable")
    for variable in _plain_variables(tree):
        name = variable.children[0]
        if name not in names and name not in known:
            raise refuse(name, "never assigned")
    _check_order(programs[-1], names)
    for call in tree.find_data("call"):
        _check_call(call, known)
    for number in tree.find_data("number"):
        _check_number(number)
    for statement in tree.find_data("variable"):
        if statement.children[0] in ("end", "def"):
            raise refuse(statement.children[0], "a keyword")


def _signature(function: Tree) -> Signature:
    lists = [c for c in function.children if isinstance(c, Tree) and c.data == "parameters"]
    entries = lists[0].children if lists else []
    required = sum(len(entry.children) == 1 for entry in entries)
    return Signature(tuple(str(entry.children[0]) for entry in entries), required)


def _assigned(tree: Tree) -> Iterator[Token]:
    for assignment in tree.find_data("assignment"):
        target = next(c for c in assignment.children if isinstance(c, Tree))
        if len(target.children) == 1:
            yield target.children[0]


def _plain_variables(tree: Tree) -> Iterator[Tree]:
    callees = {id(call.children[0]) for call in tree.find_data("call")}
    return (v for v in tree.find_data("variable") if id(v) not in callees)


def _check_order(program: Tree, names: set[str]) -> None:
    """In the program's own straight run, a name is assigned before it is read."""
    seen: set[str] = set()
    for statement in (c for c in program.children if isinstance(c, Tree)):
        for value in _read_first(statement):
            for variable in _plain_variables(value):
                name = variable.children[0]
                if name in names and name not in seen and name not in _outer(program):
                    raise refuse(name, "read before it is assigned")
        seen |= {str(name) for name in _assigned(statement)}


def _read_first(statement: Tree) -> list[Tree]:
    """The expressions that a statement certainly evaluates before it assigns."""
    parts = [c for c in statement.children if isinstance(c, Tree)]
    if statement.data == "assignment":
        return parts[1:]
    if statement.data in ("if_block", "while_block"):
        return parts[:1]
    return parts if statement.data == "call_statement" else []


def _outer(program: Tree) -> set[str]:
    """Names that functions and threads of the program assign."""
    inner = [
        c for c in program.children if isinstance(c, Tree) and c.data in ("function", "thread")
    ]
    return {str(name) for part in inner for name in _assigned(part)}


def _check_call(call: Tree, known: Mapping[str, Signature]) -> None:
    callee = call.children[0]
    name = callee.children[0]
    if len(callee.children) > 1:
        return  # a method of a handle, such as one of a remote procedure
    if name not in known:
        raise refuse(name, "no such function")
    signature = known[name]
    given = _bind(call, name, signature)
    for parameter in signature.parameters[: signature.required]:
        if parameter not in given:
            raise refuse(name, f"argument {parameter} is missing")
    if functions().get(name) == signature:
        _check_values(name, given)


def _bind(call: Tree, name: Token, signature: Signature) -> dict[str, Tree]:
    given: dict[str, Tree] = {}
    arguments = call.children[1].children if len(call.children) > 1 else []
    keyed = False
    for position, argument in enumerate(arguments):
        if len(argument.children) == 2:
            keyed, parameter = True, str(argument.children[0])
            if parameter not in signature.parameters:
                raise refuse(name, f"no argument {parameter}")
        else:
            if keyed:
                raise refuse(name, "an argument by position after one by name")
            if position >= len(signature.parameters):
                raise refuse(name, f"{len(signature.parameters)} arguments at most")
            parameter = signature.parameters[position]
        if parameter in given:
            raise refuse(name, f"argument {parameter} twice")
        given[parameter] = argument.children[-1]
    return given


def _check_values(name: str, given: Mapping[str, Tree]) -> None:
    for parameter, value in given.items():
        number = _literal(value)
        if number is not None:
            if parameter in POSITIVE.get(name, ()) and number <= 0:
                raise refuse(value, f"{name}: {parameter} is above zero")
            if parameter in NOT_NEGATIVE.get(name, ()) and number < 0:
                raise refuse(value, f"{name}: {parameter} is not below zero")
        if parameter in LISTS.get(name, ()):
            _check_six(name, parameter, value)
    mode = _literal(given["mode"]) if "mode" in given else 0
    if name == "movec" and mode not in (0, 1, None):
        raise Refused("movec: mode is 0 or 1")


def _check_six(name: str, parameter: str, value: Tree) -> None:
    if value.data == "list":
        if parameter in POSES.get(name, ()):
            raise refuse(value, f"{name}: {parameter} is a pose, p[…]")
        if len(value.children) != 6:
            raise refuse(value, f"{name}: {parameter} has six values")
    elif value.data in ("number", "string", "boolean"):
        raise refuse(value, f"{name}: {parameter} is a list or a pose")


def _literal(tree: Tree) -> float | None:
    if tree.data == "number":
        text = str(tree.children[0])
        return float(int(text, 0)) if text[:2].lower() in ("0x", "0b") else float(text)
    if tree.data == "signed" and tree.children[0] in ("+", "-"):
        inner = _literal(tree.children[1])
        return inner if inner is None or tree.children[0] == "+" else -inner
    return None


def _check_number(number: Tree) -> None:
    value = _literal(number)
    token = number.children[0]
    if value is None or not math.isfinite(value) or abs(value) > 3.4e38:
        raise refuse(token, "the number is too large")
    if token.type == "INTEGER" and value > LARGEST_INTEGER:
        raise refuse(token, "an integer has 32 bits")
