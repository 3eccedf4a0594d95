"""Answers with which a program drives no less than without them.

What is not known is proposed by an example of its type. A 0, an empty text or FALSE may lead a
program past its moves: it takes them for the end of a connection, or for an order that there is
not. So examples are tried, with what the program compares each with: a proposal for whoever has to
say what it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from ..errors import FlybyError, Span
from ..program.program import Program
from ..program.question import Answer, Question
from ..source.execution.answers import Fields, key, placed
from ..source.reading import Reading

_TRIES = 40_000
"""Lines that are read, and statements that are executed, for that."""
_PLAIN: tuple[Answer, ...] = (True, 1.0, "1")
"""What may drive where nothing tells more."""


def answers_that_fit(program: Program, questions: Sequence[Question]) -> dict[str, Answer]:
    """Examples for what a program asks with which, all together and beside what is taken for
    granted, as many of its moves are known as without them; else as many as can be.

    Args:
        program: as it is read without answers to that.
        questions: to which examples are wanted.

    Returns:
        By the keys of the questions, as far as what can be tried leads to moves.
    """
    reading, least = program.reading, _known_moves(program)
    if not isinstance(reading, Reading) or not least:
        return {}
    trials = _Trials(program, reading)
    plain = {q.key: q.example for q in questions if q.example is not None}
    if trials.moves(plain) >= least:
        return plain
    found: dict[str, Answer] = {}
    for question in questions:
        best, most = None, 0
        for candidate in _candidates(question):
            if not trials.left:
                return found
            moves = trials.moves({**found, question.key: candidate})
            if moves > most:
                best, most = candidate, moves
            if most >= least:
                break
        if best is not None:
            found[question.key], least = best, min(least, most)
    return found


def _known_moves(program: Program) -> int:
    return sum(not move.open for move in program.moves)


class _Trials:
    """Reads a program again and again, with other answers, until that takes too long."""

    def __init__(self, program: Program, reading: Reading) -> None:
        asked = program.questions
        self._reading = reading
        self._taken = {
            table: {q.key: q.taken for q in asked if q.table == table and isinstance(q.taken, int)}
            for table in ("branches", "passes")
        }
        self._lines = sum(file.text.count("\n") for file in reading.files.values())
        self._spent = 0

    @property
    def left(self) -> bool:
        """Whether there may be one more."""
        return self._spent <= _TRIES

    def moves(self, values: dict[str, Answer]) -> int:
        """How many moves are known with these answers; 0 also where they are none."""
        reading, executed = self._reading, 0

        def count(_: Span) -> None:
            nonlocal executed
            executed += 1

        told = reading.options.answers
        answers = replace(
            told,
            values={**told.values, **{key(name): one for name, one in values.items()}},
            branches={**_placed(self._taken["branches"]), **told.branches},
            passes={**_placed(self._taken["passes"]), **told.passes},
        )
        options = replace(reading.options, answers=answers, executed=count)
        try:
            other = reading.read(reading.files, reading.main, options)
        except FlybyError:
            return 0
        finally:
            self._spent += self._lines + executed
        return _known_moves(other)


def _placed(taken: Mapping[str, int]) -> dict[str, int]:
    return {placed(place): number for place, number in taken.items()}


def _candidates(question: Question) -> Iterator[Answer]:
    """What may be an answer, the likeliest first."""
    example = question.example
    tried: list[Answer] = [] if example is None else [example]
    tried += question.compared
    for number in (one for one in question.compared if type(one) is float):
        tried += [number + 1.0, number - 1.0, f"{number:g}"]
    if isinstance(example, Fields):
        tried += _other_fields(example)
    elif isinstance(example, bool):
        tried.append(not example)
    elif not isinstance(example, tuple):
        tried += ["", *_PLAIN]
    for place, candidate in enumerate(tried):
        same = (one for one in tried[:place] if type(one) is type(candidate) and one == candidate)
        if not any(True for _ in same):
            yield candidate


def _other_fields(example: Fields) -> Iterator[Fields]:
    """A structure with one of its parts otherwise: true for false, 1 for 0, a word for none."""
    for changed, part in example:
        if isinstance(part, bool):
            other: Answer = not part
        elif isinstance(part, float):
            other = 0.0 if part else 1.0
        else:
            continue
        yield Fields((name, other if name == changed else one) for name, one in example)
