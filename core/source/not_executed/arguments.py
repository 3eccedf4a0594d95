"""Arguments and parameters in a text, cut apart without parsing it."""

from __future__ import annotations

import re
from itertools import pairwise

from ...dialect import RoutineText

_OPENING, _CLOSING = "([{", ")]}"


def parameter_texts(routine: RoutineText) -> list[str]:
    """The parameters in a routine's heading."""
    return [part for part in parts(routine.parameters) if part.strip()]


def argument_text(behind: str) -> str:
    """What a call hands over, of the text behind the routine's name."""
    text = behind.lstrip(" \t")
    if not text.startswith("("):
        return re.split(r"[;\r\n]", text, maxsplit=1)[0]
    depth = 0
    for at, sign in enumerate(text):
        depth += (sign in _OPENING) - (sign in _CLOSING)
        if depth == 0:
            return text[1:at]
    return text[1:]


def parts(text: str) -> list[str]:
    """A text at its commas and backslashes; brackets that are closed keep theirs."""
    cuts: list[int] = []
    opened: list[int] = []
    for at, sign in enumerate(text):
        if sign in _OPENING:
            opened.append(len(cuts))
        elif sign in _CLOSING and opened:
            del cuts[opened.pop() :]
        elif sign in ",\\":
            cuts.append(at)
    return [text[a + 1 : b] for a, b in pairwise([-1, *cuts, len(text)])]


def count_arguments(text: str) -> int:
    """How many arguments end in a text that begins behind a routine's name."""
    count = depth = 0
    blank = True
    for sign in text.strip().removeprefix("("):
        depth += (sign in "([{") - (sign in ")]}")
        if depth == 0 and sign in ",\\":
            count += not blank
            blank = True
        else:
            blank = blank and sign.isspace()
    return count
