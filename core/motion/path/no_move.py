"""Why no move of a program is reached, and what helps."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...door import spelt
from ...errors import FaultCause, MotionError, Span
from ...program.entry_point import EntryPoint, listed
from ...program.program import Program
from ...program.question import QuestionKind
from ...program.target import JointTarget

_MOST = 4
"""Names that a message lists."""

_DATA = (
    QuestionKind.SIGNAL,
    QuestionKind.OPERATOR,
    QuestionKind.CHANNEL,
    QuestionKind.SENSOR,
    QuestionKind.DATUM,
)
"""What targets are made of."""


def no_move(program: Program) -> MotionError:
    """The error of a program of which no move is reached: why, and what helps."""
    reading = program.reading
    moving = any(entry.moves for entry in program.entries)
    asked = [question for question in program.questions if not question.answered]
    away = list(dict.fromkeys(q.key for q in asked if q.kind is QuestionKind.ROUTINE))
    streams = [question for question in asked if question.kind is QuestionKind.STREAM]
    ways = [] if streams else _open_ways(program)
    helps = []
    if streams:
        sent, line = streams[0].key, streams[0].span.line
        helps.append(
            f"a computer sends its motion at {sent} in line {line}: say that in a file of joints "
            f'over time ({spelt("answers")}: [streams] {sent} = "joints.csv", whose first line is '
            "time,j1,j2,…, in s and degrees)"
        )
    if away:
        helps.append(
            f"{_named(away)} {'is' if len(away) == 1 else 'are'} not at hand: put the files "
            f"beside the program, or name them ({spelt('others')})"
        )
    if ways and moving:
        helps.append(
            f"nobody says which way it goes in line {_named(ways)}: say it in a file "
            f"({spelt('answers')}; `flyby ask` writes one)"
        )
    told = [q.key for q in program.questions if q.answered and q.kind is not QuestionKind.PAUSE]
    if moving and told and not helps:
        helps.append(
            f"the answers to {_named(told)} have it so: others may lead to one ({spelt('answers')})"
        )
    others = not_met(program)
    if any(entry.moves for entry in others):
        helps.append(f"choose as the entry the routine that drives: {listed(others)}")
    what = "reaches no move" if moving else "has no move"
    none = "what it computes leads to none" if moving else "nothing in it moves the robot"
    why = "; or ".join(helps) or none
    return MotionError(
        f"program {program.name!r} {what}: {why}",
        span=None if reading is None else Span(reading.main, 1, 1, 0, 0),
    )


def not_met(program: Program) -> list[EntryPoint]:
    """The routines that a program may begin with, but for those that it was begun with and has met
    on its way."""
    met = {program.name.casefold(), *(_routine(call.text) for call in program.calls)}
    return [e for e in program.entries if e.name.casefold() not in met and not e.begun]


def goes_nowhere(program: Program, start: JointTarget | None) -> MotionError:
    """The error of a program of which every move ends where the robot stands, and what helps.

    Args:
        start: where it is said to stand first; None if nobody says.
    """
    from ...program.assumed_places import FROM_THE_START  # late: poses take time

    ways = _open_ways(program)
    supposed = {move.supposed for move in program.moves if not move.open}
    # A text that says no start, or asks for it, has been read from another one already.
    said = start is not None or program.start is not None or program.reading is None
    helps = []
    if FROM_THE_START in supposed and "" not in supposed:
        helps = [
            "its targets are made of where it stands before: they lead anywhere only where the "
            "program sets a part of them"
        ]
    elif said and supposed <= {""}:
        helps = [f"let it begin elsewhere ({spelt('start')})"]
    data = dict.fromkeys(q.key for q in program.questions if q.kind in _DATA and not q.answered)
    if data:
        helps.insert(
            0,
            f"its targets may depend on {_named(list(data))}, which nobody says: say it in a file "
            f"({spelt('answers')}; `flyby ask` writes one)",
        )
    if ways:
        helps.append(
            f"say which way it goes in line {_named(ways)} in a file ({spelt('answers')}; "
            "`flyby ask` writes one)"
        )
    return MotionError(
        "the program goes nowhere: this and every other move ends where the robot stands; "
        f"{', or '.join(helps) or 'what it computes has it so'}",
        0,
        cause=FaultCause.NOWHERE,
    )


def _routine(call: str) -> str:
    """The name in a call, before its arguments or its end."""
    return re.split(r"[\s(;\\]", call.strip(), maxsplit=1)[0].casefold()


def _open_ways(program: Program) -> list[str]:
    """Lines of the branches and loops that nobody decides."""
    ways = (QuestionKind.BRANCH, QuestionKind.LOOP)
    asked = {q.span.line for q in program.questions if q.kind in ways and not q.answered}
    return list(map(str, sorted(asked)))


def _named(names: Sequence[str]) -> str:
    """``a, b and c``, or the first of many."""
    if len(names) > _MOST:
        return f"{', '.join(names[:_MOST])} and {len(names) - _MOST} more"
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
