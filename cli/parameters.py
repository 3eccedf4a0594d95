"""Parameters of commands: made of the options of tasks, and how words become their values."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from functools import partial, wraps
from pathlib import Path
from typing import Annotated, Any, get_args, get_type_hints

import typer

from ..core.door import command_line
from ..tasks.options.entries import Entry, TaskOptions, defaults, entries, flag
from ..tasks.options.shell import SHELL

_DIGITS = 12
_AS_TYPED = (str, Path)
"""Kinds of values that any word will do for."""
_SEVERAL = 3
"""Options of a class from which on help shows them apart."""


def with_options(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose arguments that are classes of options become one parameter an option.

    An option that two classes have goes to the first of them; the other keeps its default.
    """
    hints = get_type_hints(command, include_extras=True)
    parameters: list[inspect.Parameter] = []
    groups: dict[str, tuple[type[TaskOptions], list[str]]] = {}
    taken: set[str] = set()
    for name, parameter in inspect.signature(command).parameters.items():
        kind = hints[name]
        if not (isinstance(kind, type) and issubclass(kind, TaskOptions)):
            parameters.append(parameter.replace(annotation=kind))
            taken.add(name)
            continue
        own = [o for o, e in entries(kind).items() if e.typed and o not in taken]
        groups[name] = kind, own
        taken |= set(own)
        parameters += [_parameter(kind, option) for option in own]
    # Those that must be given come first, as Python wants it.
    parameters.sort(key=lambda p: p.default is not inspect.Parameter.empty)

    @wraps(command)
    def run(**given: Any) -> None:
        made = {
            name: kind(**{option: _value(kind, option, given.pop(option)) for option in own})
            for name, (kind, own) in groups.items()
        }
        command(**given, **made)

    named = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in parameters]
    run.__signature__ = inspect.Signature(named)  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in named}
    return run


def _parameter(kind: type[TaskOptions], name: str) -> inspect.Parameter:
    entry = entries(kind)[name]
    default: Any = defaults(kind).get(name, inspect.Parameter.empty)
    hint: Any = entry.kind
    if entry.several:
        hint, default = list[hint] | None, None
    elif default is None:
        hint = hint | None
    elif entry.kind is float and default is not inspect.Parameter.empty:
        default = float(f"{default / entry.scale.factor:.{_DIGITS}g}")
    with command_line(SHELL):
        option = typer.Option(
            flag(kind, name), help=entry.explained, rich_help_panel=_panel(kind, name)
        )
    return inspect.Parameter(
        name,
        inspect.Parameter.KEYWORD_ONLY,
        default=default,
        annotation=Annotated[hint, option],
    )


def _panel(kind: type[TaskOptions], name: str) -> str | None:
    """What the class that states an option is about, if it states several."""
    owner = next(one for one in kind.__mro__ if name in one.__annotations__)
    own = [o for o in entries(kind) if o in owner.__annotations__]
    about = re.split(r"[.;:]", owner.__doc__ or "")[0]
    return about if len(own) >= _SEVERAL else None


def _value(kind: type[TaskOptions], name: str, typed: Any) -> Any:
    """What was typed, in SI units."""
    entry: Entry = entries(kind)[name]
    if entry.several:
        return tuple(typed or ())
    if entry.kind is float and typed is not None and entry.scale.factor != 1.0:
        return entry.scale.factor * typed
    return typed


def convert_plainly(parameter: Any) -> None:
    """Have a parameter convert texts, paths and what was not given by itself.

    To import pydantic, by which typer converts words, and to have it make a converter of each
    option takes a twentieth of a second, whatever was typed; most of that is names of files.
    Numbers and choices are left to typer, which knows what to say of a wrong one.

    Args:
        parameter: of a typer command; of a version that states no types it stays as it is.
    """
    kind = getattr(getattr(parameter, "type_descriptor", None), "annotation", None)
    if kind is not None and "process_value" not in vars(parameter):
        parameter.process_value = partial(_processed, parameter, kind, parameter.process_value)


def _processed(parameter: Any, kind: Any, usual: Any, context: Any, value: Any) -> Any:
    """The value of a parameter from what was typed, or its default."""
    if value is None and not parameter.required:
        none = () if parameter.multiple or parameter.nargs == -1 else None
        known = parameter.callback
        return none if known is None else known(context, parameter, none)
    if parameter.callback is None:
        each = get_args(kind)
        if kind in _AS_TYPED and isinstance(value, str):
            return kind(value)
        if parameter.multiple and each in [(one,) for one in _AS_TYPED]:
            return [each[0](one) for one in value]
        if type(value) is kind:
            return value
    return usual(context, value)


ProgramFile = Annotated[Path, typer.Argument(help="Program file in its vendor's language.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the report as JSON.")]
Force = Annotated[bool, typer.Option("--force", help="Replace output files.")]
Out = Annotated[Path | None, typer.Option("--out", help="Folder to write the files to.")]
InPlace = Annotated[bool, typer.Option("--in-place", help="Change the program's own files.")]
PageFile = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Write a page to look at in a browser (HTML): cell, program and plots on one clock.",
    ),
]
Plot = Annotated[Path | None, typer.Option("--plot", help="Draw it: PNG, PDF or SVG.")]
CellPlot = Annotated[
    Path | None,
    typer.Option("--plot", help="Draw the cell with the path before and after: PNG, PDF or SVG."),
]
