"""Moves that one line of the new program drives: in every pass of a loop, in every call."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..program.folding import alike, variants
from ..program.move import MoveC, MoveJ, MoveL, Opaque, Statement, Wait
from ..program.program import Program
from ..program.section import Section
from ..program.zone import FINE, Radius, Zone


class Ties:
    """Which statements of a program are one and the same statement of a loop or routine.

    Args:
        statements: on the new robot, with the old speeds and zones.
        sections: loops and routines; none for a program in which every move is for itself.
    """

    def __init__(self, statements: Sequence[Statement], sections: Sequence[Section]) -> None:
        self._first = list(range(len(statements)))
        for section in sections:
            if section.passes and alike(statements, section):
                self._tie(section.bodies)
        for classes in variants(statements, sections).values():
            for calls in classes:
                self._tie([(call.begin, call.end) for call in calls])
        self._moves = [i for i, s in enumerate(statements) if isinstance(s, MoveJ | MoveL | MoveC)]

    def of(self, statement: int) -> int:
        """The first of the statements that are one with it."""
        while self._first[statement] != statement:
            statement = self._first[statement]
        return statement

    def moves(self) -> list[list[int]]:
        """Indices of moves that are one, where there are several."""
        found: dict[int, list[int]] = {}
        for index, statement in enumerate(self._moves):
            found.setdefault(self.of(statement), []).append(index)
        return [moves for moves in found.values() if len(moves) > 1]

    def with_one_zone(self, program: Program, driven: Sequence[int]) -> Program:
        """The program in which moves that are one have one zone: the least of theirs.

        A move whose zone became a stop since the robot stops behind it all the same, or does not
        move at all, gets the zone that it has elsewhere.

        Args:
            driven: indices of the moves that go anywhere.
        """
        moves = list(program.moves)
        stopping = {*_before_stops(program.statements)} | {*range(len(moves))} - {*driven}
        for tied in self.moves():
            passing = [i for i in tied if moves[i].zone != FINE]
            if not passing or not {*tied} - {*passing} <= stopping:
                continue
            least = min((moves[i].zone for i in passing), key=_size)
            if {type(moves[i].zone) for i in passing} == {type(least)}:
                for i in tied:
                    moves[i] = replace(moves[i], zone=least)
        return program.with_moves(tuple(moves))

    def _tie(self, bodies: Sequence[tuple[int, int]]) -> None:
        begin, end = bodies[0]
        for other, _ in bodies[1:]:
            for k in range(end - begin):
                one, two = self.of(begin + k), self.of(other + k)
                self._first[max(one, two)] = min(one, two)


def _before_stops(statements: Sequence[Statement]) -> Iterator[int]:
    """Indices of the moves behind which the robot stops, whatever their zones."""
    last: int | None = None
    count = 0
    for statement in statements:
        if isinstance(statement, MoveJ | MoveL | MoveC):
            last, count = count, count + 1
        elif isinstance(statement, Wait) or (isinstance(statement, Opaque) and statement.stops):
            if last is not None:
                yield last
            last = None
    if last is not None:
        yield last


def _size(zone: Zone) -> float:
    if isinstance(zone, Radius):
        return zone.tcp
    return float(getattr(zone, "angle", getattr(zone, "fraction", 0.0)))
