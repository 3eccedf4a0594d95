"""How messages name options and tasks: as in Python, as typed in a shell, or as a file has them.

A message names the option that helps. How options are typed is known above: whoever serves a shell
says so (`command_line`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import NamedTuple


class Shell(NamedTuple):
    """What is typed: ``--in-place`` for the option ``in_place``, ``free`` for a task.

    Args:
        flags: of options that are called otherwise, by their names in Python.
        commands: for tasks that are called otherwise, likewise.
    """

    flags: Mapping[str, str]
    commands: Mapping[str, str]

    def flag_of(self, name: str) -> str:
        """The flag of an option that is called as in Python, or that is a flag already."""
        if name.startswith("-"):
            return name
        return self.flags.get(name, "--" + name.replace("_", "-"))


_SHELL: ContextVar[Shell | None] = ContextVar("shell", default=None)
_KEYS: ContextVar[Mapping[str, str]] = ContextVar("keys", default=MappingProxyType({}))


@contextmanager
def command_line(shell: Shell) -> Iterator[None]:
    """Have messages within name options, and state numbers, as they are typed."""
    token = _SHELL.set(shell)
    try:
        yield
    finally:
        _SHELL.reset(token)


@contextmanager
def said_in_file(keys: Mapping[str, str]) -> Iterator[None]:
    """Have messages within name options as the keys of a file that states them.

    Args:
        keys: by the options' names in Python.
    """
    token = _KEYS.set(keys)
    try:
        yield
    finally:
        _KEYS.reset(token)


def at_command_line() -> bool:
    """Whether options are typed in a shell."""
    return _SHELL.get() is not None


def spelt(name: str, flag: str | None = None) -> str:
    """An option as messages name it.

    Args:
        name: in Python.
        flag: at the command line, where one task alone calls it otherwise.
    """
    shell = _SHELL.get()
    known = name if shell is None else flag or shell.flag_of(name)
    return _KEYS.get().get(name, known)


def switched(name: str) -> str:
    """A switch that is on, as messages name it: ``--force``, ``force=True``."""
    return spelt(name) if at_command_line() else f"{name}=True"


def given(name: str, what: str, flag: str | None = None) -> str:
    """An option with a value that stands for any, as messages name it.

    ``--out FOLDER``, ``out=FOLDER``.
    """
    if name in _KEYS.get():
        return f"{spelt(name)} = {what}"
    return f"{spelt(name, flag)}{' ' if at_command_line() else '='}{what}"


def called(task: str, argument: str = "") -> str:
    """A task as messages name it: ``'flyby robots abb'``, ``flyby.robots("abb")``."""
    shell = _SHELL.get()
    if shell is not None:
        return f"'{' '.join(filter(None, ('flyby', shell.commands.get(task, task), argument)))}'"
    return f"flyby.{task}({argument and repr(argument)})".replace("'", '"')
