"""A program's statements as loops and routines, where these do the same every time.

A loop whose passes are alike but for targets that move on by the same stretch is one body and a
count; a routine is one body for all its calls that are alike but for targets, which are its
arguments. What a program is folded to has the program's own statements, in their order, whatever
its sections say.

Loops are compared pass by pass and routines call by call, the inner ones first (`_Instances`).
Which targets of a routine become arguments follows from all its calls together (`_Routine`).
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from .move import Move, Statement
from .places import Argument, Destination, Slot, blanked, moved_on, slots_of
from .program import Program
from .routine_places import RoutinePlaces
from .section import Section
from .tool import WorkObject


@dataclass(frozen=True, slots=True)
class Said:
    """A statement that stands where it is carried out.

    Args:
        index: of the statement.
        places: where a move goes to, and through; empty for other statements.
    """

    index: int
    places: tuple[Destination, ...] = ()


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
        arguments: the places that it is given.
        frames: the work object that each is seen in.
    """

    name: str
    number: int
    body: tuple[Node, ...]
    whole: range
    arguments: tuple[Destination, ...] = ()
    frames: tuple[WorkObject, ...] = ()


Node = Said | Repeat | Called


def folded(program: Program) -> tuple[Node, ...]:
    """The statements of a program as loops and routines."""
    return Folding(program.statements, usable(program)).nodes()


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


@dataclass(frozen=True, slots=True)
class _Leaf:
    index: int
    rest: Statement
    slots: tuple[Slot, ...]


@dataclass(frozen=True, slots=True)
class _Loop:
    body: tuple[_Part, ...]
    count: int | None
    level: int
    rest: range


@dataclass(frozen=True, slots=True)
class _Call:
    section: Section
    routine: _Routine
    body: tuple[_Part, ...]


_Part = _Leaf | _Loop | _Call


class _Routine:
    """The calls of a routine that are alike but for targets.

    Args:
        name: of the routine.
        number: of the routines of this name before it.
    """

    def __init__(self, name: str, number: int) -> None:
        self.name = name
        self.number = number
        self.calls: list[_Call] = []
        self._places: RoutinePlaces | None = None

    def places(self) -> RoutinePlaces:
        """Which of its targets are arguments; asked when all its calls are known."""
        if self._places is None:
            rows = [list(_own_slots(call.body)) for call in self.calls]
            self._places = RoutinePlaces(
                [[slot for slot, _ in row] for row in rows], [rest for _, rest in rows[0]]
            )
        return self._places


def _own_slots(body: Sequence[_Part]) -> Iterator[tuple[Slot, Statement]]:
    """The targets that a routine's own text has: those of its moves, and what it hands on."""
    for part in body:
        if isinstance(part, _Leaf):
            yield from ((slot, part.rest) for slot in part.slots)
        elif isinstance(part, _Loop):
            yield from _own_slots(part.body)
        else:
            yield from _handed(part)


def _handed(call: _Call) -> Iterator[tuple[Slot, Statement]]:
    """What a call hands on, as seen from where it stands."""
    own = list(_own_slots(call.body))
    for k in call.routine.places().chosen:
        slot, rest = own[k]
        yield slot.from_outside(), rest


