"""Names of a running program and what they stand for."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Generic, Self, TypeVar

Cell = TypeVar("Cell")
"""What a language keeps of a datum."""


@dataclass(eq=False, slots=True)
class Scope(Generic[Cell]):
    """Names and their cells; what is not found is looked up in ``outer``.

    Args:
        where: for messages and notes: ``PROC pick``.
        cells: by name, as the language folds names.
        outer: the scope round it; None for the outermost.
    """

    where: str
    cells: dict[str, Cell] = field(default_factory=dict)
    outer: Self | None = None

    def find(self, name: str) -> Cell | None:
        """The cell that a name stands for."""
        scope: Scope[Cell] | None = self
        while scope is not None:
            cell = scope.cells.get(name)
            if cell is not None:
                return cell
            scope = scope.outer
        return None

    def outwards(self) -> Iterator[Self]:
        """This scope and all round it."""
        scope: Self | None = self
        while scope is not None:
            yield scope
            scope = scope.outer


def near_names(name: str, known: Iterable[str]) -> list[str]:
    """Names that are written nearly like one that nobody declares, the nearest first."""
    spelled = {other.casefold(): other for other in sorted(known, reverse=True)}
    spelled.pop(name.casefold(), None)
    return [spelled[near] for near in alike(name.casefold(), tuple(spelled), 3, 0.6)]


@lru_cache(maxsize=256)  # a loop misses the same name thousands of times
def alike(name: str, known: tuple[str, ...], most: int, share: float) -> tuple[str, ...]:
    """Names that have a share of their letters in common with one, the nearest first."""
    return tuple(difflib.get_close_matches(name, known, most, share))


def unknown_name(kind: str, name: str, known: Iterable[str], otherwise: str) -> str:
    """The message for a name that is not declared, with the nearest ones that are.

    Args:
        kind: of what it should name.
        name: as it stands in the text.
        known: names that are declared.
        otherwise: what to do if none of them is meant.
    """
    near = near_names(name, known)
    offer = f"did you mean {' or '.join(near)}? If not: " if near else ""
    return f"unknown {kind} '{name}': {offer}{otherwise}"
