"""Data of a running program: cells with values, and the names under which they are found."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..syntax.tree import DataList, Name, Routine
from .values import Pending, Value

Path = tuple[str | tuple[int, ...], ...]
"""Components, lower case, and evaluated indices of a part of a datum."""


@dataclass(eq=False, slots=True)
class Variable:
    """One datum.

    Args:
        name: as it stands in its declaration.
        type: lower-case name of its type, or of its items' type if it is an array.
        value: None until something is assigned.
        constant: a ``CONST``.
        signal: what a ``SIGNAL`` stands for: one system variable, or the first and last of several.
        shipped: it stands in the configuration that comes with this package.
        assigned: the program has assigned to it.
        found: how an interrupt's routine puts down in it where the robot is: ``pose`` or ``axes``.
        writer, awaited: see `core.source.execution.suppose.SharedDatum`.
        supposed: what its value depends on, if a way that was chosen by rule has set it.
    """

    name: str
    type: str = ""
    value: Value | Pending | None = None
    constant: bool = False
    signal: tuple[Name, Name | None] | None = None
    shipped: bool = False
    assigned: bool = False
    found: str | None = None
    writer: str | None = None
    awaited: bool = False
    supposed: str = ""


@dataclass(eq=False)
class Module:
    """A ``.src`` with its ``.dat``.

    Args:
        stem: file name without folder and suffix, lower case.
        routines: of the file, by lower-case name.
        lists: data lists, not yet declared.
        cells: data, once declared.
        shared: names of the data that are declared GLOBAL.
    """

    stem: str
    routines: dict[str, Routine] = field(default_factory=dict)
    lists: list[DataList] = field(default_factory=list)
    cells: dict[str, Variable] = field(default_factory=dict)
    shared: set[str] = field(default_factory=set)
    declared: bool = False


@dataclass(eq=False, slots=True)
class Scope:
    """The names of a routine.

    Args:
        where: for messages: ``DEF pick``.
        module: the file that it stands in.
        returns: the type of its value, None for a ``DEF``.
    """

    where: str
    module: Module
    cells: dict[str, Variable] = field(default_factory=dict)
    returns: str | None = None


def spelled(text: str, path: Path) -> str:
    """A datum with its evaluated indices, as ``TOOL_DATA[1].X``."""
    for step in path:
        text += f".{step.upper()}" if isinstance(step, str) else f"[{','.join(map(str, step))}]"
    return text
