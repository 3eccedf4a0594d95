"""Text from anywhere as it may be shown: on a terminal, in a picture, on a page."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sized
from typing import TypeVar

T = TypeVar("T")

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def shown(text: str) -> str:
    """The text with the sign for no character in place of what terminals obey and XML lacks.

    Line feeds and tabs stay.
    """
    return _CONTROL.sub("\ufffd", text)


MOST = 120
"""Characters of a value that shows itself in a line."""


def counted(what: int | Sized, one: str, more: str | None = None) -> str:
    """A number of things: ``no notes``, ``1 note``, ``2 axes``.

    Args:
        what: how many, or the things.
        one: what one of them is called.
        more: what several are called, where it is not simply that with an s.
    """
    count = what if isinstance(what, int) else len(what)
    return f"{count or 'no'} {one if count == 1 else more or one + 's'}"


def in_line(text: str) -> str:
    """How a value shows itself: ``<text>`` in one line, cut with a sign where it is too long."""
    line = " ".join(shown(text).split())
    return f"<{line if len(line) <= MOST - 2 else line[: MOST - 3] + '…'}>"


def alike(things: Iterable[T], said: Callable[[T], str]) -> list[list[T]]:
    """Things of which the same is said but for numbers, each kind in the order of its first.

    Args:
        things: in their order.
        said: of one.
    """
    kinds: dict[str, list[T]] = {}
    for thing in things:
        kinds.setdefault(re.sub(r"-?[\d.]+", "0", said(thing)), []).append(thing)
    return list(kinds.values())
