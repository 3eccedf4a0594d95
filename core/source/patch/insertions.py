"""Which lines of changed files are as they were, and which have been put in."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ...program.program import Program
from ..reading import Reading
from ..text.files import unbroken

_LINE = re.compile(r"[^\r\n]*(?:\r\n?|\n)|[^\r\n]+")
_NUMBER = re.compile(r"[\d.]+")


@dataclass(frozen=True, slots=True)
class Inserted:
    """A line that has been put in.

    Args:
        at: offset in the text as it was.
    """

    file: str
    at: int
    text: str


def changes_of(before: Program, after: Program) -> tuple[list[Inserted], set[tuple[str, int]]]:
    """Lines put in, and file and number of those that are as they were.

    Both are empty if ``after`` was not read from a changed text.
    """
    inserted: list[Inserted] = []
    kept: set[tuple[str, int]] = set()
    old, new = before.reading, after.reading
    if not isinstance(old, Reading) or not isinstance(new, Reading) or old is new:
        return inserted, kept
    if old.files == new.files:
        return inserted, kept
    for name, file in old.files.items():
        changed = new.files.get(name)
        if changed is None:
            continue
        was, now = (_LINE.findall(unbroken(text)) for text in (file.text, changed.text))
        at = k = 0
        for line, text in _matched(was, now):
            if line is None:
                inserted.append(Inserted(name, at, text))
                continue
            k += 1
            if line == text:
                kept.add((name, k))
            at += len(line)
    return inserted, kept


def _matched(was: list[str], now: list[str]) -> Iterator[tuple[str | None, str]]:
    """Every new line with the one that it was; None if it has been put in."""
    spare = len(now) - len(was)
    k = 0
    for text in now:
        old = was[k] if k < len(was) else None
        if old is None or (
            spare > 0 and _words(old) != _words(text) and not _begin_alike(old, text)
        ):
            spare -= 1
            yield None, text
        else:
            k += 1
            yield old, text


def _words(line: str) -> str:
    return _NUMBER.sub("0", line)


def _begin_alike(one: str, other: str) -> bool:
    """Whether two lines begin with the same instruction."""
    first, second = one.split(), other.split()
    return bool(first and second) and first[0] == second[0]
