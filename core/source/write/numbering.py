"""Numbers for what a language counts: tools, frames, points."""

from __future__ import annotations

import re
from collections.abc import Hashable
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