class Folding:
    """A program's loops and routines.

    Args:
        statements: of the program.
        sections: what loops and routines have made of them.

    Attributes:
        written_out: loops whose passes differ.
        ties: statements that one line says: pairs of indices, the earlier one first.
    """

    def __init__(self, statements: Sequence[Statement], sections: Sequence[Section]) -> None:
        self._statements = statements
        self._sections = sections
        self._begins = [section.begin for section in sections]
        self._named = _named(statements)
        self.written_out: list[Section] = []
        self.ties: list[tuple[int, int]] = []
        self._routines: dict[str, list[_Routine]] = {}
        self._parts = self._within(0, len(statements), 0, len(sections), 0)

    def nodes(self) -> tuple[Node, ...]:
        """All of them."""
        return tuple(self._nodes(self._parts, None))

    def variants(self) -> Iterator[list[Section]]:
        """Of each routine of several bodies, the first call of each."""
        for routines in self._routines.values():
            if len(routines) > 1:
                yield [routine.calls[0].section for routine in routines]

    # ------------------------------------------------------------------ what is alike

    def _within(self, begin: int, end: int, first: int, stop: int, level: int) -> tuple[_Part, ...]:
        """The parts of statements ``begin`` to ``end``.

        Args:
            first, stop: the sections among which theirs are.
            level: loops of the same routine round it.
        """
        found: list[_Part] = []
        at, k = begin, first
        while k < stop:
            section = self._sections[k]
            inner = k + 1
            while inner < stop and self._sections[inner].begin < section.end:
                inner += 1
            if section.begin < at or section.end > end:  # of a pass before, or behind
                k += 1
                continue
            found += map(self._leaf, range(at, section.begin))
            found += self._section(section, k + 1, inner, level)
            at, k = section.end, inner
        found += map(self._leaf, range(at, end))
        return tuple(found)

    def _between(
        self, begin: int, end: int, first: int, stop: int, level: int
    ) -> tuple[_Part, ...]:
        """As `_within`, of statements that are only some of those of the sections."""
        low = bisect_left(self._begins, begin, first, stop)
        return self._within(begin, end, low, bisect_left(self._begins, end, low, stop), level)

    def _leaf(self, index: int) -> _Leaf:
        statement = self._statements[index]
        return _Leaf(index, blanked(statement), slots_of(statement, self._named))

    def _section(self, section: Section, first: int, stop: int, level: int) -> Sequence[_Part]:
        if not section.passes:
            body = self._within(section.begin, section.end, first, stop, 0)
            return [self._call(section, body)]
        count = len(section.passes)
        plain = section.passes[0] != section.begin or (count == 1 and not section.endless)
        times = None if section.endless else count
        inner = level if times is None else level + 1
        passes = [self._between(*body, first, stop, inner) for body in section.bodies]
        made = None if plain else _one(passes, level, exact=times is None)
        if made is None:
            if count > 1:
                self.written_out.append(section)
            ahead = self._between(section.begin, section.passes[0], first, stop, inner)
            return [*ahead, *(part for one in passes for part in one)]
        for other in passes[1:]:
            self._tie(passes[0], other)
        return [_Loop(made, times, level, range(section.bodies[0][1], section.end))]

    def _call(self, section: Section, body: tuple[_Part, ...]) -> _Call:
        routines = self._routines.setdefault(section.name.casefold(), [])
        for routine in routines:
            if _same(routine.calls[0].body, body):
                self._tie(routine.calls[0].body, body)
                break
        else:
            routine = _Routine(section.name, len(routines))
            routines.append(routine)
        call = _Call(section, routine, body)
        routine.calls.append(call)
        return call

    def _tie(self, one: Sequence[_Part], other: Sequence[_Part]) -> None:
        pairs = zip(_indices(one), _indices(other), strict=True)
        self.ties += [(min(a, b), max(a, b)) for a, b in pairs if a != b]

    # ---------------------------------------------------------------------- as written

    def _nodes(self, parts: Sequence[_Part], inside: RoutinePlaces | None) -> Iterator[Node]:
        """The parts of a routine as it is written, in the order of its targets.

        Args:
            inside: the routine's targets; None for the program's own text.
        """
        places = iter(inside.places if inside is not None else ())

        def place(slot: Slot, levels: Mapping[int, int]) -> Destination:
            return slot.place(next(places, None), levels)

        def nodes(parts: Sequence[_Part], levels: Mapping[int, int]) -> Iterator[Node]:
            for part in parts:
                if isinstance(part, _Leaf):
                    yield Said(part.index, tuple(place(slot, levels) for slot in part.slots))
                elif isinstance(part, _Loop):
                    level = len(levels)
                    inner = levels if part.count is None else {**levels, part.level: level}
                    yield Repeat(tuple(nodes(part.body, inner)), part.count, level, part.rest)
                else:
                    handed = list(_handed(part))
                    arguments = tuple(place(slot, levels) for slot, _ in handed)
                    yield self._called(part, arguments, tuple(_frame(rest) for _, rest in handed))

        return nodes(parts, {})

    def _called(
        self, call: _Call, arguments: tuple[Destination, ...], frames: tuple[WorkObject, ...]
    ) -> Called:
        routine, section = call.routine, call.section
        body = tuple(self._nodes(routine.calls[0].body, routine.places()))
        whole = range(section.begin, section.end)
        return Called(routine.name, routine.number, body, whole, arguments, frames)


