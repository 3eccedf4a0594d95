"""How much of a program is executed before it is taken for one without an end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ...door import at_command_line, given
from ...errors import SourceError, Span

Executed = Callable[[Span], None]
"""Called with a statement that is executed."""


@dataclass(frozen=True, slots=True)
class ExecutionLimits:
    """Bounds of one execution of a program.

    Args:
        statements: executed in a row without a move among them.
        moves: executed that had been before: a long program without a loop is none without an end.
        passes: of a loop that moves the robot and of which nothing tells when it ends.
        calls: routines that have called each other.
    """

    statements: int = 100_000
    moves: int = 20_000
    passes: int = 2_000
    calls: int = 40


def _remedy() -> str:
    """What helps; the limits are raised where the reader is called, and not at the command."""
    raised = "" if at_command_line() else ", or give the reader higher ones: ReadOptions(limits=…)"
    return f"Give it an end, or choose a routine without it ({given('entry', 'NAME')}){raised}"


class EndlessError(SourceError):
    """A program goes on and on.

    Args:
        what: goes on, and how.
        span: where that shows.
        foreseen: whether it is the loop that stands there.
        ends: whether the loop has an end, as far as can be foreseen.

    Attributes:
        loop: the outermost one that was under way again and again; None if there is none.
    """

    def __init__(self, what: str, span: Span, *, foreseen: bool = False, ends: bool = True) -> None:
        super().__init__(f"{what}. {_remedy()}", span)
        self.what = what
        self.foreseen = foreseen
        self.ends = ends
        self.loop: Span | None = span if foreseen else None


class Meter:
    """Counts what is executed.

    Args:
        limits: what must not be passed.
        executed: called with every statement; None for no calls.

    Attributes:
        moves: that were executed.
        row: statements that were executed since the last move.
    """

    def __init__(self, limits: ExecutionLimits, executed: Executed | None = None) -> None:
        self._limits = limits
        self._executed = executed
        self.row = 0
        self.moves = 0
        self._places: set[tuple[str, int, int]] = set()
        self._ways: set[tuple[int, str, int, int]] = set()
        self._chains: dict[tuple[int, str, int, int], int] = {}  # of calls, by the one before
        self._calls = [0]

    @property
    def driven(self) -> int:
        """How many different statements have moved the robot: one of a routine as many as the ways
        by which it was called."""
        return len(self._ways)

    @property
    def patience(self) -> int:
        """Statements of a loop in a row without a move, after which it is left: few enough that
        what comes behind it has room."""
        return self._limits.statements // 2

    def statement(self, span: Span) -> None:
        """A statement, or a pass of a loop.

        Raises:
            SourceError: there are too many since the last move.
        """
        self.row += 1
        if self._executed is not None:
            self._executed(span)
        if self.row > self._limits.statements:
            raise _endless(f"{self._limits.statements} statements are executed in a row", span)

    def move(self, span: Span) -> None:
        """A move.

        Raises:
            SourceError: there are too many.
        """
        self.moves += 1
        self.row = 0
        self._places.add((span.file, span.line, span.column))
        self._ways.add((self._calls[-1], span.file, span.line, span.column))
        if self.moves - len(self._places) > self._limits.moves:
            raise _endless(f"{self._limits.moves} moves are executed again", span)

    def ahead(self, passes: float, moves: float, words: str, span: Span) -> None:
        """A loop will run for so many passes more, with so many moves each.

        Args:
            words: what messages call it.
            span: of it.

        Raises:
            SourceError: that is more than a program may move.
        """
        if not moves or passes * moves <= self._limits.moves:
            return
        ends = passes != math.inf
        left = f"has {passes:.6g} passes left" if ends else "comes no nearer to its end"
        what = f"{words} {left}, with {moves:.3g} moves each: more than the {self._limits.moves}"
        raise EndlessError(f"{what} that are read", span, foreseen=True, ends=ends)

    def passed(self, passes: int, nears: Callable[[], bool], words: str, span: Span) -> None:
        """A loop that moves the robot has run for so many passes.

        Args:
            nears: whether it has come nearer to its end, as far as anything shows it.
            words: what messages call it.
            span: of it.

        Raises:
            SourceError: these are too many for one of which nothing tells when it ends.
        """
        if passes == self._limits.passes and not nears():
            what = f"{words} has run {passes} times, and nothing tells when it ends"
            raise EndlessError(what, span, foreseen=True)

    def has_room(self, statements: float) -> bool:
        """Whether so many statements more may be executed in a row."""
        return self.row + statements <= self._limits.statements

    def call(self, name: str, span: Span) -> None:
        """A routine is entered; `back` is called when it is left.

        Raises:
            SourceError: too many have called each other.
        """
        key = self._calls[-1], span.file, span.line, span.column
        self._calls.append(self._chains.setdefault(key, len(self._chains) + 1))
        if len(self._calls) > self._limits.calls + 1:
            raise SourceError(
                f"{name}: {self._limits.calls} routines have called each other: a recursion "
                "without end? Controllers do not go deeper either",
                span,
            )

    def back(self) -> None:
        """A routine is left."""
        self._calls.pop()


def _endless(what: str, span: Span) -> EndlessError:
    return EndlessError(f"{what} and the program has not ended: a loop without end?", span)
