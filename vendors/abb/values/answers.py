"""Answers of a user, as values of RAPID's types; what is asked for, and what answers look like."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable

from ....core.errors import Span
from ....core.program.question import Answer, QuestionKind
from ....core.source.execution.answers import Fields
from ....core.source.execution.course import About, AnswerError, Course
from ....core.spatial.pose import Pose
from ..syntax import tree
from .elements import array_mismatch
from .types import BOOL, NUM, STRING, Foreign, RecordType, Scalar, Type, Unknown, Value

_TRUTH = re.compile(r"\b(TRUE|FALSE)\b", re.IGNORECASE)


_BROUGHT = tuple(
    (re.compile(pattern), kind)
    for pattern, kind in (
        (r"tp\w*|ui\w*", QuestionKind.OPERATOR),
        (r"socket\w*|rmq\w*|read\w*|write\w*|unpack\w*|getdataval|filesize", QuestionKind.CHANNEL),
        (
            r"cam\w*|clk\w*|c?time|cdate|gettime|.*(force|sensor|search|torque).*",
            QuestionKind.SENSOR,
        ),
        (
            r"(test)?d?[adg]?(in|out)put|testdi|test_?signal\w*|valid(io)?|iounit\w*",
            QuestionKind.SIGNAL,
        ),
    )
)
_WORDS = {BOOL: "true or false", NUM: "number", STRING: "text"}


def kind_brought_by(name: str) -> QuestionKind:
    """What an instruction or a function of a name brings, lower case."""
    found = (kind for pattern, kind in _BROUGHT if pattern.fullmatch(name))
    return next(found, QuestionKind.DATUM)


def type_in_words(type_: Type | None, sizes: tuple[int, ...] = ()) -> str:
    """A type as an answer's; empty if it is not known."""
    if type_ is None:
        return ""
    named = _WORDS.get(type_, type_.name) if isinstance(type_, Scalar) else type_.name
    return f"{named} [{', '.join(map(str, sizes))}]" if sizes else named


def example_of(type_: Type | None, sizes: tuple[int, ...] = ()) -> Answer | None:
    """An answer of a type, None if there is none."""
    if sizes:
        one = example_of(type_, sizes[1:])
        return None if one is None else (one,) * sizes[0]
    if isinstance(type_, Scalar):
        return type_.default
    if not isinstance(type_, RecordType):
        return None
    if type_.name == "orient":
        return 1.0, 0.0, 0.0, 0.0
    if type_.name == "speeddata":
        return 1000.0, 500.0, 5000.0, 1000.0
    if type_.name == "extjoint":
        return (9e9,) * len(type_.components)
    parts = [example_of(part) for part in type_.components.values()]
    if type_.name in ("tooldata", "wobjdata"):
        parts[0] = type_.name == "tooldata"
    if type_.name == "wobjdata":
        parts[1] = True
    if any(part is None for part in parts):
        return None
    return tuple(part for part in parts if part is not None)


_FRAME_AT = {3: 1, 5: 3}
"""Where the frame stands in a record of so many components: a tool's, a work object's."""


def frame_answer(example: Answer, pose: Pose) -> Answer | None:
    """A pose as a user answers a tool or a work object, mm; None where neither is asked."""
    if not isinstance(example, tuple) or not isinstance(example[0], bool):
        return None
    at = _FRAME_AT.get(len(example))
    if at is None:
        return None
    place = tuple(round(1000 * value, 3) + 0.0 for value in pose.position)
    turned = tuple(round(value, 6) + 0.0 for value in pose.quaternion)
    return (*example[:at], (place, turned), *example[at + 1 :])


