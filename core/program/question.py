"""What a program asks of the world that no file says: one entry for each thing that it asks."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from ..errors import Span

Answer = bool | float | str | tuple["Answer", ...]
"""A value in the language's own units; arrays and records are tuples."""


class QuestionKind(StrEnum):
    """What is asked for."""

    SIGNAL = "signals and registers"
    OPERATOR = "operator dialogs"
    CHANNEL = "sockets, files and other computers"
    SENSOR = "sensors and clocks"
    DATUM = "data that nothing at hand sets"
    ROUTINE = "routines that are not at hand"
    BRANCH = "branches of unknown condition"
    LOOP = "loops without a known end"
    STREAM = "motion that a computer sends"
    PAUSE = "calls, waits and outputs that may take time"


@dataclass(frozen=True, slots=True)
class Question:
    """One thing that a program asks.

    Args:
        kind: what is asked for.
        table: of the answers file: ``values``, ``branches``, …
        key: in that table.
        span: where it is asked first.
        type: what an answer is, in words: ``true or false``, ``number``, ``robtarget``.
        taken: what holds without an answer, where that can be said in the file; None if not.
        meanwhile: what happens without an answer, in words.
        example: an answer of its type, as it may stand in the file; None where none is known.
        compared: what the program compares it with, as answers.
        answered: whether the user has answered it.
        count: how often it was asked.
    """

    kind: QuestionKind
    table: str
    key: str
    span: Span
    type: str
    taken: Answer | None = None
    meanwhile: str = ""
    example: Answer | None = None
    compared: tuple[Answer, ...] = ()
    answered: bool = False
    count: int = 1
