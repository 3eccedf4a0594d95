"""Programs that are loaded together and driven one after the other, each with a log of its own."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .errors import InputError, Span
from .program.program import Program
from .program.section import Section

LOG = "flyby_log.csv"
"""What a log is called where nobody says."""


@dataclass(frozen=True)
class RecordedRun:
    """One of the programs.

    Args:
        program: with the way to where it begins.
        log: name of the file that its samples go into.
        by_hand: whether the robot is jogged to where it begins, as nothing is known of the way
            there from the end of the run before.
    """

    program: Program
    log: str = LOG
    by_hand: bool = False


@dataclass(frozen=True)
class Recording:
    """What is loaded at once.

    Args:
        name: of the program that drives all runs.
        runs: in their order, one at least.
    """

    name: str
    runs: tuple[RecordedRun, ...]

    @classmethod
    def of(cls, program: Program) -> Recording:
        """A program alone."""
        return cls(program.name, (RecordedRun(program),))

    @property
    def alone(self) -> bool:
        """Whether there is one run, which needs no routine of its own."""
        return len(self.runs) == 1

    @property
    def jogged(self) -> tuple[int, ...]:
        """Runs, counted from 1, that the robot is jogged to after others have been driven."""
        return tuple(k for k, run in enumerate(self.runs, 1) if run.by_hand and k > 1)

    @property
    def program(self) -> Program:
        """All runs as one program: each a routine of its own, `routine`, if there are several."""
        if self.alone:
            return self.runs[0].program
        sections, begin = [], 0
        for number, run in enumerate(self.runs, 1):
            end = begin + len(run.program.statements)
            sections.append(Section(routine(number), begin, end, Span("", 1, 1, 0, 0)))
            begin = end
        statements = tuple(one for run in self.runs for one in run.program.statements)
        return Program(statements, self.name, sections=tuple(sections))


def routine(number: int) -> str:
    """What the routine of a run is called, counted from 1."""
    return f"run{number:02}"


def cycles_in(period: float, cycle: float, robot: str) -> int:
    """How many of a controller's cycles a log's period is.

    Args:
        period, cycle: s.
        robot: for the message.

    Raises:
        InputError: it is no whole number of them.
    """
    cycles = period / cycle if math.isfinite(period) else 0.0
    if round(cycles) < 1 or abs(cycles - round(cycles)) > 1e-6 * cycles:
        raise InputError(
            f"{robot} runs in cycles of {cycle:g} s: a log has a period of {cycle:g} s or a whole "
            f"multiple of it, not {period:g} s"
        )
    return round(cycles)


def comments(mark: str, sentences: Iterable[str]) -> list[str]:
    """Sentences as comments of a text, in lines of no more than 90 characters."""
    return [
        line
        for sentence in sentences
        for line in textwrap.wrap(
            sentence, 90, initial_indent=f"{mark} ", subsequent_indent=f"{mark} "
        )
    ]


def listed(numbers: Sequence[int]) -> str:
    """``run 3``, ``runs 3, 5 and 7``"""
    *most, last = map(str, numbers)
    return f"runs {', '.join(most)} and {last}" if most else f"run {last}"
