"""Kinds of figures of a motion model: how a file states them, and what they may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol

from ...errors import InputError

MOST_ENTRIES = 20
"""Averages one after the other, coefficients of a blend, or joints."""
NONE = "none"
"""What a file states for no limit and the like."""


@dataclass(frozen=True)
class Range:
    """Which numbers a figure may have; they are finite in any case.

    Args:
        lower, upper: the ends, which belong to it.
        above: the lower end does not.
        reason: why no others, for messages.
    """

    lower: float = -math.inf
    upper: float = math.inf
    above: bool = False
    reason: str = ""

    def holds(self, value: float) -> bool:
        """Whether a number may be."""
        if not math.isfinite(value) or (self.above and value == self.lower):
            return False
        return self.lower <= value <= self.upper

    def __str__(self) -> str:
        if self.lower == -math.inf:
            return "finite" if self.upper == math.inf else f"finite and at most {self.upper:g}"
        lower = f"{self.lower:g}" if self.lower else "zero"
        if self.upper == math.inf:
            return f"finite and above {lower}" if self.above else f"finite and {lower} or more"
        if self.above:
            return f"above {lower} and at most {self.upper:g}"
        return f"from {lower} to {self.upper:g}"

    def check(self, key: str, value: Any) -> None:
        """Refuse what it does not hold.

        Raises:
            InputError: with the key.
        """
        if not self.holds(number(key, value)):
            reason = f": {self.reason}" if self.reason else ""
            raise InputError(f"{key} must be {self}, not {value}{reason}")


FINITE = Range()
POSITIVE = Range(0.0, above=True)
NOT_NEGATIVE = Range(0.0)


class FigureKind(Protocol):
    """How figures of a kind are stated."""

    def read(self, key: str, entry: Any) -> Any:
        """What an entry of a file stands for.

        Raises:
            InputError: it is of another type; the message names the key.
        """

    def check(self, key: str, value: Any) -> None:
        """Refuse a value that makes no sense.

        Raises:
            InputError: with the key.
        """

    def entry(self, value: Any) -> Any:
        """A value as a file states it."""

    def __str__(self) -> str:
        """What a figure of the kind may be."""


@dataclass(frozen=True)
class RealNumber:
    """One number.

    Args:
        within: what it may be.
        optional: or None, which files state as "none".
    """

    within: Range = FINITE
    optional: bool = False

    def read(self, key: str, entry: Any) -> float | None:
        """See `FigureKind`."""
        return None if self.optional and entry == NONE else float(number(key, entry))

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        if not (self.optional and value is None):
            self.within.check(key, value)

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return NONE if value is None else value

    def __str__(self) -> str:
        return f'{self.within}, or "{NONE}"' if self.optional else str(self.within)


@dataclass(frozen=True)
class Whole:
    """A whole number that counts something, such as joints from one on; nothing to fit."""

    def read(self, key: str, entry: Any) -> int:
        """See `FigureKind`."""
        if isinstance(entry, bool) or not isinstance(entry, int):
            raise InputError(f"{key}: a whole number is expected, not {entry!r}")
        return entry

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        if self.read(key, value) < 1:
            raise InputError(f"{key} counts from one, not {value}")

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return value

    def __str__(self) -> str:
        return "from one on"


@dataclass(frozen=True)
class Row:
    """Several numbers.

    Args:
        within: what each may be.
        per: what there is one of for each.
        neutral: what an entry stands for that is not stated.
        single: whether a file may state one number in the place of the list, zero for none.
    """

    within: Range = FINITE
    per: str = "joint"
    neutral: float = 0.0
    single: bool = False

    def read(self, key: str, entry: Any) -> tuple[float, ...]:
        """See `FigureKind`."""
        if self.single and not isinstance(entry, list):
            value = float(number(key, entry))
            return () if value == 0.0 else (value,)
        if not isinstance(entry, list):
            raise InputError(f"{key}: a list of numbers is expected, not {entry!r}")
        return tuple(float(number(f"{key}[{k}]", value)) for k, value in enumerate(entry))

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        if not isinstance(value, tuple):
            raise InputError(f"{key}: several numbers are expected, not {value!r}")
        if len(value) > MOST_ENTRIES:
            raise InputError(f"{key} has {len(value)} numbers; at most {MOST_ENTRIES} are taken")
        for k, one in enumerate(value):
            self.within.check(f"{key}[{k}]", one)

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return list(value)

    def __str__(self) -> str:
        return str(self.within)


@dataclass(frozen=True)
class Choice:
    """One of several words.

    Args:
        words: an enumeration of them, or they themselves.
    """

    words: type[StrEnum] | tuple[str, ...]

    def read(self, key: str, entry: Any) -> Any:
        """See `FigureKind`."""
        if not isinstance(entry, str) or entry not in tuple(self.words):
            raise InputError(f"{key}: {self} is expected, not {entry!r}")
        return self.words(entry) if isinstance(self.words, type) else entry

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        known = isinstance(value, self.words if isinstance(self.words, type) else str)
        if not known or value not in tuple(self.words):
            raise InputError(f"{key}: {self} is expected, not {value!r}")

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return str(value)

    def __str__(self) -> str:
        *first, last = (f'"{word}"' for word in self.words)
        return f"{', '.join(first)} or {last}"


@dataclass(frozen=True)
class TruthValue:
    """True or false."""

    def read(self, key: str, entry: Any) -> bool:
        """See `FigureKind`."""
        self.check(key, entry)
        return bool(entry)

    def check(self, key: str, value: Any) -> None:
        """See `FigureKind`."""
        if not isinstance(value, bool):
            raise InputError(f"{key}: true or false is expected, not {value!r}")

    def entry(self, value: Any) -> Any:
        """See `FigureKind`."""
        return value

    def __str__(self) -> str:
        return "true or false"


def number(key: str, value: Any) -> float:
    """What is a number.

    Raises:
        InputError: it is none; the message names the key.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{key}: a number is expected, not {value!r}")
    return value


def words_of(names: Sequence[str]) -> str:
    """Names one after the other."""
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
