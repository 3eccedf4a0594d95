"""Values of options by the types that these are annotated with, and lists of one."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from os import PathLike
from typing import Any

from ...core.errors import OptionError

_SAID = {"str": "text", "float": "a number", "int": "a whole number", "Path": "a path"}
_SAID |= {"Sequence": "a list", "Mapping": "a mapping"}
_ALIKE = {"float": Real, "int": Integral, "Path": PathLike, "Sequence": Iterable}


def listed(value: Any, nested: bool) -> tuple[Any, ...]:
    """The entries of a list, or of one entry the list of it.

    Args:
        value: what was given.
        nested: whether entries are lists of numbers themselves.
    """
    if isinstance(value, str | PathLike) or not isinstance(value, Iterable):
        return (value,)
    values = tuple(value)
    return (values,) if nested and values and all(isinstance(v, Real) for v in values) else values


def refuse_others(name: str, value: object, hint: str) -> None:
    """Refuse a value that is of none of the types of an annotation.

    Raises:
        OptionError: naming them.
    """
    words = dict.fromkeys(re.findall(r"\w+", re.sub(r"\[[^][]*\]", "", hint)))
    if isinstance(value, Mapping) and "Mapping" not in words:
        words.pop("Sequence", None)
    words.pop("None", None)
    made = {kind.__name__ for kind in type(value).__mro__}
    if isinstance(value, bool) or not any(
        isinstance(value, _ALIKE[word]) if word in _ALIKE else word in made for word in words
    ):
        *most, last = (_SAID.get(word, word) for word in words)
        wanted = f"{', '.join(most)} or {last}" if most else last
        raise OptionError(f"{name} is {wanted}, not {value!r}")