def _named(statements: Sequence[Statement]) -> dict[str, list[Move]]:
    found: dict[str, list[Move]] = {}
    seen: set[tuple[str, int]] = set()
    for statement in statements:
        if isinstance(statement, Move) and statement.target.name:
            key = statement.target.name.casefold(), id(statement.target)
            if key not in seen:
                seen.add(key)
                found.setdefault(key[0], []).append(statement)
    return found


def _frame(statement: Statement) -> WorkObject:
    assert isinstance(statement, Move)
    return statement.work_object


def _indices(parts: Sequence[_Part]) -> Iterator[int]:
    """Of the statements that are written."""
    for part in parts:
        if isinstance(part, _Leaf):
            yield part.index
        else:
            yield from _indices(part.body)


def _same(one: Sequence[_Part], other: Sequence[_Part]) -> bool:
    """Whether two bodies are alike but for their targets."""
    return len(one) == len(other) and all(map(_same_part, one, other))


def _same_part(one: _Part, other: _Part) -> bool:
    if isinstance(one, _Leaf) and isinstance(other, _Leaf):
        same = one.rest == other.rest and len(one.slots) == len(other.slots)
        return same and all(a.kin(b) for a, b in zip(one.slots, other.slots, strict=True))
    if isinstance(one, _Loop) and isinstance(other, _Loop):
        return one.count == other.count and _same(one.body, other.body)
    if isinstance(one, _Call) and isinstance(other, _Call):
        return one.routine is other.routine and _same(one.body, other.body)
    return False


def _one(
    passes: Sequence[tuple[_Part, ...]], level: int, exact: bool, height: int = 0
) -> tuple[_Part, ...] | None:
    """The body of a loop with these passes, whose targets may move on; None if they differ.

    Args:
        exact: whether targets may not move on.
        height: calls between the loop and the parts.
    """
    if any(len(one) != len(passes[0]) for one in passes):
        return None
    found = []
    for parts in zip(*passes, strict=True):
        part = _one_part(parts, level, exact, height)
        if part is None:
            return None
        found.append(part)
    return tuple(found)


def _one_part(parts: Sequence[_Part], level: int, exact: bool, height: int) -> _Part | None:
    first = parts[0]
    if not all(_same_part(first, other) for other in parts[1:]):
        return None
    if isinstance(first, _Leaf):
        rows = [part.slots for part in parts if isinstance(part, _Leaf)]
        slots = []
        for column in zip(*rows, strict=True):
            slot = moved_on(column, (height, level), exact)
            if slot is None:
                return None
            slots.append(slot)
        return replace(first, slots=tuple(slots))
    deeper = height + isinstance(first, _Call)
    body = _one([p.body for p in parts if not isinstance(p, _Leaf)], level, exact, deeper)
    return None if body is None else replace(first, body=body)


__all__ = [
    "Argument",
    "Called",
    "Destination",
    "Folding",
    "Node",
    "Repeat",
    "Said",
    "alike",
    "folded",
    "usable",
    "with_one_cycle",
]
