"""The command ``flyby``."""

from __future__ import annotations

import logging
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from ..core.door import command_line
from ..core.errors import FlybyError, OptionError
from ..tasks.options.shell import SHELL
from .catalogue import robots, vendors
from .check import check
from .compare import compare
from .console import fail, warn
from .emulate import emulate
from .experiment import experiment
from .free import free, tune
from .identify import identify
from .kinematics import fk, ik
from .optimize import optimize
from .paint import paint
from .pareto import pareto
from .record import record
from .translate import translate
from .zones import zones

LONGEST_NAME = 300
"""Characters of a file's name that are shown."""
NUMBERS_MAY_BE_NEGATIVE = {"ignore_unknown_options": True}


class Command(TyperCommand):
    """A command whose help shows no type behind what takes no value."""

    def get_params(self, ctx: Any) -> Any:
        """All parameters."""
        found = super().get_params(ctx)
        for parameter in found:
            if getattr(parameter, "is_flag", False):
                parameter.metavar = ""
        return found


class Commands(TyperGroup):
    """The commands; an error that a user can cause ends them with one message and status 1 or 2.

    It is 2 where what was typed is wrong by itself, whatever the files hold.
    """

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
for command in (
    *(emulate, check, translate, record, experiment, compare, identify, zones),
    *(optimize, pareto, free, tune, paint, robots, vendors),
):
    app.command(cls=Command)(command)
for command in (fk, ik):
    app.command(cls=Command, context_settings=NUMBERS_MAY_BE_NEGATIVE)(command)


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
    app(prog_name="flyby")
