"""A user's answers as values."""

from __future__ import annotations

from typing import Protocol

from ....core.source.execution.answers import Answer, Course
from ..syntax.texts import Texts
from ..syntax.tree import Call, MethodCall
from .values import Unknown, UrPose, Value

_LONGEST = 60
"""Characters of a call that stands in messages as it is written."""


class Asked(Protocol):
    """What a question asks of the run that it comes up in."""

    @property
    def texts(self) -> Texts:
        """Where places are looked up."""

    @property
    def course(self) -> Course:
        """Answers for what the text leaves open."""


def given(run: Asked, call: Call | MethodCall) -> Value | None:
    """What a user says that a call returns; None if nobody says it."""
    found = run.course.value(run.texts.text_of(call))
    return None if found is None else answered(found)


def answer(run: Asked, call: Call | MethodCall, name: str) -> Value:
    """What a user says that a call returns, or that nobody knows it.

    Args:
        name: of the call, where it is too long for a message.
    """
    value = given(run, call)
    if value is not None:
        return value
    text = run.texts.text_of(call)
    reason = text if len(text) <= _LONGEST and "\n" not in text else name
    return Unknown(reason, run.texts.span_of(call))


def answered(answer: Answer) -> Value:
    """A user's answer as a value; ``"p[…]"`` is a pose."""
    if isinstance(answer, tuple):
        return tuple([answered(part) for part in answer])
    if isinstance(answer, float) and answer.is_integer() and abs(answer) < 2**53:
        return int(answer)
    if isinstance(answer, str) and answer.startswith("p[") and answer.endswith("]"):
        try:
            return UrPose(*[float(part) for part in answer[2:-1].split(",")])
        except (ValueError, TypeError):
            return answer
    return answer
