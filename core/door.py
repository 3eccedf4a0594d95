"""How messages name options and commands: ``--in-place`` in a shell, ``in_place`` in Python."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

FLAGS = {"answers": "--io", "others": "--with", "parameters": "--fit"}
"""Flags of options that are called otherwise in a shell, by their names in Python."""
_COMMANDS = {"free_motion": "free"}
"""Likewise of tasks."""
_TYPED: ContextVar[bool] = ContextVar("typed", default=False)


@contextmanager
def command_line() -> Iterator[None]:
    """Have messages within name options, and state numbers, as they are typed in a shell."""
    token = _TYPED.set(True)
    try:
        yield
    finally:
        _TYPED.reset(token)


def at_command_line() -> bool:
    """Whether options are typed in a shell."""
    return _TYPED.get()


def flag_of(name: str) -> str:
    """The flag of an option that is called as in Python, or that is a flag already."""
    return name if name.startswith("-") else FLAGS.get(name, "--" + name.replace("_", "-"))


def spelt(name: str, flag: str | None = None) -> str:
    """An option as messages name it.

    Args:
        name: in Python.
        flag: at the command line, where one task alone calls it otherwise.
    """
    return (flag or flag_of(name)) if at_command_line() else name


def switched(name: str) -> str:
    """A switch that is on, as messages name it: ``--force``, ``force=True``."""
    return flag_of(name) if at_command_line() else f"{name}=True"


def given(name: str, what: str, flag: str | None = None) -> str:
    """An option with a value that stands for any, as messages name it.

    ``--out FOLDER``, ``out=FOLDER``.
    """
    return f"{spelt(name, flag)}{' ' if at_command_line() else '='}{what}"


def called(task: str, argument: str = "") -> str:
    """A task as messages name it: ``'flyby robots abb'``, ``flyby.robots("abb")``."""
    if at_command_line():
        return f"'{' '.join(filter(None, ('flyby', _COMMANDS.get(task, task), argument)))}'"
    return f"flyby.{task}({argument and repr(argument)})".replace("'", '"')
