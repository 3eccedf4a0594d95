"""Where a datum is sure to have got another value before code uses it.

What holds until it is set again, a system variable as well as any other datum, reaches all code
that comes behind. Code that sets it itself first depends on nobody else's value. The text is taken
by its blocks: a setting counts for what follows it in its own block and in blocks inside.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ...dialect import RoutineText, Wording

Place = tuple[str, int]
"""A file and an offset."""

Texts = Mapping[str, str]
Routines = Mapping[str, Sequence[RoutineText]]

_LATER = re.compile(r"\b(?:INTERRUPT|TRIGGER|CONNECT|run)\b", re.IGNORECASE)
"""Of a line whose call comes when nobody knows."""

_KNOWN = re.compile(r"\b(?:EXT(?:FCT)?|DEFDAT|MODULE)\b[^\r\n]*|[.\\][ \t]*$", re.IGNORECASE)
"""What makes another file's routine known, names a module or a component."""

_BRANCH = re.compile(r"\s*(?:IF|THEN|TEST|SWITCH)", re.IGNORECASE)
"""What opens a block that is executed once at most."""


@dataclass(frozen=True, slots=True)
class _Mark:
    """A word that begins, parts or ends a block; a label; or what is executed on a condition."""

    kind: str
    start: int
    end: int


class FileBlocks:
    """The blocks and calls of files.

    Args:
        texts: without comments and strings.
        routines: of the texts.
        wording: how they are searched.
    """

    def __init__(self, texts: Texts, routines: Routines, wording: Wording) -> None:
        self._texts = texts
        self._routines = routines
        self._wording = wording
        self._marks = {file: [*self._found(text)] for file, text in texts.items()}
        self.sites: defaultdict[str, list[Place]] = defaultdict(list)
        names = {wording.folded(one.name) for found in routines.values() for one in found}
        for file, text in texts.items():
            for name in wording.name.finditer(text) if names else ():
                folded = wording.folded(name[0])
                if folded in names and not self._is_named_only(file, name.start()):
                    self.sites[folded].append((file, name.start()))

    def _found(self, text: str) -> Iterator[_Mark]:
        for one in self._wording.blocks.finditer(text) if self._wording.blocks else ():
            yield _Mark(str(one.lastgroup), one.start(), one.end())

    def _is_named_only(self, file: str, at: int) -> bool:
        """Whether a routine's name stands in its heading or is made known."""
        text = self._texts[file]
        if _KNOWN.search(text, text.rfind("\n", 0, at) + 1, at):
            return True
        return any(one.start <= at < one.body for one in self._routines[file])

    def routine(self, file: str, at: int) -> RoutineText | None:
        """The innermost routine round a place."""
        around = [one for one in self._routines[file] if one.start <= at < one.end]
        return min(around, key=lambda one: one.end - one.start, default=None)

    def renewed(self, at: Place, given: Collection[Place], changed: Collection[Place]) -> bool:
        """Whether a datum is given another value before a place is executed, whatever happens.

        Args:
            at: the place.
            given: where the datum gets a value that has not changed.
            changed: where it gets one that has.
        """
        if self._wording.blocks is None or not given:
            return False
        return self._renewed(at, given, changed, self._reaching(changed), frozenset())

    def _renewed(
        self,
        at: Place,
        given: Collection[Place],
        changed: Collection[Place],
        reaching: Collection[Place],
        asked: frozenset[str],
    ) -> bool:
        file, offset = at
        routine = self.routine(file, offset)
        first = 0 if routine is None else routine.body
        bad = {*changed, *reaching}
        before = sorted((at for f, at in given if f == file and first <= at < offset), reverse=True)
        last = max((at for f, at in bad if f == file and first <= at < offset), default=-1)
        for start in before:
            if start > last and self._holds(file, start, offset, bad):
                return True
        if routine is None or not self._untouched(file, first, offset, bad):
            return False
        name = self._wording.folded(routine.name)
        sites = self.sites[name]
        return bool(sites) and all(
            name in asked
            or (
                not (self._comes_later(site) or site in reaching)
                and self._renewed(site, given, changed, reaching, asked | {name})
            )
            for site in sites
        )

    def _comes_later(self, site: Place) -> bool:
        file, at = site
        text = self._texts[file]
        return _LATER.search(text, text.rfind("\n", 0, at) + 1, at) is not None

    def _holds(self, file: str, start: int, at: int, bad: Collection[Place]) -> bool:
        """Whether what is set at a place is so at a later one of the same routine."""
        if any(m.kind == "once" and m.start <= start < m.end for m in self._marks[file]):
            return False
        return self._untouched(file, start + 1, at, bad)

    def _untouched(self, file: str, start: int, at: int, bad: Collection[Place]) -> bool:
        """Whether every way to a place comes through another one, and by nothing bad since."""
        loops: list[bool] = []
        behind = at
        for mark in self._marks[file]:
            if mark.start < start or mark.kind == "once":
                continue
            if mark.start >= at and not loops:
                break
            if mark.kind == "label" and mark.start < at:
                return False
            if mark.kind == "part" and not loops:
                return False
            if mark.kind == "open":
                loops.append(_BRANCH.fullmatch(self._texts[file], mark.start, mark.end) is None)
            elif mark.kind == "close":
                if not loops:
                    return False
                if loops.pop() and mark.start >= at:
                    # What comes later in a loop comes before its next turn.
                    behind = mark.end
        return not any(other == file and start <= one < behind for other, one in bad)

    def _reaching(self, changed: Collection[Place]) -> set[Place]:
        """Calls that lead to places."""
        found: set[Place] = set()
        queue = list(changed)
        while queue:
            file, at = queue.pop()
            for one in self._routines[file]:
                if one.start <= at < one.end:
                    sites = set(self.sites[self._wording.folded(one.name)]) - found
                    found |= sites
                    queue += sites
        return found
