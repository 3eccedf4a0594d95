"""Names for what a writer or patcher declares: legal, free, and near to the wanted ones."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import count

_OTHER = re.compile(r"[^A-Za-z0-9_]+")


@dataclass(frozen=True, slots=True)
class NameRules:
    """What a language takes for a name.

    Args:
        reserved: names that no program may give, folded.
        longest: characters.
        fold: makes equal what the language takes for one name: `str.casefold` where upper and
            lower case are the same, `str` where they differ.
        legal: names that may be given, as long as they please; only of ASCII letters, digits and
            ``_``, beginning with any letter.
    """

    reserved: frozenset[str]
    longest: int = sys.maxsize
    fold: Callable[[str], str] = str.casefold
    legal: re.Pattern[str] = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


class Names:
    """The names that a program has given out."""

    def __init__(self, rules: NameRules, taken: Iterable[str] = ()) -> None:
        self._rules = rules
        self._taken = set(map(rules.fold, taken)) | rules.reserved

    def claim(self, wanted: str, fallback: str) -> str:
        """``wanted`` if it is legal and free, else a legal and free name near to it.

        Args:
            wanted: any text; what may not stand in a name becomes ``_``.
            fallback: a legal name, taken if nothing of ``wanted`` can stand in a name.
        """
        return self.first_free(self._near(self._stem(wanted, fallback)))

    def first_free(self, candidates: Iterable[str]) -> str:
        """The first of the candidates that is free; it is taken from now on.

        Args:
            candidates: legal names; of an iterator, those that follow are left.

        Raises:
            ValueError: none is free.
        """
        for name in candidates:
            folded = self._rules.fold(name)
            if folded not in self._taken:
                self._taken.add(folded)
                return name
        raise ValueError("no candidate is free")

    def _stem(self, wanted: str, fallback: str) -> str:
        legal = self._rules.legal
        if legal.fullmatch(wanted):
            return wanted
        stem = _OTHER.sub("_", wanted).strip("_") or fallback
        return stem if legal.fullmatch(stem) else f"{fallback}_{stem}"

    def _near(self, stem: str) -> Iterator[str]:
        longest = self._rules.longest
        yield stem[:longest]
        for k in count(2):
            suffix = f"_{k}"
            yield stem[: longest - len(suffix)] + suffix
