"""Moves that one line of the new program drives: in every pass of a loop, in every call."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..program.folding import Folding
from ..program.move import Move, MoveC, MoveJ, MoveL, Opaque, Statement, Wait
from ..program.program import Program
from ..program.section import Section
from ..program.target import PoseTarget
from ..program.zone import Fine, Radius, Zone


class Ties:
    """Which statements of a program are one and the same statement of a loop or routine.

    Args:
        statements: on the new robot, with the old speeds and zones.
        sections: loops and routines; none for a program in which every move is for itself.
    """

    def __init__(self, statements: Sequence[Statement], sections: Sequence[Section]) -> None:
        self._first = list(range(len(statements)))
        for pair in Folding(statements, sections).ties:
            one, two = map(self.of, pair)
            self._first[max(one, two)] = min(one, two)
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
            passing = [i for i in tied if not isinstance(moves[i].zone, Fine)]
            if not passing or not {*tied} - {*passing} <= stopping:
                continue
            least = min((moves[i].zone for i in passing), key=_size)
            if {type(moves[i].zone) for i in passing} == {type(least)}:
                for i in tied:
                    moves[i] = replace(moves[i], zone=least)
        return program.with_moves(tuple(moves))


def groups_of_hints(
    statements: Sequence[Statement], sections: Sequence[Section]
) -> list[list[int]]:
    """Moves that would be one line but for hints of where to look for their solutions."""
    bare = [_without_hint(s) if isinstance(s, MoveJ | MoveL | MoveC) else s for s in statements]
    if bare == list(statements):
        return []
    return Ties(bare, sections).moves()


def with_first_hints(program: Program, groups: Sequence[Sequence[int]]) -> Program:
    """The program in which the moves of a group have the hint of the first."""
    moves = list(program.moves)
    for group in groups:
        first = moves[group[0]].target
        for index in group[1:]:
            target = moves[index].target
            if isinstance(target, PoseTarget) and isinstance(first, PoseTarget):
                one = replace(target, configuration=first.configuration)
                moves[index] = replace(moves[index], target=one)
    return program.with_moves(tuple(moves))


def _without_hint(move: Move) -> Move:
    target = move.target
    if not isinstance(target, PoseTarget) or target.configuration is None:
        return move
    if not target.configuration.hint:
        return move
    return replace(move, target=replace(target, configuration=None))


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
