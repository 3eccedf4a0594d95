"""Where a text names a datum: whole, one element of it, or one component.

``P[2]``, ``p{2}.trans`` and ``XP1.X`` are a name and a path of indices and components. Two of them
meet unless they have another number, or another component, at the same step; an index that is
computed may be any.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ...dialect import Wording

Step = int | str
"""An index, or the name of a component."""

_OPENING = re.compile(r"[ \t]*(?P<bracket>[\[{])")
_COMPONENT = re.compile(r"[ \t]*\.[ \t]*(?P<name>[^\W\d][\w$]*)")
_CLOSING = {"[": "]", "{": "}"}
_MODULE = re.compile(r"[^\[{.:]*:(?!=)")
_BEFORE, _BEHIND = r"(?<![\w$.])", r"(?![\w$])"


@dataclass(frozen=True, slots=True)
class Reference:
    """A datum, or a part of it, as a text names it.

    Args:
        name: of the whole datum, folded where upper and lower case are the same.
        path: indices and components, outermost first, up to an index that is not written out.
        start, end: offsets of all of it.
    """

    name: str
    path: tuple[Step, ...]
    start: int = 0
    end: int = 0

    def meets(self, other: Reference) -> bool:
        """Whether both may name the same numbers."""
        if self.name != other.name:
            return False
        steps = zip(self.path, other.path, strict=False)
        return not any(type(a) is type(b) and a != b for a, b in steps)


def reference_of(datum: str, wording: Wording) -> Reference:
    """A datum by the name that its origin has, such as ``mine:p{2}``."""
    module = _MODULE.match(datum)
    return _reference(datum, 0 if module is None else module.end(), wording)


def references(name: str, text: str, wording: Wording) -> Iterator[Reference]:
    """Where a text names a datum.

    Args:
        name: see `Reference`.
        text: without comments and strings (`Wording.quiet`).
    """
    flags = re.IGNORECASE if wording.same_case else 0
    pattern = re.compile(_BEFORE + re.escape(name) + _BEHIND, flags)
    for found in pattern.finditer(text):
        made = _reference(text, found.start(), wording)
        if made.name == name:
            yield made


def _reference(text: str, start: int, wording: Wording) -> Reference:
    """What begins at a place."""
    found = wording.name.match(text, start)
    whole = text[start:] if found is None else found[0]
    # A language's own names may have their index in them.
    bare = re.split(r"[\[{.]", whole, maxsplit=1)[0].strip()
    path, end = _path(text, start + len(bare))
    steps = (wording.folded(step) if isinstance(step, str) else step for step in path)
    return Reference(wording.folded(bare), tuple(steps), start, end)


def _path(text: str, at: int) -> tuple[list[Step], int]:
    """Steps from an offset on, up to the first that is computed, and where all of them end."""
    path: list[Step] = []
    known = True
    while True:
        component = _COMPONENT.match(text, at)
        opening = _OPENING.match(text, at)
        if component is not None:
            steps: list[Step] | None = [component["name"]]
            at = component.end()
        elif opening is not None and (end := _closing(text, opening)) is not None:
            steps = _indices(text[opening.end() : end])
            at = end + 1
        else:
            return path, at
        known = known and steps is not None
        if known and steps is not None:
            path += steps


def _closing(text: str, opening: re.Match[str]) -> int | None:
    """Offset of the bracket that closes one."""
    opened, closed = opening["bracket"], _CLOSING[opening["bracket"]]
    depth = 0
    for at in range(opening.start("bracket"), len(text)):
        depth += (text[at] == opened) - (text[at] == closed)
        if depth == 0:
            return at
    return None


def _indices(text: str) -> list[Step] | None:
    """``2`` and ``1,2`` as numbers; None if they are computed."""
    parts = [part.strip() for part in text.split(",")]
    return [int(part) for part in parts] if all(map(str.isdecimal, parts)) else None
