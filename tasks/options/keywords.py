"""Tasks called by keywords: the Python door to a class of options."""

from __future__ import annotations

import difflib
import inspect
import re
import textwrap
from collections.abc import Callable
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar, overload

from .entries import TaskOptions, defaults, entries
from .kinds import refuse_others

_P = ParamSpec("_P")
_O = TypeVar("_O", bound=TaskOptions)
_A = TypeVar("_A")
_B = TypeVar("_B")
_R = TypeVar("_R")
_WIDTH = 92
_PLAIN = {"str", "Path", "Sequence", "float"}
"""Types of arguments that are checked here; what takes programs says itself what it takes."""
_OF_FILES = ("out", "write", "force")
"""Options of commands that write what a task hands back."""
WITH = "_with"
"""Ends the name of a task that takes its options as one value."""


@overload
def by_keywords(task: Callable[[_O], _R], options: Callable[_P, _O]) -> Callable[_P, _R]: ...
@overload
def by_keywords(
    task: Callable[[_A, _O], _R], options: Callable[_P, _O]
) -> Callable[Concatenate[_A, _P], _R]: ...
@overload
def by_keywords(
    task: Callable[[_A, _B, _O], _R], options: Callable[_P, _O]
) -> Callable[Concatenate[_A, _B, _P], _R]: ...
def by_keywords(task: Callable[..., Any], options: Callable[..., Any]) -> Callable[..., Any]:
    """A task whose last argument is a class of options, with these options as keywords.

    Types follow from the class; so do the signature and the help that Python shows.

    Args:
        task: whose arguments before the options are given by place or by name.
        options: the class.
    """
    if not (isinstance(options, type) and issubclass(options, TaskOptions)):
        raise TypeError(f"{options!r} is no class of options")
    own = list(inspect.signature(task).parameters.values())[:-1]
    taken = inspect.signature(options).parameters.values()
    signature = inspect.Signature([*own, *taken])

    @wraps(task)
    def call(*args: Any, **words: Any) -> Any:
        for word in words.keys() - signature.parameters.keys():
            near = difflib.get_close_matches(word, signature.parameters, 1)
            hint = f"; did you mean {near[0]}?" if near else ""
            if word in _OF_FILES:
                hint = "; flyby.write(result, folder) writes its files"
            raise TypeError(f"flyby.{call.__name__} has no option {word!r}{hint}")
        try:
            bound = signature.bind(*args, **words).arguments
        except TypeError as error:
            raise TypeError(f"flyby.{call.__name__}: {error}; options go by their names") from None
        first = [bound.pop(parameter.name) for parameter in own]
        for parameter, value in zip(own, first, strict=True):
            if _PLAIN.issuperset(re.findall(r"\w+", parameter.annotation)):
                refuse_others(parameter.name, value, parameter.annotation)
        return task(*first, options(**bound))

    call.__signature__ = signature  # type: ignore[attr-defined]
    call.__name__ = call.__qualname__ = task.__name__.removesuffix(WITH)
    call.__doc__ = f"{inspect.cleandoc(task.__doc__ or '')}\n\n{described(options)}"
    return call


def described(options: type[TaskOptions]) -> str:
    """Every option of a class, with its default, in the form of a docstring."""
    known = defaults(options)
    lines = ["Options:"]
    for name, entry in entries(options).items():
        usual = known.get(name)
        default = "" if usual is None or usual is False else f" Default: {usual!r}."
        text = f"{name}: {entry.explained}{default}"
        lines += textwrap.wrap(text, _WIDTH, initial_indent="    ", subsequent_indent=" " * 8)
    lines.append("    report: Is called with what is being done.")
    return "\n".join(lines)
