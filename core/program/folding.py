"""A program's statements as loops and routines, where these do the same every time.

A loop whose passes are all alike is one body and a count; a routine is one body for all its calls
that are alike, and has another name for each further body. What a program is folded to has the
program's own statements, in their order, whatever its sections say: only equal ones are folded.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from .move import Statement
from .program import Program
from .section import Section


@dataclass(frozen=True, slots=True)
class Repeat:
    """A loop.

    Args:
        body: the first pass.
        count: how often it runs; None for without an end.
        level: loops that count in the same routine round it.
        rest: indices of the statements of the further passes.
    """

    body: tuple[Node, ...]
    count: int | None
    level: int
    rest: range


@dataclass(frozen=True, slots=True)
class Called:
    """A call of a routine.

    Args:
        name: of the routine in the source.
        number: which of the bodies of this name, from 0.
        body: what it does.
        whole: indices of its statements.
    """

    name: str
    number: int
    body: tuple[Node, ...]
    whole: range


Node = int | Repeat | Called
"""The index of a statement, or what holds several."""


def folded(program: Program) -> tuple[Node, ...]:
    """The statements of a program as loops and routines."""
    return _Folding(program.statements, usable(program)).nodes()


def usable(program: Program) -> tuple[Section, ...]:
    """A program's sections, if they are of these statements."""
    count = len(program.statements)
    fits = all(section.end <= count for section in program.sections)
    return program.sections if fits else ()


def alike(statements: Sequence[Statement], section: Section) -> bool:
    """Whether a loop does the same in every pass."""
    first, *others = (statements[begin:end] for begin, end in section.bodies)
    return all(first == other for other in others)


def with_one_cycle(program: Program) -> Program:
    """The program with one pass of the loop that production runs in, if its passes are alike."""
    sections = usable(program)
    loop = next((s for s in sections if s.endless and alike(program.statements, s)), None)
    if loop is None or len(loop.passes) < 2:
        return program
    end = loop.bodies[0][1]
    kept = (
        replace(s, end=min(s.end, end), passes=tuple(p for p in s.passes if p < end))
        for s in sections
        if s.begin < end
    )
    return replace(program, statements=program.statements[:end], sections=tuple(kept), cycle=None)


def variants(
    statements: Sequence[Statement], sections: Sequence[Section]
) -> dict[str, list[list[Section]]]:
    """The calls of every routine, those together that do the same; the routines' names folded."""
    found: dict[str, list[list[Section]]] = {}
    for section in sections:
        if section.passes:
            continue
        classes = found.setdefault(section.name.casefold(), [])
        body = statements[section.begin : section.end]
        for calls in classes:
            if statements[calls[0].begin : calls[0].end] == body:
                calls.append(section)
                break
        else:
            classes.append([section])
    return found


class _Folding:
    def __init__(self, statements: Sequence[Statement], sections: Sequence[Section]) -> None:
        self._statements = statements
        self._sections = sections
        self._number = {
            id(section): number
            for classes in variants(statements, sections).values()
            for number, calls in enumerate(classes)
            for section in calls
        }

    def nodes(self) -> tuple[Node, ...]:
        """All of them."""
        return tuple(self._within(0, len(self._statements), 0, len(self._sections), 0))

    def _within(self, begin: int, end: int, first: int, stop: int, level: int) -> Iterator[Node]:
        """The nodes of statements ``begin`` to ``end``.

        Args:
            first, stop: the sections among which theirs are.
            level: loops of the same routine round them.
        """
        at, k = begin, first
        while k < stop:
            section = self._sections[k]
            inner = k + 1
            while inner < stop and self._sections[inner].begin < section.end:
                inner += 1
            if section.begin < at or section.end > end:  # of a pass before, or behind
                k += 1
                continue
            yield from range(at, section.begin)
            yield from self._section(section, k + 1, inner, level)
            at, k = section.end, inner
        yield from range(at, end)

    def _section(self, section: Section, first: int, stop: int, level: int) -> Iterator[Node]:
        whole = section.begin, section.end
        if not section.passes:
            body = tuple(self._within(*whole, first, stop, 0))
            yield Called(section.name, self._number[id(section)], body, range(*whole))
            return
        count = len(section.passes)
        plain = section.passes[0] != section.begin or (count == 1 and not section.endless)
        if plain or not alike(self._statements, section):
            yield from self._within(*whole, first, stop, level)
        else:
            begin, end = section.bodies[0]
            times = None if section.endless else count
            inner = level if times is None else level + 1
            body = tuple(self._within(begin, end, first, stop, inner))
            yield Repeat(body, times, level, range(end, section.end))
