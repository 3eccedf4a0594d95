"""The command ``flyby``."""

from __future__ import annotations

import gc
import logging
import os
from collections.abc import Iterator, Mapping
from importlib import import_module
from keyword import iskeyword
from typing import Annotated, Any, cast

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from ..core.door import command_line
from ..core.errors import FlybyError, OptionError
from ..tasks.options.shell import SHELL
from .output.console import fail, warn
from .parameters import convert_plainly

COMMANDS = {
    "emulate": "emulate",
    "view": "view",
    "ask": "emulate",
    **{
        name: name
        for name in (
            *("check", "translate", "experiment", "compare", "identify"),
            *("zones", "optimize", "pareto", "place"),
        )
    },
    "cspace": "view",
    "record": "experiment",
    "free": "free",
    "tune": "free",
    "paint": "paint",
    "station": "station",
    "import": "backup",
    "diff": "diff",
    "robots": "catalogue",
    "vendors": "catalogue",
    "new-vendor": "catalogue",
    "fk": "kinematics",
    "ik": "kinematics",
}
"""The module of each command, in the order of the help."""
LONGEST_NAME = 300
"""Characters of a file's name that are shown."""
_BETWEEN_LOOKS = 500_000
"""Objects that are made before Python looks for garbage; 700 by itself."""
NUMBERS_MAY_BE_NEGATIVE = ("fk", "ik")
"""Commands that take words which begin with a minus for numbers."""


class Command(TyperCommand):
    """A command whose help shows no type behind what takes no value."""

    def get_params(self, ctx: Any) -> Any:
        """All parameters."""
        found = super().get_params(ctx)
        for parameter in found:
            convert_plainly(parameter)
            if getattr(parameter, "is_flag", False):
                parameter.metavar = ""
        return found


class _Imported(Mapping[str, TyperCommand]):
    """Commands by name; each is imported when it is asked for."""

    def __init__(self) -> None:
        self._made: dict[str, TyperCommand] = {}

    def __getitem__(self, name: str) -> TyperCommand:
        if name not in self._made:
            module = import_module(f".{COMMANDS[name]}", __package__)
            alone = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
            settings = {"ignore_unknown_options": name in NUMBERS_MAY_BE_NEGATIVE}
            command = getattr(module, f"{name}_" if iskeyword(name) else name.replace("-", "_"))
            alone.command(name, cls=Command, context_settings=settings)(command)
            self._made[name] = cast(TyperCommand, get_command(alone))
        return self._made[name]

    def __contains__(self, name: object) -> bool:
        return name in COMMANDS

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)


class Commands(TyperGroup):
    """The commands; an error that a user can cause ends them with one message and status 1 or 2.

    It is 2 where what was typed is wrong by itself, whatever the files hold.
    """

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.commands = _Imported()  # type: ignore[assignment]

    def get_params(self, ctx: Any) -> Any:
        """All parameters."""
        found = super().get_params(ctx)
        for parameter in found:
            convert_plainly(parameter)
        return found

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        logged = _Warnings()
        log = logging.getLogger("flyby")
        log.addHandler(logged)
        try:
            with command_line(SHELL):
                return super().invoke(ctx)
        except FlybyError as error:
            fail(str(error))
            raise typer.Exit(2 if isinstance(error, OptionError) else 1) from None
        except OSError as error:  # a name that the system does not take, a disk that fails
            if error.filename is None:
                raise
            fail(f"{str(error.filename)[:LONGEST_NAME]}: {error.strerror or error}")
            raise typer.Exit(1) from None
        finally:
            log.removeHandler(logged)


app = typer.Typer(
    cls=Commands,
    help="Emulates how industrial robot controllers drive a program, checks and translates it.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"flyby {version('flyby')}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


class _Warnings(logging.Handler):
    """Tells what the library logs as the command line tells its own warnings."""

    def emit(self, record: logging.LogRecord) -> None:
        warn(record.getMessage())


def main() -> None:
    """Run the command line."""
    # Imports make many objects and no garbage: to look for it some hundred times is a tenth of a
    # short command.
    gc.set_threshold(_BETWEEN_LOOKS)
    # The matrices are small: on a busy machine further threads wait for each other, and spin.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    app(prog_name="flyby")
