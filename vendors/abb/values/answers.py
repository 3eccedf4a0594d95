"""Answers of a user, as values of RAPID's types."""

from __future__ import annotations

from ....core.errors import SourceError, Span
from ....core.source.execution.answers import Answer
from .elements import array_mismatch
from .types import Foreign, RecordType, Scalar, Type, Value


def free(answer: Answer) -> Value:
    """An answer to a name that nobody declares."""
    if isinstance(answer, tuple):
        return tuple(free(item) for item in answer)
    return answer


def typed(answer: Answer, type_: Type, sizes: tuple[int, ...], key: str, span: Span) -> Value:
    """An answer as a value of a type, or an array of it; 0 and 1 stand for FALSE and TRUE.

    Raises:
        SourceError: it is none.
    """
    value = _converted(answer, type_, sizes)
    wrong = array_mismatch(value, type_, sizes)
    if wrong is not None:
        raise SourceError(f"the answer to '{key}': {wrong}", span)
    return value


def like_signals(left: Value, right: Value) -> tuple[Value, Value]:
    """A signal that is answered with true or false, compared with a number, is 1 or 0."""
    if isinstance(left, bool) and type(right) is float:
        return float(left), right
    if isinstance(right, bool) and type(left) is float:
        return left, float(right)
    return left, right


def _converted(answer: Answer, type_: Type, sizes: tuple[int, ...]) -> Value:
    if isinstance(answer, tuple):
        if sizes:
            return tuple(_converted(item, type_, sizes[1:]) for item in answer)
        if isinstance(type_, RecordType) and len(answer) == len(type_.components):
            parts = zip(answer, type_.components.values(), strict=True)
            return tuple(_converted(item, part, ()) for item, part in parts)
        return free(answer)
    if isinstance(type_, Scalar) and type_.python is float and isinstance(answer, bool):
        return float(answer)
    if isinstance(type_, Scalar) and type_.python is bool and answer in (0.0, 1.0):
        return bool(answer)
    if isinstance(type_, Foreign):
        return free(answer)
    return answer