class TypedAnswers:
    """The user's answers to expressions of a program."""

    def __init__(self, course: Course, text_of: Callable[[Span], str]) -> None:
        self._course = course
        self._text_of = text_of

    def key(self, span: Span) -> str:
        """Under which the user may answer the expression at a place."""
        return " ".join(self._text_of(span).split())

    def ask(
        self,
        span: Span,
        type_: Type | None,
        sizes: tuple[int, ...] = (),
        kind: QuestionKind | None = None,
    ) -> Value | None:
        """The user's answer to the expression at a place, None if there is none.

        Args:
            type_: of the answer, None if it is not known.
            kind: what it is that is asked; None for what comes of something else that is.

        Raises:
            AnswerError: the answer is of another type.
        """
        return self.ask_by(self.key(span), span, type_, sizes, kind)

    def stated(self, call: str) -> float | None:
        """What the controller is known to say to a call; None if that is not known."""
        return self._course.stated(call)

    def ask_by(
        self,
        key: str,
        span: Span,
        type_: Type | None,
        sizes: tuple[int, ...],
        kind: QuestionKind | None = None,
    ) -> Value | None:
        """The same under a key."""
        about = None
        if kind is not None and not isinstance(type_, Foreign):
            about = About(span, kind, type_in_words(type_, sizes), example_of(type_, sizes))
        answer = self._course.value(key, about) if key else None
        if answer is None:
            return None
        return _free(answer) if type_ is None else _typed(answer, type_, sizes, key, span)

    def used_as(self, expression: tree.Expression, value: Value, type_: Type | None) -> None:
        """What was asked turns out to be of a type, as it is used so.

        Args:
            expression: that is used: what was asked, or an aggregate with it.
            value: of it.
        """
        if isinstance(expression, tree.Aggregate) and isinstance(value, tuple):
            if isinstance(type_, RecordType) and len(value) == len(type_.components):
                parts = zip(expression.items, value, type_.components.values(), strict=True)
                for item, part, component in parts:
                    self.used_as(item, part, component)
            return
        if not isinstance(value, Unknown) or not value.key or isinstance(type_, Foreign | None):
            return
        example = example_of(type_)
        if example is not None and value.key == self.key(expression.span):
            self._course.used_as(value.key, type_in_words(type_), example)

    def compared(self, value: Value, other: Value) -> None:
        """What was asked, or what comes of it, is compared with a value."""
        if isinstance(value, Unknown) and value.key and isinstance(other, bool | float | str):
            self._course.compared(value.key, other)

    def kind_of(self, unknown: Unknown, span: Span) -> QuestionKind | None:
        """What the expression at a place asks for; None if it comes of something else that is
        asked."""
        derived = unknown.key != self.key(span) and self._course.lists(unknown.key)
        return None if derived else QuestionKind.DATUM

    def assumed(self, span: Span, message: str) -> None:
        """Note what is taken where there is no answer."""
        self._course.decided(span, message, listed=False)

    @property
    def guessed(self) -> bool:
        """Whether the program's course, or a value, was decided without an answer."""
        return self._course.guessed

    def in_turn(self, span: Span) -> bool:
        """Whether the user answers the expression at a place in turn."""
        return self._course.changing(self.key(span))


def _free(answer: Answer) -> Value:
    """An answer to a name that nobody declares."""
    if isinstance(answer, tuple):
        return tuple(_free(item) for item in answer)
    return answer


def _typed(answer: Answer, type_: Type, sizes: tuple[int, ...], key: str, span: Span) -> Value:
    """An answer as a value of a type, or an array of it; 0 and 1 stand for FALSE and TRUE.

    Raises:
        AnswerError: it is none.
    """
    value = _converted(answer, type_, sizes)
    wrong = array_mismatch(value, type_, sizes)
    if wrong is None:
        return value
    hint = ""
    if isinstance(answer, tuple) and not isinstance(answer, Fields) and answer:
        each = [_converted(item, type_, sizes) for item in answer]
        if all(array_mismatch(item, type_, sizes) is None for item in each):
            hint = "; answers one after the other stand in [sequences]"
    raise AnswerError(f"the answer to '{key}': {wrong}{hint}", span)


def like_signals(left: Value, right: Value) -> tuple[Value, Value]:
    """A signal that is answered with true or false, compared with a number, is 1 or 0."""
    if isinstance(left, bool) and type(right) is float:
        return float(left), right
    if isinstance(right, bool) and type(left) is float:
        return left, float(right)
    return left, right


def _aggregate(text: str) -> Answer:
    """``[[1,2,3],TRUE,"text"]`` as a value; the text itself if it is none."""
    try:
        return _parsed(json.loads(_TRUTH.sub(lambda found: found[0].lower(), text)))
    except (ValueError, RecursionError):
        return text


def _parsed(item: object) -> Answer:
    if isinstance(item, list):
        return tuple(map(_parsed, item))
    if isinstance(item, bool | str):
        return item
    if isinstance(item, int | float) and math.isfinite(item):
        return float(item)
    raise ValueError("no value of RAPID")


def _in_order(fields: Fields, type_: RecordType) -> Answer:
    """The components of a record in its order; those that are left out have examples' values."""
    given = {name.lower(): part for name, part in fields}
    usual = example_of(type_)
    if not isinstance(usual, tuple) or not given.keys() <= type_.components.keys():
        return fields
    pairs = zip(type_.components, usual, strict=True)
    return tuple(given.get(name, part) for name, part in pairs)


def _converted(answer: Answer, type_: Type, sizes: tuple[int, ...]) -> Value:
    if isinstance(answer, str) and (type_ is not STRING or sizes) and answer.startswith("["):
        answer = _aggregate(answer)  # as RAPID writes it
    if isinstance(answer, Fields) and isinstance(type_, RecordType):
        answer = _in_order(answer, type_)
    if isinstance(answer, tuple):
        if sizes:
            return tuple(_converted(item, type_, sizes[1:]) for item in answer)
        if isinstance(type_, RecordType) and len(answer) == len(type_.components):
            parts = zip(answer, type_.components.values(), strict=True)
            return tuple(_converted(item, part, ()) for item, part in parts)
        return _free(answer)
    if isinstance(type_, Scalar) and type_.python is float and isinstance(answer, bool):
        return float(answer)
    if isinstance(type_, Scalar) and type_.python is bool and answer in (0.0, 1.0):
        return bool(answer)
    if isinstance(type_, Foreign):
        return _free(answer)
    return answer
