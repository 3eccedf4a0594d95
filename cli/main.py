"""The command ``flyby``."""

from __future__ import annotations

import logging
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from ..core.errors import FlybyError
from ..tasks.options.door import command_line
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


class Commands(TyperGroup):
    """The commands; an error that a user can cause ends them with one message and status 1."""

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        logged = _Warnings()
        log = logging.getLogger("flyby")
        log.addHandler(logged)
        try:
            with command_line():
                return super().invoke(ctx)
        except FlybyError as error:
            fail(str(error))
            raise typer.Exit(1) from None
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
app.command()(emulate)
app.command()(check)
app.command()(translate)
app.command()(record)
app.command()(experiment)
app.command()(compare)
app.command()(identify)
app.command()(zones)
app.command()(optimize)
app.command()(pareto)
app.command()(free)
app.command()(tune)
app.command()(paint)
app.command()(robots)
app.command()(vendors)
app.command(context_settings=NUMBERS_MAY_BE_NEGATIVE)(fk)
app.command(context_settings=NUMBERS_MAY_BE_NEGATIVE)(ik)


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
