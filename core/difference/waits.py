"""The waits of a routine on both sides, laid side by side by the moves that they stand behind."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from ..program.move import Opaque, Wait
from ..program.program import Program
from .differences import Difference, Differing
from .moves import move_key


@dataclass(frozen=True, slots=True)
class _Placed:
    """A wait, the key of the move before it and what messages call that."""

    wait: Wait
    key: tuple[str, ...]
    behind: str


def wait_differences(routine: str, before: Program, after: Program) -> Iterator[Difference]:
    """Waits that were added, removed, or last longer or less long.

    What devices take is no wait of the program. A wait that a loop comes to again counts once.

    Args:
        routine: its name, for the differences' names.
        before, after: as they are driven.
    """
    olds, news = _placed(before), _placed(after)
    same = [[(one.key, _shown(one.wait)) for one in side] for side in (olds, news)]
    for _, a, b, c, d in _stretches(*same, alike=False):
        yield from _otherwise(routine, olds[a:b], news[c:d])


def _otherwise(
    routine: str, olds: Sequence[_Placed], news: Sequence[_Placed]
) -> Iterator[Difference]:
    """Waits none of which is the same: those behind one move belong together, and those of which
    as many stand in one place."""
    keys = [[one.key for one in side] for side in (olds, news)]
    for what, a, b, c, d in _stretches(*keys, alike=True):
        if what == "equal" or b - a == d - c:
            for old, new in zip(olds[a:b], news[c:d], strict=True):
                yield _difference(routine, new, _shown(old.wait), _shown(new.wait))
            continue
        for one in olds[a:b]:
            yield _difference(routine, one, _shown(one.wait), "")
        for one in news[c:d]:
            yield _difference(routine, one, "", _shown(one.wait))


def _stretches(
    olds: Sequence[Hashable], news: Sequence[Hashable], *, alike: bool
) -> list[tuple[str, int, int, int, int]]:
    """Where two lists differ, and where they are alike if that is wanted."""
    matcher = SequenceMatcher(None, olds, news, autojunk=False)
    return [one for one in matcher.get_opcodes() if alike or one[0] != "equal"]


def _difference(routine: str, placed: _Placed, before: str, after: str) -> Difference:
    name = f"{routine}, {placed.behind}"
    return Difference(Differing.WAIT, name, before, after, span=placed.wait.span)


def _placed(program: Program) -> list[_Placed]:
    found: dict[object, _Placed] = {}
    key: tuple[str, ...] = ()
    behind = "before the first move"
    for statement in program.statements:
        if isinstance(statement, Wait):
            if statement.duration > 0.0 and not statement.device:
                at = (key, statement.duration, statement.span)
                found.setdefault(at, _Placed(statement, key, behind))
        elif not isinstance(statement, Opaque):
            key = move_key(statement)
            line = statement.statement
            to = statement.target.name or (f"line {line.line}" if line else "a move")
            behind = f"behind {to}"
    return list(found.values())


def _shown(wait: Wait) -> str:
    return f"{wait.duration:.6g} s"
