"""Values that a move or an instruction takes: known, and of the type that is wanted."""

from __future__ import annotations

from ....core.errors import SourceError, Span
from .types import Type, Unknown, Value, find_unknown, mismatch


def check_known(value: Value, use: str, span: Span) -> None:
    """Refuse a value that only the running controller has.

    Args:
        use: what depends on it, to stand at the beginning of a message.

    Raises:
        SourceError: a part of it is not known.
    """
    unknown = find_unknown(value)
    if unknown is not None:
        raise SourceError(
            f"{use} depends on {unknown.reason}: what only the running controller knows "
            f"cannot be followed; put a fixed value in its place{_answerable(unknown)}",
            span,
        )


def check_type(
    value: Value, type_: Type, use: str, span: Span, own: Type | None = None, name: str = ""
) -> None:
    """Refuse a known value of another type.

    Args:
        own: type of the datum that has the value, None if it is none or that is not known.
        name: of the datum.

    Raises:
        SourceError: it is none of ``type_``.
    """
    wrong = mismatch(value, type_)
    if wrong is not None and own is not None and own != type_:
        wrong = f"{name} is a {own.name}, a {type_.name} is wanted"
    if wrong is not None:
        raise SourceError(f"{use}: {wrong}", span)


def _answerable(unknown: Unknown) -> str:
    if not unknown.key:
        return ""
    return f', or answer it in a file (--io): [values] "{unknown.key}" = …'
