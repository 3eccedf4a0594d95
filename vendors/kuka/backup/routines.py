"""Which routines move the robot: found by words, as an archive may hold a thousand of them."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ....core.source.text.files import SourceFile
from ..values.library import stem_of

_COMMENT = re.compile(r";[^\r\n]*")
_DEF = re.compile(
    r"^[ \t]*(?P<shared>GLOBAL[ \t]+)?DEF(?P<gives>FCT[ \t]+[\w$]+(?:[ \t]*\[[^\]\r\n]*\])?)?[ \t]+"
    r"(?P<name>[A-Z_$][\w$]*)[ \t]*\((?P<takes>[^)\r\n]*)\)?",
    re.IGNORECASE | re.MULTILINE,
)
_MOVE = re.compile(
    r"^[ \t]*(?:S?(?:PTP|LIN|CIRC)(?:_REL)?|SPL)(?![\w$]|[ \t]*=)", re.IGNORECASE | re.MULTILINE
)
_CALLED = re.compile(r"(?<![\w$])([A-Z_][\w$]*)[ \t]*\(", re.IGNORECASE)
_MOST_COUNTED = 500
"""Routines that one calls of which moves are counted."""
_MOST_VISITED = 200_000
"""Routines that are visited while moves of all are counted."""


@dataclass(frozen=True, slots=True, eq=False)
class Routine:
    """A ``DEF``.

    Args:
        name: as it is declared.
        file: below the archive's root.
        parameters: their names.
        shared: everybody may call it.
        gives: it returns a value.
        moves: statements in it that move the robot.
        calls: lower-case names of what it may call.
    """

    name: str
    file: str
    parameters: tuple[str, ...]
    shared: bool
    gives: bool
    moves: int
    calls: tuple[str, ...]


def routines_in(source: SourceFile) -> tuple[Routine, ...]:
    """The routines of a file."""
    text = _COMMENT.sub("", source.text)
    stem = stem_of(source.name)
    heads = list(_DEF.finditer(text))
    ends = [*(head.start() for head in heads[1:]), len(text)]
    renamed = not any(head["name"].lower() == stem for head in heads)  # the file, by somebody
    found = []
    for head, end in zip(heads, ends, strict=False):
        body = text[head.end() : end]
        takes = (one.partition(":")[0].partition("[")[0] for one in head["takes"].split(","))
        name = head["name"]
        found.append(
            Routine(
                name=name,
                file=source.name,
                parameters=tuple(filter(None, (one.strip() for one in takes))),
                shared=bool(head["shared"])
                or name.lower() == stem
                or (renamed and head is heads[0] and not head["gives"]),
                gives=head["gives"] is not None,
                moves=len(_MOVE.findall(body)),
                calls=tuple(dict.fromkeys(one.lower() for one in _CALLED.findall(body))),
            )
        )
    return tuple(found)


class Routines:
    """All routines of an archive; names are global over it."""

    def __init__(self, found: Iterable[Routine]) -> None:
        self.all = tuple(found)
        self._shared: dict[str, Routine] = {}
        self._own: dict[tuple[str, str], Routine] = {}
        for routine in self.all:
            self._own.setdefault((routine.file, routine.name.lower()), routine)
            if routine.shared:
                self._shared.setdefault(routine.name.lower(), routine)
        self._visited = 0
        self._moving = self._found_moving()

    def named(self, name: str) -> Routine | None:
        """The one that everybody means by a name."""
        return self._shared.get(name.lower())

    def called_by(self, routine: Routine) -> Iterator[Routine]:
        """Those that it may call."""
        for name in routine.calls:
            found = self._own.get((routine.file, name)) or self._shared.get(name)
            if found is not None:
                yield found

    def moves_robot(self, routine: Routine) -> bool:
        """Whether it, or what it calls, moves the robot."""
        return routine in self._moving

    def moves(self, routine: Routine) -> int | None:
        """Statements in it, and in what it calls, that move the robot; None of too many."""
        seen, left = {routine}, [routine]
        while left:
            self._visited += 1
            if len(seen) > _MOST_COUNTED or self._visited > _MOST_VISITED:
                return None
            for other in self.called_by(left.pop()):
                if other not in seen:
                    seen.add(other)
                    left.append(other)
        return sum(one.moves for one in seen)

    def _found_moving(self) -> set[Routine]:
        callers: defaultdict[Routine, list[Routine]] = defaultdict(list)
        for routine in self.all:
            for other in self.called_by(routine):
                callers[other].append(routine)
        moving = {routine for routine in self.all if routine.moves}
        left = list(moving)
        while left:
            for caller in callers[left.pop()]:
                if caller not in moving:
                    moving.add(caller)
                    left.append(caller)
        return moving
