"""What RAPID programs ask: by the instruction or function that brings it."""

from __future__ import annotations

import re

from ....core.program.question import Answer, QuestionKind
from .types import BOOL, NUM, STRING, RecordType, Scalar, Type

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
