"""Why no move of a program is reached, and what helps."""

from __future__ import annotations

from collections.abc import Sequence

from ...door import spelt
from ...errors import MotionError, Span
from ...program.entry_point import listed
from ...program.program import Program
from ...program.question import Question, QuestionKind

_MOST = 4
"""Names that a message lists."""


def no_move(program: Program) -> MotionError:
    """The error of a program of which no move is reached: why, and what helps."""
    reading = program.reading
    moving = any(entry.moves for entry in program.entries)
    asked = [question for question in program.questions if not question.answered]
    away = list(dict.fromkeys(q.key for q in asked if q.kind is QuestionKind.ROUTINE))
    ways = [q for q in asked if q.kind in (QuestionKind.BRANCH, QuestionKind.LOOP)]
    helps = []
    if away:
        helps.append(
            f"{_named(away)} {'is' if len(away) == 1 else 'are'} not at hand: put the files "
            f"beside the program, or name them ({spelt('others')})"
        )
    if ways and moving:
        helps.append(
            f"nobody says which way it goes in line {_named(_lines(ways))}: say it in a file "
            f"({spelt('answers')}; `flyby ask` writes one)"
        )
    told = [q.key for q in program.questions if q.answered and q.table in ("values", "sequences")]
    if moving and told and not helps:
        helps.append(
            f"the answers to {_named(told)} have it so: others may lead to one ({spelt('answers')})"
        )
    run = {program.name.casefold(), *(_routine(call.text) for call in program.calls)}
    others = [entry for entry in program.entries if entry.name.casefold() not in run]
    if any(entry.moves for entry in others) or (moving and not helps):
        helps.append(f"choose as the entry the routine that drives: {listed(program.entries)}")
    what = "reaches no move" if moving else "has no move"
    why = "; or ".join(helps) or "nothing in it moves the robot"
    return MotionError(
        f"program {program.name!r} {what}: {why}",
        span=None if reading is None else Span(reading.main, 1, 1, 0, 0),
    )


def _routine(call: str) -> str:
    return call.partition("(")[0].strip().casefold()


def _lines(questions: Sequence[Question]) -> list[str]:
    return list(dict.fromkeys(str(question.span.line) for question in questions))


def _named(names: Sequence[str]) -> str:
    """``a, b and c``, or the first of many."""
    if len(names) > _MOST:
        return f"{', '.join(names[:_MOST])} and {len(names) - _MOST} more"
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
