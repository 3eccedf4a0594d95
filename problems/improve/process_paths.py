"""Where an output shows that the robot works along its path: what it glues, welds or cuts there.

No program says which of its points the process needs. But where an output goes on, the robot then
drives along lines and arcs alone, and the output goes off again, the moves in a row at one speed
are taken to be the work itself: a bead may be slower round its corners. Way through the air is
driven by joint moves or at speeds of its own, and what only opens and shuts at stops lies between
no moves.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from shlex import quote

from ...core.dialect import SignalWords
from ...core.door import spelt
from ...core.errors import Note
from ...core.program.event import EventAnchor
from ...core.program.move import Move, MoveJ, Opaque
from ...core.program.program import Program
from ...core.program.signal import SetSignal
from ...core.program.tool import Tool
from ...core.program.zone import Fine
from .solution import Moved


@dataclass(frozen=True, slots=True)
class ProcessPath:
    """Moves in a row along which an output is on.

    Args:
        output: its name, as the language spells it.
        first, last: indices of the moves.
        on, off: indices of the moves behind which it goes on, and off.
    """

    output: str
    first: int
    last: int
    on: int
    off: int


def process_paths(program: Program, words: SignalWords | None) -> tuple[ProcessPath, ...]:
    """The paths of a program that are work, in the order in which they end.

    Args:
        program: the program.
        words: how its language sets outputs; None if nobody knows, and none is found.
    """
    begun: dict[str, int] = {}
    found: list[ProcessPath] = []
    for first, last, action in () if words is None else _switched(program, words):
        key = action.name.casefold()
        if action.value and action.pulse is None:
            begun.setdefault(key, first)
        elif key in begun:
            begin = begun.pop(key)
            moves = program.moves[begin : last + 1]
            if not any(isinstance(move, MoveJ) for move in moves):
                found += [
                    ProcessPath(action.name, begin + i, begin + k, begin - 1, last)
                    for i, k in _works(moves)
                ]
    return tuple(found)


def outputs_of(program: Program, words: SignalWords | None) -> tuple[str, ...]:
    """Names of the outputs that a program sets, each once, in the order in which they come."""
    switched = () if words is None else _switched(program, words)
    return tuple({action.name.casefold(): action.name for _, _, action in switched}.values())


def along_process(paths: Sequence[ProcessPath], free: Collection[str]) -> dict[int, str]:
    """Outputs by the indices of the moves that they are on along.

    Args:
        paths: of the program.
        free: names of outputs that are no process, without regard to case.
    """
    return {
        i: path.output
        for path in paths
        if path.output.casefold() not in free
        for i in range(path.first, path.last + 1)
    }


def lines_moved(given: Program, moved: Sequence[Moved]) -> list[Note]:
    """Notes on points in a row, on lines at one speed, that are no longer where they were.

    Nothing shows whether the tool works there: a valve may be opened by a routine, or by hand.

    Args:
        given: the program before.
        moved: its points that are elsewhere now.
    """
    moves, distance = given.moves, {one.move: one.distance for one in moved}
    lines = [
        i
        for i in distance
        if i + 1 < len(moves)
        and not any(isinstance(move, MoveJ) for move in moves[i : i + 2])
        and _works(moves[i : i + 2])
    ]
    notes, begin = [], 0
    for end in range(1, len(lines) + 1):
        if end < len(lines) and lines[end] == lines[end - 1] + 1:
            continue
        row, begin = lines[begin:end], end
        if len(row) > 1:
            furthest = 1e3 * max(distance[i] for i in row)
            message = (
                f"{len(row)} points in a row, on lines at one speed, are moved by up to "
                f"{furthest:.3g} mm: if the tool works along there, {spelt('keep')} them"
            )
            notes.append(Note(message, row[0], moves[row[0]].statement))
    return notes


def why_process(output: str) -> str:
    """Why a point stays that lies on such a path."""
    return (
        f"{output} is on there, along lines at one speed, as where a tool works on its way "
        f"({spelt('free')} {quote(output)} if it does not)"
    )


def _switched(program: Program, words: SignalWords) -> Iterator[tuple[int, int, SetSignal]]:
    """Outputs that are set: the first move that is driven behind that, and the last one before."""
    index = -1
    for statement in program.statements:
        if isinstance(statement, Move):
            index += 1
            for event in statement.events:
                action = words.read(words.event(event.text))
                if isinstance(action, SetSignal):
                    begins = event.anchor is EventAnchor.START and event.distance == event.time == 0
                    yield index, index - begins, action
        elif isinstance(statement, Opaque):
            action = words.read(statement.text)
            if isinstance(action, SetSignal):
                yield index + 1, index, action


def _works(moves: Sequence[Move]) -> list[tuple[int, int]]:
    """First and last of moves in a row at one speed with one tool, where a point is passed."""
    begins = [0] + [k for k in range(1, len(moves)) if _paced(moves[k]) != _paced(moves[k - 1])]
    rows = [(begin, end - 1) for begin, end in pairwise([*begins, len(moves)])]
    return [
        (first, last)
        for first, last in rows
        if any(not isinstance(move.zone, Fine) for move in moves[first:last])
    ]


def _paced(move: Move) -> tuple[float | None, float | None, Tool]:
    return move.speed.tcp, move.speed.reorientation, move.tool
