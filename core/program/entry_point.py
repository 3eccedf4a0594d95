"""Routines that a program may begin with."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..display import counted

ALL = "all"
"""In the place of an entry: each of them, one after the other."""
_CALL = re.compile(r"\s*([\w$.:]+)\s*\((.*)\)\s*", re.DOTALL)
_SHOWN = 12


@dataclass(frozen=True, slots=True)
class EntryPoint:
    """A routine that a program may begin with.

    Args:
        name: as it is declared.
        parameters: names of those that must be given.
        moves: statements in it, and in what it calls, that move the robot.
        begun: whether the program was begun with it.
    """

    name: str
    parameters: tuple[str, ...]
    moves: int
    begun: bool = False

    def __str__(self) -> str:
        arguments = f"({', '.join(self.parameters)})" if self.parameters else ""
        return f"{self.name}{arguments} ({counted(self.moves, 'move')})"


def listed(entries: Iterable[EntryPoint]) -> str:
    """Entries in a message, those that move the robot first."""
    found = sorted(entries, key=lambda entry: not entry.moves)
    more = f" and {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
    return ", ".join(map(str, found[:_SHOWN])) + more


def without_caller(name: str, parameters: Iterable[str]) -> str:
    """What is said of a routine with arguments that a program is begun with."""
    names = ", ".join(parameters)
    return (
        f"{name} is read without a caller: its arguments ({names}) have no values, unless a file "
        f"of answers gives them, or the entry: {name}({names}) with values in their places"
    )


def others_drive(entries: Sequence[EntryPoint]) -> bool:
    """Whether a program drives nothing because it was begun with a routine that never does."""
    return any(e.moves for e in entries) and not any(e.moves for e in entries if e.begun)


def entry_call(entry: str | None) -> tuple[str | None, str | None]:
    """A routine's name, and the text of its arguments: ``Pick(1, p10)``; None for none given."""
    found = None if entry is None else _CALL.fullmatch(entry)
    return (entry, None) if found is None else (found[1], found[2])
