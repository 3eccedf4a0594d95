"""Numbers for what a language counts: tools, frames, points."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

from ...errors import InputError

Value = TypeVar("Value", bound=Hashable)
_NUMBER = re.compile(r"\d+")


class Numbering(Generic[Value]):
    """A number for each value: the one in its name if that is free, else the next that is.

    Args:
        what: is counted, for messages.
        most: greatest number that there is.
        first: least one.
    """

    def __init__(self, what: str, most: int, first: int = 1) -> None:
        self._what, self._most, self._first = what, most, first
        self.numbers: dict[Value, int] = {}

    def of(self, value: Value, name: str | None = None) -> int:
        """The number of a value.

        Args:
            name: as it is called: of ``UTOOL[3]`` and ``tool3`` it is 3.

        Raises:
            InputError: there are no more numbers.
        """
        if value not in self.numbers:
            taken = set(self.numbers.values())
            found = _NUMBER.search(name or "")
            wanted = int(found[0]) if found else 0
            if not self._first <= wanted <= self._most or wanted in taken:
                free = (k for k in range(self._first, self._most + 1) if k not in taken)
                wanted = next(free, 0)
            if not wanted:
                raise InputError(f"there are no more than {self._most} {self._what}")
            self.numbers[value] = wanted
        return self.numbers[value]


class PointNumbers:
    """Points that are declared as motions name them; those that say the same are one point.

    Args:
        text: the declaration of a point, of its number and of what it says.
        first: number of the first one.

    Attributes:
        texts: the declarations, in the order of their numbers.
    """

    def __init__(self, text: Callable[..., str], first: int = 1) -> None:
        self._text, self._first = text, first
        self._numbers: dict[str, int] = {}
        self.texts: list[str] = []

    def of(self, *said: Hashable) -> int:
        """The number of the point that says this."""
        key = self._text(0, *said)
        if key not in self._numbers:
            self._numbers[key] = self._first + len(self.texts)
            self.texts.append(self._text(self._numbers[key], *said))
        return self._numbers[key]
