"""A user's answers as values."""

from __future__ import annotations

import re
from typing import Protocol

from ....core.program.question import Answer, QuestionKind
from ....core.source.execution.answers import Fields
from ....core.source.execution.course import About, Course
from ..syntax.texts import Texts
from ..syntax.tree import Call, Expression, Index, MethodCall, Name
from .expected import returned_by, used, vaguer
from .instructions import ADD_ONS, asks, kept
from .values import Struct, Unknown, UrPose, Value

_PROXY = "rpc_factory"
"""What it returns stands for another computer's functions: no answer can."""
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


def given(run: Asked, call: Call | MethodCall, listed: bool = True) -> Value | None:
    """What a user says that a call returns; None if nobody says it.

    Args:
        listed: whether it is listed among the program's questions.
    """
    listed = listed and call.name != _PROXY
    own = asks(call.name) or kept(call.name) not in (None, ADD_ONS)
    expected = (returned_by(call) if own else None) or ("", None)
    about = About(run.texts.span_of(call), brought_by(call.name), *expected)
    found = run.course.value(run.texts.text_of(call), about if listed else None)
    return None if found is None else answered(found)


def answer(run: Asked, call: Call | MethodCall, name: str, listed: bool = True) -> Value:
    """What a user says that a call returns, or that nobody knows it.

    Args:
        name: of the call, where it is too long for a message.
        listed: see `given`.
    """
    value = given(run, call, listed)
    if value is not None:
        return value
    text = run.texts.text_of(call)
    reason = text if len(text) <= _LONGEST and "\n" not in text else name
    return Unknown(reason, run.texts.span_of(call), key=text)


def used_as(run: Asked, expression: Expression, value: Value, kind: str) -> None:
    """What was asked for turns out to be of a kind, as it is used so.

    Args:
        expression: that is used: what was asked for, or an element of it.
        value: of it.
        kind: of `EXPECTED`.
    """
    while isinstance(expression, Index):
        expression = expression.base
    if isinstance(value, Unknown) and value.key and isinstance(expression, Name | Call):
        words, example = used(kind, value.depth, run.course.elements(value.key))
        run.course.used_as(value.key, words, example, vaguer(kind, value.depth))


_BROUGHT = (
    ("request_", QuestionKind.OPERATOR),
    (("socket_", "rpc_", "rtde_", "ftp_"), QuestionKind.CHANNEL),
    (("read_", "modbus_", "get_digital", "get_standard", "get_config"), QuestionKind.SIGNAL),
    (("get_tool_", "get_analog", "get_flag", "get_euromap", "profinet_"), QuestionKind.SIGNAL),
    (("force", "get_tcp_force", "get_joint_torques", "tool_"), QuestionKind.SENSOR),
    (("get_steptime", "time", "random", "rq_", "cam_", "is_"), QuestionKind.SENSOR),
)


def brought_by(name: str) -> QuestionKind:
    """What a function brings, by its name."""
    found = (kind for beginnings, kind in _BROUGHT if name.startswith(beginnings))
    return next(found, QuestionKind.DATUM)


def answered(answer: Answer) -> Value:
    """A user's answer as a value; ``"p[…]"`` is a pose."""
    if isinstance(answer, Fields):
        names = tuple(name for name, _ in answer)
        return Struct(names, tuple([answered(part) for _, part in answer]))
    if isinstance(answer, tuple):
        return tuple([answered(part) for part in answer])
    if isinstance(answer, float) and answer.is_integer() and abs(answer) < 2**53:
        return int(answer)
    if isinstance(answer, str) and re.fullmatch(r"p?\[.*\]", answer):
        try:
            numbers = [float(part) for part in answer.strip("p[]").split(",")]
            return UrPose(*numbers) if answer.startswith("p") else tuple(numbers)
        except (ValueError, TypeError):
            return answer
    return answer
