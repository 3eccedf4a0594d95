"""What is odd about a program, with line, rule and what to do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.errors import FlybyError, MotionError, SourceError
from .options.keywords import by_keywords
from .setup import RobotOptions, start_of, with_setup

if TYPE_CHECKING:
    from ..core.program.program import Program
    from .results.findings import Findings


@dataclass(frozen=True, kw_only=True)
class CheckOptions(RobotOptions):
    """How a program is checked."""


def check_with(program: Program, options: CheckOptions) -> Findings:
    """Look for what goes wrong, or other than it seems: zones, limits, configurations, speeds.

    Args:
        program: as `flyby.read` gives it.

    Raises:
        InputError: nobody says which robot.
    """
    from ..core.lint.check import check as look
    from .results.findings import Findings

    program, setup = with_setup(program, options)
    return Findings(look(program, setup.vendor, setup.robot, start_of(program)))


check = by_keywords(check_with, CheckOptions)


def unread(error: FlybyError) -> Findings:
    """The finding of a program that cannot be read.

    Raises:
        FlybyError: the error itself, where it names no place in a text: a wrong file or option is
            no finding in a program.
    """
    from ..core.lint.check import unreadable
    from .results.findings import Findings

    if not isinstance(error, SourceError | MotionError) or error.span is None:
        raise error
    return Findings((unreadable(error),))
